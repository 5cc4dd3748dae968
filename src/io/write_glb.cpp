// glTF 2.0, binary (Khronos, "glTF 2.0 Specification"): a JSON chunk and a chunk of numbers. A curve is a primitive of
// mode LINE_STRIP, a mesh one of triangles with indices. Positions are 32-bit floats, the only kind there is: they
// stand about the middle of the box, which the node's translation puts back.

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>

#include "io/geometry.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

constexpr std::uint64_t kMostBytes = 0xFFFFFFFFU;
constexpr int kLineStrip = 3;
constexpr int kTriangles = 4;
constexpr int kPoints = 0;
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;

std::string shortest_decimal(double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

/// Fills a chunk up to a multiple of four bytes.
std::size_t padding(std::size_t size) { return (4 - size % 4) % 4; }

}  // namespace

void write_glb(OutputFile& out, const Geometry& geometry) {
  const Index n = geometry.size();
  const Index m = geometry.faces.cols();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  const auto position = [&](Index i, Index j) { return static_cast<float>(geometry.at(i, j) - middle(i)); };
  for (Index i = 0; i < 3 && n > 0; ++i) {
    double least = geometry.at(i, 0);
    double most = least;
    for (Index j = 1; j < n; ++j) {
      least = std::min(least, geometry.at(i, j));
      most = std::max(most, geometry.at(i, j));
    }
    middle(i) = 0.5 * (least + most);
    if (!(0.5 * (most - least) < static_cast<double>(std::numeric_limits<float>::max()))) {
      throw InvalidArgument("points lie farther apart than the numbers of .glb reach; write .ply or .vtp");
    }
  }
  const bool with_normals = geometry.has_normals();
  const std::uint64_t vector_bytes = 12 * static_cast<std::uint64_t>(n);
  const std::uint64_t index_bytes = 12 * static_cast<std::uint64_t>(m);
  const std::uint64_t bytes = vector_bytes * (with_normals ? 2 : 1) + index_bytes;

  std::string accessors;
  std::string primitives;
  Index num_accessors = 0;
  const auto add_vectors = [&](int view, Index first, Index count, bool bounds) {
    accessors += (num_accessors > 0 ? "," : "") + std::string("{\"bufferView\":") + std::to_string(view) +
                 ",\"byteOffset\":" + std::to_string(12 * first) + ",\"componentType\":" + std::to_string(kFloat) +
                 ",\"count\":" + std::to_string(count) + ",\"type\":\"VEC3\"";
    if (bounds) {
      std::string least;
      std::string most;
      for (Index i = 0; i < 3; ++i) {
        float low_i = position(i, first);
        float high_i = low_i;
        for (Index j = first; j < first + count; ++j) {
          low_i = std::min(low_i, position(i, j));
          high_i = std::max(high_i, position(i, j));
        }
        least += (i > 0 ? "," : "") + shortest_decimal(static_cast<double>(low_i));
        most += (i > 0 ? "," : "") + shortest_decimal(static_cast<double>(high_i));
      }
      accessors += ",\"min\":[" + least + "],\"max\":[" + most + "]";
    }
    accessors += "}";
    return num_accessors++;
  };
  const auto add_primitive = [&](int mode, Index first, Index count, bool indexed) {
    if (count == 0) return;
    std::string primitive = "{\"mode\":" + std::to_string(mode) +
                            ",\"attributes\":{\"POSITION\":" + std::to_string(add_vectors(0, first, count, true));
    if (with_normals) primitive += ",\"NORMAL\":" + std::to_string(add_vectors(1, first, count, false));
    primitive += "}";
    if (indexed) {
      accessors += ",{\"bufferView\":" + std::to_string(with_normals ? 2 : 1) +
                   ",\"componentType\":" + std::to_string(kUnsignedInt) + ",\"count\":" + std::to_string(3 * m) +
                   ",\"type\":\"SCALAR\"}";
      primitive += ",\"indices\":" + std::to_string(num_accessors++);
    }
    primitives += (primitives.empty() ? "" : ",") + primitive + "}";
  };
  if (m > 0) {
    add_primitive(kTriangles, 0, n, true);
  } else {
    for (Index l = 0; l < geometry.num_lines(); ++l) {
      const Index first = geometry.line_starts[static_cast<std::size_t>(l)];
      const Index count = geometry.line_starts[static_cast<std::size_t>(l) + 1] - first;
      add_primitive(count == 1 ? kPoints : kLineStrip, first, count, false);
    }
  }

  std::string views = "{\"buffer\":0,\"byteLength\":" + std::to_string(vector_bytes) + ",\"byteStride\":12}";
  if (with_normals) {
    views += ",{\"buffer\":0,\"byteOffset\":" + std::to_string(vector_bytes) +
             ",\"byteLength\":" + std::to_string(vector_bytes) + ",\"byteStride\":12}";
  }
  if (m > 0) {
    views += ",{\"buffer\":0,\"byteOffset\":" + std::to_string(bytes - index_bytes) +
             ",\"byteLength\":" + std::to_string(index_bytes) + "}";
  }
  std::string json = R"({"asset":{"version":"2.0","generator":"taut"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{)";
  if (!primitives.empty()) {
    json += "\"mesh\":0,\"translation\":[" + shortest_decimal(middle(0)) + "," + shortest_decimal(middle(1)) + "," +
            shortest_decimal(middle(2)) + "]}],\"meshes\":[{\"primitives\":[" + primitives + "]}],\"accessors\":[" +
            accessors + "],\"bufferViews\":[" + views + "],\"buffers\":[{\"byteLength\":" + std::to_string(bytes) +
            "}]}";
  } else {
    json += "}]}";
  }
  json.append(padding(json.size()), ' ');
  const std::uint64_t total = 12 + 8 + json.size() + (primitives.empty() ? 0 : 8 + bytes);
  if (total > kMostBytes) throw InvalidArgument("a .glb file holds at most 4 GB; write .ply or .vtp");

  const auto word = [&](std::uint64_t value) {
    write_raw(out, static_cast<std::int32_t>(static_cast<std::uint32_t>(value)));
  };
  out.write("glTF");
  word(2);
  word(total);
  word(json.size());
  out.write("JSON");
  out.write(json);
  if (primitives.empty()) return;
  word(bytes);
  out.write(std::string_view("BIN\0", 4));
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < 3; ++i) write_raw(out, position(i, j));
  }
  for (Index j = 0; with_normals && j < n; ++j) {
    for (Index i = 0; i < 3; ++i) write_raw(out, static_cast<float>(geometry.normal_at(i, j)));
  }
  for (Index f = 0; f < m; ++f) {
    for (Index c = 0; c < 3; ++c) write_raw(out, static_cast<std::int32_t>(geometry.faces(c, f)));
  }
}

}  // namespace taut::detail
