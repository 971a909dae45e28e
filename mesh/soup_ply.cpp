// SPDX-License-Identifier: Apache-2.0
// Writes PLY files.

#include "mesh/soup_ply.hpp"

#include "base/assert.hpp"
#include "base/atomic_file.hpp"

#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace penumbra::mesh {
namespace {

static_assert(std::endian::native == std::endian::little, "the bytes are written as they lie in memory");

class Bytes {
 public:
  template <typename T>
  void put(const T& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  void put(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  [[nodiscard]] std::span<const std::byte> all() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

constexpr std::string_view kColorProperties = "property uchar red\nproperty uchar green\nproperty uchar blue\n";

std::string header(const PlyMesh& mesh) {
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment Penumbra\n"
      "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "element face {}\nproperty list uchar int vertex_indices\n",
      mesh.positions.size(), mesh.triangles.size());
  if (!mesh.triangle_colors.empty()) text += kColorProperties;
  if (!mesh.edges.empty()) {
    text += fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\n{}", mesh.edges.size(),
                        kColorProperties);
  }
  return text + "end_header\n";
}

/// PLY's usual index type is a signed 32-bit integer, the only one that all readers support.
std::int32_t index(const PlyMesh& mesh, std::uint32_t i) {
  PENUMBRA_ASSERT(i < mesh.positions.size(), "vertex {} of {}", i, mesh.positions.size());
  return static_cast<std::int32_t>(i);
}

}  // namespace

void write_ply(const std::filesystem::path& path, const PlyMesh& mesh) {
  PENUMBRA_ASSERT(mesh.positions.size() <= std::numeric_limits<std::int32_t>::max(), "{} positions",
                  mesh.positions.size());
  PENUMBRA_ASSERT(mesh.triangle_colors.empty() || mesh.triangle_colors.size() == mesh.triangles.size(),
                  "{} colours for {} triangles", mesh.triangle_colors.size(), mesh.triangles.size());
  Bytes bytes;
  bytes.put(std::string_view(header(mesh)));
  for (const glm::dvec3& p : mesh.positions) {
    for (const double x : {p.x, p.y, p.z}) bytes.put(x);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    bytes.put(std::uint8_t{3});
    for (const std::uint32_t i : mesh.triangles[t]) bytes.put(index(mesh, i));
    if (!mesh.triangle_colors.empty()) bytes.put(mesh.triangle_colors[t]);
  }
  for (const PlyEdge& edge : mesh.edges) {
    bytes.put(index(mesh, edge.a));
    bytes.put(index(mesh, edge.b));
    bytes.put(edge.color);
  }
  write_file_atomically(path, bytes.all());
}

}  // namespace penumbra::mesh
