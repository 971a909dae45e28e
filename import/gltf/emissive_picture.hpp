#pragma once

#include "scenes/scene.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <span>

namespace penumbra::scenes {

/// A triangle that a picture lies on.
struct PicturedTriangle {
  std::array<glm::dvec2, 3> places;  ///< in the picture, (0, 0) its top left, (1, 1) its bottom right; finite
  double area = 0;                   ///< in the world
};

/// The mean of the texels (linear red green blue) that the triangles cover, each by the area that it has in the world.
/// Texels are squares of one colour: what a filter would bring in from beside a triangle does not count, so that a
/// part of an atlas is as it was painted. Exact up to rounding, but for triangles over more than a few million texels
/// (pictures that repeat), which are sampled. Black for triangles without area.
glm::dvec3 mean_over(const Picture& picture, const PictureUse& use, std::span<const PicturedTriangle> triangles);

}  // namespace penumbra::scenes
