#pragma once

#include <cstdint>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/mesh.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Distances over the triangles of a mesh, from the nearest of the sources so far. On faces that are planes, and over
/// edges between them, a distance is that of the unfolded triangles, exact until ways round differ within a triangle;
/// on curved ones it is off by the order of a triangle's size. Borders and edges are walked along like anything else.
class MeshMarch {
 public:
  explicit MeshMarch(const TriangleMesh& mesh);

  /// Adds a source, a point on the mesh or next to it. Throws Cancelled.
  void add_source(const VectorIn& x, const Context& context);

  [[nodiscard]] const Vector& distance() const { return distance_; }  ///< one a vertex, infinity where no path leads
  /// The number of the nearest source, -1: none.
  [[nodiscard]] const std::vector<std::int32_t>& source() const { return source_; }

 private:
  [[nodiscard]] double over(int a, int b, int c) const;

  const TriangleMesh& mesh_;
  std::vector<std::size_t> first_;  // of a vertex's triangles; one more than vertices
  std::vector<Index> around_;       // triangles
  Vector distance_;
  std::vector<std::int32_t> source_;
  std::int32_t num_sources_ = 0;
};

}  // namespace taut::detail
