#pragma once

/// What most programs need of Taut, in one include: surfaces, the questions people ask about them, and files. The rooms
/// below (cells, march, curve, fan) have headers of their own.

#include "taut/core/context.hpp"
#include "taut/core/error.hpp"
#include "taut/core/status.hpp"
#include "taut/core/types.hpp"
#include "taut/curve/exponential_map.hpp"
#include "taut/io/read_point_cloud.hpp"
#include "taut/io/read_points.hpp"
#include "taut/io/read_surface.hpp"
#include "taut/io/write_geometry.hpp"
#include "taut/query/closed_geodesic.hpp"
#include "taut/query/distance.hpp"
#include "taut/query/distance_matrix.hpp"
#include "taut/query/field.hpp"
#include "taut/query/path.hpp"
#include "taut/query/point_sets.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/query/surface_summary.hpp"
#include "taut/query/tangent_maps.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/point_cloud.hpp"
#include "taut/surface/projection.hpp"
#include "taut/surface/surface.hpp"
#include "taut/surface/volume.hpp"
