#include "taut/io/read_surface.hpp"

#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "support/clouds.hpp"
#include "support/temp_folder.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

RbfModel model_with_faces(RbfKernel kernel) {
  PointCloud cloud = test::sphere_cloud(3, 60);
  cloud.faces.resize(3, 2);
  cloud.faces << 0, 1, 2, 3, 4, 59;
  return fit_rbf(cloud, {.kernel = kernel});
}

void expect_same(const RbfModel& a, const RbfModel& b) {
  EXPECT_EQ(a.kernel, b.kernel);
  EXPECT_EQ(a.centres, b.centres);
  EXPECT_EQ(a.weights, b.weights);
  EXPECT_EQ(a.polynomial, b.polynomial);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.scale, b.scale);
  EXPECT_EQ(a.support_radius, b.support_radius);
  EXPECT_EQ(a.samples.points, b.samples.points);
  EXPECT_EQ(a.samples.normals, b.samples.normals);
  EXPECT_EQ(a.samples.faces, b.samples.faces);
  EXPECT_EQ(a.report.num_samples, b.report.num_samples);
  EXPECT_EQ(a.report.num_fitted, b.report.num_fitted);
  EXPECT_EQ(a.report.spacing, b.report.spacing);
  EXPECT_EQ(a.report.noise, b.report.noise);
  EXPECT_EQ(a.report.smoothing, b.report.smoothing);
  EXPECT_EQ(a.report.offset, b.report.offset);
  EXPECT_EQ(a.report.residual, b.report.residual);
  EXPECT_EQ(a.report.left_out_rms, b.report.left_out_rms);
  EXPECT_EQ(a.report.left_out_max, b.report.left_out_max);
  EXPECT_EQ(a.report.residual_rms, b.report.residual_rms);
  EXPECT_EQ(a.report.residual_max, b.report.residual_max);
  EXPECT_EQ(a.report.residual_at, b.report.residual_at);
}

TEST(ModelFile, GivesBackEveryBit) {
  const test::TempFolder folder;
  for (const RbfKernel kernel : {RbfKernel::cubic, RbfKernel::quintic}) {
    const RbfModel model = model_with_faces(kernel);
    const auto path = folder.path() / "s.taut";
    write_model(path, model);
    expect_same(std::get<RbfModel>(read_model(path)), model);
    EXPECT_EQ(folder.num_entries(), 1U);  // no temporary file is left
  }
}

TEST(ModelFile, GivesBackAModelInFourDimensions) {
  const test::TempFolder folder;
  const RbfModel model = fit_rbf(test::sphere_cloud(4, 80));
  write_model(folder.path() / "s.taut", model);
  expect_same(std::get<RbfModel>(read_model(folder.path() / "s.taut")), model);
}

TEST(ModelFile, GivesBackALocalFit) {
  const test::TempFolder folder;
  LocalFitModel model = fit_local(test::torus_cloud(300));
  model.between = {model.samples.points.leftCols(2), model.samples.normals.leftCols(2), Vector::Constant(2, 0.1)};
  model.flatness = 3;
  write_model(folder.path() / "s.taut", model);
  const LocalFitModel read = std::get<LocalFitModel>(read_model(folder.path() / "s.taut"));
  EXPECT_EQ(read.centres, model.centres);
  EXPECT_EQ(read.radii, model.radii);
  EXPECT_EQ(read.coefficients, model.coefficients);
  EXPECT_EQ(read.support, model.support);
  EXPECT_EQ(read.between.points, model.between.points);
  EXPECT_EQ(read.between.normals, model.between.normals);
  EXPECT_EQ(read.between.radius, model.between.radius);
  EXPECT_EQ(read.flatness, model.flatness);
  EXPECT_EQ(read.samples.points, model.samples.points);
  EXPECT_EQ(read.samples.normals, model.samples.normals);
  EXPECT_EQ(read.report.num_samples, model.report.num_samples);
  EXPECT_EQ(read.report.samples_per_patch, model.report.samples_per_patch);
  EXPECT_EQ(read.report.spacing, model.report.spacing);
  EXPECT_EQ(read.report.noise, model.report.noise);
  EXPECT_EQ(read.report.residual_rms, model.report.residual_rms);
  EXPECT_EQ(read.report.residual_max, model.report.residual_max);
  EXPECT_EQ(read.report.residual_at, model.report.residual_at);
  // The same function, to the last bit.
  const Points somewhere = 1.01 * model.samples.points;
  EXPECT_EQ(make_surface(FitModel(read)).value(somewhere), make_surface(FitModel(model)).value(somewhere));
}

TEST(ModelFile, EveryCutAndEveryFlippedBitIsNoticed) {
  const test::TempFolder folder;
  RbfModel model = fit_rbf(test::ellipsoid_cloud(Eigen::Vector3d::Ones(), 8));
  write_model(folder.path() / "s.taut", model);
  const std::string bytes = test::file_bytes(folder.path() / "s.taut");
  for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 16) {
    const auto path = folder.write("cut.taut", std::string_view(bytes).substr(0, length));
    EXPECT_THROW((void)read_model(path), IoError) << length;
  }
  for (std::size_t at = 0; at < bytes.size(); at += 1 + at / 16) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (at % 8)));
    EXPECT_THROW((void)read_model(folder.write("damaged.taut", damaged)), IoError) << at;
  }
  std::string longer = bytes;
  longer.push_back('x');
  EXPECT_THROW((void)read_model(folder.write("longer.taut", longer)), IoError);
}

TEST(ModelFile, SaysWhatIsWrong) {
  const test::TempFolder folder;
  const auto message = [&](std::string_view bytes) -> std::string {
    try {
      (void)read_model(folder.write("m.taut", bytes));
    } catch (const IoError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_NE(message("ply\nformat ascii 1.0\n").find("is not a model"), std::string::npos);
  EXPECT_NE(message("taut model 1\nsomething").find("version '1'"), std::string::npos);
  EXPECT_NE(message("taut model 4\nabcdefghijkl").find("checksum"), std::string::npos);
  EXPECT_THROW((void)read_model(folder.path() / "missing.taut"), IoError);
  EXPECT_THROW((void)read_model(folder.path()), IoError);
  EXPECT_THROW(write_model(folder.path() / "no such folder" / "s.taut", RbfModel{}), IoError);
}

}  // namespace
}  // namespace taut
