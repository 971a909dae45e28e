// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/gltf/gltf_deform.hpp"
#include "import/gltf/gltf_nodes.hpp"
#include "import/gltf/gltf_surface.hpp"
#include "mesh/triangle_soup.hpp"
#include "scenes/instances.hpp"
#include "scenes/scene.hpp"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::import {

/// A primitive's vertices as modelled, and their transforms into the world. All members must outlive this object.
struct PrimitiveVertices {
  std::span<const glm::dvec3> local;
  const std::optional<Skinned>& skinned;  ///< nullopt: the node's transform applies to all vertices
  const Look& look;
  const PlacedNode& placed;
  const std::string& place;                     ///< place in the file, for messages
  std::vector<glm::dvec2>* lightmap = nullptr;  ///< receives Look::lightmap of each position of the soup; may be null

  [[nodiscard]] const glm::dmat4& to_world(std::uint32_t vertex) const {
    return skinned ? skinned->vertices[vertex] : placed.to_world;
  }
};

/// Lengths of a scene's lists.
struct SoupEnd {
  std::size_t position, triangle;
};

/// Adds the triangles in world space, with only the vertices that they use (exporters share one long list of vertices
/// among many primitives) and the appearance of these, under the number that the scene's next object will have. Returns
/// the lists' lengths before. Throws InputError for a vertex that is not finite in the world, and for too many
/// vertices.
SoupEnd append_triangles(scenes::Scene& scene, const PrimitiveVertices& vertices,
                         std::vector<mesh::Triangle> triangles);

/// Returns the triangles in the mesh's own space, for nodes that share them; apart from the space they are as
/// append_triangles adds them, so that a node's instance equals the triangles that the node would add.
scenes::SharedMesh shared_mesh(const PrimitiveVertices& vertices, std::vector<mesh::Triangle> triangles);

/// Removes everything added since `end`.
void shorten(scenes::Scene& scene, const SoupEnd& end);

/// Gives a default appearance to all vertices after the last one that has an appearance.
void complete_looks(scenes::Scene& scene);

}  // namespace penumbra::import
