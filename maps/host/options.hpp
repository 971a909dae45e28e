#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::maps {

/// `otherwise`: what a method's paper takes.
constexpr visibility::IntegerOption map_size(std::uint32_t otherwise) {
  return {"size", 8, 16384, otherwise, "texels on a side of a map"};
}
inline constexpr visibility::IntegerOption kMapSize = map_size(1024);
inline constexpr visibility::RealOption kBias{
    "bias", 0, 1024, 0.5,
    "how far, in texels, a surface may rise above the receiver's plane without shading it; grows with the slope"};

/// What all methods here have: texels on a side of a map, and the bias in texels.
struct MapOptions {
  std::uint32_t size = kMapSize.otherwise;
  double bias = kBias.otherwise;
};

/// How `methods` describes them.
std::vector<visibility::OptionDescription> map_option_descriptions(const visibility::IntegerOption& size = kMapSize,
                                                                   const visibility::RealOption& bias = kBias);

/// Throws UsageError for a size that the device cannot draw.
MapOptions map_options(const render::Device& device, const visibility::MethodDescription& method,
                       const visibility::ParsedOptions& options);

}  // namespace penumbra::maps
