#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace tinygltf {
class Model;
}

namespace penumbra::scenes {

/// A POSITION accessor's vertices: three components of any type, normalized or not, strided, sparse, or all zero
/// (no buffer view). Throws InputError with the accessor's or the view's place if it does not fit its buffer, or if a
/// vertex is not finite.
std::vector<glm::dvec3> read_positions(const tinygltf::Model& model, int accessor);

/// An index accessor's numbers: unsigned integers of 1, 2 or 4 bytes.
std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor);

}  // namespace penumbra::scenes
