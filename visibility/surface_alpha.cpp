// SPDX-License-Identifier: Apache-2.0
// Alpha of surfaces with holes and translucent ones, from factor, texel and vertex values.

#include "visibility/surface_alpha.hpp"

#include "scenes/texel_number.hpp"
#include "visibility/alpha_shares.hpp"
#include "visibility/scene_floats.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::visibility {

using scenes::Alpha;

SurfaceAlphas make_surface_alphas(const scenes::Scene& scene) {
  SurfaceAlphas alphas;
  const auto lets_through = [](const scenes::Object& object) { return object.alpha.mode != Alpha::Mode::opaque; };
  if (std::ranges::none_of(scene.objects, lets_through)) return alphas;
  alphas.pictures.resize(scene.pictures.size());
  bool in_picture = false;
  for (const scenes::Object& object : scene.objects) {
    alphas.surfaces.push_back({object.alpha, object.picture});
    if (!lets_through(object) || !object.picture) continue;
    in_picture = true;
    const scenes::Picture& source = scene.pictures.at(object.picture->picture);
    SurfaceAlphas::Picture& picture = alphas.pictures.at(object.picture->picture);
    if (!picture.texels.empty()) continue;
    picture.width = source.width;
    picture.height = source.height;
    picture.texels.reserve(source.texels.size());
    for (const auto& texel : source.texels) picture.texels.push_back(texel[3]);
  }
  if (in_picture) alphas.places = scene.looks.places;
  const bool colored = std::ranges::any_of(scene.looks.colors, [](const glm::vec4& color) { return color.a != 1; });
  if (colored) {
    for (const glm::vec4& color : scene.looks.colors) alphas.vertices.push_back(color.a);
  }
  return alphas;
}

Alpha::Mode alpha_mode(const SceneFloats& scene, std::uint32_t triangle) {
  return scene.alphas.empty() ? Alpha::Mode::opaque : scene.alphas.surfaces[scene.object[triangle]].alpha.mode;
}

glm::dvec3 shares_from(const glm::dvec3& volumes) {
  const glm::dvec3 shares = volumes / (volumes.x + volumes.y + volumes.z);
  const bool finite = std::isfinite(shares.x) && std::isfinite(shares.y) && std::isfinite(shares.z);
  return finite ? shares : glm::dvec3(1, 0, 0);
}

glm::dvec3 shares_on_line(const glm::dvec3& p, const glm::dvec3& direction, const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 a = glm::dvec3(corners[0]) - p, b = glm::dvec3(corners[1]) - p, c = glm::dvec3(corners[2]) - p;
  return shares_from({glm::dot(direction, glm::cross(b, c)), glm::dot(direction, glm::cross(c, a)),
                      glm::dot(direction, glm::cross(a, b))});
}

namespace {

/// Interpolates a vertex value linearly over a triangle; exact where all three corners have the same value.
template <class T>
T between(const T& a, const T& b, const T& c, const glm::dvec3& shares) {
  return a + shares.y * (b - a) + shares.z * (c - a);
}

}  // namespace

double alpha_at(const SceneFloats& scene, std::uint32_t triangle, const glm::dvec3& shares) {
  const SurfaceAlphas& all = scene.alphas;
  if (all.empty()) return 1;
  const SurfaceAlphas::Surface& surface = all.surfaces[scene.object[triangle]];
  const Triangle& corners = scene.triangles[triangle];
  double alpha = surface.alpha.factor;
  if (surface.picture) {
    const SurfaceAlphas::Picture& picture = all.pictures[surface.picture->picture];
    const glm::dvec2 place = between(all.places[corners[0]], all.places[corners[1]], all.places[corners[2]], shares);
    const double x = std::floor(place.x * picture.width), y = std::floor(place.y * picture.height);
    if (std::isfinite(x) && std::isfinite(y)) {
      const std::size_t column = scenes::texel_number(x, picture.width, surface.picture->wrap_s),
                        row = scenes::texel_number(y, picture.height, surface.picture->wrap_t);
      alpha *= picture.texels[row * picture.width + column] / 255.0;
    }
  }
  if (!all.vertices.empty()) {
    const auto vertex = [&](std::size_t corner) { return double{all.vertices[corners[corner]]}; };
    alpha *= std::clamp(between(vertex(0), vertex(1), vertex(2), shares), 0.0, 1.0);
  }
  return alpha;
}

double transmittance_at(const SceneFloats& scene, std::uint32_t triangle, const glm::dvec3& shares) {
  switch (alpha_mode(scene, triangle)) {
    case Alpha::Mode::mask:
      return alpha_at(scene, triangle, shares) >= scene.alphas.surfaces[scene.object[triangle]].alpha.cutoff ? 0 : 1;
    case Alpha::Mode::blend:
      return 1 - alpha_at(scene, triangle, shares);
    case Alpha::Mode::opaque:
      break;
  }
  return 0;
}

}  // namespace penumbra::visibility
