#include "maps/host/options.hpp"

#include "base/error.hpp"

#include <algorithm>

namespace penumbra::maps {

std::vector<visibility::OptionDescription> map_option_descriptions(const visibility::IntegerOption& size,
                                                                   const visibility::RealOption& bias) {
  return {size.description(), bias.description(), kRasteriser.description()};
}

std::vector<visibility::OptionDescription> single_map_option_descriptions(DepthUse otherwise) {
  return {kMapSize.description(), kBias.description(), depth_option(otherwise).description(),
          kRasteriser.description()};
}

MapOptions map_options(const render::Device& device, const visibility::MethodDescription& method,
                       const visibility::ParsedOptions& options) {
  MapOptions chosen{.size = options[kMapSize], .bias = options[kBias], .rasteriser = options[kRasteriser]};
  if (std::ranges::any_of(method.options, [](const auto& option) { return option.name == kDepth.name(); })) {
    chosen.depth = options[kDepth];
  }
  if (chosen.size > device.limits().max_image_size) {
    throw UsageError("method {}: option {} is {}; this device draws images of up to {} texels a side", method.name,
                     kMapSize.name(), chosen.size, device.limits().max_image_size);
  }
  return chosen;
}

}  // namespace penumbra::maps
