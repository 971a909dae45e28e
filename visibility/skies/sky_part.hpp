// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/skies/sky.hpp"

#include <glm/vec2.hpp>

#include <array>
#include <vector>

namespace penumbra::visibility {

/// Adds up the flux from parts of one face of a dome with a picture. A sweep cuts the visible region at levels, into
/// trapezoids: where one ends and another begins their sides cancel, and are left out before they cost anything.
class SkyPart {
 public:
  /// `face` must outlive this object.
  explicit SkyPart(const Light& face);

  /// The coordinate that is equal along the two level sides of a trapezoid.
  enum class Level { s, t };
  /// Adds a trapezoid, counter-clockwise. Its first side is level for Level::t, its second side for Level::s.
  void add(const std::array<glm::dvec2, 4>& corners, Level level);
  /// Adds all of the face above the plane orthogonal to a unit vector.
  void add_above(const glm::dvec3& n);
  /// Returns the sum of the exposures of all sides (Sky::side); complete after take_form_factor.
  [[nodiscard]] double exposure() const { return exposure_; }
  /// Returns the form factor, for each colour, of everything that was added, at an element of unit normal n; then
  /// forgets the parts.
  glm::dvec3 take_form_factor(const glm::dvec3& n);

 private:
  /// End of a level side: from here on one more side, or one less, runs toward larger coordinates.
  struct End {
    double level = 0, at = 0;
    int change = 0;
  };
  void add_levels(std::vector<End>& ends, Level level);

  const Sky& sky_;
  std::size_t face_;
  SkyFlux flux_{0.0};
  double exposure_ = 0;
  std::vector<End> along_s_, along_t_;
};

}  // namespace penumbra::visibility
