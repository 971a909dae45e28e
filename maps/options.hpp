#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::maps {

/// What all methods here have: texels on a side of a map, and the bias in texels.
struct MapOptions {
  std::uint32_t size = 1024;
  double bias = 0.5;
};

/// How `methods` describes them.
std::vector<visibility::OptionDescription> map_option_descriptions();

/// Throws UsageError for values that cannot be meant, or a size that the device cannot draw.
MapOptions parse_map_options(const render::Device& device, const visibility::MethodDescription& method,
                             const visibility::MethodOptions& options);

/// The option `key` as a whole number in [lower, upper], or `otherwise` if it is not given. Throws UsageError.
std::uint32_t whole_number_option(const visibility::MethodDescription& method, const visibility::MethodOptions& options,
                                  const std::string& key, std::uint32_t lower, std::uint32_t upper,
                                  std::uint32_t otherwise);

}  // namespace penumbra::maps
