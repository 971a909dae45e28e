// SPDX-License-Identifier: Apache-2.0
// Radiance of an emissive primitive: its material's, times the mean of its picture over the triangles, weighted by
// their areas in the world. The search for the light's shape allows the rounding of positions in single precision.

#include "import/gltf/gltf_emission.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace penumbra::import {

glm::dvec3 radiance_of(const PrimitiveVertices& vertices, std::span<const mesh::Triangle> triangles,
                       PictureMeans& means) {
  const Look& look = vertices.look;
  if (!look.emission) return look.radiance;
  std::vector<PicturedTriangle> pictured;
  for (const mesh::Triangle& triangle : triangles) {
    std::array<glm::dvec3, 3> corners{};
    PicturedTriangle one;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = glm::dvec3(vertices.to_world(triangle[k]) * glm::dvec4(vertices.local[triangle[k]], 1));
      one.places[k] = look.emission_places[triangle[k]];
    }
    one.area = glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) / 2;
    pictured.push_back(one);
  }
  return look.radiance * means.over(*look.emission, pictured);
}

std::variant<Emitter, std::string> emitter_since(const scenes::Scene& scene, const SoupEnd& before,
                                                 const PlacedNode& placed, bool two_sided) {
  // Files store single precision: a position is rounded by half the spacing of floats at its distance from the node's
  // origin, and so is each coordinate; the rounding of the transform in double is negligible.
  const auto positions = std::span(scene.soup.positions).subspan(before.position);
  const glm::dvec3 origin(placed.to_world[3]);
  double distance = 0;
  for (const glm::dvec3& p : positions) distance = std::max(distance, glm::distance(p, origin));
  const double rounding = distance * static_cast<double>(std::numeric_limits<float>::epsilon());
  std::vector<mesh::Triangle> body;
  for (const mesh::Triangle& t : std::span(scene.soup.triangles).subspan(before.triangle)) {
    const auto first = static_cast<std::uint32_t>(before.position);
    body.push_back({t[0] - first, t[1] - first, t[2] - first});
  }
  return recognise_emitter(positions, body, two_sided, rounding);
}

}  // namespace penumbra::import
