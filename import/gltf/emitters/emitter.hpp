#pragma once

#include "mesh/triangle_soup.hpp"
#include "scenes/scene.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <variant>

namespace penumbra::scenes {

/// An emissive mesh as a light.
struct Emitter {
  LightShape shape;
  bool two_sided = false;
  /// Some of it stands before some other that emits toward it. A light's own mesh hides none of its light, so there is
  /// more of it than an emitter of this shape would give.
  bool hides_itself = false;
};

/// More pieces than this are refused: each costs what a light costs.
inline constexpr std::size_t kMostPieces = 1024;

/// The light whose body is the given triangles, or why there is none. Whole, it is a flat convex outline
/// (flat_light.hpp) or a sphere (sphere_light.hpp). Otherwise each of the meshes that it consists of is that, or is cut
/// into flat convex parts (convex_parts.hpp).
///
/// Triangles emit to the side from which they run counter-clockwise, if `two_sided` to both. But of a mesh that is
/// closed only the outside is ever seen, and there is nothing to see in one that another encloses: if `two_sided`,
/// closed meshes emit outward whichever way they are wound, and what a closed mesh that emits outward encloses, not
/// at all. `rounding`: how far each position may be from where its author meant it to be.
std::variant<Emitter, std::string> recognise_emitter(std::span<const glm::dvec3> positions,
                                                     std::span<const mesh::Triangle> triangles, bool two_sided,
                                                     double rounding);

}  // namespace penumbra::scenes
