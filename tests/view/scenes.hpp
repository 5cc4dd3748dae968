#pragma once

#include <cmath>
#include <numbers>

#include "taut/view/scene.hpp"

namespace taut::test {

/// A unit ball of n x 2 n quads with the polar angle as its scalar, and a quarter of a great circle a hair above it.
inline Scene ball_scene(int n = 40) {
  using std::numbers::pi;
  SceneMesh ball;
  TriangleMesh& mesh = ball.mesh;
  const int m = 2 * n;
  mesh.vertices.resize(3, (n + 1) * m);
  VertexScalar polar{"polar angle", Vector((n + 1) * m)};
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double a = pi * i / n;
      const double b = 2 * pi * j / m;
      mesh.vertices.col(i * m + j) << std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a);
      polar.values(i * m + j) = a;
    }
  }
  mesh.faces.resize(3, 2 * n * m);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const int k = (j + 1) % m;
      mesh.faces.col(2 * (i * m + j)) << i * m + j, (i + 1) * m + j, (i + 1) * m + k;
      mesh.faces.col(2 * (i * m + j) + 1) << i * m + j, (i + 1) * m + k, i * m + k;
    }
  }
  mesh.normals = mesh.vertices;
  mesh.scalars.push_back(polar);
  ScenePath path;
  path.points.resize(3, 50);
  for (int i = 0; i < 50; ++i) {
    const double a = pi / 2 * i / 49;
    path.points.col(i) << std::cos(a), std::sin(a), 0;
  }
  path.label = "quarter <turn> & \"more\"";
  path.colour = Colour::hex(0xFF0000);
  Scene scene;
  scene.title = "A ball </script><b>";
  scene.meshes.push_back(ball);
  scene.paths.push_back(path);
  scene.points.push_back({path.points.col(0), "from", Colour::hex(0x0000FF)});
  scene.points.push_back({path.points.col(49), "to", Colour::hex(0x0000FF)});
  scene.facts.push_back({"length", "1.570796327"});
  scene.caption.push_back("x\xC2\xB2 + y\xC2\xB2 + z\xC2\xB2 = 1, and bytes that are no text: \xFF\xFE\x01");
  return scene;
}

}  // namespace taut::test
