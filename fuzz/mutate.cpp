// Runs a fuzz target without a fuzzing engine: `TARGET SECONDS FILE...` feeds it random mutations of the files, after
// the files themselves, for so long. Without coverage feedback it finds less than libFuzzer, but it needs no Clang.
// What fails is left in the file "failed_input" beside the program.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kLastInput = "failed_input";
constexpr std::size_t kLongest = 4096;  // of a seed: short inputs reach more of a parser per second

void run(const std::string& bytes) {
  std::ofstream(kLastInput, std::ios::binary) << bytes;
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

/// Changes, removes, repeats or inserts a few bytes; digits and signs more often, since counts are where parsers break.
std::string mutated(std::string bytes, const std::vector<std::string>& seeds, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
  const std::string favourites = "0123456789-+.eE,; \t\r\n\"#/\\naninf";
  for (std::size_t k = 1 + below(6); k > 0; --k) {
    const std::size_t at = below(bytes.size());
    const std::size_t length = below(std::min<std::size_t>(bytes.size() - at, 32) + 1);
    switch (below(7)) {
      case 0: bytes[at] = static_cast<char>(random()); break;
      case 1: bytes[at] = favourites[below(favourites.size())]; break;
      case 2: bytes.erase(at, length); break;
      case 3: bytes.insert(at, bytes.substr(at, length)); break;
      case 4: bytes.insert(at, 1 + below(12), favourites[below(favourites.size())]); break;
      case 5: bytes.resize(at); break;
      default: {
        const std::string& other = seeds[below(seeds.size())];
        const std::size_t from = below(other.size());
        bytes.insert(at, other.substr(from, below(64)));
      }
    }
    if (bytes.empty()) bytes = "0";
  }
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: %s SECONDS FILE...\n", argv[0]);
    return 2;
  }
  std::vector<std::string> seeds;
  for (int i = 2; i < argc; ++i) {
    std::ifstream in(argv[i], std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (bytes.size() > kLongest) bytes.resize(kLongest);
    if (!bytes.empty()) seeds.push_back(std::move(bytes));
  }
  if (seeds.empty()) return 2;
  for (const std::string& file : seeds) run(file);
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  const auto end = Clock::now() + std::chrono::duration<double>(std::atof(argv[1]));
  long count = 0;
  for (; Clock::now() < end; ++count) run(mutated(seeds[random() % seeds.size()], seeds, random));
  std::remove(kLastInput);
  std::printf("%s: %ld mutations of %zu files, seed %u: no failure\n", argv[0], count, seeds.size(), seed);
  return 0;
}
