// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/gltf/emissive_picture.hpp"
#include "import/gltf/emitters/emitter.hpp"
#include "import/gltf/gltf_triangles.hpp"
#include "scenes/scene.hpp"

#include <glm/vec3.hpp>

#include <span>
#include <string>
#include <variant>

namespace penumbra::import {

/// Returns the uniform radiance that a primitive emits: its material's radiance times the mean of its emissive picture
/// over the texels under its triangles (emissive_picture.hpp). `triangles` are those of the file, indices into its
/// vertices.
glm::dvec3 radiance_of(const PrimitiveVertices& vertices, std::span<const mesh::Triangle> triangles,
                       PictureMeans& means);

/// Returns the light whose body is the scene's triangles since `before`, placed by `placed`; or the reason why there is
/// none.
std::variant<Emitter, std::string> emitter_since(const scenes::Scene& scene, const SoupEnd& before,
                                                 const PlacedNode& placed, bool two_sided);

}  // namespace penumbra::import
