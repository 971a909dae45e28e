#pragma once

#include "mesh/triangle_soup.hpp"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace penumbra::scenes {

/// A mesh whose vertices are the distinct positions: exporters split vertices where normals or texture coordinates
/// differ.
struct Welded {
  std::vector<glm::dvec3> points;         ///< those that triangles use
  std::vector<mesh::Triangle> triangles;  ///< of three different points each; none is there twice, wound alike
};

Welded weld(std::span<const glm::dvec3> positions, std::span<const mesh::Triangle> triangles);

/// Some of its triangles, with only their points.
Welded part_of(const Welded& mesh, std::span<const std::size_t> triangles);

/// What hangs together by common points, each as a mesh.
std::vector<Welded> components_of(const Welded& mesh);

}  // namespace penumbra::scenes
