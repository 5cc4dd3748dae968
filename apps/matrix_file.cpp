// Rows of a matrix on disk. FILE.partial is a line of text, then 64-bit floats: of a dense row its entries, of a sparse
// one how many there are, then pairs (column, distance). A row that was not finished is cut off.

#include "matrix_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include "taut/core/error.hpp"
#include "taut/io/output_file.hpp"

namespace taut::app {
namespace {

std::string_view bytes_of(const std::vector<double>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)};
}

bool is_npy(const std::filesystem::path& file) { return file.extension() == ".npy"; }

}  // namespace

MatrixFile::MatrixFile(std::filesystem::path file, std::string_view request, MatrixLayout layout, Index rows,
                       Index columns)
    : file_(std::move(file)), partial_(file_.string() + ".partial"), layout_(layout), rows_(rows), columns_(columns) {
  const std::string header = "# " + std::string(request) + "\n";
  header_size_ = header.size();
  read_earlier(header);
  out_ = std::fopen(partial_.c_str(), num_done_ > 0 ? "ab" : "wb");
  if (out_ == nullptr) fail(std::string("cannot be written: ") + std::strerror(errno));
  if (num_done_ == 0 && std::fwrite(header.data(), 1, header.size(), out_) != header.size()) {
    fail(std::string("cannot be written: ") + std::strerror(errno));
  }
}

MatrixFile::~MatrixFile() {
  if (out_ != nullptr) std::fclose(out_);
}

void MatrixFile::fail(const std::string& what) const { throw IoError(partial_.string(), what); }

Index MatrixFile::dense_length(Index row) const {
  return layout_ == MatrixLayout::full ? columns_ : columns_ - row - 1;
}

/// Finds the whole rows of an earlier run of the same request, and cuts off one that was not finished.
void MatrixFile::read_earlier(std::string_view header) {
  std::ifstream in(partial_, std::ios::binary);
  std::string line;
  if (!std::getline(in, line) || in.eof() || line + "\n" != header) return;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(partial_, error);
  if (error) return;
  std::uintmax_t end = header.size();
  while (num_done_ < rows_) {
    std::uintmax_t next = end;
    if (layout_ == MatrixLayout::sparse) {
      double count = 0;
      in.seekg(static_cast<std::streamoff>(end));
      if (!in.read(reinterpret_cast<char*>(&count), sizeof count)) break;
      next += (1 + 2 * static_cast<std::uintmax_t>(count)) * sizeof(double);
    } else {
      next += static_cast<std::uintmax_t>(dense_length(num_done_)) * sizeof(double);
    }
    if (next > size) break;
    end = next;
    ++num_done_;
  }
  in.close();
  std::filesystem::resize_file(partial_, end, error);
  if (error) fail("cannot be continued: " + error.message());
}

void MatrixFile::add(const std::vector<Index>& column, const std::vector<double>& distance) {
  std::vector<double> numbers;
  if (layout_ == MatrixLayout::sparse) {
    numbers.push_back(static_cast<double>(column.size()));
    for (std::size_t s = 0; s < column.size(); ++s) {
      numbers.push_back(static_cast<double>(column[s]));
      numbers.push_back(distance[s]);
    }
  } else {
    numbers = distance;
  }
  if (std::fwrite(numbers.data(), sizeof(double), numbers.size(), out_) != numbers.size()) {
    fail(std::string("cannot be written to the end: ") + std::strerror(errno));
  }
  ++num_done_;
}

void MatrixFile::flush() {
  if (std::fflush(out_) != 0) fail(std::string("cannot be written to the end: ") + std::strerror(errno));
}

void MatrixFile::count(double distance) {
  ++num_entries_;
  if (std::isnan(distance)) ++num_unknown_;
  if (std::isinf(distance)) ++num_apart_;
}

/// A few hundred rows of a square matrix at a time: their part right of the diagonal as it stands, and of every row
/// above them the stretch that belongs below it.
void MatrixFile::write_dense() {
  std::ifstream in(partial_, std::ios::binary);
  const auto read = [&](Index first, double* to, Index count) {
    in.seekg(static_cast<std::streamoff>(header_size_ + static_cast<std::size_t>(first) * sizeof(double)));
    if (!in.read(reinterpret_cast<char*>(to),
                 static_cast<std::streamsize>(count) * static_cast<Index>(sizeof(double)))) {
      fail("cannot be read back");
    }
  };
  const auto start_of = [&](Index row) {
    return layout_ == MatrixLayout::full ? row * columns_ : row * columns_ - row * (row + 1) / 2;
  };
  OutputFile out(file_);
  const bool npy = is_npy(file_);
  if (npy) {
    if (layout_ == MatrixLayout::condensed) {
      write_npy_header(out, {rows_ * (rows_ - 1) / 2});
    } else {
      write_npy_header(out, {rows_, columns_});
    }
  }
  constexpr Index kBlock = 256;
  std::vector<double> part(static_cast<std::size_t>(kBlock));
  for (Index first = 0; first < rows_; first += kBlock) {
    const Index num = std::min(kBlock, rows_ - first);
    std::vector<std::vector<double>> lines(static_cast<std::size_t>(num));
    for (Index r = 0; r < num; ++r) {
      const Index row = first + r;
      std::vector<double>& line = lines[static_cast<std::size_t>(r)];
      const Index length = dense_length(row);
      const Index left = layout_ == MatrixLayout::square ? row + 1 : 0;
      line.assign(static_cast<std::size_t>(left + length), 0);
      read(start_of(row), line.data() + left, length);
      for (Index c = left; c < left + length; ++c) count(line[static_cast<std::size_t>(c)]);
    }
    for (Index above = 0; layout_ == MatrixLayout::square && above < first + num; ++above) {
      const Index from = std::max(first, above + 1);  // columns of `above` that are rows of the block
      const Index length = first + num - from;
      if (length <= 0) continue;
      read(start_of(above) + from - above - 1, part.data(), length);
      for (Index c = 0; c < length; ++c) {
        lines[static_cast<std::size_t>(from - first + c)][static_cast<std::size_t>(above)] =
            part[static_cast<std::size_t>(c)];
      }
    }
    for (const std::vector<double>& line : lines) {
      if (npy) {
        out.write(bytes_of(line));
        continue;
      }
      for (std::size_t c = 0; c < line.size(); ++c) {
        if (c > 0) out.write(layout_ == MatrixLayout::condensed ? "\n" : ",");
        out.write_number(line[c]);
      }
      if (!line.empty()) out.write("\n");
    }
  }
  out.commit();
}

void MatrixFile::write_sparse() {
  std::ifstream in(partial_, std::ios::binary);
  const auto each = [&](const auto& visit) {
    in.clear();
    in.seekg(static_cast<std::streamoff>(header_size_));
    for (Index row = 0; row < rows_; ++row) {
      double count = 0;
      in.read(reinterpret_cast<char*>(&count), sizeof count);
      for (double i = 0; i < count; ++i) {
        double entry[2];
        if (!in.read(reinterpret_cast<char*>(entry), sizeof entry)) fail("cannot be read back");
        visit(row, entry[0], entry[1]);
      }
    }
  };
  each([&](Index, double, double distance) { count(distance); });
  OutputFile out(file_);
  const bool npy = is_npy(file_);
  if (npy) {
    write_npy_header(out, {num_entries_, 3});
  } else {
    out.write("row,column,distance\n");
  }
  each([&](Index row, double column, double distance) {
    if (npy) {
      out.write(bytes_of({static_cast<double>(row), column, distance}));
      return;
    }
    out.write_number(static_cast<std::ptrdiff_t>(row));
    out.write(",");
    out.write_number(static_cast<std::ptrdiff_t>(column));
    out.write(",");
    out.write_number(distance);
    out.write("\n");
  });
  out.commit();
}

void MatrixFile::finish() {
  flush();
  std::fclose(out_);
  out_ = nullptr;
  num_entries_ = num_unknown_ = num_apart_ = 0;
  if (layout_ == MatrixLayout::sparse) {
    write_sparse();
  } else {
    write_dense();
  }
  std::error_code ignored;
  std::filesystem::remove(partial_, ignored);
}

}  // namespace taut::app
