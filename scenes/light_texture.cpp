// SPDX-License-Identifier: Apache-2.0
// Reads, checks and averages pictures on lights.

#include "scenes/light_texture.hpp"

#include "base/error.hpp"
#include "base/exr.hpp"
#include "mesh/import_helper.hpp"
#include "mesh/import_wire.hpp"
#include "scenes/scene_wire.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace penumbra::scenes {
namespace {

/// A picture of the largest size takes 200 MB to read; OpenEXR also keeps lines of all channels of a file in memory.
constexpr mesh::ImportLimits kTextureLimits{.memory_bytes = 1ull << 30, .output_bytes = 64ull << 20};
constexpr mesh::ImportLimits kSkyLimits{.memory_bytes = 4ull << 30, .output_bytes = 512ull << 20};

/// The import helper's name of a kind of picture, and its limits.
struct PictureKind {
  const char* name;
  const mesh::ImportLimits& limits;
  std::uint32_t largest_side;
};

/// Sets negative values to 0. Returns a warning with the number of texels that had any; nullopt if there were none.
std::optional<std::string> without_negative(Texture& texture, const std::string& shown) {
  std::size_t texels = 0;
  float least = 0;
  for (glm::vec3& texel : texture.texels) {
    bool any = false;
    for (int c = 0; c < 3; ++c) {
      if (!(texel[c] < 0) || !std::isfinite(texel[c])) continue;
      any = true;
      least = std::min(least, texel[c]);
      texel[c] = 0;
    }
    texels += any ? 1 : 0;
  }
  if (texels == 0) return std::nullopt;
  return fmt::format("\"{}\": negative values in {} of its texels (down to {}), taken as 0: light is never negative",
                     shown, texels, least);
}

Texture read_picture(const mesh::InputFile& input, const std::string& shown, const PictureKind& kind,
                     std::vector<std::string>& warnings) {
  try {
    const mesh::HelperAnswer answer = mesh::run_import_helper({kind.name, input, {}}, kind.limits);
    mesh::WireReader from(answer.payload());
    Texture texture = get_texture(from);
    from.expect_end();
    texture.file = shown;
    const std::optional<std::string> negative = without_negative(texture, shown);
    check_texture(texture, fmt::format("\"{}\"", shown), kind.largest_side);
    if (negative) warnings.push_back(*negative);
    return texture;
  } catch (const InputError& error) {
    const std::string name = fmt::format("\"{}\"", shown);
    if (std::string_view(error.what()).starts_with(name)) throw;
    throw InputError("{}: {}", name, error.what());
  } catch (const mesh::WireError& error) {
    throw InputError("\"{}\": the importer's answer is damaged ({}); the file is probably damaged", shown,
                     error.what());
  }
}

}  // namespace

Texture read_texture(const mesh::InputFile& input, const std::string& shown, std::vector<std::string>& warnings) {
  return read_picture(input, shown, {"texture", kTextureLimits, kLargestTextureSide}, warnings);
}

Texture read_sky_picture(const mesh::InputFile& input, const std::string& shown, std::vector<std::string>& warnings) {
  return read_picture(input, shown, {"sky", kSkyLimits, kLargestSkySide}, warnings);
}

void check_texture(const Texture& texture, const std::string& where, std::uint32_t largest_side) {
  if (std::max(texture.width, texture.height) > largest_side || texture.width == 0 || texture.height == 0) {
    throw InputError("{}: {}x{} texels; a texture has from 1 to {} a side", where, texture.width, texture.height,
                     largest_side);
  }
  bool black = true;
  for (std::size_t i = 0; i < texture.texels.size(); ++i) {
    const glm::vec3& texel = texture.texels[i];
    for (int c = 0; c < 3; ++c) {
      if (std::isfinite(texel[c]) && texel[c] >= 0) continue;
      throw InputError("{}: texel ({}, {}) from the top left is ({}, {}, {}); expected finite numbers from 0 up", where,
                       i % texture.width, i / texture.width, texel.r, texel.g, texel.b);
    }
    black = black && texel == glm::vec3(0);
  }
  if (black) throw InputError("{}: every texel is black; a light needs one at least that emits", where);
}

void write_texture(const Texture& texture, const std::filesystem::path& file) {
  ExrImage image;
  image.width = texture.width;
  image.height = texture.height;
  const float* first = &texture.texels.front().x;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::span<const float> values(first + c, 3 * texture.texels.size() - c);
    image.channels.push_back({std::string(1, "RGB"[c]), values, 3});
  }
  write_exr(file, image);
}

glm::dvec3 mean_color(const Texture& texture) {
  glm::dvec3 sum(0);
  for (const glm::vec3& texel : texture.texels) sum += glm::dvec3(texel);
  return sum / static_cast<double>(texture.texels.size());
}

}  // namespace penumbra::scenes
