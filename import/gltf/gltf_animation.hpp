#pragma once

#include "scenes/scene.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace tinygltf {
class Model;
}

namespace penumbra::scenes {

/// When the animations of these numbers begin and end; nothing if nothing in them moves. InputError for key times that
/// glTF does not allow.
std::optional<Motion> motion_of(const tinygltf::Model& model, const std::vector<std::size_t>& played);

/// Puts the model's nodes where these animations (ascending numbers, ClipChoice::played) have them at `seconds`: all of
/// them together, as they were in the program that wrote them. Before its first key and after its last one a channel
/// holds still; where two keys are at one time the later one counts from then on. LINEAR (rotations along the shorter
/// arc), STEP and CUBICSPLINE as glTF 2.0, appendix C, defines them. Where two channels move the same, the later in the
/// file wins. InputError for what glTF does not allow.
void pose_model(tinygltf::Model& model, double seconds, const std::vector<std::size_t>& played);

}  // namespace penumbra::scenes
