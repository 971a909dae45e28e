// SPDX-License-Identifier: Apache-2.0
// Measures the effect of storing a mesh's positions in float32: spacing of floats, lost vertices and triangles. Not
// from a paper.

#include "mesh/diagnosis/precision.hpp"

#include "base/parallel.hpp"
#include "mesh/predicates.hpp"

#include <glm/common.hpp>

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

namespace penumbra::mesh {
namespace {

using Floats = std::array<float, 3>;

/// Returns the distance from the largest float ≤ x to the next float, as if the exponent were unbounded.
double spacing_of_floats(double x) {
  constexpr int kLowest = std::numeric_limits<float>::min_exponent - 1, kBits = std::numeric_limits<float>::digits - 1;
  return std::ldexp(1.0, (x > 0 ? std::max(std::ilogb(x), kLowest) : kLowest) - kBits);
}

std::uint64_t count_lost_vertices(std::vector<Floats> vertices) {
  tbb::parallel_sort(vertices.begin(), vertices.end());
  const auto different = std::unique(vertices.begin(), vertices.end()) - vertices.begin();
  return vertices.size() - static_cast<std::size_t>(different);
}

bool finite(const glm::vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace

glm::dvec3 centre_of_bounds(const Diagnosis& diagnosis) {
  return 0.5 * diagnosis.lower + 0.5 * diagnosis.upper;
}

void diagnose_precision(const MeshView& mesh, const EdgeGraph& graph, Diagnosis& diagnosis) {
  if (mesh.triangles.empty()) return;
  std::vector<bool> used(mesh.positions.size());
  diagnosis.lower = diagnosis.upper = mesh.positions[graph.vertex[mesh.triangles[0][0]]];
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : graph.corners(triangle)) {
      used[v] = true;
      diagnosis.lower = glm::min(diagnosis.lower, mesh.positions[v]);
      diagnosis.upper = glm::max(diagnosis.upper, mesh.positions[v]);
    }
  }
  const glm::dvec3 centre = centre_of_bounds(diagnosis);
  const glm::dvec3 largest = glm::max(glm::abs(diagnosis.lower), glm::abs(diagnosis.upper));
  const glm::dvec3 farthest = glm::max(glm::abs(diagnosis.lower - centre), glm::abs(diagnosis.upper - centre));
  diagnosis.largest_coordinate = std::max({largest.x, largest.y, largest.z});
  diagnosis.float_spacing = spacing_of_floats(std::max({farthest.x, farthest.y, farthest.z}));

  for (const Edge& edge : graph.edges) {
    const glm::dvec3 d = mesh.positions[edge.b] - mesh.positions[edge.a];
    const double length = std::hypot(d.x, d.y, d.z);
    if (diagnosis.shortest_edge == 0 || length < diagnosis.shortest_edge) diagnosis.shortest_edge = length;
  }

  const auto in_float = [&](std::uint32_t v) { return glm::vec3(mesh.positions[v] - centre); };
  std::vector<Floats> vertices;
  for (std::uint32_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    const glm::vec3 p = in_float(v);
    vertices.push_back({p.x, p.y, p.z});
  }
  diagnosis.vertices_lost = count_lost_vertices(std::move(vertices));

  std::atomic<std::uint64_t> lost = 0;
  for_each_index(mesh.triangles.size(), [&](std::size_t t) {
    if (graph.kind[t] != TriangleKind::proper) return;
    const Triangle corners = graph.corners(mesh.triangles[t]);
    const glm::vec3 a = in_float(corners[0]), b = in_float(corners[1]), c = in_float(corners[2]);
    if (!finite(a) || !finite(b) || !finite(c) || collinear(a, b, c)) ++lost;
  });
  diagnosis.triangles_lost = lost;
}

}  // namespace penumbra::mesh
