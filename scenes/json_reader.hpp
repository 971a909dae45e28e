#pragma once

#include "scenes/reader.hpp"

/// Internal to scenes/.
namespace penumbra::scenes {

/// Reads penumbra-scene/1.
Scene read_json(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace penumbra::scenes
