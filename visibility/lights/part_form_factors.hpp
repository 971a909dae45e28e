// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/lights/unshadowed_light.hpp"

#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace penumbra::visibility {

/// Parts of a light with four corners each, counter-clockwise in the frame's coordinates: a list of all first corners,
/// one of all second corners and so on, each padded for a vector that begins at its last element.
class FourCorneredParts {
 public:
  using Corners = std::array<glm::dvec2, 4>;

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Call before set().
  void resize(std::size_t count) {
    size_ = count;
    if (count + kRoom <= lists_[0].s.size()) return;
    for (List& list : lists_) list.s.resize(count + kRoom), list.t.resize(count + kRoom);
  }
  void clear() { size_ = 0; }
  void add(const Corners& corners) {
    const std::size_t part = size_;
    // Lists grow to twice their length.
    if (part + 1 + kRoom > lists_[0].s.size()) resize(2 * part + 1);
    size_ = part + 1;
    set(part, corners);
  }
  void set(std::size_t part, const Corners& corners) {
    for (std::size_t i = 0; i < corners.size(); ++i) lists_[i].s[part] = corners[i].x, lists_[i].t[part] = corners[i].y;
  }
  [[nodiscard]] Corners get(std::size_t part) const {
    const auto corner = [&](std::size_t i) { return glm::dvec2(lists_[i].s[part], lists_[i].t[part]); };
    return {corner(0), corner(1), corner(2), corner(3)};
  }
  [[nodiscard]] const double* s(std::size_t corner) const { return lists_[corner].s.data(); }
  [[nodiscard]] const double* t(std::size_t corner) const { return lists_[corner].t.data(); }

 private:
  static constexpr std::size_t kRoom = 63;  // no vector has more lanes than 64
  struct List {
    std::vector<double> s, t;
  };
  std::array<List, 4> lists_;
  std::size_t size_ = 0;
};

/// Returns the sum of UnshadowedLight::part() of all parts, in their order, on the processor's vector units: the same
/// bits for every vector width. For a rectangle or polygon.
double sum_of_parts(const UnshadowedLight& seen, const FourCorneredParts& parts);

}  // namespace penumbra::visibility
