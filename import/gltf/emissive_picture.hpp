#pragma once

#include "scenes/scene.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <map>
#include <span>
#include <vector>

namespace penumbra::scenes {

/// A triangle that a picture lies on.
struct PicturedTriangle {
  std::array<glm::dvec2, 3> places;  ///< in the picture, (0, 0) its top left, (1, 1) its bottom right; finite
  double area = 0;                   ///< in the world
};

/// Means of pictures over triangles. Texels are squares of one colour: what a filter would bring in from beside a
/// triangle does not count, so that a part of an atlas is as it was painted. A mean is exact up to rounding, but for
/// triangles over more than a few million texels, and for all that come after a hundred million texels were looked at:
/// those are sampled.
class PictureMeans {
 public:
  /// `pictures` must outlive it, and may grow.
  explicit PictureMeans(const std::vector<Picture>& pictures) : pictures_(pictures) {}

  /// The mean of the texels (linear red green blue) that the triangles cover, each by the area that it has in the
  /// world. Black for triangles without area.
  glm::dvec3 over(const PictureUse& use, std::span<const PicturedTriangle> triangles);

 private:
  glm::dvec3 of_triangle(const PictureUse& use, const std::array<glm::dvec2, 3>& places);

  const std::vector<Picture>& pictures_;
  double cells_left_ = 1 << 27;
  /// Of triangles that were looked at before: many lamps share one picture and the places in it. By picture, ways to
  /// wrap and places.
  std::map<std::array<double, 9>, glm::dvec3> known_;
};

}  // namespace penumbra::scenes
