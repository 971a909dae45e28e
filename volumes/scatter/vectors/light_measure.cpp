// SPDX-License-Identifier: Apache-2.0
// Area or luminance of parts of a light's window: plain, in the unit disk, or under a texture.

#include "volumes/scatter/vectors/light_measure.hpp"

#include "visibility/lights/disk_part.hpp"

#include <algorithm>
#include <array>
#include <numbers>

namespace penumbra::volumes {
namespace {

bool in_unit_disk(const glm::dvec2& at) {
  return at.x * at.x + at.y * at.y <= 1;
}

}  // namespace

LightMeasure::LightMeasure(const visibility::Light& light, const glm::dvec2& size)
    : size_(size), round_(visibility::is_round(light.kind)), whole_(size.x * size.y) {
  if (round_) whole_ *= std::numbers::pi / 4;
  if (!light.texture) return;
  texture_.emplace(*light.texture);
  densest_ = texture_->contrast();
}

double LightMeasure::of(const Trapezoid& part) const {
  if (round_) return in_disk(part);
  if (texture_) return under_texture(part);
  return 0.5 * (part.low.right - part.low.left + part.high.right - part.high.left) * (part.high.y - part.low.y);
}

double LightMeasure::rounding() const {
  const double share = round_ ? 64 * 0x1p-53 : texture_ ? texture_->rounding() : 0;
  return share * size_.x * size_.y;
}

double LightMeasure::in_disk(const Trapezoid& part) const {
  const glm::dvec2 scale = 2.0 / size_;
  const auto at = [&](double x, double y) { return glm::dvec2(x, y) * scale - 1.0; };
  const auto& [low, high] = part;
  const std::array corners{at(low.left, low.y), at(low.right, low.y), at(high.right, high.y), at(high.left, high.y)};
  if (std::ranges::all_of(corners, in_unit_disk))
    return 0.5 * (low.right - low.left + high.right - high.left) * (high.y - low.y);
  return visibility::DiskPart(corners).area() / (scale.x * scale.y);
}

double LightMeasure::under_texture(const Trapezoid& part) const {
  const auto at = [&](double cells, int axis) { return 2 * cells / size_[axis] - 1; };
  const auto& [low, high] = part;
  return whole_ * texture_->share_of({at(low.y, 1), at(high.y, 1), at(low.left, 0), at(low.right, 0), at(high.left, 0),
                                      at(high.right, 0)});
}

}  // namespace penumbra::volumes
