#include "batch_output.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <system_error>
#include <utility>

#include "taut/core/error.hpp"
#include "taut/io/output_file.hpp"

namespace taut::app {

namespace {

bool answered(std::string_view line) {
  std::size_t begin = 0;
  for (int column = 0; column < 4; ++column) begin = line.find(',', begin) + 1;
  return line.substr(begin, line.find(',', begin) - begin) == "ok";
}

}  // namespace

BatchOutput::BatchOutput(const std::string& header) {
  if (!header.empty()) write(header + "\n");
}

BatchOutput::BatchOutput(const std::filesystem::path& file, std::string_view request, std::string header_line)
    : file_(file), partial_(file.string() + ".partial"), header_(std::move(header_line)) {
  const std::string header = "# " + std::string(request) + "\n";
  read_earlier(header);
  out_ = std::fopen(partial_.c_str(), num_done_ > 0 ? "ab" : "wb");
  if (out_ == nullptr) throw IoError(partial_.string(), std::string("cannot be written: ") + std::strerror(errno));
  if (num_done_ == 0) write(header);
}

BatchOutput::~BatchOutput() {
  if (out_ != nullptr) std::fclose(out_);
}

/// Counts the whole lines of an earlier run of the same request, and cuts off one that was not finished.
void BatchOutput::read_earlier(std::string_view header) {
  std::ifstream in(partial_, std::ios::binary);
  std::string line;
  if (!std::getline(in, line) || in.eof() || line + "\n" != header) return;
  std::uintmax_t size = header.size();
  while (std::getline(in, line) && !in.eof()) {
    size += line.size() + 1;
    ++num_done_;
    some_failed_ = some_failed_ || !answered(line);
  }
  in.close();
  std::error_code error;
  std::filesystem::resize_file(partial_, size, error);
  if (error) throw IoError(partial_.string(), "cannot be continued: " + error.message());
}

void BatchOutput::write(std::string_view lines) {
  if (out_ == nullptr) {
    std::cout << lines << std::flush;
    return;
  }
  if (std::fwrite(lines.data(), 1, lines.size(), out_) != lines.size() || std::fflush(out_) != 0) {
    throw IoError(partial_.string(), std::string("cannot be written to the end: ") + std::strerror(errno));
  }
}

void BatchOutput::finish() {
  if (out_ == nullptr) return;
  std::fclose(out_);
  out_ = nullptr;
  std::ifstream in(partial_, std::ios::binary);
  std::string line;
  std::getline(in, line);  // the request
  OutputFile out(file_);
  if (!header_.empty()) out.write(header_ + "\n");
  std::string block(1 << 16, '\0');
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0) {
    out.write(std::string_view(block.data(), static_cast<std::size_t>(in.gcount())));
  }
  out.commit();
  in.close();
  std::error_code ignored;
  std::filesystem::remove(partial_, ignored);
}

}  // namespace taut::app
