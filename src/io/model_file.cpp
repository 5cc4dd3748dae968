#include "taut/io/read_surface.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "io/input_file.hpp"
#include "taut/core/error.hpp"
#include "taut/io/output_file.hpp"

// The format, all numbers little-endian, a real as its 64 IEEE bits, an integer in 64 bits:
//   "taut model 4\n"
//   kind (0 dense, 1 local)
//   dense: kernel (0 cubic, 1 quintic)
//          centres, weights, polynomial, origin: each rows, columns, then the entries column by column
//          scale, support radius
//   local: centres, radii, coefficients, support, places between (points, normals, radius), as above
//          flatness
//   samples: points, normals as above, faces with integers
//   report: of a dense fit five integers and ten reals, of a local one five integers and five reals
//   checksum: FNV-1a (64 bit) of everything before it

namespace taut {
namespace {

constexpr std::string_view kMagic = "taut model ";
constexpr std::string_view kVersion = "4\n";

std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001B3ULL;
  return hash;
}

class ModelWriter {
 public:
  ModelWriter() : bytes_(kMagic) { bytes_ += kVersion; }

  void integer(Index value) { word(static_cast<std::uint64_t>(value)); }
  void real(double value) { word(std::bit_cast<std::uint64_t>(value)); }
  template <class Matrix>
  void matrix(const Matrix& matrix) {
    integer(matrix.rows());
    integer(matrix.cols());
    for (Index j = 0; j < matrix.cols(); ++j) {
      for (Index i = 0; i < matrix.rows(); ++i) entry(matrix(i, j));
    }
  }
  std::string finish() {
    word(checksum(bytes_));
    return std::move(bytes_);
  }

 private:
  void entry(double value) { real(value); }
  void entry(int value) { integer(value); }
  void word(std::uint64_t value) {
    for (int byte = 0; byte < 8; ++byte) bytes_ += static_cast<char>(value >> (8 * byte) & 0xFF);
  }

  std::string bytes_;
};

class ModelReader {
 public:
  explicit ModelReader(const detail::InputFile& file) : file_(file), rest_(file.bytes) {
    if (!rest_.starts_with(kMagic)) file_.fail("is not a model that taut fit wrote; fit the cloud with taut fit");
    rest_.remove_prefix(kMagic.size());
    if (!rest_.starts_with(kVersion)) {
      file_.fail("has model version " + detail::quote(rest_.substr(0, rest_.find('\n'))) +
                 ", this program reads version 4; fit the cloud again");
    }
    rest_.remove_prefix(kVersion.size());
    constexpr std::size_t kWord = 8;
    if (rest_.size() < kWord) file_.fail("is cut short; fit the cloud again");
    const std::string_view covered(file.bytes.data(), file.bytes.size() - kWord);
    std::string_view last = std::string_view(file.bytes).substr(covered.size());
    if (take_word(last) != checksum(covered))
      file_.fail("is damaged or cut short (its checksum does not fit); fit the cloud again");
    rest_.remove_suffix(kWord);
  }

  Index integer() {
    const auto value = static_cast<std::int64_t>(word());
    // No count in a model is negative or anywhere near this.
    if (value < 0 || value > std::int64_t{1} << 40)
      file_.fail("is damaged (a count is " + std::to_string(value) + "); fit the cloud again");
    return static_cast<Index>(value);
  }
  double real() { return std::bit_cast<double>(word()); }
  template <class Matrix>
  Matrix matrix() {
    const Index rows = integer();
    const Index cols = integer();
    const auto left = static_cast<Index>(rest_.size() / 8);
    if (cols > 0 && rows > left / cols) file_.fail("is damaged (a table is larger than the file); fit the cloud again");
    const bool fits = (Matrix::RowsAtCompileTime == Eigen::Dynamic || Matrix::RowsAtCompileTime == rows) &&
                      (Matrix::ColsAtCompileTime == Eigen::Dynamic || Matrix::ColsAtCompileTime == cols);
    if (!fits) file_.fail("is damaged (a table has the wrong shape); fit the cloud again");
    Matrix result(rows, cols);
    for (auto& entry : result.reshaped()) read(entry);
    return result;
  }
  void finish() const {
    if (!rest_.empty()) file_.fail("is damaged (there is more in it than a model); fit the cloud again");
  }

 private:
  void read(double& value) { value = real(); }
  void read(int& value) {
    const Index wide = integer();
    if (wide > std::numeric_limits<int>::max()) file_.fail("is damaged (a face names no sample); fit the cloud again");
    value = static_cast<int>(wide);
  }
  std::uint64_t word() {
    if (rest_.size() < 8) file_.fail("is damaged (it ends too early); fit the cloud again");
    return take_word(rest_);
  }
  static std::uint64_t take_word(std::string_view& from) {
    std::uint64_t value = 0;
    for (std::size_t byte = 0; byte < 8; ++byte) {
      value |= std::uint64_t{static_cast<unsigned char>(from[byte])} << (8 * byte);
    }
    from.remove_prefix(8);
    return value;
  }

  const detail::InputFile& file_;
  std::string_view rest_;
};

/// Finite points with normals that fit them, faces that name points.
bool sound_samples(const PointCloud& samples, Index d) {
  return samples.points.rows() == d && samples.normals.rows() == d && samples.points.allFinite() &&
         (samples.normals.cols() == 0 || samples.normals.cols() == samples.points.cols()) &&
         (samples.faces.size() == 0 || samples.faces.maxCoeff() < samples.points.cols());
}

bool sound(const RbfModel& model) {
  const Index d = model.origin.size();
  return d >= 2 && model.centres.rows() == d && model.weights.size() == model.centres.cols() &&
         model.centres.allFinite() && model.weights.allFinite() && model.polynomial.allFinite() &&
         model.origin.allFinite() && model.scale > 0 && std::isfinite(model.scale) && model.support_radius >= 0 &&
         sound_samples(model.samples, d);
}

bool sound(const SupportPlaces& places, Index d) {
  const Index n = places.radius.size();
  return places.points.rows() == (n > 0 ? d : places.points.rows()) && places.points.cols() == n &&
         places.normals.rows() == places.points.rows() && places.normals.cols() == n && places.points.allFinite() &&
         places.normals.allFinite() && places.radius.allFinite();
}

bool sound(const LocalFitModel& model) {
  const Index d = model.centres.rows();
  const Index m = model.centres.cols();
  return (d == 2 || d == 3) && m > 0 && model.radii.size() == m && model.coefficients.cols() == m &&
         model.centres.allFinite() && model.coefficients.allFinite() && model.radii.allFinite() &&
         model.radii.minCoeff() > 0 && model.support.size() == model.samples.size() && model.support.allFinite() &&
         sound(model.between, d) && model.flatness >= 1 && std::isfinite(model.flatness) &&
         sound_samples(model.samples, d) && model.samples.size() > 0;
}

void write_samples(ModelWriter& out, const PointCloud& samples) {
  out.matrix(samples.points);
  out.matrix(samples.normals);
  out.matrix(samples.faces);
}

PointCloud read_samples(ModelReader& in) {
  PointCloud samples;
  samples.points = in.matrix<Points>();
  samples.normals = in.matrix<Points>();
  samples.faces = in.matrix<Eigen::Matrix3Xi>();
  return samples;
}

// The numbers of a report, in the order of the file.
auto counts(auto& report) {
  return std::array{&report.num_samples, &report.residual_at, &report.merged_sheets.count, &report.merged_sheets.at};
}
auto reals(RbfReport& report) {
  return std::array{&report.spacing,          &report.noise,        &report.smoothing,
                    &report.offset,           &report.residual,     &report.left_out_rms,
                    &report.left_out_max,     &report.residual_rms, &report.residual_max,
                    &report.merged_sheets.gap};
}
auto reals(LocalFitReport& report) {
  return std::array{&report.spacing, &report.noise, &report.residual_rms, &report.residual_max,
                    &report.merged_sheets.gap};
}

template <class Report>
void write_report(ModelWriter& out, Report report, Index own_count) {
  out.integer(own_count);
  for (const Index* count : counts(report)) out.integer(*count);
  for (const double* real : reals(report)) out.real(*real);
}

template <class Report>
void read_report(ModelReader& in, Report& report, Index& own_count) {
  own_count = in.integer();
  for (Index* count : counts(report)) *count = in.integer();
  for (double* real : reals(report)) *real = in.real();
}

void write(ModelWriter& out, const RbfModel& model) {
  out.integer(0);
  out.integer(model.kernel == RbfKernel::quintic ? 1 : 0);
  out.matrix(model.centres);
  out.matrix(model.weights);
  out.matrix(model.polynomial);
  out.matrix(model.origin);
  out.real(model.scale);
  out.real(model.support_radius);
  write_samples(out, model.samples);
  write_report(out, model.report, model.report.num_fitted);
}

void write(ModelWriter& out, const LocalFitModel& model) {
  out.integer(1);
  out.matrix(model.centres);
  out.matrix(model.radii);
  out.matrix(model.coefficients);
  out.matrix(model.support);
  out.matrix(model.between.points);
  out.matrix(model.between.normals);
  out.matrix(model.between.radius);
  out.real(model.flatness);
  write_samples(out, model.samples);
  write_report(out, model.report, model.report.samples_per_patch);
}

RbfModel read_dense(ModelReader& in, const detail::InputFile& file) {
  RbfModel model;
  const Index kernel = in.integer();
  if (kernel > 1) file.fail("is damaged (it names kernel " + std::to_string(kernel) + "); fit the cloud again");
  model.kernel = kernel == 1 ? RbfKernel::quintic : RbfKernel::cubic;
  model.centres = in.matrix<Points>();
  model.weights = in.matrix<Vector>();
  model.polynomial = in.matrix<Vector>();
  model.origin = in.matrix<Vector>();
  model.scale = in.real();
  model.support_radius = in.real();
  model.samples = read_samples(in);
  read_report(in, model.report, model.report.num_fitted);
  return model;
}

LocalFitModel read_local(ModelReader& in) {
  LocalFitModel model;
  model.centres = in.matrix<Points>();
  model.radii = in.matrix<Vector>();
  model.coefficients = in.matrix<Points>();
  model.support = in.matrix<Vector>();
  model.between.points = in.matrix<Points>();
  model.between.normals = in.matrix<Points>();
  model.between.radius = in.matrix<Vector>();
  model.flatness = in.real();
  model.samples = read_samples(in);
  read_report(in, model.report, model.report.samples_per_patch);
  return model;
}

}  // namespace

void write_model(const std::filesystem::path& path, const FitModel& model) {
  ModelWriter out;
  std::visit([&](const auto& kind) { write(out, kind); }, model);
  write_text(path, out.finish());
}

FitModel read_model(const std::filesystem::path& path, const Context& context) {
  const detail::InputFile file = detail::read_file(path, context);
  ModelReader in(file);
  const Index kind = in.integer();
  if (kind > 1) file.fail("is damaged (it names kind " + std::to_string(kind) + " of fit); fit the cloud again");
  FitModel model = kind == 0 ? FitModel(read_dense(in, file)) : FitModel(read_local(in));
  in.finish();
  if (!std::visit([](const auto& fit) { return sound(fit); }, model)) {
    file.fail("is damaged (its parts do not fit together); fit the cloud again");
  }
  return model;
}

}  // namespace taut
