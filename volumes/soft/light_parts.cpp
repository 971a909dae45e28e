// SPDX-License-Identifier: Apache-2.0
// Cuts a rectangle light into n × n equal rectangles (Assarsson, Dougherty, Mounier and Akenine-Möller 2003).
#include "volumes/soft/light_parts.hpp"

#include "base/assert.hpp"
#include "visibility/lights/light_parts.hpp"

namespace penumbra::volumes {

std::vector<visibility::Light> light_parts(const visibility::Light& light, std::uint32_t n) {
  if (n == 1) return {light};
  PENUMBRA_ASSERT(is_parallelogram(light.kind), "a {} cut in parts", name_of(light.kind));
  const visibility::LightFrame frame = visibility::light_frame(light);
  const auto at = [&](double s, double t) { return glm::vec3(frame.center + s * frame.u + t * frame.v); };
  std::vector<visibility::Light> parts;
  for (std::uint32_t row = 0; row < n; ++row) {
    for (std::uint32_t column = 0; column < n; ++column) {
      const double half = 1.0 / n, s = (2 * column + 1) * half - 1, t = (2 * row + 1) * half - 1;
      visibility::Light part = light;
      part.center = at(s, t);
      part.center_u = at(s + half, t);
      part.center_v = at(s, t + half);
      part.outline = {at(s - half, t - half), at(s + half, t - half), at(s + half, t + half), at(s - half, t + half)};
      part.area = light.area / (n * n);
      part.rows = part.columns = 0;
      part.row_shift.clear();
      part.points.clear();
      part.coordinates.clear();
      part.weights.clear();
      part.sample_colors.clear();
      if (light.texture) part.texture = visibility::texture_part(*light.texture, n, {column, row});
      parts.push_back(part);
    }
  }
  return parts;
}

}  // namespace penumbra::volumes
