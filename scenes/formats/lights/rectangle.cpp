// SPDX-License-Identifier: Apache-2.0
// Rectangle lights in files: a centre and two half sides. Half sides that are not at right angles span a parallelogram;
// readers then give a warning.

#include "scenes/formats/lights/halves.hpp"

namespace penumbra::scenes {
namespace {

std::string rectangle_hint(const LightShape& shape) {
  return hint_of_halves<Rectangle>(shape, "the light is a parallelogram");
}

std::vector<glm::dvec3> rectangle_outline(const LightShape& shape) {
  const auto& [center, half_u, half_v] = std::get<Rectangle>(shape);
  return {center - half_u - half_v, center + half_u - half_v, center + half_u + half_v, center - half_u + half_v};
}

}  // namespace

const LightFormat kRectangleFormat{.read = read_halves<Rectangle>,
                                   .write = write_halves<Rectangle>,
                                   .check = check_halves<Rectangle>,
                                   .hint = rectangle_hint,
                                   .outline = rectangle_outline};

}  // namespace penumbra::scenes
