#include "core/machine_memory.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#ifdef __unix__
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace taut::detail {
namespace {

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

// Where the machine does not say how much it has.
[[maybe_unused]] constexpr std::size_t kAssumedMemory = std::size_t{4} << 30;

std::size_t physical_memory() {
#ifdef _SC_PHYS_PAGES
  const long pages = sysconf(_SC_PHYS_PAGES);
  const long page_size = sysconf(_SC_PAGE_SIZE);
  if (pages > 0 && page_size > 0) return static_cast<std::size_t>(pages) * static_cast<std::size_t>(page_size);
#endif
  return kAssumedMemory;
}

std::size_t process_limit() {
#ifdef RLIMIT_AS
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) return limit.rlim_cur;
#endif
  return kNoLimit;
}

/// The number in a file; no limit where there is no file, or a word ("max").
std::size_t number_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::size_t number = 0;
  return in >> number ? number : kNoLimit;
}

}  // namespace

std::size_t control_group_limit(std::istream& membership, const std::filesystem::path& root) {
  std::size_t least = kNoLimit;
  for (std::string line; std::getline(membership, line);) {  // HIERARCHY:CONTROLLERS:/GROUP
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = ',' + line.substr(first + 1, second - first - 1) + ',';
    const bool unified = controllers == ",,";
    if (!unified && controllers.find(",memory,") == std::string::npos) continue;
    const std::filesystem::path mount = unified ? root : root / "memory";
    const char* file = unified ? "memory.max" : "memory.limit_in_bytes";
    // In a container the group may be named as the host sees it, while the mount shows the container's own as its root.
    least = std::min(least, number_in(mount / file));
    std::filesystem::path group = mount;
    for (const auto& name : std::filesystem::path(line.substr(second + 1)).relative_path()) {
      group /= name;
      least = std::min(least, number_in(group / file));
    }
  }
  return least;
}

std::size_t machine_memory() {
  static const std::size_t memory = [] {
    std::ifstream membership("/proc/self/cgroup");
    return std::min({physical_memory(), process_limit(), control_group_limit(membership, "/sys/fs/cgroup")});
  }();
  return memory;
}

}  // namespace taut::detail
