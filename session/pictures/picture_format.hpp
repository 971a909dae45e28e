// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/exr.hpp"
#include "session/options.hpp"
#include "visibility/light_samples.hpp"

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Returns the names of whole lights' layers. A light keeps its own name if that can be a layer. Of two names that
/// differ only by "_V" or "_light", the endings of a light's further layers, only the first is kept. Then the other
/// lights get changed names: dots and slashes, which create nested layers, and control characters become "_"; names
/// longer than hosts support (kLongestLayer) are cut; and "_2", "_3" and so on is added if the name is reserved or
/// taken.
std::vector<std::string> layer_names(std::span<const visibility::Light> lights);

/// Blender keeps 50 bytes of a pass' name, including "_light".
inline constexpr std::size_t kLongestLayer = 44;

/// Format of OUT.exr.
struct PictureFormat {
  std::vector<std::string>
      layers;         ///< as given by the user: names, patterns, "beauty"; empty: all except those on request
  bool half = false;  ///< 16 bits for colours, V and N
  ExrCompression compression = ExrCompression::zip;
};

/// Parses the options. Throws UsageError if they are invalid.
PictureFormat parse_format(const FormatOptions& options);

/// Channel of a picture.
struct PictureChannel {
  std::string name;
  bool on_request = false;  ///< duplicate of other channels, for one host
};

/// Returns all channels of a picture: for lights with these layers, and this number of triangles. `several`: several
/// view samples a pixel.
std::vector<PictureChannel> picture_channels(std::span<const std::string> lights, bool several,
                                             std::uint64_t triangles);

/// Returns the names of the channels to be written. Throws UsageError for a requested layer that the picture does not
/// have.
std::set<std::string> wanted_channels(const PictureFormat& format, std::span<const PictureChannel> channels);

/// Returns whether 16 bits are sufficient for the channel's values.
bool stands_half(const std::string& channel);
/// Returns whether a small error makes the channel's values wrong.
bool must_be_exact(const std::string& channel);

/// Triangle numbers as floats, for programs that drop integer channels: `id` + 1, and 0 where there is no triangle.
/// Floats represent each integer below kFloatNumbers exactly; larger numbers are split into low and high parts.
constexpr std::uint64_t kFloatNumbers = std::uint64_t{1} << 24;
constexpr float low_number(std::int64_t triangle) {
  return static_cast<float>(static_cast<std::uint64_t>(triangle + 1) % kFloatNumbers);
}
constexpr float high_number(std::int64_t triangle) {
  const std::uint64_t whole = static_cast<std::uint64_t>(triangle + 1) / kFloatNumbers;
  return static_cast<float>(whole);
}

}  // namespace penumbra::session
