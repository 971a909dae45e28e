#pragma once

#include "scenes/losses.hpp"

#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

namespace penumbra::scenes {

/// Says what becomes of the extensions that a file uses. Those that are understood, and those that change no diffuse
/// surface, no light and no shadow, are not spoken of. Those that light the scene and are not done, and others that the
/// file requires, are refused; what is left is one warning. `as_mesh`: lights are not asked for.
void judge_extensions(const tinygltf::Model& model, bool as_mesh, Losses& losses, std::vector<std::string>& warnings);

}  // namespace penumbra::scenes
