// SPDX-License-Identifier: Apache-2.0
// Finds the closed parts of a mesh, and the one layer of each that counts as a caster for a light.

#include "visibility/closed_casters.hpp"

#include "base/assert.hpp"
#include "mesh/closed_components.hpp"
#include "visibility/pair_truth.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace penumbra::visibility {
namespace {

using mesh::EdgeGraph;
using mesh::MeshView;
using mesh::Side;

std::array<glm::dvec3, 3> corners_of(const MeshView& mesh, std::uint32_t triangle) {
  const mesh::Triangle& t = mesh.triangles[triangle];
  return {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
}

}  // namespace

ClosedCasters::ClosedCasters(const MeshView& mesh, const EdgeGraph& graph) {
  mesh::Components found = mesh::find_components(mesh, graph);
  for (mesh::Component& component : found.components) {
    if (!component.closed) continue;
    Part part;
    part.outside = mesh::signed_volume(mesh, component, found.turn) < 0 ? -1 : 1;
    part.lower = part.upper = corners_of(mesh, component.triangles.front())[0];
    for (const std::uint32_t t : component.triangles) {
      for (const glm::dvec3& corner : corners_of(mesh, t)) {
        part.lower = glm::min(part.lower, corner);
        part.upper = glm::max(part.upper, corner);
      }
    }
    part.triangles = std::move(component.triangles);
    parts_.push_back(std::move(part));
  }
  turn_ = std::move(found.turn);
}

/// Returns whether the winding number of the part around c is not 0, by the crossings of the part with a segment from c
/// to a point outside of the part's box.
bool ClosedCasters::is_around(const Part& part, const MeshView& mesh, const Light& light, const glm::vec3& c) const {
  const glm::dvec3 at(c);
  if (glm::any(glm::lessThan(at, part.lower)) || glm::any(glm::greaterThan(at, part.upper))) return false;
  const glm::vec3 beyond(part.upper + (part.upper - part.lower) + 1.0);
  int winding = 0;
  for (const std::uint32_t t : part.triangles) {
    const auto [a, b, d] = corners_of(mesh, t);
    const std::array<glm::vec3, 3> corners = {glm::vec3(a), glm::vec3(b), glm::vec3(d)};  // the coordinates were floats
    if (!segment_meets_triangle(c, beyond, corners, light).meets) continue;
    winding += turn_[t] * static_cast<int>(mesh::side_of_plane(corners[0], corners[1], corners[2], c));
  }
  return winding != 0;
}

std::vector<Side> ClosedCasters::light_sides(const MeshView& mesh, const Light& light, const glm::vec3& c) const {
  std::vector<Side> sides(mesh.triangles.size(), Side::on);
  for (const Part& part : parts_) {
    const int toward_light = is_around(part, mesh, light, c) ? -part.outside : part.outside;
    for (const std::uint32_t t : part.triangles) sides[t] = static_cast<Side>(toward_light * turn_[t]);
  }
  return sides;
}

std::vector<Side> light_sides(const MeshView& mesh, const EdgeGraph& graph, const Light& light, const glm::vec3& c) {
  return ClosedCasters(mesh, graph).light_sides(mesh, light, c);
}

void keep_one_layer(std::span<const Side> light_sides, bool from_light, std::span<Side> facings) {
  PENUMBRA_ASSERT(light_sides.size() == facings.size(), "{} for {} triangles", light_sides.size(), facings.size());
  for (std::size_t i = 0; i < facings.size(); ++i) {
    if (light_sides[i] == Side::on) continue;
    const Side counted = from_light ? light_sides[i] : mesh::opposite(light_sides[i]);
    if (facings[i] != counted) facings[i] = Side::on;
  }
}

}  // namespace penumbra::visibility
