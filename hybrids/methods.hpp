#pragma once

#include "engines/method_row.hpp"

#include <memory>
#include <span>

namespace penumbra::hybrids {

/// Makes `hybrid-volume` (Chan and Durand 2004): a shadow map, and shadow volumes where its texels disagree.
/// docs/hybrid-volume.md.
std::unique_ptr<visibility::Method> make_hybrid_volume(const render::Device& device,
                                                       const visibility::MethodOptions& options);
visibility::MethodDescription hybrid_volume_description();

/// Returns the family's table of methods.
std::span<const engines::MethodRow> methods();

}  // namespace penumbra::hybrids
