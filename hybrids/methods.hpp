// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/method_row.hpp"

#include <memory>
#include <span>

namespace penumbra::hybrids {

/// Makes `hybrid-volume`: a shadow map, and shadow volumes where its texels disagree (Chan and Durand 2004), or shadow
/// volumes that are reconstructed from the map (McCool 2000). docs/hybrid-volume.md.
std::unique_ptr<visibility::Method> make_hybrid_volume(const render::Device& device,
                                                       const visibility::MethodOptions& options);
visibility::MethodDescription hybrid_volume_description();

/// Makes the variant `mccool` of `hybrid-volume`.
std::unique_ptr<visibility::Method> make_reconstructed_volume(const render::Device& device,
                                                              const visibility::MethodOptions& options);

/// Returns the family's table of methods.
std::span<const engines::MethodRow> methods();

}  // namespace penumbra::hybrids
