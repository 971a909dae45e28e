#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>

namespace penumbra::visibility {

/// UnshadowedLight::whole() of many surface elements, on the processor's vector units: the same bits, whatever their
/// width.
struct SurfaceElements {
  std::span<const glm::vec3> p, n;
  std::span<const std::uint32_t> which;  ///< of these
};
/// `whole`: one for each of `which`, in order. One thread.
void whole_form_factors(const Light& light, const SurfaceElements& elements, std::span<double> whole);

}  // namespace penumbra::visibility
