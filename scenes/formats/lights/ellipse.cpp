// SPDX-License-Identifier: Apache-2.0
// Ellipse lights in files: two half diameters, as a parallelogram has half sides, and the rim as a polygon of
// kRimSides corners for glTF, which has no ellipses.

#include "scenes/formats/lights/halves.hpp"

namespace penumbra::scenes {
namespace {

std::string ellipse_hint(const LightShape& shape) {
  return hint_of_halves<Ellipse>(shape, "they are conjugate half diameters of the ellipse, not its axes");
}

std::vector<glm::dvec3> ellipse_outline(const LightShape& shape) {
  const auto& [center, half_u, half_v] = std::get<Ellipse>(shape);
  return rim_points(center, half_u, half_v);
}

}  // namespace

const LightFormat kEllipseFormat{.read = read_halves<Ellipse>,
                                 .write = write_halves<Ellipse>,
                                 .check = check_halves<Ellipse>,
                                 .hint = ellipse_hint,
                                 .outline = ellipse_outline};

}  // namespace penumbra::scenes
