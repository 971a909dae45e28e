// SPDX-License-Identifier: Apache-2.0
// Computes the width of a map's texels at view samples, for comparisons across resolutions.

#include "maps/host/texel_widths.hpp"

#include "maps/host/map_fit.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <string>

namespace penumbra::maps {
namespace {

/// Returns the width across the axis of the face that contains the direction d from the light; infinity if no face
/// contains d.
double width_at(const FittedViews& fitted, const LightBasis& basis, const glm::dvec3& d, std::uint32_t size) {
  for (std::uint32_t i = 0; i < fitted.faces; ++i) {
    const Face face = face_of(fitted.views.front(), basis, i);
    const double w = glm::dot(d, face.w);
    if (!(w > 0)) continue;
    const glm::dvec2 at(glm::dot(d, face.a) / w, glm::dot(d, face.b) / w);
    if (at.x < face.lower.x || at.y < face.lower.y || at.x > face.upper.x || at.y > face.upper.y) continue;
    const glm::dvec2 whole = face.upper - face.lower;
    return w * std::sqrt(whole.x * whole.y) / size;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<float> texel_widths(const visibility::SceneFloats& scene, const visibility::ViewSamples& samples,
                                const visibility::Light& light, const visibility::MethodOptions& complete) {
  const auto is = [&](const char* key, const char* value) {
    const auto found = complete.find(key);
    return found == complete.end() || found->second == value;
  };
  const auto size = complete.find("size");
  if (size == complete.end() || !is_planar(light.kind) || !is("fit", "receivers") || !is("projection", "window"))
    return {};
  const auto texels = static_cast<std::uint32_t>(std::stoul(size->second));
  const LightBasis basis = light_basis(light);
  const glm::vec3 center(basis.center);
  const FittedViews fitted = fit_views(scene, light, basis, {&center, 1}, {.size = texels});
  std::vector<float> widths(samples.size(), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < widths.size(); ++i) {
    if (samples.triangle[i] == visibility::ViewSamples::kBackground) continue;
    widths[i] = static_cast<float>(width_at(fitted, basis, glm::dvec3(samples.p[i]) - glm::dvec3(center), texels));
  }
  return widths;
}

}  // namespace penumbra::maps
