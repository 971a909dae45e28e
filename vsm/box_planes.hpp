// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vsm/light_tree.hpp"
#include "vsm/receiver_tree.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

namespace penumbra::vsm {

/// Classifies boxes of view samples by whether a triangle is between them and a box of light samples. Inside vsm/ only.
///
/// The segment p→l passes the edge a→b on the side given by the sign of f(p, l) = det(l − p, a − p, b − p), which is
/// affine in p and in l. So for a box of light samples its four corners decide. Each corner gives a plane through the
/// edge, with f a function of p alone; the edge's penumbra wedge is between these planes. With the triangle's own plane
/// there are thirteen half-spaces. p sees no light sample of the box if it is in all of them. It sees all light samples
/// (as far as this triangle is concerned) if it is outside of all four half-spaces of an edge, or of the half-space of
/// the triangle's plane.
class BoxPlanes {
 public:
  static constexpr std::uint32_t kAll =
      (1U << 13) - 1;  ///< bit 4 e + i: edge e, corner i; bit 12: the triangle's plane
  static constexpr std::uint32_t kEdges = kAll >> 1;

  BoxPlanes() = default;
  BoxPlanes(const std::array<glm::dvec3, 3>& corners, const LightTree& tree, const LightTree::Node& light);

  /// Returns whether the box of light samples is certainly on one side of the triangle's plane. If not, no box is
  /// hidden as a whole.
  [[nodiscard]] bool one_side() const { return one_side_; }

  enum class Answer : std::uint8_t { beside, hidden, open };
  /// Classifies a box. `open`: on input the half-spaces that an enclosing box was not certainly in; on return those
  /// that this box is not certainly in.
  [[nodiscard]] Answer look(const ReceiverTree::Node& box, std::uint32_t& open) const;

 private:
  /// The half-space normal · (base − p) > 0. The error of the value is below `relative` times the length of base − p,
  /// plus the effect of l's distance from the corners of its box.
  struct Plane {
    glm::dvec3 normal{0}, base{0};
    double relative = 0;
  };
  std::array<Plane, 13> planes_;
  std::array<glm::dvec3, 3> corners_{};
  double off_ = 0;
  bool sun_ = false, one_side_ = false;
};

}  // namespace penumbra::vsm
