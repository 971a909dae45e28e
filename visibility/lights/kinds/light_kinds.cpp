// SPDX-License-Identifier: Apache-2.0
// The table of kinds of light, one row per kind, and the functions that round kinds share: the test of the horizon and
// the form factor of a circle. Each kind's formulas, with their sources, are in its own file of this folder.

#include "visibility/lights/kinds/light_kinds.hpp"

#include "visibility/lights/form_factor.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace penumbra::visibility {
namespace {

/// Behaviours in the order of scenes::kLightTraits.
constexpr std::array kBehaviours{&kRectangleBehaviour, &kDiskBehaviour, &kEllipseBehaviour, &kPolygonBehaviour,
                                 &kSphereBehaviour,    &kSunBehaviour,  &kDomeBehaviour};
static_assert(kBehaviours.size() == scenes::kLightTraits.size());

}  // namespace

const LightBehaviour& behaviour_of(LightKind kind) {
  return *kBehaviours[static_cast<std::size_t>(kind)];
}

bool is_round_above_horizon(const UnshadowedLight& seen) {
  const UnshadowedLight::Frame frame = seen.frame();
  return frame.height > std::hypot(frame.height_u, frame.height_v);
}

double circle_form_factor(const UnshadowedLight& seen) {
  return form_factor(FormFactorDisk{seen.frame().center, seen.along(), seen.radius()}, seen.normal());
}

}  // namespace penumbra::visibility
