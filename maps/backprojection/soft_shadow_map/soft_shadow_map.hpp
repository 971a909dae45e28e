#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace penumbra::maps {

/// Atty et al. 2006: a map of soft shadows from a map of occluders and one of receivers. docs/soft-shadow-map.md.
std::unique_ptr<visibility::Method> make_soft_shadow_map(const render::Device& device,
                                                         const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription soft_shadow_map_description();

/// What who looks at its picture must know, from a run's options and counters: nothing, or that pixels on occluders
/// have no shadows.
std::optional<std::string> soft_shadow_map_warning(const visibility::MethodOptions& options,
                                                   const std::map<std::string, std::uint64_t>& counters);

}  // namespace penumbra::maps
