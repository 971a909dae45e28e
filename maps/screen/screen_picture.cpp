// SPDX-License-Identifier: Apache-2.0
// Converts a camera's view samples to a picture of depths in eye space.

#include "maps/screen/screen_picture.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>

namespace penumbra::maps {
namespace {

/// Largest permitted distance, in pixels, of a view sample's position from its pixel's centre. Positions are rounded to
/// float32, with steps of a small part of a pixel unless the eye is millions of scene sizes away.
constexpr double kOffCentre = 0.25;

}  // namespace

std::optional<ScreenPicture> ScreenPicture::of(const visibility::ViewSamples& samples) {
  ScreenPicture picture;
  const visibility::PinholeCamera& camera = samples.camera;
  if (camera.width != samples.width || camera.height != samples.height) return std::nullopt;
  picture.camera_ = camera;
  picture.width_ = samples.width;
  picture.height_ = samples.height;
  if (!camera.half_height) picture.shift_ = {glm::dot(camera.right, camera.middle), glm::dot(camera.up, camera.middle)};
  const auto turned = [&](const glm::dvec3& d) {
    return glm::dvec3(glm::dot(camera.right, d), glm::dot(camera.up, d), -glm::dot(camera.forward, d));
  };
  picture.points_.resize(samples.size());
  picture.normals_.resize(samples.size());
  picture.shown_.resize(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.triangle[i] == visibility::ViewSamples::kBackground) continue;
    picture.shown_[i] = 1;
    picture.points_[i] = turned(glm::dvec3(samples.p[i]) - camera.eye);
    picture.normals_[i] = turned(samples.n[i]);
    const std::optional<glm::dvec2> place = picture.place_of(picture.points_[i]);
    if (!place || !(glm::distance(*place, picture.centre_of(i)) < kOffCentre)) return std::nullopt;
  }
  return picture;
}

std::optional<glm::dvec2> ScreenPicture::place_of(const glm::dvec3& point) const {
  const double distance = -point.z;
  if (!(distance > 0)) return std::nullopt;
  const glm::dvec2 across = camera_.half_height ? glm::dvec2(point) / *camera_.half_height
                                                : (glm::dvec2(point) / distance - shift_) / camera_.tan_half_fov;
  const double half = 0.5 * height_;
  return glm::dvec2(0.5 * width_ + half * across.x, half - half * across.y);
}

std::optional<std::size_t> ScreenPicture::surface_at(const glm::dvec2& place) const {
  if (!holds(place)) return std::nullopt;
  const std::size_t pixel = static_cast<std::size_t>(place.y) * width_ + static_cast<std::size_t>(place.x);
  if (!shows_surface(pixel)) return std::nullopt;
  return pixel;
}

double ScreenPicture::pixels_per_length(double distance) const {
  return 0.5 * height_ / (camera_.half_height ? *camera_.half_height : camera_.tan_half_fov * distance);
}

}  // namespace penumbra::maps
