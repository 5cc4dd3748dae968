// OpenVDB files, read by OpenVDB: the active voxels of one grid, made dense, with the background around them.

#include "io/vdb_module.hpp"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <exception>
#include <stdexcept>

namespace taut::detail {
namespace {

[[noreturn]] void refuse(const std::string& problem) { throw std::runtime_error(problem); }

std::string quote(const std::string& name) { return "'" + name + "'"; }

/// Background around the active voxels: what a spline needs not to end at the surface of a level set.
constexpr int kMargin = 3;

std::string list_of_grids(const openvdb::GridPtrVec& grids) {
  std::string list;
  for (const auto& grid : grids)
    list += (list.empty() ? "" : ", ") + quote(grid->getName()) + " (" + grid->valueType() + ")";
  return list;
}

bool holds_numbers(const openvdb::GridBase& grid) {
  return grid.isType<openvdb::FloatGrid>() || grid.isType<openvdb::DoubleGrid>() || grid.isType<openvdb::Int32Grid>() ||
         grid.isType<openvdb::Int64Grid>();
}

openvdb::GridBase::Ptr choose(const openvdb::GridPtrVec& grids, const std::string& name) {
  openvdb::GridBase::Ptr chosen;
  std::size_t num_fitting = 0;
  for (const auto& grid : grids) {
    if (name.empty() ? !holds_numbers(*grid) : grid->getName() != name) continue;
    chosen = grid;
    ++num_fitting;
  }
  const std::string list = list_of_grids(grids);
  if (grids.empty()) refuse("holds no grid");
  if (num_fitting == 0 && name.empty()) refuse("holds no grid of single numbers; there are " + list);
  if (num_fitting == 0) refuse("holds no grid " + quote(name) + "; there are " + list);
  if (num_fitting > 1) refuse("holds several grids; choose one by name (--grid-name): " + list);
  if (!holds_numbers(*chosen)) refuse("grid " + quote(name) + " holds " + chosen->valueType() + ", not single numbers");
  return chosen;
}

/// Voxels to the world: x = M (i, j, k, 1), with OpenVDB's row vectors turned into columns.
void place(const openvdb::math::Transform& transform, const openvdb::Coord& corner, VoxelVolume& volume) {
  if (!transform.isLinear()) refuse("the grid's transform is not linear (a frustum); resample it");
  const openvdb::Vec3d origin = transform.indexToWorld(openvdb::Vec3d(0, 0, 0));
  for (int a = 0; a < 3; ++a) {
    openvdb::Vec3d unit(0, 0, 0);
    unit[a] = 1;
    const openvdb::Vec3d step = transform.indexToWorld(unit) - origin;
    for (int r = 0; r < 3; ++r) volume.axes(r, a) = step[r];
  }
  const openvdb::Vec3d first = transform.indexToWorld(corner.asVec3d());
  for (int r = 0; r < 3; ++r) volume.origin(r) = first[r];
}

template <class Grid>
bool make_dense(const openvdb::GridBase& base, const openvdb::CoordBBox& box, std::vector<float>& values) {
  if (!base.isType<Grid>()) return false;
  openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, values.data());
  openvdb::tools::copyToDense(static_cast<const Grid&>(base), dense);
  return true;
}

VoxelVolume to_volume(const openvdb::GridBase& grid, std::size_t memory_limit) {
  openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) refuse("grid " + quote(grid.getName()) + " has no active voxels");
  box.expand(kMargin);
  const openvdb::Coord size = box.dim();
  VoxelVolume volume;
  for (int a = 0; a < 3; ++a) volume.size[static_cast<std::size_t>(a)] = size[a];
  // The values here, and the coefficients made of them.
  const double bytes = 8.3 * static_cast<double>(volume.size[0]) * static_cast<double>(volume.size[1]) *
                       static_cast<double>(volume.size[2]);
  if (bytes > static_cast<double>(memory_limit)) {
    refuse("grid " + quote(grid.getName()) + " spans " + std::to_string(size[0]) + " x " + std::to_string(size[1]) +
           " x " + std::to_string(size[2]) + " voxels, which do not fit into memory as a dense volume; resample it");
  }
  volume.values.resize(static_cast<std::size_t>(volume.num_voxels()));
  static_cast<void>(make_dense<openvdb::FloatGrid>(grid, box, volume.values) ||
                    make_dense<openvdb::DoubleGrid>(grid, box, volume.values) ||
                    make_dense<openvdb::Int32Grid>(grid, box, volume.values) ||
                    make_dense<openvdb::Int64Grid>(grid, box, volume.values));
  place(grid.transform(), box.min(), volume);
  return volume;
}

}  // namespace

extern "C" void taut_read_vdb(const VdbRequest& request, VdbAnswer& answer) {
  try {
    openvdb::initialize();
    openvdb::io::File source(request.path);
    source.open();
    const openvdb::GridPtrVec grids = *source.readAllGridMetadata();
    const openvdb::GridBase::Ptr chosen = choose(grids, request.grid_name);
    answer.volume = to_volume(*source.readGrid(chosen->getName()), request.memory_limit);
  } catch (const openvdb::Exception& error) {
    answer.problem = "OpenVDB cannot read it (" + std::string(error.what()) + "); write it again";
  } catch (const std::exception& error) {
    answer.problem = error.what();
  }
}

}  // namespace taut::detail
