#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "taut/cells/cell_grid.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// Where a surface is.
struct SurfaceExtent {
  /// Holds what there is of it in `window`, tightly.
  Box box;
  /// Where it was looked for: everywhere but on endless axes.
  Box window;
  /// Holds all of it, as far as numbers go on endless axes.
  Box whole;
  /// By axis: does the surface go on beyond the window.
  Eigen::Array<bool, Eigen::Dynamic, 1> endless;
};

/// Where to look for a surface: its own box where it has one; else, in this order,
///  - a surface with samples: their box and 5 % of its diagonal around it;
///  - F with interval bounds: a box that holds the whole surface, proved within +-2^24 (16.8 million model units, more
///    where `near` asks for it), tight to about 1/24 of its size (1/8 above d = 3). A surface that goes on beyond (a
///    plane, a gyroid) is boxed, on the axes where it does so, around `near` with a margin of the points' spread, at
///    least half their largest coordinate; without points, +-5, doubled until there is a surface in it;
///  - else by trial: starts scattered over scales from 1e-3 to 1e6 around `near` (or 0) are projected; where three
///    scales in a row find the same extent the surface is taken as bounded by it (and 10 % more), else as going on
///    beyond, as above. Nothing is proved then: give a box if you know one.
/// `near`: points of interest, d x n, model units, may be d x 0. Throws EmptySurface when there is nothing,
/// InvalidArgument for a wrong dimension, non-finite points, or more than 12 dimensions to go
/// through by bounds.
[[nodiscard]] SurfaceExtent find_extent(const Surface& surface, const PointsIn& near, const Context& context = {});

/// find_extent(...).box.
[[nodiscard]] Box find_box(const Surface& surface, const PointsIn& near, const Context& context = {});

/// The same surface through another window, which meets it: with the tight box in there by
/// bounds, without bounds with the window itself.
[[nodiscard]] SurfaceExtent through_window(const Surface& surface, const SurfaceExtent& extent, const Box& window,
                                           const Context& context = {});

/// The work that Algorithm I or II has done, to hold against N, the number of cells that came of it (Appendix I).
struct CellCounts {
  Index num_tests = 0;    ///< crossing tests, of cells of all sizes
  Index num_lookups = 0;  ///< Algorithm II: neighbours looked up among the cells seen so far, 2 d a cell of the patch
  bool complete = true;   ///< false: Algorithm II stopped at GrowOptions::most_cells
};

struct SubdivideOptions {
  /// sigma, the cell size wanted, model units, > 0.
  double size = 0;
  /// Where to look; unset = find_box(surface, {}). Cells that do not meet it are dropped.
  std::optional<Box> box = std::nullopt;
  /// Where cell 0 begins, d; unset = lattice_origin(middle of the box, size).
  std::optional<Vector> origin = std::nullopt;
  /// Where to count the work; null = nowhere.
  CellCounts* counts = nullptr;
};

/// Algorithm I of the paper (sec. 3.1): halve the cells of the box that the surface may cross (a test that, where F has
/// interval bounds, says no by proof only) until they have the size wanted. With interval bounds no crossed cell is
/// ever lost, and cells wholly outside the domain are dropped; without them the search starts from cells of 1/32 of the
/// box (1/8 above d = 4), and what is finer may be missed. The cells stand in Morton order. Threads do not change them.
/// Cost O(2^d N) tests for N cells, as the paper's Appendix I says; memory some 22 bytes a cell (d = 3), at most 80
/// while it runs. Throws EmptySurface, InvalidArgument (also above d = 12), Cancelled, and OutOfMemory, the latter at
/// once where the coarse cells already show that the limit will be passed by far.
[[nodiscard]] CellGrid subdivide(const Surface& surface, const SubdivideOptions& options, const Context& context = {});

struct GrowOptions {
  /// sigma, the cell size wanted, model units, > 0.
  double size = 0;
  /// Where cell 0 begins, d; unset = lattice_origin(middle of the seeds, size).
  std::optional<Vector> origin = std::nullopt;
  /// Where to count the work; null = nowhere.
  CellCounts* counts = nullptr;
  /// With that many crossed cells, growth stops after the front at hand; 0 = never.
  Index most_cells = 0;
};

/// Algorithm II of the paper (sec. 3.1): the cells that hold a seed and are crossed, and all crossed
/// cells connected to them, found front by front over the 2 d neighbours across faces (the paper's Figure 1). Faces
/// suffice: where the surface passes from cell to cell through an edge or a corner, all closed cells around that edge
/// or corner are crossed, and they are connected across faces. So on a connected surface the cells are those of
/// `subdivide` on the same lattice; cells kept only by overestimating bounds can differ, and none of them holds a
/// surface point.
///
/// `seeds`: d x n, n >= 1, surface points (samples; one is enough). Seeds beside the surface are projected first; those
/// that do not reach it are left out. The cells stand in Morton order; threads do not change them. Cost: each cell and
/// its neighbours are tested once, so O(d N) tests and hash look-ups for N cells, instead of the O(d N^2) that the
/// paper's Appendix I allows for. An unbounded surface without box or domain ends in OutOfMemory. Throws EmptySurface
/// when no seed's cell is crossed, InvalidArgument, OutOfMemory, Cancelled.
[[nodiscard]] CellGrid grow(const Surface& surface, const PointsIn& seeds, const GrowOptions& options,
                            const Context& context = {});

[[nodiscard]] inline CellGrid grow(const Surface& surface, const PointsIn& seeds, double size,
                                   const Context& context = {}) {
  return grow(surface, seeds, GrowOptions{.size = size}, context);
}

/// The paper's envelope of a surface (sec. 3.1), as thick as marching in it wants it: the cells given and `layers` >= 0
/// layers around them, each the 2 d neighbours across faces (the paper's Figure 1) of the one before, whether the
/// surface goes through them or not. The cells given come first, in their order. Every point of the envelope lies
/// within (layers + sqrt d) cells of a cell given; where the surface is smooth it is at least layers / sqrt d cells
/// thick on either side. Where cells end, at the edge of a box or a domain, it reaches as far over the edge; sheets
/// closer than twice its reach grow together. Throws InvalidArgument for layers < 0, OutOfMemory.
[[nodiscard]] CellGrid thicken(const CellGrid& cells, Index layers, const Context& context = {});

/// The layers with which distances marched in the envelope converge like sqrt(h) (Memoli and Sapiro 2001; docs/march.md
/// has the measurement): C sqrt(L / h), L the longest side of the cells' box, so that the envelope gets thinner, but
/// slower than its cells.
[[nodiscard]] Index envelope_layers(const CellGrid& cells);

/// Which cells hang together, corners included (3^d - 1 neighbours).
struct Components {
  static constexpr std::int32_t kNone = -1;
  /// By cell: its component, numbered in the order of their first cells; kNone = left out.
  std::vector<std::int32_t> label;
  std::int32_t count = 0;
};

/// Of all cells. Where F and the domain have interval bounds and the set is complete, two points whose
/// cells have different labels lie on different components of the surface: a proof, since a path would pass through
/// closed cells that touch. The same label proves nothing.
[[nodiscard]] Components components(const CellGrid& grid);

/// Of all cells, hanging together across faces alone (2 d neighbours, in any dimension): what Algorithm II joins.
[[nodiscard]] Components components_across_faces(const CellGrid& grid);

/// Of the cells that marching may walk on: invalid ones are left out.
[[nodiscard]] Components components(const SurfaceCells& cells);

}  // namespace taut
