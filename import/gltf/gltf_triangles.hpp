#pragma once

#include "import/gltf/gltf_deform.hpp"
#include "import/gltf/gltf_nodes.hpp"
#include "import/gltf/gltf_surface.hpp"
#include "mesh/triangle_soup.hpp"
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

namespace penumbra::scenes {

/// A primitive's vertices as they were modelled, and what takes each into the world. All must outlive it.
struct PrimitiveVertices {
  std::span<const glm::dvec3> local;
  const std::optional<Skinned>& skinned;  ///< nothing: the node's transform is all
  const Look& look;
  const PlacedNode& placed;
  const std::string& place;                     ///< in the file, for messages
  std::vector<glm::dvec2>* lightmap = nullptr;  ///< gets Look::lightmap, of each position of the soup; may be null

  [[nodiscard]] const glm::dmat4& to_world(std::uint32_t vertex) const {
    return skinned ? skinned->vertices[vertex] : placed.to_world;
  }
};

/// How long a scene's lists were.
struct SoupEnd {
  std::size_t position, triangle;
};

/// Adds the triangles in world space, with only the vertices that they use (exporters share one long list of vertices
/// among many primitives) and what these look like, under the number that the scene's next object will have. Returns
/// where they begin. Throws InputError for a vertex that is not finite in the world, and for one too many.
SoupEnd append_triangles(Scene& scene, const PrimitiveVertices& vertices, std::vector<mesh::Triangle> triangles);

/// Removes what was added since.
void shorten(Scene& scene, const SoupEnd& end);

/// Gives the vertices after the last that has a look one that says nothing.
void complete_looks(Scene& scene);

}  // namespace penumbra::scenes
