// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/input_file.hpp"
#include "scenes/light_texture.hpp"

/// Runs inside the import helper only: pictures are foreign files, too.
namespace penumbra::import {

/// Reads a texture as described at read_texture (scenes/light_texture.hpp), without the file's name in messages and
/// without check_texture.
scenes::Texture read_texture_file(const mesh::InputFile& input);

/// Reads a sky as described at read_sky_picture, without the file's name in messages.
scenes::Texture read_sky_file(const mesh::InputFile& input);

}  // namespace penumbra::import
