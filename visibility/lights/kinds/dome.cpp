// SPDX-License-Identifier: Apache-2.0
// Domes: directions all around. Light samples are strata of luminance × solid angle, so that a sun in a picture gets
// samples in proportion to its light: y of the unit square selects a row of texels and the height within it, by the
// sums of the rows; x selects the texel in that row, by its luminance (M. Pharr, W. Jakob, G. Humphreys, Physically
// Based Rendering, 12.6). For constant radiance, rows have equal solid angle: heights are evenly spaced, and so are
// angles.

#include "base/assert.hpp"
#include "base/error.hpp"
#include "visibility/dome_faces.hpp"
#include "visibility/dome_picture.hpp"
#include "visibility/lights/kinds/light_kinds.hpp"
#include "visibility/skies/sky.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <variant>
#include <vector>

namespace penumbra::visibility {
namespace {

/// Adds light samples, sorted by face.
void add_samples(Light& light, const std::vector<glm::vec3>& directions, const std::vector<glm::vec3>& colors) {
  std::array<std::vector<std::uint32_t>, kDomeFaces> of_face;
  for (std::uint32_t i = 0; i < directions.size(); ++i)
    of_face.at(dome_face_of(*light.dome, directions[i])).push_back(i);
  for (std::size_t face = 0; face < kDomeFaces; ++face) {
    light.dome->first[face] = static_cast<std::uint32_t>(light.points.size());
    for (const std::uint32_t i : of_face[face]) {
      light.points.push_back(directions[i]);
      light.coordinates.push_back(dome_face_place(*light.dome, face, directions[i]));
      if (!colors.empty()) light.sample_colors.push_back(colors[i]);
    }
  }
  light.dome->first.back() = static_cast<std::uint32_t>(light.points.size());
}

/// Returns orthonormal axes along the stored ones, so that half a dome's faces end where its picture does.
DomeFrame stored_frame(const Light::Dome& dome) {
  const glm::dvec3 right = glm::normalize(glm::dvec3(dome.axes[0]));
  const glm::dvec3 up = glm::normalize(glm::cross(right, glm::dvec3(dome.axes[1])));
  return {right, glm::cross(up, right), up};
}

void make_dome(const scenes::LightShape& shape, const LightBuilder& to) {
  const auto& dome = std::get<scenes::Dome>(shape);
  Light& light = to.light;
  if (!(glm::length(dome.up) > 0) || !std::isfinite(dome.rotate))
    throw InputError(
        "light \"{}\": a dome needs an up direction other than 0, and a finite angle; they are ({}, {}, {}) and {}",
        light.name, dome.up.x, dome.up.y, dome.up.z, dome.rotate);
  const DomeFrame frame = dome_frame(dome.up, 0), turned = dome_frame(dome.up, dome.rotate);
  light.dome = Light::Dome{};
  // right-handed: right × ahead is up
  light.dome->axes = {glm::vec3(frame.right) + 0.0f, glm::vec3(frame.ahead) + 0.0f, glm::vec3(frame.up) + 0.0f};
  light.dome->half = dome.half;
  if (to.picture != nullptr)
    light.dome->sky =
        std::make_shared<const Sky>(*to.picture, stored_frame(*light.dome).turned(dome.rotate), *light.dome);
  light.sun = Light::Directions{light.dome->axes[0], light.dome->axes[1], 1};
  light.center = light.center_u = light.center_v = light.dome->axes[2];
  light.area = (dome.half ? 2 : 4) * std::numbers::pi;
  light.rows = light.columns = 0;  // not on a plane
  light.row_shift.clear();
  const DomeSamples samples = dome_samples(to.picture, dome.half, to.unit);
  if (samples.places.empty())
    throw InputError("light \"{}\": its picture is black{}; a light needs a texel that emits", light.name,
                     dome.half ? " above the horizon" : "");
  light.dome->power = samples.power / std::numbers::pi;
  std::vector<glm::vec3> directions;
  for (const SkyPlace& place : samples.places) {
    glm::vec3 direction = glm::vec3(turned.direction(place)) + 0.0f;
    // Rounding must not move a direction below the plane at which half a dome ends.
    if (dome.half && !(glm::dot(glm::dvec3(direction),
                                glm::cross(glm::dvec3(light.dome->axes[0]), glm::dvec3(light.dome->axes[1]))) > 0))
      direction = light.dome->axes[2];
    directions.push_back(direction);
  }
  add_samples(light, directions, samples.colors);
}

bool is_dome_above_horizon(const UnshadowedLight& seen) {
  if (seen.light().dome->face < 0) return true;  // the part below does not affect V
  const UnshadowedLight::Frame frame = seen.frame();
  return std::ranges::all_of(dome_face_corners(seen.light()), [&](const glm::dvec2& st) {
    return frame.height + st.x * frame.height_u + st.y * frame.height_v > 0;
  });
}

double dome_whole(const UnshadowedLight& seen) {
  if (seen.light().dome->face < 0) return dome_form_factor(seen.light(), seen.normal());
  return std::max(0.0, seen.part(dome_face_corners(seen.light())));
}

}  // namespace

const LightBehaviour kDomeBehaviour{make_dome, is_dome_above_horizon, dome_whole};

}  // namespace penumbra::visibility
