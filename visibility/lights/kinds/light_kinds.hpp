// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/lights/kinds/light_builder.hpp"
#include "visibility/lights/unshadowed_light.hpp"

/// Behaviour of each kind of light that its properties (scenes/light_kind.hpp) do not determine. Inside visibility/
/// only.
namespace penumbra::visibility {

struct LightBehaviour {
  /// Stores frame, outline, area and samples of a shape of this kind; refuses one without an area.
  void (*make)(const scenes::LightShape& shape, const LightBuilder& to);
  /// Returns whether the whole light that p sees is above the element's plane. (UnshadowedLight::above_horizon)
  bool (*is_above_horizon)(const UnshadowedLight& seen);
  /// Returns the form factor of the whole light, for a p on an emitting side. (UnshadowedLight::whole)
  double (*form_factor)(const UnshadowedLight& seen);
};

const LightBehaviour& behaviour_of(LightKind kind);

// The rows of the table, each defined in its kind's file.
extern const LightBehaviour kRectangleBehaviour, kDiskBehaviour, kEllipseBehaviour, kPolygonBehaviour, kSphereBehaviour,
    kSunBehaviour, kDomeBehaviour;

/// Returns, for round lights, whether the unit disk of the frame is above the element's plane.
bool is_round_above_horizon(const UnshadowedLight& seen);
/// Returns, for round lights, the form factor of a circle of UnshadowedLight::radius.
double circle_form_factor(const UnshadowedLight& seen);

}  // namespace penumbra::visibility
