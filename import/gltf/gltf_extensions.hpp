// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/losses.hpp"

#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

namespace penumbra::import {

/// Reports the extensions that a file uses. Supported extensions, and those that change no diffuse surface, no light
/// and no shadow, are not mentioned. Unsupported extensions that light the scene, and others that the file requires,
/// are refused; the rest gives one warning. `as_mesh`: lights are ignored.
void judge_extensions(const tinygltf::Model& model, bool as_mesh, scenes::Losses& losses,
                      std::vector<std::string>& warnings);

}  // namespace penumbra::import
