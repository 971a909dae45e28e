// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/session.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::session {

/// View samples at which lights are left out because they are faint (--light-cutoff).
struct FaintLights {
  /// For each light, for each view sample, 1: left out (RunPlan::dark). Empty for a light that is left out nowhere; the
  /// outer list is empty if no light is left out.
  std::vector<std::vector<std::uint8_t>> dark;
  std::uint64_t pairs = 0;   ///< pairs of view sample and left-out light that would arrive if nothing hid it
  double largest_share = 0;  ///< largest left-out share of a view sample's unshadowed light, of R, G and B
};

/// Finds the lights that are faint at a view sample: in each of R, G and B, the light's unshadowed light is at most
/// `cutoff` times that of all of the session's lights together. Unshadowed light: radiance × the spot lamp's share ×
/// the form factor of all of the light above the horizon. The surface's colour is a common factor, so it does not
/// matter.
///
/// Pieces of a light are left out together. Textured lights and domes stay, and are not counted in the sum; so do
/// lights at view samples where V is set by a rule (PixelClass::unshadowed, emitter). `normals`: of the beauty.
/// `counted`: rows of view samples whose pairs are counted. Throws ResourceError without the memory for `dark`.
FaintLights find_faint_lights(const Session& session, std::span<const glm::vec3> normals, double cutoff,
                              const visibility::Tile& counted);

}  // namespace penumbra::session
