#include "visibility/lights/light_parts.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <numeric>

namespace penumbra::visibility {
namespace {

/// How much of [from, to] texel k of n covers, all of them over [0, 1].
double overlap(double from, double to, std::uint32_t k, std::uint32_t n) {
  return std::max(0.0, std::min(to, (k + 1.0) / n) - std::max(from, static_cast<double>(k) / n));
}

/// The integral of the texture's luminance over a part, of the light's coordinates scaled to [0, 1]².
double luminance_in(const LightTexture& texture, const glm::dvec2& lower, const glm::dvec2& upper) {
  double sum = 0;
  for (std::uint32_t y = 0; y < texture.height; ++y) {
    // Rows run from the top downward.
    const double high = overlap(lower.y, upper.y, texture.height - 1 - y, texture.height);
    for (std::uint32_t x = 0; high > 0 && x < texture.width; ++x) {
      sum += texture.luminance[std::size_t{y} * texture.width + x] * high * overlap(lower.x, upper.x, x, texture.width);
    }
  }
  return sum;
}

}  // namespace

std::vector<LightPart> light_parts(const Light& light, std::uint32_t count) {
  if (count == 1) return {{light, 1}};
  if (light.kind != LightKind::rectangle) {
    throw InputError("light \"{}\" is a {}; only rectangles are cut into sub-lights: take sublights=1", light.name,
                     name_of(light.kind));
  }
  const LightFrame frame = light_frame(light);
  const glm::dvec3 u = frame.u / static_cast<double>(count), v = frame.v / static_cast<double>(count);
  std::vector<LightPart> parts;
  for (std::uint32_t row = 0; row < count; ++row) {
    for (std::uint32_t column = 0; column < count; ++column) {
      const glm::dvec2 lower = glm::dvec2(column, row) / static_cast<double>(count),
                       upper = glm::dvec2(column + 1, row + 1) / static_cast<double>(count);
      const double weight = light.texture ? luminance_in(*light.texture, lower, upper) : 1;
      if (weight == 0) continue;
      const glm::dvec3 center = frame.center + (2.0 * column + 1.0 - count) * u + (2.0 * row + 1.0 - count) * v;
      LightPart& part = parts.emplace_back(LightPart{light, weight});
      part.light.texture.reset();
      part.light.weights.clear();
      part.light.sample_colors.clear();
      part.light.area = light.area / (static_cast<double>(count) * count);
      part.light.center = center;
      part.light.center_u = center + u;
      part.light.center_v = center + v;
      part.light.outline = {center - u - v, center + u - v, center + u + v, center - u + v};
      for (std::size_t i = 0; i < light.points.size(); ++i) {
        part.light.points[i] = center + light.coordinates[i].x * u + light.coordinates[i].y * v;
      }
    }
  }
  const double sum = std::accumulate(parts.begin(), parts.end(), 0.0,
                                     [](double so_far, const LightPart& part) { return so_far + part.weight; });
  for (LightPart& part : parts) part.weight /= sum;
  return parts;
}

}  // namespace penumbra::visibility
