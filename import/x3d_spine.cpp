// SPDX-License-Identifier: Apache-2.0
// Computes the cross-section planes of X3D extrusions (ISO/IEC 19775-1, 13.3.5).

#include "import/x3d_spine.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>

namespace penumbra::import {

std::vector<glm::dmat3> x3d_planes_across(const std::vector<glm::dvec3>& spine) {
  const std::size_t count = spine.size();
  const bool closed = count > 2 && spine.front() == spine.back();
  std::vector<glm::dvec3> y(count), z(count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool at_end = i == 0 || i + 1 == count;
    const std::size_t before = i > 0 ? i - 1 : closed ? count - 2 : 0;
    const std::size_t after = i + 1 < count ? i + 1 : closed ? 1 : count - 1;
    y[i] = spine[after] - spine[before];
    if (!at_end || closed) z[i] = glm::cross(spine[after] - spine[i], spine[before] - spine[i]);
  }
  const auto set = [](glm::dvec3& v) {
    const double length = glm::length(v);
    v = length > 0 ? v / length : glm::dvec3(0);
    return length > 0;
  };
  for (glm::dvec3& axis : y) set(axis);
  std::vector<bool> known(count);
  for (std::size_t i = 0; i < count; ++i) known[i] = set(z[i]);
  const auto first = static_cast<std::size_t>(std::ranges::find(known, true) - known.begin());
  if (first == count) {  // a straight spine: the Y axis rotated to it
    const auto along = std::ranges::find_if(y, [](const glm::dvec3& v) { return v != glm::dvec3(0); });
    const glm::dvec3 axis = along == y.end() ? glm::dvec3(0, 1, 0) : *along;
    // Rotated from the Y axis by the smallest angle; if opposite to it, around the X axis.
    const glm::dvec3 turned =
        axis.y > -1 ? glm::dvec3(0, 0, 1) - axis.z / (1 + axis.y) * (axis + glm::dvec3(0, 1, 0)) : glm::dvec3(0, 0, -1);
    for (glm::dvec3& v : z) v = turned;
  } else {
    for (std::size_t i = 0; i < first; ++i) z[i] = z[first];
    for (std::size_t i = first + 1; i < count; ++i) {
      if (!known[i]) z[i] = z[i - 1];
      if (glm::dot(z[i], z[i - 1]) < 0) z[i] = -z[i];
    }
  }
  std::vector<glm::dmat3> planes(count);
  for (std::size_t i = 0; i < count; ++i) planes[i] = glm::dmat3(glm::cross(y[i], z[i]), y[i], z[i]);
  return planes;
}

}  // namespace penumbra::import
