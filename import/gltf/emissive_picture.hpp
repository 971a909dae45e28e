// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <map>
#include <span>
#include <vector>

namespace penumbra::import {

/// A triangle with its place in a picture.
struct PicturedTriangle {
  std::array<glm::dvec2, 3> places;  ///< coordinates in the picture, (0, 0) its top left, (1, 1) its bottom right;
                                     ///< finite
  double area = 0;                   ///< area in the world
};

/// Means of pictures over triangles. Texels are squares of one colour: neighbouring texels that a filter would blend in
/// do not count, so that a part of an atlas keeps its painted colour. A mean is exact up to rounding, except for
/// triangles over more than a few million texels, and for all triangles after the first hundred million texels: those
/// are sampled.
class PictureMeans {
 public:
  /// `pictures` must outlive this object, and may grow.
  explicit PictureMeans(const std::vector<scenes::Picture>& pictures) : pictures_(pictures) {}

  /// Returns the mean of the texels (linear red green blue) that the triangles cover, each weighted by its area in the
  /// world. Black for triangles without area.
  glm::dvec3 over(const scenes::PictureUse& use, std::span<const PicturedTriangle> triangles);

 private:
  glm::dvec3 of_triangle(const scenes::PictureUse& use, const std::array<glm::dvec2, 3>& places);

  const std::vector<scenes::Picture>& pictures_;
  double cells_left_ = 1 << 27;
  /// Means of triangles computed before, by picture, wrap modes and coordinates: many lamps share one picture and the
  /// same coordinates in it.
  std::map<std::array<double, 9>, glm::dvec3> known_;
};

}  // namespace penumbra::import
