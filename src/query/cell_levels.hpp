#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "march/cell_map.hpp"
#include "query/sharp_bends.hpp"
#include "taut/cells/find_box.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/core/box.hpp"
#include "taut/core/context.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// The cells of one surface at sizes h, h/2, h/4, ..., each made when first asked for and then kept.
class CellLevels {
 public:
  /// Beyond it there would be too many cells.
  static constexpr Index kMostDimensions = 6;

  /// `cell` = 0 has the size h chosen.
  CellLevels(Surface surface, GridMethod grid, double cell, Context context);

  /// Makes sure that the points near (d x n) lie where cells are looked for. Finds the box and h the first time. True
  /// when that makes earlier cells void.
  bool prepare(const PointsIn& near);

  /// False in more than kMostDimensions: then there is a box and a size to judge points by, but no cells.
  [[nodiscard]] bool exist() const { return surface_.dim() <= kMostDimensions; }
  /// True when cells are grown where they are needed: from the ends, for each call.
  [[nodiscard]] bool lazy() const { return grows() && !fitted(); }
  /// How many sizes are worth trying: the number of cells grows by 2^(d - 1) each time.
  [[nodiscard]] int num_levels() const { return surface_.dim() <= 3 ? 5 : surface_.dim() == 4 ? 3 : 2; }
  [[nodiscard]] double size(int level) const;
  /// Where cells are looked for. Empty until prepared.
  [[nodiscard]] const Box& box() const { return extent_.box; }
  [[nodiscard]] const SurfaceExtent& extent() const { return extent_; }
  /// True when the surface goes on beyond the box, where no cells are.
  [[nodiscard]] bool endless() const { return exist() && !lazy() && extent_.endless.any(); }
  /// The cells of a level. `seeds` (d x n) are where lazy ones start; those are the caller's alone. Complete ones are
  /// shared by all callers, who must not ask for more than their const interface; they may call from several threads.
  [[nodiscard]] std::shared_ptr<SurfaceCells> cells(int level, const PointsIn& seeds);
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

  /// False when the cells of level 0 are coarser than the surface bends, and finer ones would be too many: marched
  /// distances may miss ways then. Known once there are such cells.
  [[nodiscard]] bool resolved() const { return resolved_; }

  /// x (d) brought onto the surface. `name` ("start") says in messages which point it is. Throws InvalidArgument when
  /// x does not fit the surface or lies more than ten cells off it; a move of more than one cell is told.
  [[nodiscard]] Vector on_surface(const VectorIn& x, const char* name) const;

 private:
  [[nodiscard]] bool fitted() const;
  [[nodiscard]] bool grows() const;
  void refine_to_curvature();

  Surface surface_;
  GridMethod grid_;
  Context context_;
  double cell_;
  double size_ = 0;  // h of level 0; 0 until prepared
  bool resolved_ = true;
  SurfaceExtent extent_;
  std::mutex mutex_;
  struct Complete {
    std::shared_ptr<SurfaceCells> cells;
    std::shared_ptr<const CellMap> map;
    std::shared_ptr<const SharpBends> sharp_bends;
    std::shared_ptr<const std::vector<std::int32_t>> components;
  };
  std::vector<Complete> complete_;  // a level each, null until asked for
};

/// "1,0,0.5": a point as the command line takes it.
[[nodiscard]] std::string text_of(const VectorIn& x);
/// "[0, 2] x [-1, 1]"
[[nodiscard]] std::string text_of(const Box& box);

/// Throws InvalidArgument unless x has the surface's dimension and is finite.
void check_point(const Surface& surface, const VectorIn& x, const char* name);

}  // namespace taut::detail
