// SPDX-License-Identifier: Apache-2.0
// Makes the triangles of placed meshes run by run, one instance after the other, so that memory holds one instance at a
// time (docs/instances.md).

#include "visibility/seen/all_placed.hpp"

#include "base/parallel.hpp"
#include "mesh/predicates.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace penumbra::visibility {
namespace {

/// Number of triangles in a run of the scene's own soup, which may be large.
constexpr std::size_t kMostOfRun = 100'000;

using Corners = std::array<glm::vec3, 3>;

/// Exact. A difference of float32 is off by 2⁻⁵³ of itself in double, and each term of the cross product by twice that
/// and one rounding: the bound of 2⁻⁵⁰ of the terms decides nearly all triangles without exact numbers.
bool has_area(const Corners& corners) {
  const glm::dvec3 a = glm::dvec3(corners[1]) - glm::dvec3(corners[0]),
                   b = glm::dvec3(corners[2]) - glm::dvec3(corners[0]);
  const glm::dvec3 normal = glm::abs(glm::cross(a, b)), wide_a = glm::abs(a), wide_b = glm::abs(b);
  const glm::dvec3 doubt =
      0x1p-50 * glm::dvec3(wide_a.y * wide_b.z + wide_a.z * wide_b.y, wide_a.z * wide_b.x + wide_a.x * wide_b.z,
                           wide_a.x * wide_b.y + wide_a.y * wide_b.x);
  return normal.x > doubt.x || normal.y > doubt.y || normal.z > doubt.z ||
         !mesh::collinear(corners[0], corners[1], corners[2]);
}

}  // namespace

void AllPlaced::for_each_run(const std::function<void(const Run&)>& take) const {
  std::vector<Corners> corners;
  std::vector<std::uint8_t> counts;
  for (const PlacedMeshes::Part& part : meshes_.parts()) {
    const auto all = static_cast<std::uint32_t>(part.soup->triangles.size());
    for (std::uint32_t first = 0, end = 0; first < all; first = end) {
      const std::uint32_t object = meshes_.object(part, first);
      while (end < all && end - first < kMostOfRun && meshes_.object(part, end) == object) ++end;
      corners.resize(end - first);
      counts.resize(end - first);
      for_each_index(corners.size(), [&](std::size_t i) {
        corners[i] = meshes_.corners(part, first + static_cast<std::uint32_t>(i));
        counts[i] = has_area(corners[i]) ? 1 : 0;
      });
      std::size_t kept = 0;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        if (counts[i] != 0) corners[kept++] = corners[i];
      }
      const scenes::Object& of = meshes_.scene().objects[object];
      take({std::span(corners).first(kept), of.casts_shadow && of.alpha.mode == scenes::Alpha::Mode::opaque,
            of.receives_shadow, of.emits ? static_cast<std::int32_t>(*of.emits) : -1});
    }
  }
}

void AllPlaced::for_each_positions(const std::function<void(std::span<const glm::vec3>)>& take) const {
  std::vector<glm::vec3> positions;
  for (const PlacedMeshes::Part& part : meshes_.parts()) {
    const std::size_t all = part.soup->positions.size();
    for (std::size_t first = 0; first < all; first += positions.size()) {
      positions.resize(std::min<std::size_t>(all - first, kMostOfRun));
      for_each_index(positions.size(), [&](std::size_t i) { positions[i] = meshes_.position(part, first + i); });
      take(positions);
    }
  }
}

}  // namespace penumbra::visibility
