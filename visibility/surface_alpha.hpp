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

/// What lets light through some triangles (glTF 2.0, 3.9.4: alphaMode MASK and BLEND): alpha = factor × texel × vertex.
/// Without entries in a scene all of whose surfaces stop light.
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
  std::vector<Picture> pictures;   ///< of each of the scene's; without texels where no such surface has it
  std::vector<glm::dvec2> places;  ///< in pictures, of each position; empty: no surface has one
  std::vector<float> vertices;     ///< of each position; empty: 1
  /// Of each position, in a scene in projective coordinates (maps/host/sun_space.hpp): places and vertices times these
  /// are linear over a triangle there, and so are these. Empty: 1. alpha_at() is of scenes without.
  std::vector<double> weights;
  /// Triangles (ascending) that cast shadow as their alpha says. SceneFloats::casts_shadow is 0 for them: methods
  /// know only what stops all light, and the host asks these apart (visibility/alpha/).
  std::vector<std::uint32_t> casters;

  [[nodiscard]] bool empty() const { return surfaces.empty(); }
};

/// Those of a scene; casters are its caller's.
SurfaceAlphas make_surface_alphas(const scenes::Scene& scene);

/// How a triangle's surface stops light.
scenes::Alpha::Mode alpha_mode(const SceneFloats& scene, std::uint32_t triangle);

/// Barycentric coordinates of where the line p + t · way meets the triangle's plane, in double: from the signed volumes
/// of way and each edge as seen from p. Of a line in the plane: the first corner.
glm::dvec3 shares_on_line(const glm::dvec3& p, const glm::dvec3& way, const std::array<glm::vec3, 3>& corners);

/// The surface's alpha where these are its coordinates: texture coordinates linear over the triangle in double, the
/// nearest texel of level 0. 1 of a surface without.
double alpha_at(const SceneFloats& scene, std::uint32_t triangle, const glm::dvec3& shares);

/// What comes through there: 0 or 1 of MASK (there is something where alpha is at least the cutoff), 1 − alpha of
/// BLEND, else 0.
double transmittance_at(const SceneFloats& scene, std::uint32_t triangle, const glm::dvec3& shares);

}  // namespace penumbra::visibility
