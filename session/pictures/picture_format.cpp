// SPDX-License-Identifier: Apache-2.0
// Names and selects layers and channels of pictures.

#include "session/pictures/picture_format.hpp"

#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "session/pictures/cryptomatte.hpp"
#include "session/whole_lights.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace penumbra::session {
namespace {

/// Reserved layer names: the picture's own layers, and the names under which programs show channels without a layer
/// ("Combined" and "Depth" in Blender, the others in Nuke).
constexpr std::array kOwnLayers = {"",  // channels without a layer
                                   "P",
                                   "Prel",
                                   "N",
                                   "object",
                                   "material",
                                   "triangle",
                                   "triangle_high",
                                   "CryptoObject00",
                                   "CryptoObject01",
                                   "CryptoObject02",
                                   "CryptoMaterial00",
                                   "CryptoMaterial01",
                                   "CryptoMaterial02",
                                   "Combined",
                                   "Depth",
                                   "rgb",
                                   "rgba",
                                   "other"};

/// Endings of a light's layers: the layer with all channels, and on request one with V and one with R G B. These are
/// for Blender's compositor, which supports only one kind of channel in a layer: of R, G, B and V it would show V as R.
constexpr std::array kEndings = {"", "_V", "_light"};

/// Returns the first bytes of a UTF-8 text, at most `most`, in whole characters.
std::string cut(std::string text, std::size_t most) {
  if (text.size() <= most) return text;
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xc0U) == 0x80U) --most;
  text.resize(most);
  return text;
}

std::string without_dots(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return c == '.' || c == '/' || c < 0x20 || c == 0x7f; }, '_');
  return name;
}

/// Returns the part before the only dot; a channel without a dot is its own layer.
std::string_view layer_of(std::string_view channel) {
  return channel.substr(0, channel.find('.'));
}

/// Matches a pattern: `*` stands for any characters, `?` for one.
bool fits(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, star = std::string_view::npos, resume = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++resume;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

bool is_beauty(std::string_view channel) {
  return channel == "R" || channel == "G" || channel == "B" || channel == "A";
}

bool asks_for(const std::string& wish, const std::string& channel) {
  return (wish == "beauty" && is_beauty(channel)) || fits(wish, channel) || fits(wish, layer_of(channel)) ||
         without_dots(wish) == layer_of(channel);  // the light's own name
}

/// Lists the picture's layers, each once, for a message; long lists are cut.
std::string list_of(std::span<const PictureChannel> channels, bool on_request) {
  constexpr std::size_t kMost = 40;
  std::vector<std::string> names;
  for (const PictureChannel& channel : channels) {
    if (channel.on_request != on_request) continue;
    const std::string name(is_beauty(channel.name) ? "beauty" : layer_of(channel.name));
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    if (names.size() > kMost) return fmt::format("{} and others", fmt::join(names, ", "));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::vector<std::string> layer_names(std::span<const visibility::Light> lights) {
  std::set<std::string> taken(kOwnLayers.begin(), kOwnLayers.end());
  const std::vector<std::string> wholes = whole_names(lights);
  std::vector<std::string> names(wholes.size());
  const auto is_taken = [&](const std::string& name) {
    return std::ranges::any_of(kEndings, [&](const char* end) { return taken.contains(name + end); });
  };
  const auto take = [&](std::size_t light, std::string name) {
    for (const char* const end : kEndings) taken.insert(name + end);
    names[light] = std::move(name);
  };
  // Names that can stay come first, so that they do not depend on the names of other lights.
  for (std::size_t i = 0; i < wholes.size(); ++i) {
    const bool stays = wholes[i] == cut(without_dots(wholes[i]), kLongestLayer);
    if (stays && !is_taken(wholes[i])) take(i, wholes[i]);
  }
  for (std::size_t i = 0; i < wholes.size(); ++i) {
    if (!names[i].empty()) continue;
    const std::string plain = without_dots(wholes[i]);
    std::string name = cut(plain, kLongestLayer);
    for (int number = 2; is_taken(name); ++number) {
      const std::string end = fmt::format("_{}", number);
      name = cut(plain, kLongestLayer - end.size()) + end;
    }
    take(i, std::move(name));
  }
  return names;
}

PictureFormat parse_format(const FormatOptions& options) {
  PictureFormat format;
  format.half = options.half;
  if (options.layers) {
    std::string_view rest = *options.layers;
    while (true) {
      const std::size_t comma = std::min(rest.find(','), rest.size());
      std::string_view wish = rest.substr(0, comma);
      while (wish.starts_with(' ')) wish.remove_prefix(1);
      while (wish.ends_with(' ')) wish.remove_suffix(1);
      if (wish.empty())
        throw UsageError("--layers \"{}\": expected names with commas between, such as beauty,V,Z", *options.layers);
      format.layers.emplace_back(wish);
      if (comma == rest.size()) break;
      rest.remove_prefix(comma + 1);
    }
  }
  constexpr std::pair<std::string_view, ExrCompression> kCompressions[] = {{"zip", ExrCompression::zip},
                                                                           {"zips", ExrCompression::zips},
                                                                           {"dwaa", ExrCompression::dwaa},
                                                                           {"none", ExrCompression::none}};
  if (options.compression.empty()) return format;
  for (const auto& [name, compression] : kCompressions) {
    if (options.compression != name) continue;
    format.compression = compression;
    return format;
  }
  throw UsageError("--compression {}: expected zip, zips, dwaa or none", options.compression);
}

std::vector<PictureChannel> picture_channels(std::span<const std::string> lights, bool several,
                                             std::uint64_t triangles) {
  std::vector<PictureChannel> channels;
  const auto add = [&](const std::string& layer, std::string_view letters, bool on_request = false) {
    for (const char letter : letters)
      channels.push_back({layer.empty() ? std::string(1, letter) : fmt::format("{}.{}", layer, letter), on_request});
  };
  add("", "RGBAV");
  for (const std::string& light : lights) add(light, "RGBV");
  for (const std::string& light : lights) {
    add(light + "_light", "RGB", true);
    add(light + "_V", "V", true);
  }
  for (const char* const layer : {"P", "Prel", "N"}) add(layer, "XYZ");
  add("", "Z");
  channels.push_back({"id"});
  for (const char* const layer : {"triangle", "object", "material"}) add(layer, "X");
  if (triangles >= kFloatNumbers) add("triangle_high", "X");
  for (const char* const layer : {"CryptoObject", "CryptoMaterial"}) {
    const std::size_t groups = several ? Cryptomatte::kRanks / 2 : 1;
    for (std::size_t group = 0; group < groups; ++group) add(fmt::format("{}{:02}", layer, group), "RGBA");
  }
  return channels;
}

std::set<std::string> wanted_channels(const PictureFormat& format, std::span<const PictureChannel> channels) {
  std::set<std::string> wanted;
  for (const PictureChannel& channel : channels) {
    if (format.layers.empty() && !channel.on_request) wanted.insert(channel.name);
  }
  for (const std::string& wish : format.layers) {
    bool fits_any = false;
    // a pattern selects duplicate channels only if all channels that match are duplicates
    for (const bool on_request : {false, true}) {
      for (const PictureChannel& channel : channels) {
        if (channel.on_request != on_request || !asks_for(wish, channel.name)) continue;
        wanted.insert(channel.name);
        fits_any = true;
      }
      if (fits_any) break;
    }
    if (fits_any) continue;
    std::vector<std::string> names = {"beauty"};
    for (const PictureChannel& channel : channels) names.emplace_back(layer_of(channel.name));
    throw UsageError("--layers {}: the picture has no such layer{}; it has {}; on request: {}", wish,
                     did_you_mean(wish, names), list_of(channels, false), list_of(channels, true));
  }
  return wanted;
}

bool must_be_exact(const std::string& channel) {
  constexpr std::array kNumbers = {"P", "Prel", "N", "Z", "id", "triangle", "triangle_high", "object", "material"};
  return std::ranges::find(kNumbers, layer_of(channel)) != kNumbers.end() || channel.starts_with("CryptoObject0") ||
         channel.starts_with("CryptoMaterial0");
}

bool stands_half(const std::string& channel) {
  return layer_of(channel) == "N" || !must_be_exact(channel);
}

}  // namespace penumbra::session
