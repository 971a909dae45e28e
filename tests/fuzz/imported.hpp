// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/assert.hpp"
#include "mesh/import.hpp"

#include <cmath>

namespace penumbra::fuzz {

/// Checks the properties of every mesh that a reader accepts.
inline void check_imported(const mesh::ImportedMesh& mesh) {
  const mesh::TriangleSoup& soup = mesh.soup;
  PENUMBRA_ASSERT(!soup.triangles.empty(), "an empty mesh was let through");
  PENUMBRA_ASSERT(soup.object.size() == soup.triangles.size() && soup.source_face.size() == soup.triangles.size(),
                  "{} triangles, {} objects, {} faces", soup.triangles.size(), soup.object.size(),
                  soup.source_face.size());
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    PENUMBRA_ASSERT(soup.object[t] == 0, "triangle {} is of object {}", t, soup.object[t]);
    PENUMBRA_ASSERT(t == 0 || soup.source_face[t] >= soup.source_face[t - 1], "triangle {}: face {} after {}", t,
                    soup.source_face[t], soup.source_face[t - 1]);
    for (const std::uint32_t corner : soup.triangles[t]) {
      PENUMBRA_ASSERT(corner < soup.positions.size(), "triangle {} names vertex {}", t, corner);
    }
  }
  for (const glm::dvec3& p : soup.positions) {
    PENUMBRA_ASSERT(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "({}, {}, {})", p.x, p.y, p.z);
  }
}

}  // namespace penumbra::fuzz
