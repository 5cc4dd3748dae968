#pragma once

#include <cstddef>
#include <filesystem>
#include <istream>

namespace taut::detail {

/// Bytes this process may use: the machine's memory, or less where the process (`ulimit -v`) or its control group (a
/// container, a batch system) is held to less. Asked once.
[[nodiscard]] std::size_t machine_memory();

/// The least limit that the control groups of a process set to its memory, the groups around them included; the largest
/// number there is when there is none. `membership`: the lines of /proc/self/cgroup; `root`: /sys/fs/cgroup. Versions 1
/// and 2 (Linux manual, cgroups(7)).
[[nodiscard]] std::size_t control_group_limit(std::istream& membership, const std::filesystem::path& root);

}  // namespace taut::detail
