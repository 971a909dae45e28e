#pragma once

#include "mesh/input_file.hpp"
#include "scenes/scene.hpp"

#include <cstdint>

/// Runs inside the import helper only: pictures are foreign files, too.
namespace penumbra::scenes {

/// More texels a side than the densest light samples (64 x 64) can tell apart, and few enough for every copy of a light
/// to carry its own: 84 MB at most.
inline constexpr std::uint32_t kLargestTextureSide = 2048;

/// What read_texture says of it (scenes/light_texture.hpp), but the file's name in messages, and check_texture.
Texture read_texture_file(const mesh::InputFile& input);

}  // namespace penumbra::scenes
