#pragma once

#include "visibility/lights/kinds/light_builder.hpp"
#include "visibility/lights/unshadowed_light.hpp"

/// What each kind of light does, where its properties (scenes/light_kind.hpp) do not say enough. Inside visibility/
/// only.
namespace penumbra::visibility {

struct LightBehaviour {
  /// Stores frame, outline, area and samples of a shape of this kind; refuses one without an area.
  void (*make)(const scenes::LightShape& shape, const LightBuilder& to);
  /// Is all of the light that p sees above the element's plane? (UnshadowedLight::above_horizon)
  bool (*is_above_horizon)(const UnshadowedLight& seen);
  /// The form factor of the whole light, for a p that it shines on. (UnshadowedLight::whole)
  double (*form_factor)(const UnshadowedLight& seen);
};

const LightBehaviour& behaviour_of(LightKind kind);

// The rows, each in a file of its own.
extern const LightBehaviour kRectangleBehaviour, kDiskBehaviour, kEllipseBehaviour, kPolygonBehaviour, kSphereBehaviour,
    kSunBehaviour, kDomeBehaviour;

/// Of round lights: is the unit disk of the frame above the element's plane?
bool is_round_above_horizon(const UnshadowedLight& seen);
/// Of round lights: the form factor of a circle of UnshadowedLight::radius.
double circle_form_factor(const UnshadowedLight& seen);

}  // namespace penumbra::visibility
