#include "maps/options.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace penumbra::maps {
namespace {

constexpr std::uint32_t kSmallestSize = 8, kLargestSize = 16384;
constexpr double kLargestBias = 1024;

/// The whole text as a number, or nothing.
template <typename Number>
bool parse(const std::string& text, Number& number) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end;
}

}  // namespace

std::vector<visibility::OptionDescription> map_option_descriptions() {
  const MapOptions defaults;
  return {
      {"size", fmt::format("{} … {}", kSmallestSize, kLargestSize), fmt::format("{}", defaults.size),
       "texels on a side of a map"},
      {"bias", fmt::format("0.0 … {:.1f}", kLargestBias), fmt::format("{}", defaults.bias),
       "how far, in texels, a surface may rise above the receiver's plane without shading it; grows with the slope"}};
}

std::uint32_t whole_number_option(const visibility::MethodDescription& method, const visibility::MethodOptions& options,
                                  const std::string& key, std::uint32_t lower, std::uint32_t upper,
                                  std::uint32_t otherwise) {
  const auto found = options.find(key);
  if (found == options.end()) return otherwise;
  std::uint32_t value = 0;
  if (!parse(found->second, value) || value < lower || value > upper) {
    throw UsageError("method {}: {}={} is not a whole number from {} to {}", method.name, key, found->second, lower,
                     upper);
  }
  return value;
}

MapOptions parse_map_options(const render::Device& device, const visibility::MethodDescription& method,
                             const visibility::MethodOptions& options) {
  MapOptions out;
  out.size = whole_number_option(method, options, "size", kSmallestSize,
                                 std::min(kLargestSize, device.limits().max_image_size), out.size);
  if (const auto found = options.find("bias"); found != options.end()) {
    if (!parse(found->second, out.bias) || !(out.bias >= 0 && out.bias <= kLargestBias)) {
      throw UsageError("method {}: bias={} is not a number from 0 to {}", method.name, found->second, kLargestBias);
    }
  }
  return out;
}

}  // namespace penumbra::maps
