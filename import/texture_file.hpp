#pragma once

#include "mesh/input_file.hpp"
#include "scenes/light_texture.hpp"

/// Runs inside the import helper only: pictures are foreign files, too.
namespace penumbra::scenes {

/// What read_texture says of it (scenes/light_texture.hpp), but the file's name in messages, and check_texture.
Texture read_texture_file(const mesh::InputFile& input);

/// Likewise of read_sky_picture.
Texture read_sky_file(const mesh::InputFile& input);

}  // namespace penumbra::scenes
