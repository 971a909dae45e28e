#pragma once

#include "mesh/input_file.hpp"
#include "scenes/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

/// Pictures on lights. Internal to scenes/.
namespace penumbra::scenes {

/// More texels a side than the densest light samples (64 x 64) can tell apart, and few enough for every copy of a light
/// to carry its own: 84 MB at most.
inline constexpr std::uint32_t kLargestTextureSide = 2048;

/// Likewise of pictures of the sky, with the directions of a sphere: 403 MB at most.
inline constexpr std::uint32_t kLargestSkySide = 8192;

/// Reads a PNG (values are sRGB, made linear; transparent texels are put on black) or an OpenEXR picture (channels R, G
/// and B, or Y alone, linear with the primaries of Rec. 709; a premultiplied alpha is left out); the file's first bytes
/// say which. It is read in a child process under limits. `shown` is its name in messages. InputError for anything
/// else, and for texels as check_texture says.
Texture read_texture(const mesh::InputFile& input, const std::string& shown);

/// The same for a picture of the sky, which may be larger, and a Radiance picture (RGBE) too.
Texture read_sky_picture(const mesh::InputFile& input, const std::string& shown);

/// Sizes that fit, finite texels from 0 up, and one at least above 0: InputError otherwise, with the texel. `where`
/// begins the message.
void check_texture(const Texture& texture, const std::string& where, std::uint32_t largest_side = kLargestTextureSide);

/// The picture as 32-bit OpenEXR, which read_texture reads back to the last bit.
void write_texture(const Texture& texture, const std::filesystem::path& file);

/// The mean colour: what a constant light of the same power has in its place.
glm::dvec3 mean_color(const Texture& texture);

}  // namespace penumbra::scenes
