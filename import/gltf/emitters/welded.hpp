// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace penumbra::import {

/// A mesh whose vertices are distinct positions: exporters split vertices where normals or texture coordinates differ.
struct Welded {
  std::vector<glm::dvec3> points;         ///< the points that triangles use
  std::vector<mesh::Triangle> triangles;  ///< three different points each; no triangle occurs twice with the same
                                          ///< winding
};

Welded weld(std::span<const glm::dvec3> positions, std::span<const mesh::Triangle> triangles);

/// Returns some of the mesh's triangles, with only their points.
Welded part_of(const Welded& mesh, std::span<const std::size_t> triangles);

/// Returns the parts connected by common points, each as a mesh.
std::vector<Welded> components_of(const Welded& mesh);

}  // namespace penumbra::import
