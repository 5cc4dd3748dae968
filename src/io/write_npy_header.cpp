#include "taut/io/output_file.hpp"

#include <string>
#include <string_view>

namespace taut {

void write_npy_header(OutputFile& out, const std::vector<Index>& shape) {
  constexpr std::size_t kAlignment = 64;
  std::string extents;
  for (const Index extent : shape) extents += std::to_string(extent) + (shape.size() == 1 ? "," : ", ");
  if (shape.size() > 1) extents.resize(extents.size() - 2);
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + extents + "), }";
  header.resize((header.size() + 11 + kAlignment - 1) / kAlignment * kAlignment - 11, ' ');
  out.write(std::string_view("\x93NUMPY\x01\0", 8));
  out.write({std::string{static_cast<char>((header.size() + 1) & 0xFF), static_cast<char>((header.size() + 1) >> 8)}});
  out.write(header + "\n");
}

}  // namespace taut
