#pragma once

#include "app/options.hpp"
#include "base/exr.hpp"
#include "visibility/light_samples.hpp"

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// The names of whole lights' layers: the light's own, with dots and slashes, which make layers in layers, and control
/// characters as "_", and cut where it is longer than hosts take (kLongestLayer). Where this makes two equal, or one
/// that the picture or a host has for something else, the later one gets "_2", "_3" and so on; each light has its
/// layer's name with "_V" and "_light", too.
std::vector<std::string> layer_names(std::span<const visibility::Light> lights);

/// Blender keeps 50 bytes of a pass' name, and "_light" comes behind.
inline constexpr std::size_t kLongestLayer = 44;

/// How OUT.exr is written.
struct PictureFormat {
  std::vector<std::string>
      layers;         ///< as the user gave them: names, patterns, "beauty"; none: all but those on request
  bool half = false;  ///< 16 bits of colours, V and N
  ExrCompression compression = ExrCompression::zip;
};

/// Throws UsageError.
PictureFormat parse_format(const FormatOptions& options);

/// A channel that a picture may have.
struct PictureChannel {
  std::string name;
  bool on_request = false;  ///< it repeats others, for one host's sake
};

/// All channels of a picture: of lights with these layers, and of as many triangles. `several`: view samples a pixel.
std::vector<PictureChannel> picture_channels(std::span<const std::string> lights, bool several,
                                             std::uint64_t triangles);

/// Names of the channels that are written. Throws UsageError for a requested layer that the picture does not have.
std::set<std::string> wanted_channels(const PictureFormat& format, std::span<const PictureChannel> channels);

/// Are 16 bits enough for what it shows?
bool stands_half(const std::string& channel);
/// Is it wrong if it is off by a little?
bool must_be_exact(const std::string& channel);

/// Triangle numbers as floats, for programs that drop integer channels: `id` + 1, and 0 where there is no triangle. A
/// float holds each whole number below this one exactly; larger numbers are split into low and high parts.
constexpr std::uint64_t kFloatNumbers = std::uint64_t{1} << 24;
constexpr float low_number(std::int64_t triangle) {
  return static_cast<float>(static_cast<std::uint64_t>(triangle + 1) % kFloatNumbers);
}
constexpr float high_number(std::int64_t triangle) {
  const std::uint64_t whole = static_cast<std::uint64_t>(triangle + 1) / kFloatNumbers;
  return static_cast<float>(whole);
}

}  // namespace penumbra::app
