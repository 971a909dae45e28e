// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_view.shared.h"
#include "maps/host/opengl_maps.hpp"
#include "maps/host/view_fit.hpp"
#include "render/device.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::maps {

/// Returns the option `size`, with `otherwise`, the value of a method's paper, as default.
constexpr visibility::IntegerOption map_size(std::uint32_t otherwise) {
  return {"size", 8, 16384, otherwise, "texels on a side of a map"};
}
inline constexpr visibility::IntegerOption kMapSize = map_size(1024);
inline constexpr visibility::RealOption kBias{"bias", 0, 1024, 0.5,
                                              "largest height, in texels, of a surface above the receiver's plane that "
                                              "does not shade the receiver; grows with the slope"};

inline constexpr visibility::ChoiceOption kRasteriser{
    "rasteriser",
    {{"vulkan", Rasteriser::vulkan}, {"opengl", Rasteriser::opengl}},
    Rasteriser::vulkan,
    "API that draws the maps: Vulkan on the device itself, or OpenGL"};

/// Surface of a texel behind which a receiver is in shadow: taps.glsl, begins_behind.
enum class DepthUse : std::uint8_t {
  first = gpu::kDepthFirst,
  second = gpu::kDepthSecond,
  midpoint = gpu::kDepthMidpoint,
  dual = gpu::kDepthDual,
};
/// Returns the option `depth` of a single-map method.
constexpr visibility::ChoiceOption<DepthUse, 4> depth_option(DepthUse otherwise) {
  return {"depth",
          {{"first", DepthUse::first},
           {"second", DepthUse::second},
           {"midpoint", DepthUse::midpoint},
           {"dual", DepthUse::dual}},
          otherwise,
          "depth behind which a receiver is in shadow: the nearest surface plus the bias, the second surface, the "
          "middle between the two, or the nearest surface plus the bias, limited to the middle"};
}
inline constexpr auto kDepth = depth_option(DepthUse::first);

/// Option of a single-map method that compares texels with a receiver one by one: taps.glsl.
inline constexpr auto kReceiverPlane = visibility::flag_option(
    "receiverPlane", true, "compare each texel with the receiver's plane; off: with the receiver's own depth");

/// Polygon offset: for methods that compare depths without projecting them.
inline constexpr visibility::RealOption kOffsetFactor{
    "offsetFactor", 0, 64, 0, "polygon offset: factor of the depths' change across a texel, added to stored depths"};
inline constexpr visibility::RealOption kOffsetUnits{
    "offsetUnits", 0, 1048576, 0, "polygon offset: number of steps of a 24-bit depth added to stored depths"};

/// Options of all methods in this family: texels on a side of a map, the bias in texels, and the rasteriser of the
/// maps; `depth` and `receiverPlane`, if the method has them.
struct MapOptions {
  std::uint32_t size = kMapSize.otherwise;
  double bias = kBias.otherwise;
  DepthUse depth = DepthUse::first;
  bool receiver_plane = true;
  Rasteriser rasteriser = Rasteriser::vulkan;
  ViewFit fit = {};
  float offset_factor = 0, offset_units = 0;  ///< as in CasterPush
};

/// Returns the descriptions of the common options, as listed by `methods`.
std::vector<visibility::OptionDescription> map_option_descriptions(const visibility::IntegerOption& size = kMapSize,
                                                                   const visibility::RealOption& bias = kBias);
/// Returns the common options and `depth`, for a method with one map from the light's centre.
std::vector<visibility::OptionDescription> single_map_option_descriptions(DepthUse otherwise = DepthUse::first);
/// Returns the options of single_map_option_descriptions() and `receiverPlane`, for a method that compares the map's
/// texels with a receiver one by one.
std::vector<visibility::OptionDescription> compared_map_option_descriptions(DepthUse otherwise = DepthUse::first);

/// Parses the options. Throws UsageError for a size that the device cannot draw.
MapOptions map_options(const render::Device& device, const visibility::MethodDescription& method,
                       const visibility::ParsedOptions& options);

}  // namespace penumbra::maps
