// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

/// A dome as the faces of a cube, each a rectangle infinitely far away: in the projection onto a face from p, edges are
/// straight.
namespace penumbra::visibility {

/// One face: directions middle + s u + t v; u × v is the direction in which its light travels.
struct DomeFace {
  glm::vec3 middle{0}, u{0}, v{0};
};

/// Number of faces of a dome: six; half a dome has the four sides, of which it covers half, and the top.
inline constexpr std::size_t kDomeFaces = 6;
inline constexpr std::size_t kDomeBottom = 5;  ///< the face that half a dome lacks
DomeFace dome_face(const Light::Dome& dome, std::size_t face);
/// Returns the face that contains a direction: that of its largest component along the stored axes, the first if equal.
std::size_t dome_face_of(const Light::Dome& dome, const glm::vec3& direction);
/// Returns a direction's place on a face, as (s, t) of dome_face.
glm::dvec2 dome_face_place(const Light::Dome& dome, std::size_t face, const glm::vec3& direction);

/// Returns the corners in (s, t), counter-clockwise, of the emitting part of a face: the square, or its upper half.
std::array<glm::dvec2, 4> dome_face_corners(const Light& face);

/// Returns the faces as lights, in order; for half a dome without the bottom. Each has the dome's light samples that
/// lie on it, in their order. `own_samples`: 64 points of a grid instead.
std::vector<Light> light_faces(const Light& dome, bool own_samples);

/// Returns the form factor of an unoccluded dome of constant radiance at an element of unit normal n: 1, or for half a
/// dome (1 + n · up) / 2.
double dome_form_factor(const Light& dome, const glm::dvec3& n);

/// Returns Σ max(0, n · d) over the light samples of a dome whose bits are set; `mask` empty: all. Sums have a fixed
/// order.
double dome_cosines(const Light& dome, std::span<const std::uint32_t> mask, const glm::vec3& n);
/// Returns V of a dome's mask: irradiance from the visible light samples at an element of normal n, over that from all.
/// 0 if none is above the element.
float dome_share(const Light& dome, std::span<const std::uint32_t> mask, const glm::vec3& n);

}  // namespace penumbra::visibility
