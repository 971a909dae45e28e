#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

/// A dome as the faces of a cube, each a rectangle infinitely far away: projected onto it from p, edges are straight.
namespace penumbra::visibility {

/// One face: directions middle + s u + t v; u × v is the way its light travels.
struct DomeFace {
  glm::vec3 middle{0}, u{0}, v{0};
};

/// Which faces a dome has: six, or of half a dome the four sides, which are halves, and the top.
inline constexpr std::size_t kDomeFaces = 6;
inline constexpr std::size_t kDomeBottom = 5;  ///< which half a dome lacks
DomeFace dome_face(const Light::Dome& dome, std::size_t face);
/// The face that a direction lies on: that of its largest part along the stored axes, the first of equals.
std::size_t dome_face_of(const Light::Dome& dome, const glm::vec3& direction);
/// Where, as (s, t) of dome_face.
glm::dvec2 dome_face_place(const Light::Dome& dome, std::size_t face, const glm::vec3& direction);

/// The corners in (s, t), counter-clockwise, of what of a face is light: the square, or the upper half.
std::array<glm::dvec2, 4> dome_face_corners(const Light& face);

/// The faces as lights, in order; of half a dome without the bottom. Each has its own of the dome's light samples, in
/// their order. `own_samples`: 64 points of a grid instead.
std::vector<Light> light_faces(const Light& dome, bool own_samples);

/// The form factor of all of a dome of one radiance that nothing hides, from an element of unit normal n: 1, or of half
/// a dome (1 + n · up) / 2.
double dome_form_factor(const Light& dome, const glm::dvec3& n);

/// Σ max(0, n · d) over light samples of a dome whose bits are set; `mask` empty: all. Sums run in one order.
double dome_cosines(const Light& dome, std::span<const std::uint32_t> mask, const glm::vec3& n);
/// V of masks of a dome: what the visible light samples send to an element of normal n, over what all do. 0 where none
/// is above it.
float dome_share(const Light& dome, std::span<const std::uint32_t> mask, const glm::vec3& n);

}  // namespace penumbra::visibility
