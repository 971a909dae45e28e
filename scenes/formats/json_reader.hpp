// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/formats/reader.hpp"

#include <filesystem>
#include <string_view>

/// Internal to scenes/.
namespace penumbra::scenes {

/// Reads penumbra-scene/1.
Scene read_json(const std::filesystem::path& file, const ReadOptions& options);

/// Reads a scene from the text of `file`; meshes that the scene refers to are looked for in the file's folder.
Scene read_json_text(std::string_view text, const std::filesystem::path& file, const ReadOptions& options);

}  // namespace penumbra::scenes
