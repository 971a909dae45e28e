// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace penumbra::visibility {

struct SceneFloats;

/// Alpha of triangles that let light through (glTF 2.0, 3.9.4: alphaMode MASK and BLEND): alpha = factor × texel ×
/// vertex. Empty for a scene with only opaque surfaces.
struct SurfaceAlphas {
  struct Surface {
    scenes::Alpha alpha;
    std::optional<scenes::PictureUse> picture;
  };
  struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> texels;  ///< alpha; row by row from the top left
  };

  std::vector<Surface> surfaces;   ///< of each object
  std::vector<Picture> pictures;   ///< for each of the scene's pictures; without texels if no such surface uses it
  std::vector<glm::dvec2> places;  ///< picture coordinates of each position; empty: no surface has any
  std::vector<float> vertices;     ///< alpha of each position; empty: 1
  /// For each position of a scene in projective coordinates (maps/host/sun_space.hpp): coordinates and vertex values
  /// times these weights are linear over a triangle there, and so are the weights. Empty: 1. alpha_at() is for scenes
  /// without weights.
  std::vector<double> weights;
  /// Triangles (ascending) that cast shadows depending on their alpha. SceneFloats::casts_shadow is 0 for them: methods
  /// handle only opaque surfaces, and the host handles these separately (visibility/alpha/).
  std::vector<std::uint32_t> casters;

  [[nodiscard]] bool empty() const { return surfaces.empty(); }
};

/// Returns the alphas of a scene, without `casters`, which the caller sets.
SurfaceAlphas make_surface_alphas(const scenes::Scene& scene);

/// Returns the alpha mode of a triangle's surface.
scenes::Alpha::Mode alpha_mode(const SceneFloats& scene, std::uint32_t triangle);

/// Returns the barycentric coordinates of the point where the line p + t · direction meets the triangle's plane, in
/// double: from the signed volumes of `direction` and each edge as seen from p. For a line in the plane: the first
/// corner.
glm::dvec3 shares_on_line(const glm::dvec3& p, const glm::dvec3& direction, const std::array<glm::vec3, 3>& corners);

/// Returns the surface's alpha at these barycentric coordinates: texture coordinates are linear over the triangle in
/// double, the nearest texel of level 0. 1 for a surface without alpha.
double alpha_at(const SceneFloats& scene, std::uint32_t triangle, const glm::dvec3& shares);

/// Returns the surface's transmittance at these barycentric coordinates: 0 or 1 for MASK (opaque where alpha is at
/// least the cutoff), 1 − alpha for BLEND, else 0.
double transmittance_at(const SceneFloats& scene, std::uint32_t triangle, const glm::dvec3& shares);

}  // namespace penumbra::visibility
