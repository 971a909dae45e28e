// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace tinygltf {
class Model;
}

namespace penumbra::import {

/// Returns begin and end of the animations `played`; nullopt if nothing in them moves. Throws InputError for key times
/// that glTF does not allow.
std::optional<scenes::Motion> motion_of(const tinygltf::Model& model, const std::vector<std::size_t>& played);

/// Moves the model's nodes to their places at `seconds` in the animations `played` (ascending indices,
/// ClipChoice::played): all together, as in the program that wrote the file. A channel holds its value before its first
/// key and after its last one; of two keys at the same time the later one holds from then on. LINEAR (rotations along
/// the shorter arc), STEP and CUBICSPLINE are those of glTF 2.0, appendix C. If two channels move the same property,
/// the later in the file wins. Throws InputError for files that glTF does not allow.
void pose_model(tinygltf::Model& model, double seconds, const std::vector<std::size_t>& played);

}  // namespace penumbra::import
