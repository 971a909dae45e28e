#pragma once

#include "scenes/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

namespace penumbra::scenes {

/// When the file's animations begin and end; nothing if nothing in it moves.
std::optional<Motion> motion_of(const tinygltf::Model& model);

/// Puts the model's nodes where its animations have them at `seconds`: all of them together, as they were in the
/// program that wrote them. Before its first key and after its last one a channel holds still. LINEAR (rotations along
/// the shorter arc), STEP and CUBICSPLINE as glTF 2.0, appendix C, defines them. Where two channels move the same, the
/// later in the file wins, and `warnings` says so. InputError for what glTF does not allow.
void pose_model(tinygltf::Model& model, double seconds, std::vector<std::string>& warnings);

}  // namespace penumbra::scenes
