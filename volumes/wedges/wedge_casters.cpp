// SPDX-License-Identifier: Apache-2.0
// Selects the silhouette edges that cast penumbrae and derives their crop planes (Lehtinen et al. 2006; extended to
// triangle soups, see wedge_casters.hpp).

#include "volumes/wedges/wedge_casters.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"
#include "mesh/predicates.hpp"
#include "volumes/wedges/planar.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace penumbra::volumes {
namespace {

using mesh::Side;

/// Returns the side of the plane (a, b, apex) that all corners are strictly on; `on` if there is none.
Side strict_side(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& apex, const LightHull& light) {
  const Side first = mesh::side_of_plane(a, b, apex, light.corners.front());
  const bool common = std::ranges::all_of(
      light.corners, [&](const glm::dvec3& l) { return mesh::side_of_plane(a, b, apex, l) == first; });
  return common ? first : Side::on;
}

/// Value and error bound of h(l) = g · (l − a), g = (b − a) × (c − a), for points with exact coordinates.
struct Signed {
  double value = 0, error = 0;
};

/// The coordinates of g are off by 2 differences, a product and a sum: 4 · 2⁻⁵³ of |P| + |Q| each, P and Q being the
/// products. The product with a difference and the sum of three add 4 more. 16 · 2⁻⁵³ of the sum of sizes leaves a
/// margin of two.
Signed height(const Crop& crop, const glm::dvec3& l) {
  const glm::dvec3 u = crop.triangle[1] - crop.triangle[0], v = crop.triangle[2] - crop.triangle[0],
                   w = l - crop.triangle[0];
  const glm::dvec3 size = glm::abs(u), other = glm::abs(v), direction = glm::abs(w);
  const double sum = direction.x * (size.y * other.z + size.z * other.y) +
                     direction.y * (size.z * other.x + size.x * other.z) +
                     direction.z * (size.x * other.y + size.y * other.x);
  return {glm::dot(glm::cross(u, v), w), 0x1p-49 * sum};
}

/// Returns whether n · (x − l) − κ s h(l) ≥ 0 for both ends x and all corners l, with certainty: by more than the error
/// of the evaluation.
bool holds_where_cropped(const glm::dvec3& n, double factor, const Crop& crop, const EdgeAndLight& cast) {
  return std::ranges::all_of(cast.light, [&](const glm::dvec3& l) {
    const Signed h = height(crop, l);
    return std::ranges::all_of(std::array{cast.a, cast.b}, [&](const glm::dvec3& x) {
      const glm::dvec3 direction = x - l;
      const double along = glm::dot(n, direction), size = glm::dot(glm::abs(n), glm::abs(direction));
      const double rest = along - factor * crop.others * h.value;
      return rest > 0x1p-50 * (size + std::abs(factor * h.value)) + factor * h.error;
    });
  });
}

}  // namespace

Casters casters_of(const visibility::SceneFloats& scene, const visibility::Light& light) {
  Casters casters;
  casters.positions = mesh::widened(scene.positions);
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.casts_shadow[i] == 0 || scene.emits[i] == light.index) continue;
    casters.triangles.push_back(scene.triangles[i]);
    casters.triangle.push_back(i);
  }
  casters.graph = mesh::build_edge_graph(casters.view());
  return casters;
}

Casters casters_of(const mesh::TriangleSoup& soup) {
  Casters casters{soup.positions, soup.triangles, {}, {}};
  casters.triangle.resize(soup.triangles.size());
  std::iota(casters.triangle.begin(), casters.triangle.end(), 0U);
  casters.graph = mesh::build_edge_graph(casters.view());
  return casters;
}

Box bounds_of(const Casters& casters) {
  PENUMBRA_ASSERT(!casters.positions.empty(), "a scene has positions");
  Box box{casters.positions.front(), casters.positions.front()};
  for (const glm::dvec3& p : casters.positions) {
    box.lower = glm::min(box.lower, p);
    box.upper = glm::max(box.upper, p);
  }
  const glm::dvec3 extent = box.upper - box.lower;
  const double pad = largest(extent) > 0 ? largest(extent) / 16 : 1.0;
  for (int k = 0; k < 3; ++k) {
    if (extent[k] > 0) continue;
    box.lower[k] -= pad;
    box.upper[k] += pad;
  }
  return box;
}

std::optional<Crop> crop_of(const Casters& casters, std::uint32_t edge, const LightHull& light) {
  const mesh::EdgeGraph& graph = casters.graph;
  const glm::dvec3 &a = casters.positions[graph.edges[edge].a], &b = casters.positions[graph.edges[edge].b];
  std::optional<Crop> crop;
  int sum = 0;
  for (const mesh::Incidence& around : graph.around(edge)) {
    if (graph.kind[around.triangle] != mesh::TriangleKind::proper) continue;
    const glm::dvec3& apex = casters.positions[around.apex];
    const Side side = strict_side(a, b, apex, light);
    if (side != Side::on) {
      sum += static_cast<int>(side);
    } else if (crop) {
      return std::nullopt;
    } else {
      crop = Crop{{a, b, apex}, 0};
    }
  }
  if (!crop || std::abs(sum) != 1) return std::nullopt;
  crop->others = sum;
  return crop;
}

std::optional<Plane> crop_plane(const Crop& crop, const EdgeAndLight& cast) {
  const std::optional<glm::dvec3> inward = separating_direction(cast);
  if (!inward) return std::nullopt;
  const glm::dvec3 gradient = glm::cross(crop.triangle[1] - crop.triangle[0], crop.triangle[2] - crop.triangle[0]);
  const double size = largest(gradient);
  if (!(size > 0) || !std::isfinite(size)) return std::nullopt;
  const glm::dvec3 wanted = -crop.others / size * gradient, turn = *inward / largest(*inward);
  for (double share = 0x1p-50; share <= 0x1p-20; share *= 2) {
    const glm::dvec3 normal = wanted + share * turn;
    if (!holds_where_cropped(normal, 1 / size, crop, cast)) continue;
    const double low = std::min(glm::dot(normal, cast.a), glm::dot(normal, cast.b));
    const double reach = std::max({largest(cast.a), largest(cast.b), std::numeric_limits<double>::min()});
    Plane plane{normal.x, normal.y, normal.z, -low};
    for (double step = 0x1p-53; side_of(plane, cast.a) < 0 || side_of(plane, cast.b) < 0; step *= 2) {
      plane.d = -low + step * reach;
    }
    return plane;
  }
  return std::nullopt;
}

CastingEdges casting_edges(const Casters& casters, const LightHull& light, SilhouettesFrom from, bool crop) {
  PENUMBRA_ASSERT(!crop || from == SilhouettesFrom::anywhere, "silhouettes from the centre are never cropped");
  CastingEdges casting;
  if (from == SilhouettesFrom::anywhere) {
    casting.edges = mesh::possible_silhouette_edges(casters.view(), casters.graph, light.corners);
  } else {
    for (const auto& silhouette : mesh::silhouette_edges(casters.view(), casters.graph, light.center)) {
      casting.edges.push_back(silhouette.edge);
    }
  }
  casting.wedges.resize(casting.edges.size());
  for_each_index(casting.edges.size(), [&](std::size_t i) {
    const mesh::Edge& edge = casters.graph.edges[casting.edges[i]];
    WedgeEdge& wedge = casting.wedges[i];
    wedge.a = casters.positions[edge.a];
    wedge.b = casters.positions[edge.b];
    if (!crop) return;
    const std::optional<Crop> found = crop_of(casters, casting.edges[i], light);
    const auto plane = found ? crop_plane(*found, {wedge.a, wedge.b, light.corners}) : std::nullopt;
    if (plane) wedge.crop.push_back(*plane);
  });
  return casting;
}

}  // namespace penumbra::volumes
