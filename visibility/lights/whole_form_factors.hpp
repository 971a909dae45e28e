// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>

namespace penumbra::visibility {

/// Surface elements of which some are chosen.
struct SurfaceElements {
  std::span<const glm::vec3> p, n;
  std::span<const std::uint32_t> which;  ///< indices of the elements to compute
};
/// Computes UnshadowedLight::whole() for many surface elements, on the processor's vector units: the same bits for
/// every vector width. `whole`: one for each of `which`, in order. Single-threaded.
void whole_form_factors(const Light& light, const SurfaceElements& elements, std::span<double> whole);

}  // namespace penumbra::visibility
