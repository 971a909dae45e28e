// SPDX-License-Identifier: Apache-2.0
// Shadow volumes of any triangle soup (F. Crow 1977; P. Bergeron 1986 for open meshes): a volume for each triangle,
// their common faces removed by the signed multiplicity of edges.

#include "volumes/raster/light_volumes.hpp"

#include "base/parallel.hpp"
#include "volumes/edges/device/silhouette_pass.hpp"
#include "volumes/raster/volume_count.shared.h"
#include "volumes/raster/small_vectors.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace penumbra::volumes {
namespace {

/// Signs that must all agree for a statement to be true; GLSL twin in volume_count.frag.
struct Agreement {
  bool up = false, down = false, doubt = false;
  void look(double value, double bound) {
    up |= value > bound;
    down |= value < -bound;
    doubt |= !(value > bound || value < -bound);
  }
  /// Returns nullopt if the result depends on a sign that may be due to rounding.
  [[nodiscard]] std::optional<bool> agree() const {
    if (up && down) return false;
    if (doubt) return std::nullopt;
    return true;
  }
};

void look_at_determinant(Agreement& signs, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  signs.look(glm::dot(a, glm::cross(b, c)), gpu::kDeterminantError * norm1(a) * norm1(b) * norm1(c));
}

/// Returns whether the direction d is within the cone of the cap from l.
std::optional<bool> in_cone(const LightVolumes& volumes, const VolumeCap& cap, const glm::dvec3& d) {
  Agreement signs;
  const glm::dvec3 l = volumes.l;
  for (std::size_t i = 0; i < 3; ++i) {
    look_at_determinant(signs, glm::dvec3(cap.corners[i]) - l, glm::dvec3(cap.corners[(i + 1) % 3]) - l, d);
  }
  // Selects the cone, not its opposite: for corners that are counter-clockwise from l, the determinant (a, b, c) of
  // their directions from l is negative.
  signs.look(-1, 0);
  return signs.agree();
}

/// Returns the sums of `inside` over the parts' caps, or nullopt if `inside` is undecided for any.
template <typename Inside>
std::optional<std::vector<std::int32_t>> count(const LightVolumes& volumes, const Inside& inside) {
  std::vector<std::int32_t> sums(std::max<std::size_t>(volumes.parts.size(), 1));
  for (const VolumeCap& cap : volumes.caps) {
    const std::optional<bool> is = inside(cap);
    if (!is) return std::nullopt;
    sums[cap.part] += *is ? 1 : 0;
  }
  return sums;
}

}  // namespace

ShadowCasters::ShadowCasters(const visibility::SceneFloats& scene, Layers layers)
    : scene_(&scene), positions_(mesh::widened(scene.positions)), layers_(layers) {
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.casts_shadow[i] == 0) continue;
    casters_.push_back(i);
    triangles_.push_back(scene.triangles[i]);
  }
  graph_ = mesh::build_edge_graph({positions_, triangles_});
  if (layers_ == Layers::one_a_solid) parts_ = visibility::ClosedCasters({positions_, triangles_}, graph_);
}

std::vector<std::uint32_t> ShadowCasters::counted_sides(const glm::vec3& l, const visibility::Light& light) const {
  std::vector<std::uint32_t> counted(casters_.size(), gpu::kBothBits);
  if (layers_ == Layers::one_a_solid) {
    const std::vector<mesh::Side> toward = parts_.light_sides({positions_, triangles_}, light, l);
    for (std::size_t i = 0; i < counted.size(); ++i) {
      if (toward[i] != mesh::Side::on) counted[i] = bits_of(toward[i]);
    }
  }
  for (std::size_t i = 0; i < counted.size(); ++i) {
    if (scene_->emits[casters_[i]] == light.index) counted[i] = 0;
  }
  return counted;
}

LightVolumes ShadowCasters::assembled(const glm::vec3& l, std::span<const std::uint32_t> sides,
                                      std::span<const mesh::SilhouetteEdge> edges) const {
  LightVolumes volumes{l, {}, {}, {}, {}};
  const bool all = layers_ == Layers::every_triangle && std::ranges::all_of(sides, [](std::uint32_t side) {
                     return (side & gpu::kBothBits) == side >> gpu::kCountedShift;
                   });
  if (!all) volumes.left_out.resize(scene_->triangles.size());
  volumes.caps.reserve(casters_.size());
  for (std::size_t i = 0; i < casters_.size(); ++i) {
    const std::uint32_t counted = sides[i] >> gpu::kCountedShift;
    if (!volumes.left_out.empty()) volumes.left_out[casters_[i]] = counted != (sides[i] & gpu::kBothBits) ? 1 : 0;
    if (counted == 0) continue;
    VolumeCap cap{scene_->corners(casters_[i]), scene_->plane[casters_[i]], 0, static_cast<std::uint32_t>(i)};
    if (counted == gpu::kBackBit) std::swap(cap.corners[1], cap.corners[2]);
    volumes.caps.push_back(cap);
  }
  volumes.edges.reserve(edges.size());
  for (const mesh::SilhouetteEdge& edge : edges) {
    const auto [a, b] = graph_.edges[edge.edge];
    volumes.edges.push_back(
        {scene_->positions[a], scene_->positions[b], edge.multiplicity, 0, graph_.around(edge.edge).front().triangle});
  }
  return volumes;
}

std::vector<std::uint32_t> ShadowCasters::components() const {
  std::vector<std::uint32_t> root(casters_.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (std::uint32_t edge = 0; edge < graph_.edges.size(); ++edge) {
    for (const mesh::Incidence& incidence : graph_.around(edge)) {
      const std::uint32_t first = find(graph_.around(edge).front().triangle), other = find(incidence.triangle);
      root[std::max(first, other)] = std::min(first, other);
    }
  }
  std::vector<std::uint32_t> number(casters_.size());
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < number.size(); ++i) number[i] = root[i] == i ? next++ : number[find(i)];
  return number;
}

LightVolumes ShadowCasters::seen_from(const glm::vec3& l, const visibility::Light& light) const {
  return seen_from(l, light, {});
}

LightVolumes ShadowCasters::seen_from(const glm::vec3& l, const visibility::Light& light,
                                      std::span<const std::uint8_t> kept) const {
  std::vector<mesh::Side> facings = mesh::facings({positions_, triangles_}, graph_, l);
  std::vector<std::uint32_t> counted = counted_sides(l, light);
  for (std::size_t i = 0; i < kept.size(); ++i) counted[i] = kept[i] != 0 ? counted[i] : 0;
  std::vector<std::uint32_t> sides(facings.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const std::uint32_t side = bits_of(facings[i]);
    sides[i] = side | (side & counted[i]) << gpu::kCountedShift;
    if ((side & counted[i]) == 0) facings[i] = mesh::Side::on;
  }
  std::vector<std::int32_t> multiplicities(graph_.edges.size());
  for_each_index(multiplicities.size(), [&](std::size_t edge) {
    multiplicities[edge] = mesh::signed_multiplicity(graph_, static_cast<std::uint32_t>(edge), facings);
  });
  std::vector<mesh::SilhouetteEdge> edges;
  for (std::uint32_t edge = 0; edge < multiplicities.size(); ++edge) {
    if (multiplicities[edge] != 0) edges.push_back({edge, multiplicities[edge]});
  }
  return assembled(l, sides, edges);
}

std::optional<std::vector<std::int32_t>> counts_along(const LightVolumes& volumes, const glm::dvec3& direction) {
  return count(volumes, [&](const VolumeCap& cap) { return in_cone(volumes, cap, direction); });
}

std::optional<std::vector<std::int32_t>> counts_at(const LightVolumes& volumes, const glm::dvec3& x) {
  return count(volumes, [&](const VolumeCap& cap) -> std::optional<bool> {
    const std::optional<bool> cone = in_cone(volumes, cap, x - glm::dvec3(volumes.l));
    if (cone && !*cone) return false;
    const glm::dvec3 a = cap.corners[0];
    Agreement beyond;
    look_at_determinant(beyond, glm::dvec3(cap.corners[1]) - a, glm::dvec3(cap.corners[2]) - a, x - a);
    if (!beyond.doubt && beyond.up) return false;  // x is on l's side
    return beyond.doubt ? std::nullopt : cone;
  });
}

}  // namespace penumbra::volumes
