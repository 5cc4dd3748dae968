#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "strata/faceted_surface.hpp"
#include "taut/core/box.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// A corner that reaches into faces, where they have more than 180 degrees, next to a way.
struct ReflexCorner {
  Point3 x;
  std::vector<int> faces;
  std::size_t step = 0;  ///< of the way, nearest to it
};

/// One way between two points over a graph: what a path is corrected from.
struct FacetWay {
  double length = 0;
  std::vector<Point3> points;  ///< from p to q
  /// One a step between points: faces that both points lie on.
  std::vector<std::vector<int>> faces;
  std::vector<bool> corner;  ///< one a point
  std::vector<int> edge;     ///< one a point: the edge it lies on, or -1
  std::vector<ReflexCorner> reflex;
};

/// Points of every face, edge and corner in the cells of a box, joined to their neighbours on the same face. Shortest
/// ways over it are some per cent too long, and tell which faces a shortest path may cross.
class FacetGraph {
 public:
  /// Cells of at most `size` (model units) of `box`. Throws EmptySurface, OutOfMemory, Cancelled.
  FacetGraph(FacetedSurface& surface, const Box& box, double size, const Context& context);

  [[nodiscard]] const Box& box() const { return box_; }
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] std::size_t num_nodes() const { return nodes_.size(); }
  [[nodiscard]] Index num_cells() const { return num_cells_; }

  /// Ways from p to q (on the surface) no longer than `slack` times the shortest: one for each way round, and one for
  /// each row of faces. Shortest first; empty where there is none.
  [[nodiscard]] std::vector<FacetWay> ways(const Point3& p, const Point3& q, double slack) const;

 private:
  struct Node {
    Point3 x;
    std::vector<int> faces;
    int edge = -1;
    bool corner = false;
    std::vector<int> reflex = {};  // faces that a corner reaches into
  };
  struct Link {
    std::uint32_t to;
    float length;
  };
  void add(Node node);
  /// A point of the face with these conditions zero near the cell's centre that `is_right` accepts.
  template <class IsRight>
  [[nodiscard]] bool find_point(const Box& cell, int face, const std::vector<int>& conditions, bool try_corners,
                                const IsRight& is_right, Point3& x);
  void fill_cell(const Box& cell, const std::vector<int>& kinks);
  void link();
  [[nodiscard]] double step(int face, const Point3& a, const Point3& b, bool along_edge) const;
  [[nodiscard]] std::vector<Link> links_of(const Node& node, double reach) const;
  [[nodiscard]] double joined(const Node& a, const Node& b) const;

  FacetedSurface& surface_;
  Box box_;
  double size_;
  Index num_cells_ = 0;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> reflex_;  // corners that reach into a face
  std::vector<std::vector<Link>> links_;
  std::map<std::array<int, 3>, std::vector<std::uint32_t>> bins_;
};

}  // namespace taut::detail
