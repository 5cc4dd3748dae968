// A volume as a surface: which level, which side is inside, smoothing, coefficients, and where the volume ends.

#include "taut/surface/volume.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "surface/describe.hpp"
#include "surface/volume/gaussian.hpp"
#include "surface/volume/prefilter.hpp"
#include "surface/volume/value_statistics.hpp"
#include "surface/volume/volume_function.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using detail::describe;
using detail::Lattice;
using detail::SplineVolume;
using detail::VolumeFace;
using detail::VoxelBox;

/// Below it two axes count as one: the volume a voxel fills, relative to that of a box with its edges.
constexpr double kFlat = 1e-6;
constexpr double kLeastLabelSmoothing = 0.5;
constexpr double kMostSmoothing = 100;  // voxels
/// How many labels a message lists.
constexpr std::size_t kMostLabelsShown = 40;
/// Where a face crosses zero is looked for down to this part of a voxel.
constexpr double kFaceResolution = 0.25;
/// Room around the box that holds the surface, in voxels: rounding must not cut it.
constexpr double kBoxMargin = 0.01;

std::string describe_size(const VoxelVolume& volume) {
  return std::to_string(volume.size[0]) + " x " + std::to_string(volume.size[1]) + " x " +
         std::to_string(volume.size[2]);
}

void require_volume(const VoxelVolume& volume) {
  if (*std::ranges::min_element(volume.size) < 4) {
    throw InvalidArgument("the volume has " + describe_size(volume) +
                          " voxels; a smooth surface takes at least 4 along each axis");
  }
  if (static_cast<Index>(volume.values.size()) != volume.num_voxels()) {
    throw InvalidArgument("the volume has " + std::to_string(volume.values.size()) + " values for " +
                          describe_size(volume) + " voxels; give one each");
  }
  const Eigen::Vector3d lengths = volume.axes.colwise().norm().transpose();
  const double filled = std::abs(volume.axes.determinant());
  if (!volume.origin.allFinite() || !volume.axes.allFinite() || !(lengths.minCoeff() > 0) ||
      !(filled > kFlat * lengths.prod())) {
    throw InvalidArgument("the voxels' axes are " + describe(volume.axes.col(0)) + ", " + describe(volume.axes.col(1)) +
                          ", " + describe(volume.axes.col(2)) + " and their origin " + describe(volume.origin) +
                          "; axes must be finite, longer than zero and not in one plane");
  }
  std::size_t num_bad = 0;
  Index first_bad = 0;
  for (Index v = volume.num_voxels() - 1; v >= 0; --v) {
    if (std::isfinite(volume.values[static_cast<std::size_t>(v)])) continue;
    ++num_bad;
    first_bad = v;
  }
  if (num_bad > 0) {
    const Index row = first_bad / volume.size[0];
    throw InvalidArgument(std::to_string(num_bad) + " of " + std::to_string(volume.num_voxels()) +
                          " voxels are NaN or infinite, the first at (" + std::to_string(first_bad % volume.size[0]) +
                          ", " + std::to_string(row % volume.size[1]) + ", " + std::to_string(row / volume.size[1]) +
                          "); fill them with a value of the outside");
  }
}

/// "0, 1, 5": the different values when they are few, as labels are; else "".
std::string list_of_labels(const std::vector<float>& values) {
  std::string list;
  for (const float value : detail::few_values(values, kMostLabelsShown)) {
    list += (list.empty() ? "" : ", ") + describe(static_cast<double>(value));
  }
  return list;
}

void require_options(const VolumeOptions& options, const VoxelVolume& volume) {
  if (options.iso && options.label) throw InvalidArgument("give iso or label, not both");
  if (!options.iso && !options.label) {
    const std::string labels = list_of_labels(volume.values);
    throw InvalidArgument("a volume needs a level: " + detail::value_statistics(volume.values).text() +
                          ". Give iso (option iso)" +
                          (labels.empty() ? "" : ", or label (option label) for a segmentation: there are " + labels));
  }
  const double level = options.iso ? *options.iso : *options.label;
  if (!std::isfinite(level)) throw InvalidArgument("iso and label must be finite numbers");
  const double smooth = options.smooth.value_or(1);
  if (!(smooth >= 0) || smooth > kMostSmoothing) {
    throw InvalidArgument("smoothing by " + describe(smooth) + " voxels: give 0 to " + describe(kMostSmoothing));
  }
  if (options.label && smooth < kLeastLabelSmoothing) {
    throw InvalidArgument("smoothing by " + describe(smooth) +
                          " voxels leaves the staircase of the labels' voxels; take at least 0.5");
  }
}

/// 1 in the voxels of a label, 0 elsewhere.
void make_indicator(std::vector<float>& values, double label) {
  if (std::ranges::find(values, static_cast<float>(label)) == values.end()) {
    const std::string list = list_of_labels(values);
    throw EmptySurface("no voxel has the label " + describe(label) +
                       (list.empty() ? "; this volume has more than " + std::to_string(kMostLabelsShown) +
                                           " different values: is it a segmentation?"
                                     : "; there are " + list));
  }
  for (float& value : values) value = value == static_cast<float>(label) ? 1.0F : 0.0F;
}

void require_level(const std::vector<float>& values, double iso, const VolumeOptions& options) {
  const auto [least, largest] = std::ranges::minmax(values);
  if (least < iso && iso < largest) return;
  if (options.label) {
    throw EmptySurface("nothing is left of label " + describe(*options.label) + " after smoothing by " +
                       describe(options.smooth.value_or(1)) + " voxels; take less (option smooth), at least 0.5");
  }
  throw EmptySurface("no surface at iso " + describe(iso) + ": values run from " +
                     describe(static_cast<double>(least)) + " to " + describe(static_cast<double>(largest)));
}

/// Are most of the voxels on the volume's faces above `iso`? As many above as below: no.
bool faces_lie_above(const VoxelVolume& volume, double iso) {
  Index above = 0;
  Index below = 0;
  std::size_t v = 0;
  for (Index k = 0; k < volume.size[2]; ++k) {
    for (Index j = 0; j < volume.size[1]; ++j) {
      const bool whole_row = k == 0 || j == 0 || k + 1 == volume.size[2] || j + 1 == volume.size[1];
      const Index step = whole_row ? 1 : volume.size[0] - 1;
      for (Index i = 0; i < volume.size[0]; i += step) {
        const double value = volume.values[v + static_cast<std::size_t>(i)];
        above += value > iso ? 1 : 0;
        below += value < iso ? 1 : 0;
      }
      v += static_cast<std::size_t>(volume.size[0]);
    }
  }
  return above > below;
}

/// sign (v - iso), with a layer of zeros around for the coefficients at the ends.
Lattice padded(const VoxelVolume& volume, double iso, double sign, const Context& context) {
  Lattice lattice{{volume.size[0] + 2, volume.size[1] + 2, volume.size[2] + 2}, {}};
  lattice.values.assign(static_cast<std::size_t>(lattice.size[0] * lattice.size[1] * lattice.size[2]), 0.0F);
  detail::parallel_for(context, 0, volume.size[2], 1, [&](Index k, Index) {
    for (Index j = 0; j < volume.size[1]; ++j) {
      const float* from = volume.values.data() + volume.size[0] * (j + volume.size[1] * k);
      float* to = lattice.values.data() + lattice.at(1, j + 1, k + 1);
      for (Index i = 0; i < volume.size[0]; ++i) to[i] = static_cast<float>(sign * (from[i] - iso));
    }
  });
  return lattice;
}

/// Does the spline vanish somewhere in the box? Said of boxes down to kFaceResolution that may hold a zero.
bool may_vanish(const SplineVolume& spline, const VoxelBox& box) {
  const detail::ValueRange range = spline.bounds(box);
  if (range.lower > 0 || range.upper < 0) return false;
  int axis = 0;
  const double widest = (box.upper - box.lower).maxCoeff(&axis);
  if (widest <= kFaceResolution) return true;
  VoxelBox half = box;
  half.upper(axis) = 0.5 * (box.lower(axis) + box.upper(axis));
  if (may_vanish(spline, half)) return true;
  std::swap(half.lower(axis), half.upper(axis));
  half.upper(axis) = box.upper(axis);
  return may_vanish(spline, half);
}

/// The faces of the volume that the surface reaches.
std::vector<VolumeFace> reached_faces(const SplineVolume& spline) {
  std::vector<VolumeFace> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      VoxelBox face;
      for (int a = 0; a < 3; ++a) {
        face.lower(a) = 0;
        face.upper(a) = static_cast<double>(spline.num_cells(a));
      }
      face.lower(axis) = face.upper(axis) = upper ? face.upper(axis) : 0;
      if (may_vanish(spline, face)) faces.push_back({axis, upper});
    }
  }
  return faces;
}

/// World coordinates of the box in which the surface lies.
Box surface_box(const SplineVolume& spline) {
  VoxelBox box;
  if (!spline.zero_box(box)) throw EmptySurface("there is no surface in the volume");
  box = spline.world_box({box.lower - kBoxMargin, box.upper + kBoxMargin});
  return {box.lower.matrix(), box.upper.matrix()};
}

}  // namespace

Surface volume_surface(VoxelVolume volume, const VolumeOptions& options, const Context& context) {
  require_volume(volume);
  require_options(options, volume);
  context.report("volume", 0);
  if (options.label) make_indicator(volume.values, *options.label);
  const double iso = options.label ? 0.5 : *options.iso;
  if (const double sigma = options.smooth.value_or(options.label ? 1 : 0); sigma > 0) {
    Lattice lattice{volume.size, std::move(volume.values)};
    detail::smooth_gaussian(lattice, sigma, context);
    volume.values = std::move(lattice.values);
  }
  require_level(volume.values, iso, options);
  const double sign = !options.label && faces_lie_above(volume, iso) ? 1 : -1;
  Lattice lattice = padded(volume, iso, sign, context);
  volume.values = {};
  context.report("volume", 0.3);
  detail::prefilter(lattice, context);
  context.report("volume", 0.8);
  const auto spline = std::make_shared<const SplineVolume>(std::move(lattice), volume.origin, volume.axes, context);
  SurfaceExtras extras;
  extras.box = surface_box(*spline);
  if (const std::vector<VolumeFace> faces = reached_faces(*spline); !faces.empty()) {
    extras.domain = std::make_shared<const detail::VolumeDomain>(spline, faces);
    context.tell("the surface reaches " + std::to_string(faces.size()) + " of the volume's 6 faces and ends there");
  }
  context.report("volume", 1);
  return Surface(std::make_shared<const detail::VolumeFunction>(spline), std::move(extras));
}

}  // namespace taut
