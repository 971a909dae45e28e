// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
struct Primitive;
}  // namespace tinygltf

namespace penumbra::import {

/// Parts of a file's primitives that form no triangles.
struct SkippedPrimitives {
  std::uint64_t points_and_lines = 0, without_positions = 0, without_triangles = 0;
  std::uint64_t leftover_indices = 0;  ///< indices at the ends of primitives
};

/// A primitive as modelled.
struct PrimitiveMesh {
  std::vector<glm::dvec3> positions;
  std::vector<mesh::Triangle> triangles;  ///< not empty; indices into positions
};

/// Reads a primitive. Returns nullopt for a primitive without triangles, which is counted in `skipped`. Throws
/// InputError, with places that begin with `place`.
std::optional<PrimitiveMesh> read_primitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                            const std::string& place, SkippedPrimitives& skipped);

}  // namespace penumbra::import
