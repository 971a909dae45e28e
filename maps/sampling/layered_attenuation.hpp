#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace penumbra::maps {

/// Agrawala et al. 2000: how many light samples see each surface of a layered depth image. docs/layered-attenuation.md.
std::unique_ptr<visibility::Method> make_layered_attenuation(const render::Device& device,
                                                             const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription layered_attenuation_description();

/// What who looks at its picture must know, from a run's counters: nothing, or that surfaces which cast no shadow are
/// dark.
std::optional<std::string> layered_attenuation_warning(const std::map<std::string, std::uint64_t>& counters);

}  // namespace penumbra::maps
