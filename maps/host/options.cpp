// SPDX-License-Identifier: Apache-2.0
// Options common to methods of maps, and their parsing.

#include "maps/host/options.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <string_view>

namespace penumbra::maps {

std::vector<visibility::OptionDescription> map_option_descriptions(const visibility::IntegerOption& size,
                                                                   const visibility::RealOption& bias) {
  return {size.description(), bias.description(), kRasteriser.description()};
}

std::vector<visibility::OptionDescription> single_map_option_descriptions(DepthUse otherwise) {
  return {kMapSize.description(), kBias.description(), depth_option(otherwise).description(),
          kRasteriser.description()};
}

std::vector<visibility::OptionDescription> compared_map_option_descriptions(DepthUse otherwise) {
  std::vector<visibility::OptionDescription> options = single_map_option_descriptions(otherwise);
  options.push_back(kReceiverPlane.description());
  return options;
}

MapOptions map_options(const render::Device& device, const visibility::MethodDescription& method,
                       const visibility::ParsedOptions& options) {
  MapOptions chosen{.size = options[kMapSize], .bias = options[kBias], .rasteriser = options[kRasteriser]};
  const auto has = [&](std::string_view name) {
    return std::ranges::find(method.options, name, &visibility::OptionDescription::name) != method.options.end();
  };
  if (has(kDepth.name())) chosen.depth = options[kDepth];
  if (has(kReceiverPlane.name())) chosen.receiver_plane = options[kReceiverPlane];
  if (has(kOffsetFactor.name())) {
    chosen.offset_factor = static_cast<float>(options[kOffsetFactor]);
    chosen.offset_units = static_cast<float>(options[kOffsetUnits]) * 0x1p-24F;
    if ((chosen.offset_factor != 0 || chosen.offset_units != 0) && chosen.depth != DepthUse::first) {
      throw UsageError("method {}: a polygon offset moves only the first surface; take {}=first", method.name,
                       kDepth.name());
    }
  }
  chosen.fit = view_fit(method.options, options);
  const ViewFit& fit = chosen.fit;
  if (fit.fit != Fit::receivers && fit.projection != Projection::window) {
    throw UsageError("method {}: option projection={} applies to maps of all receivers; take fit=receivers, not fit={}",
                     method.name, kProjection.name_of(fit.projection), kFit.name_of(fit.fit));
  }
  if (fit.has_faces() && chosen.rasteriser == Rasteriser::opengl) {
    throw UsageError(
        "method {}: option {} needs rasteriser=vulkan; OpenGL draws windows and cubes of fit=receivers and view",
        method.name, words_of(fit));
  }
  if (fit.asks_triangles() && (chosen.offset_factor != 0 || chosen.offset_units != 0)) {
    throw UsageError(
        "method {}: {} intersects rays with triangles in place of drawing polygons, so it has no polygon offset",
        method.name, words_of(fit));
  }
  if (chosen.size > device.limits().max_image_size) {
    throw UsageError("method {}: option {} is {}; this device draws images of up to {} texels a side", method.name,
                     kMapSize.name(), chosen.size, device.limits().max_image_size);
  }
  return chosen;
}

}  // namespace penumbra::maps
