// SPDX-License-Identifier: Apache-2.0
#pragma once

// Small soups for tests of diagnoses.

#include "mesh/diagnosis/diagnosis.hpp"
#include "mesh/shapes/shapes.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace penumbra::mesh {

inline Diagnosis diagnosis_of(const TriangleSoup& soup, const DiagnosisOptions& options = {}) {
  return diagnose({soup.positions, soup.triangles}, options);
}

inline TriangleSoup soup(std::vector<glm::dvec3> positions, std::vector<Triangle> triangles) {
  return {std::move(positions), std::move(triangles), {}, {}};
}

inline TriangleSoup unit_box() {
  return make_box({0.5, 0.5, 0.5}, {0.5, 0.5, 0.5});
}

inline void append(TriangleSoup& soup, TriangleSoup other) {
  const auto offset = static_cast<std::uint32_t>(soup.positions.size());
  soup.positions.insert(soup.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& t : other.triangles) soup.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
}

inline TriangleSoup moved(TriangleSoup soup, const glm::dvec3& by) {
  for (glm::dvec3& p : soup.positions) p += by;
  return soup;
}

inline std::uint64_t all_defects(const Diagnosis& d) {
  return d.boundary_edges.count + d.boundary_loops + d.non_manifold_edges.count + d.non_manifold_vertices.count +
         d.inconsistent_windings.count + d.duplicate_faces.count + d.opposite_faces.count +
         d.zero_area_triangles.count + d.needles.count + d.t_junctions.count + d.self_intersections.value().count;
}

}  // namespace penumbra::mesh
