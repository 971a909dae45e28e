// SPDX-License-Identifier: Apache-2.0
// A planar light or a sun in orthonormal axes, with bounds of its light samples and of their rounding.

#include "engines/pairs/light_box.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::pairs {

glm::dvec2 LightBox::sample(const glm::vec3& l) const {
  const glm::dvec3 at = place(glm::dvec3(l));
  return sun ? glm::dvec2(at) / -at.z : glm::dvec2(at);
}

LightBox make_light_box(const visibility::Light& light) {
  PENUMBRA_ASSERT(!is_body(light.kind), "light \"{}\": a body has no plane", light.name);
  LightBox box;
  box.sun = light.sun.has_value();
  if (box.sun) {
    box.axis = -glm::normalize(glm::dvec3(light.center));
    box.across = glm::normalize(glm::cross(box.axis, glm::dvec3(light.sun->axis_v)));
  } else {
    const visibility::LightFrame frame = visibility::light_frame(light);
    box.origin = frame.center;
    box.across = glm::normalize(frame.u);
    box.axis = glm::normalize(glm::cross(frame.u, frame.v));
  }
  box.along = glm::cross(box.axis, box.across);
  constexpr double kFlattest = 0x1p-8;  // least component of a direction along the axis, relative to its length; double
                                        // keeps 44 digits of the remainder
  double reach = 0;
  for (const glm::vec3& l : light.points) {
    if (box.sun && !(-box.place(glm::dvec3(l)).z >= kFlattest * glm::length(glm::dvec3(l)))) {
      throw InputError(
          "light \"{}\": a sun of more than 179.5 degrees is too wide for this method; edge-scatter, view-sample, "
          "depth-complexity and raytrace support it",
          light.name);
    }
    const glm::dvec2 at = box.sample(l);
    box.lower = glm::min(box.lower, at);
    box.upper = glm::max(box.upper, at);
    const glm::dvec3 x(l);
    reach =
        std::max(reach, box.sun ? glm::length(x) / glm::dot(-box.axis, x) : glm::length(x) + glm::length(box.origin));
    if (!box.sun) box.off = std::max(box.off, std::abs(box.place(x).z));
  }
  // Axes deviate from unit length and right angles by a few roundings each, and so does (a, b, h) relative to its
  // inputs: together fewer than 32 roundings of the largest length.
  box.off += 0x1p-48 * reach;
  return box;
}

}  // namespace penumbra::pairs
