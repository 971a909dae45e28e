// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

/// Directions of the texels of a dome's picture, and light samples in proportion to their light.
namespace penumbra::visibility {

/// Returns Rec. 709's luminance.
double luminance_of(const glm::dvec3& color);

/// A direction, given by its height (the cosine of the angle to `up`) and its azimuth (in turns from the picture's left
/// border: 1/2 is the middle).
struct SkyPlace {
  double height = 0, turn = 0;
};

/// A dome's axes in world space, orthonormal: `right` × `ahead` = `up`. The picture's middle column shows the direction
/// `ahead`.
struct DomeFrame {
  glm::dvec3 right{1, 0, 0}, ahead{0, 0, -1}, up{0, 1, 0};

  [[nodiscard]] glm::dvec3 direction(const SkyPlace& place) const;
  [[nodiscard]] SkyPlace place(const glm::dvec3& direction) const;
  /// Returns the axes rotated by `degrees`, right-handed, about `up`.
  [[nodiscard]] DomeFrame turned(double degrees) const;
};
/// Returns a dome's axes. The smallest rotation takes +Y to `up`, and −Z and +X to `ahead` and `right`; then these are
/// rotated by `degrees`, right-handed, about `up`. For −Y the rotation is about X.
DomeFrame dome_frame(const glm::dvec3& up, double degrees);

/// Returns the texel at a place; on a border, the right one and the lower one.
std::size_t sky_texel(const scenes::Texture& picture, const SkyPlace& place);

struct DomeSamples {
  std::vector<SkyPlace> places;
  std::vector<glm::vec3> colors;  ///< for a picture: colour of the texel, over its luminance
  double power = 0;               ///< ∫ luminance dω
};
/// Returns a light sample for each point of the unit square, each for the same fraction of ∫ luminance dω. `picture`:
/// null for constant radiance. `half`: the part above the horizon. Empty if that part of the picture is black.
DomeSamples dome_samples(const scenes::Texture* picture, bool half, const std::vector<glm::dvec2>& unit);

}  // namespace penumbra::visibility
