#include "taut/io/read_points.hpp"

#include <cerrno>
#include <cmath>
#include <fstream>
#include <istream>
#include <string_view>
#include <system_error>
#include <utility>

#include "io/column_roles.hpp"
#include "io/input_file.hpp"
#include "io/row_parser.hpp"
#include "io/text_reader.hpp"

namespace taut {

struct CsvRows::State {
  std::unique_ptr<std::istream> own;
  std::istream* in = nullptr;
  std::string name;
  std::string buffer;    // the part of the file that lies in memory
  std::size_t next = 0;  // first byte of `buffer` not handed out yet
  std::size_t line = 0;  // number of the last line handed out
  bool header_passed = false;
  bool separator_known = false;
  detail::RowParser parser;

  /// Makes room in `buffer` and reads on; false at the end of the file.
  bool refill() {
    constexpr std::size_t kChunk = std::size_t{1} << 16;
    buffer.erase(0, next);
    next = 0;
    const std::size_t filled = buffer.size();
    buffer.resize(filled + kChunk);
    in->read(buffer.data() + filled, static_cast<std::streamsize>(kChunk));
    const auto got = static_cast<std::size_t>(in->gcount());
    buffer.resize(filled + got);
    if (in->bad()) throw IoError(name, "cannot be read to its end; check the disk or copy the file");
    return got > 0;
  }

  bool next_line(std::string_view& out) {
    constexpr std::size_t kLongest = std::size_t{16} << 20;
    std::size_t searched = next;
    while (true) {
      if (const auto feed = buffer.find('\n', searched); feed != std::string::npos) {
        out = std::string_view(buffer).substr(next, feed - next);
        next = feed + 1;
        ++line;
        return true;
      }
      if (buffer.size() - next > kLongest) {
        throw IoError(name, "line " + std::to_string(line + 1) + ": longer than 16 MiB; this is no table of numbers");
      }
      const std::size_t tail = buffer.size() - next;
      if (refill()) {
        searched = tail;
        continue;
      }
      if (next == buffer.size()) return false;
      out = std::string_view(buffer).substr(next);  // the last line, without an end
      next = buffer.size();
      ++line;
      return true;
    }
  }
};

namespace {

/// The line without comment and the blanks around it.
std::string_view stripped(std::string_view line) {
  line = line.substr(0, line.find('#'));
  if (line.starts_with("//") || line.starts_with("%")) return {};
  while (!line.empty() && detail::is_blank(line.front())) line.remove_prefix(1);
  while (!line.empty() && detail::is_blank(line.back())) line.remove_suffix(1);
  return line;
}

}  // namespace

CsvRows::CsvRows(std::istream& in, std::string name) : state_(std::make_unique<State>()) {
  state_->in = &in;
  state_->name = std::move(name);
  state_->refill();
  if (state_->buffer.starts_with("\xEF\xBB\xBF")) state_->buffer.erase(0, 3);
}

CsvRows::CsvRows(const std::filesystem::path& path, std::string name) : state_(std::make_unique<State>()) {
  State& state = *state_;
  state.name = name.empty() ? path.string() : std::move(name);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw IoError(state.name, "is a folder, not a file; name a file inside it");
  errno = 0;
  state.own = std::make_unique<std::ifstream>(path, std::ios::binary);
  state.in = state.own.get();
  if (!*state.own) detail::fail_to_open(state.name, errno);
  state.refill();
  if (state.buffer.empty()) throw IoError(state.name, "the file is empty; check how it was written");
  const std::string_view kind = detail::recognise(state.buffer);
  if (!kind.empty())
    throw IoError(state.name, "the content is " + std::string(kind) + ", not lines of numbers; convert it");
  if (state.buffer.find('\0') != std::string::npos) {
    throw IoError(state.name, "binary data where lines of numbers are expected; check the file");
  }
  if (state.buffer.starts_with("\xEF\xBB\xBF")) state.buffer.erase(0, 3);
}

CsvRows::CsvRows(CsvRows&&) noexcept = default;
CsvRows& CsvRows::operator=(CsvRows&&) noexcept = default;
CsvRows::~CsvRows() = default;

void CsvRows::set_samples(const Points& samples) { state_->parser.set_samples(&samples); }

bool CsvRows::next(CsvRow& row) {
  State& state = *state_;
  std::string_view line;
  while (state.next_line(line)) {
    line = stripped(line);
    if (line.empty()) continue;
    if (!state.separator_known) {
      state.parser.choose_separator(line);
      const std::vector<std::string_view> fields = state.parser.split(line);
      const bool is_header = !std::exchange(state.header_passed, true) && detail::is_header(fields);
      state.separator_known = fields.size() > 1;  // a single word shows no separator
      if (is_header) continue;
    }
    row.line = state.line;
    row.values.clear();
    row.problem = state.parser.parse(line, row.values);
    for (std::size_t i = 0; row.problem.empty() && i < row.values.size(); ++i) {
      if (std::isfinite(row.values[i])) continue;
      row.problem = "column " + std::to_string(i + 1) + " is " + (std::isnan(row.values[i]) ? "nan" : "infinite") +
                    "; give a finite value";
    }
    return true;
  }
  return false;
}

}  // namespace taut
