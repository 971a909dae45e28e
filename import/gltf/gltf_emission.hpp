#pragma once

#include "import/gltf/emissive_picture.hpp"
#include "import/gltf/emitters/emitter.hpp"
#include "import/gltf/gltf_triangles.hpp"
#include "scenes/scene.hpp"

#include <glm/vec3.hpp>

#include <span>
#include <string>
#include <variant>

namespace penumbra::scenes {

/// What a primitive emits, evenly: its material's radiance times the mean of its emissive picture over the texels that
/// its triangles cover (emissive_picture.hpp). `triangles` are the file's, indices into its vertices.
glm::dvec3 radiance_of(const PrimitiveVertices& vertices, std::span<const mesh::Triangle> triangles,
                       PictureMeans& means);

/// The light whose body the scene's triangles since `before` are, which `placed` put there; or why there is none.
std::variant<Emitter, std::string> emitter_since(const Scene& scene, const SoupEnd& before, const PlacedNode& placed,
                                                 bool two_sided);

}  // namespace penumbra::scenes
