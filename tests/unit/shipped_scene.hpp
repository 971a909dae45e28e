// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/formats/reader.hpp"

#include <filesystem>
#include <string>

namespace penumbra::tests {

/// One of the scenes that ship, without its ending.
inline scenes::Scene shipped_scene(const std::string& name) {
  return scenes::read_scene(std::filesystem::path(PENUMBRA_SCENES) / (name + ".json"));
}

}  // namespace penumbra::tests
