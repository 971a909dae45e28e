// SPDX-License-Identifier: Apache-2.0
// Looks up textures as defined by glTF 2.0, 3.8.4: (0, 0) is the picture's top left corner, texel centres at half
// integers.
#include "compare/surface.hpp"

#include "base/image.hpp"
#include "base/pages.hpp"
#include "scenes/texel_number.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace penumbra::compare {
namespace {

using scenes::Picture;
using scenes::PictureUse;

glm::dvec3 texel_at(const Picture& picture, const PictureUse& use, double x, double y) {
  static const std::array<double, 256> linear = [] {
    std::array<double, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = linear_of_srgb(static_cast<double>(i) / 255);
    return values;
  }();
  const auto& texel = picture.texels[scenes::texel_number(y, picture.height, use.wrap_t) * picture.width +
                                     scenes::texel_number(x, picture.width, use.wrap_s)];
  return {linear[texel[0]], linear[texel[1]], linear[texel[2]]};
}

glm::dvec3 picture_at(const Picture& picture, const PictureUse& use, const glm::dvec2& place) {
  const glm::dvec2 at = place * glm::dvec2(picture.width, picture.height);
  if (!std::isfinite(at.x) || !std::isfinite(at.y)) return glm::dvec3(0);
  if (use.nearest) return texel_at(picture, use, std::floor(at.x), std::floor(at.y));
  const glm::dvec2 low = glm::floor(at - 0.5), share = at - 0.5 - low;
  return glm::mix(
      glm::mix(texel_at(picture, use, low.x, low.y), texel_at(picture, use, low.x + 1, low.y), share.x),
      glm::mix(texel_at(picture, use, low.x, low.y + 1), texel_at(picture, use, low.x + 1, low.y + 1), share.x),
      share.y);
}

/// Returns the barycentric coordinates of p in the triangle, or of the point nearest to p in these coordinates: p was
/// rounded.
glm::dvec3 barycentric(const std::array<glm::vec3, 3>& corners, const glm::vec3& p) {
  const glm::dvec3 a = corners[0], b = corners[1], c = corners[2], at = p;
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  glm::dvec3 shares(glm::dot(glm::cross(b - at, c - at), normal), glm::dot(glm::cross(c - at, a - at), normal),
                    glm::dot(glm::cross(a - at, b - at), normal));
  shares = glm::max(shares, glm::dvec3(0));
  const double sum = shares.x + shares.y + shares.z;
  return sum > 0 ? shares / sum : glm::dvec3(1, 0, 0);
}

template <typename Wide, typename Stored>
Wide between(const std::vector<Stored>& values, const visibility::Triangle& corners, const glm::dvec3& shares) {
  return shares.x * Wide(values[corners[0]]) + shares.y * Wide(values[corners[1]]) +
         shares.z * Wide(values[corners[2]]);
}

glm::vec3 shading_normal(const scenes::VertexLooks& looks, const visibility::Triangle& corners,
                         const glm::dvec3& shares, const glm::vec3& geometric) {
  for (const std::uint32_t corner : corners) {
    if (looks.normals[corner] == glm::vec3(0)) return geometric;
  }
  const auto normal = between<glm::dvec3>(looks.normals, corners, shares);
  const double length = glm::length(normal);
  if (!(length > 0)) return geometric;
  const glm::dvec3 unit = normal / length;
  // Exporters also write the normals of facets, rotated in single precision, and the facet's own normal is computed
  // from rounded corners: a tenth of a milliradian is far above the error of either normal in any visible triangle,
  // and changes a cosine by less than a ten-thousandth. Within this tolerance, the facet's own normal is exact.
  constexpr double kSame = 1e-4;
  if (glm::length(glm::cross(unit, glm::dvec3(geometric))) <= kSame) return geometric;
  return glm::vec3(glm::dot(unit, glm::dvec3(geometric)) < 0 ? -unit : unit);
}

}  // namespace

SurfaceLooks look_at(const scenes::Scene& scene, const visibility::SceneFloats& floats,
                     const visibility::ViewSamples& samples, bool shading_normals) {
  const scenes::VertexLooks& looks = scene.looks;
  const bool painted = !looks.colors.empty() || std::ranges::any_of(scene.objects, [](const scenes::Object& object) {
    return object.picture.has_value();
  });
  SurfaceLooks all;
  if (painted) resize_on_all_cores(all.colors, samples.size());
  const bool smooth = shading_normals && !looks.normals.empty();
  if (smooth) all.normals = samples.n;
  if (!painted && !smooth) return all;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, samples.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      if (samples.triangle[i] == visibility::ViewSamples::kBackground) continue;
      const auto triangle = static_cast<std::uint32_t>(samples.triangle[i]);
      const scenes::Object& object = scene.objects[floats.object[triangle]];
      if (painted) all.colors[i] = object.color;
      if (looks.colors.empty() && !object.picture && !smooth) continue;
      const visibility::Triangle& corners = floats.triangles[triangle];
      const glm::dvec3 shares = barycentric(floats.corners(triangle), samples.p[i]);
      if (!looks.colors.empty()) all.colors[i] *= glm::dvec3(between<glm::dvec4>(looks.colors, corners, shares));
      if (object.picture) {
        all.colors[i] *= picture_at(scene.pictures[object.picture->picture], *object.picture,
                                    between<glm::dvec2>(looks.places, corners, shares));
      }
      if (smooth) all.normals[i] = shading_normal(looks, corners, shares, samples.n[i]);
    }
  });
  return all;
}

}  // namespace penumbra::compare
