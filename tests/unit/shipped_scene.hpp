// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/formats/reader.hpp"

#include <filesystem>
#include <string>

namespace penumbra::tests {

/// Returns a shipped scene. `name` is its file's name without .json.
inline scenes::Scene shipped_scene(const std::string& name) {
  return scenes::read_scene(std::filesystem::path(PENUMBRA_SCENES) / (name + ".json"));
}

}  // namespace penumbra::tests
