// SPDX-License-Identifier: Apache-2.0
// Directions of a sky picture's texels, and stratified light samples in proportion to luminance times solid angle.

#include "visibility/dome_picture.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace penumbra::visibility {
namespace {

/// The step of a growing list of sums `up_to` that contains the fraction `share` of the last sum, and the position
/// within that step.
struct Step {
  std::size_t index = 0;
  double within = 0;  // [0, 1)
};
Step step_at(const std::vector<double>& up_to, double share) {
  const double wanted = share * up_to.back();
  auto found = std::upper_bound(up_to.begin(), up_to.end(), wanted);
  if (found == up_to.end()) found = std::lower_bound(up_to.begin(), up_to.end(), up_to.back());
  const double before = found == up_to.begin() ? 0 : *(found - 1);
  return {static_cast<std::size_t>(found - up_to.begin()),
          std::clamp((wanted - before) / (*found - before), 0.0, 1 - 0x1p-53)};
}

/// Heights of the upper and lower end of row `row` of `count`, clamped to the horizon for half a dome.
struct Heights {
  double upper = 1, lower = -1;
};
Heights heights_of(std::size_t row, std::size_t count, bool half) {
  const auto at = [&](std::size_t border) {
    if (border == 0) return 1.0;
    if (border == count) return -1.0;
    if (2 * border == count) return 0.0;
    return std::cos(std::numbers::pi * static_cast<double>(border) / static_cast<double>(count));
  };
  const Heights heights{at(row), at(row + 1)};
  return half ? Heights{std::max(heights.upper, 0.0), std::max(heights.lower, 0.0)} : heights;
}

}  // namespace

double luminance_of(const glm::dvec3& color) {
  return 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
}

glm::dvec3 DomeFrame::direction(const SkyPlace& place) const {
  const double angle = 2 * std::numbers::pi * (place.turn - 0.5);
  const double flat = std::sqrt(std::max(0.0, (1 - place.height) * (1 + place.height)));
  return flat * (std::cos(angle) * ahead + std::sin(angle) * right) + place.height * up;
}

SkyPlace DomeFrame::place(const glm::dvec3& direction) const {
  const glm::dvec3 d = glm::normalize(direction);
  const double angle = std::atan2(glm::dot(d, right), glm::dot(d, ahead));
  return {std::clamp(glm::dot(d, up), -1.0, 1.0), 0.5 + angle / (2 * std::numbers::pi)};
}

DomeFrame dome_frame(const glm::dvec3& up, double degrees) {
  DomeFrame frame;
  const double length = glm::length(up);
  frame.up = up / length;
  const glm::dvec3& c = frame.up;
  // The smallest rotation from +Y to c (Rodrigues, with axis Y × c = (c.z, 0, −c.x)), applied to +X and −Z.
  if (c.y > -1 + 0x1p-40) {
    const double k = 1 / (1 + c.y);
    frame.right = {1 - k * c.x * c.x, -c.x, -k * c.x * c.z};
    frame.ahead = {k * c.x * c.z, c.z, k * c.z * c.z - 1};
  } else {
    frame.right = {1, 0, 0};
    frame.ahead = {0, 0, 1};
  }
  return degrees == 0 ? frame : frame.turned(degrees);
}

DomeFrame DomeFrame::turned(double degrees) const {
  const double turn = glm::radians(std::remainder(degrees, 360.0)), cosine = std::cos(turn), sine = std::sin(turn);
  return {cosine * right + sine * ahead, cosine * ahead - sine * right, up};
}

std::size_t sky_texel(const scenes::Texture& picture, const SkyPlace& place) {
  const auto cell = [](double share, std::uint32_t count) {
    return static_cast<std::size_t>(std::clamp(std::floor(share * count), 0.0, static_cast<double>(count - 1)));
  };
  const std::size_t row = cell(std::acos(place.height) / std::numbers::pi, picture.height);
  return row * picture.width + cell(place.turn, picture.width);
}

DomeSamples dome_samples(const scenes::Texture* picture, bool half, const std::vector<glm::dvec2>& unit) {
  const std::size_t height = picture != nullptr ? picture->height : 1, width = picture != nullptr ? picture->width : 1;
  const auto luminance = [&](std::size_t row, std::size_t x) {
    return picture != nullptr ? luminance_of(glm::dvec3(picture->texels[row * width + x])) : 1.0;
  };
  DomeSamples samples;
  std::vector<double> rows;  // for each row, ∫ luminance dω up to its end
  for (std::size_t row = 0; row < height; ++row) {
    const auto [upper, lower] = heights_of(row, height, half);
    double sum = 0;
    for (std::size_t x = 0; x < width; ++x) sum += luminance(row, x);
    samples.power += 2 * std::numbers::pi * (upper - lower) * sum / static_cast<double>(width);
    rows.push_back(samples.power);
  }
  if (!(samples.power > 0)) return samples;
  std::vector<std::vector<double>> columns(height);  // for used rows, the sums up to each texel
  for (const glm::dvec2& at : unit) {
    const auto [row, down] = step_at(rows, at.y);
    std::vector<double>& sums = columns[row];
    if (sums.empty()) {
      double sum = 0;
      for (std::size_t x = 0; x < width; ++x) sums.push_back(sum += luminance(row, x));
    }
    const auto [x, across] = step_at(sums, at.x);
    const auto [upper, lower] = heights_of(row, height, half);
    samples.places.push_back(
        {upper + down * (lower - upper), (static_cast<double>(x) + across) / static_cast<double>(width)});
    if (picture == nullptr) continue;
    const glm::vec3& texel = picture->texels[row * width + x];
    samples.colors.emplace_back(glm::dvec3(texel) / luminance_of(glm::dvec3(texel)));
  }
  return samples;
}

}  // namespace penumbra::visibility
