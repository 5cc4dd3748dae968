#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "march/cell_map.hpp"
#include "search/sharp_bends.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/search/path_options.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// How cells are made.
struct CellRequest {
  GridMethod method = GridMethod::automatic;
  double size = 0;    ///< h of level 0, model units; 0 = chosen
  Points seeds = {};  ///< PathOptions::seeds
};

/// The cells of one surface at sizes h, h/2, h/4, ..., each made when first asked for and then kept.
class CellLevels {
 public:
  /// Beyond it there would be too many cells to make all of them.
  static constexpr Index kMostDimensions = 6;
  /// So many grow where a march goes, before it is given up.
  static constexpr Index kMostLazyCells = 1'000'000;

  /// Throws InvalidArgument for a request that does not fit the surface.
  CellLevels(Surface surface, CellRequest request, Context context);

  /// Makes sure that the points near (d x n) lie where cells are looked for. Finds the box and h the first time. True
  /// when that makes earlier cells void.
  bool prepare(const PointsIn& near);

  /// False in more than kMostDimensions, unless they are to grow: then there is a box and a size to judge points by,
  /// but no cells.
  [[nodiscard]] bool exist() const { return surface_.dim() <= kMostDimensions || lazy(); }
  /// True when cells grow only where a march goes: in more than kMostDimensions, by Algorithm II, if that was asked
  /// for.
  [[nodiscard]] bool lazy() const { return surface_.dim() > kMostDimensions && request_.method == GridMethod::grow; }
  /// Algorithm II from the ends of paths, on a surface that brings no samples.
  [[nodiscard]] bool grows_from_ends() const { return grows() && !fitted(); }
  /// The algorithm that makes the cells.
  [[nodiscard]] GridMethod grid() const { return grows() ? GridMethod::grow : GridMethod::subdivide; }
  /// The work that the complete cells of a level, which must be there, have taken.
  [[nodiscard]] CellCounts counts(int level) const { return complete_.at(static_cast<std::size_t>(level)).counts; }
  /// How many sizes are worth trying: the number of cells grows by 2^(d - 1) each time.
  [[nodiscard]] int num_levels() const { return surface_.dim() <= 3 ? 5 : surface_.dim() == 4 ? 3 : 2; }
  [[nodiscard]] double size(int level) const;
  /// True where a size was asked for, and cells of this level are clearly coarser than those that would be chosen.
  [[nodiscard]] bool coarser_than_chosen(int level) const;
  /// Where cells are looked for. Empty until prepared.
  [[nodiscard]] const Box& box() const { return extent_.box; }
  [[nodiscard]] const SurfaceExtent& extent() const { return extent_; }
  /// True when the surface goes on beyond the box, where no cells are.
  [[nodiscard]] bool endless() const { return exist() && !lazy() && extent_.endless.any(); }
  /// The cells of a level. `seeds` (d x n) are where lazy ones start; those are the caller's alone. Complete ones are
  /// shared by all callers, who must not ask for more than their const interface; they may call from several threads.
  [[nodiscard]] std::shared_ptr<SurfaceCells> cells(int level, const PointsIn& seeds);
  /// The complete cells of a level with others around them (PathOptions::envelope), made when first asked for. Throws
  /// InvalidArgument where cells are lazy.
  [[nodiscard]] std::shared_ptr<SurfaceCells> envelope(int level, Index layers);
  /// Of the complete cells of a level, made when first asked for; null for lazy ones.
  [[nodiscard]] std::shared_ptr<const CellMap> map(int level);
  /// Which component of the complete cells of a level each of them belongs to, found out when first asked for.
  [[nodiscard]] std::shared_ptr<const std::vector<std::int32_t>> components(int level);
  /// The same, null where nobody has asked yet.
  [[nodiscard]] std::shared_ptr<const std::vector<std::int32_t>> known_components(int level);
  /// Where the surface bends within the complete cells of a level, made when first asked for; null where that is not
  /// looked at: lazy cells, cells for samples, and other than surfaces in R^3.
  [[nodiscard]] std::shared_ptr<const SharpBends> sharp_bends(int level);
  /// Complete cells of any size where `cells` gives complete ones by subdivision; null elsewhere.
  [[nodiscard]] std::shared_ptr<SurfaceCells> subdivided(double h) const;
  /// The grid alone of complete cells of any size, by the algorithm that was asked for. Once prepared.
  [[nodiscard]] CellGrid grid_of(double h, CellCounts* counts = nullptr) const;

  /// False when the cells of level 0 are coarser than the surface bends, since they were asked for or finer ones would
  /// be too many: marched distances may miss ways then. Known once there are such cells.
  [[nodiscard]] bool resolved() const { return resolved_; }
  /// The same of most cells: where that fails, what was asked for is too coarse to say anything about the surface.
  [[nodiscard]] bool mostly_resolved() const { return mostly_resolved_; }

  /// x (d) brought onto the surface. `name` ("start") says in messages which point it is. Throws InvalidArgument when
  /// x does not fit the surface or lies more than ten cells off it; a move of more than one cell is told.
  [[nodiscard]] Vector on_surface(const VectorIn& x, const char* name) const;

 private:
  [[nodiscard]] bool fitted() const;
  [[nodiscard]] double chosen_size() const;
  [[nodiscard]] bool grows() const;
  [[nodiscard]] bool plant(const PointsIn& near);
  [[nodiscard]] std::shared_ptr<SurfaceCells> complete(double h, CellCounts* counts) const;
  void refine_to_curvature();

  Surface surface_;
  CellRequest request_;
  Context context_;
  Points seeds_;     // surface points that cells without samples grow from
  double size_ = 0;  // h of level 0; 0 until prepared
  bool resolved_ = true;
  bool mostly_resolved_ = true;
  SurfaceExtent extent_;
  std::mutex mutex_;
  struct Complete {
    std::shared_ptr<SurfaceCells> cells;
    std::shared_ptr<SurfaceCells> envelope;
    CellCounts counts;
    std::shared_ptr<const CellMap> map;
    std::shared_ptr<const SharpBends> sharp_bends;
    std::shared_ptr<const std::vector<std::int32_t>> components;
  };
  std::vector<Complete> complete_;  // a level each, null until asked for
};

/// h of level 0 for the points near (d x n). Throws as CellLevels does.
[[nodiscard]] double first_cell_size(const Surface& surface, const CellRequest& request, const PointsIn& near,
                                     const Context& context);

}  // namespace taut::detail
