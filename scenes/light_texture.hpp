// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/input_file.hpp"
#include "scenes/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// Pictures on lights. Internal to scenes/.
namespace penumbra::scenes {

/// Largest side of a light's texture: more texels than the densest light samples (64 x 64) can resolve, and few enough
/// for every copy of a light to have its own: 84 MB at most.
inline constexpr std::uint32_t kLargestTextureSide = 2048;

/// Largest side of pictures of the sky, which cover the directions of a sphere: 403 MB at most.
inline constexpr std::uint32_t kLargestSkySide = 8192;

/// Reads a PNG (values are sRGB, made linear; transparent texels are composited on black) or an OpenEXR picture
/// (channels R, G and B, or Y alone, linear with the primaries of Rec. 709; a premultiplied alpha is ignored),
/// distinguished by the file's first bytes. Reads in a child process under limits. `shown` is the name in messages.
/// Negative values, which lossy compression and resampling leave, become 0, with one warning. Throws InputError for
/// anything else, and for texels as check_texture does.
Texture read_texture(const mesh::InputFile& input, const std::string& shown, std::vector<std::string>& warnings);

/// Reads a picture of the sky as read_texture does; the picture may be larger, and may also be a Radiance picture
/// (RGBE).
Texture read_sky_picture(const mesh::InputFile& input, const std::string& shown, std::vector<std::string>& warnings);

/// Throws InputError, with the texel, unless the size is within `largest_side`, the number of texels fits, and texels
/// are finite, not negative, and not all 0. `where` begins the message.
void check_texture(const Texture& texture, const std::string& where, std::uint32_t largest_side = kLargestTextureSide);

/// Writes the picture as 32-bit OpenEXR, which read_texture reads back to the last bit.
void write_texture(const Texture& texture, const std::filesystem::path& file);

/// Returns the mean colour, which a constant light of the same power has.
glm::dvec3 mean_color(const Texture& texture);

}  // namespace penumbra::scenes
