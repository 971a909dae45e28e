// SPDX-License-Identifier: Apache-2.0
// Integrates a light's texture over regions by Green's theorem, with prefix sums of rows of texels. Not from a paper;
// derived in docs/coverage.md.

#include "volumes/wedges/texture_weights.hpp"

#include "base/error.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::volumes {
namespace {

constexpr std::uint32_t kMostTexels = 0xffff;  // limit along one side; the two sides share a 32-bit word

/// Returns the index of the cell that contains `at`, of `count` cells, each 1 long.
std::uint32_t cell_of(double at, std::uint32_t count) {
  return static_cast<std::uint32_t>(std::clamp(std::floor(at), 0.0, static_cast<double>(count - 1)));
}

/// Returns the point where the ray from `reference` through q leaves [−1, 1]², as its distance along the rim from (1,
/// −1), counter-clockwise.
double rim_position(const glm::dvec2& reference, const glm::dvec2& q) {
  const glm::dvec2 d = q - reference;
  double least = std::numeric_limits<double>::infinity();
  int axis = 0;
  for (int i = 0; i < 2; ++i) {
    const double steps = d[i] == 0 ? least : (std::copysign(1.0, d[i]) - reference[i]) / d[i];
    if (steps >= least) continue;
    least = steps;
    axis = i;
  }
  const double other = std::clamp(reference[1 - axis] + least * d[1 - axis], -1.0, 1.0);
  if (axis == 0) return d.x > 0 ? 1 + other : 5 - other;
  return d.y > 0 ? 3 - other : 7 + other;
}

/// Returns the point at distance `position` along the rim.
glm::dvec2 rim_point(double position) {
  if (position < 2) return {1, position - 1};
  if (position < 4) return {3 - position, 1};
  if (position < 6) return {-1, 5 - position};
  return {position - 7, -1};
}

}  // namespace

TextureWeights::TextureWeights(const visibility::LightTexture& texture)
    : width_(texture.width), height_(texture.height) {
  if (width_ > kMostTexels || height_ > kMostTexels) {
    throw ResourceError("a light's texture has {}x{} texels; soft-volume supports at most {} along a side", width_,
                        height_, kMostTexels);
  }
  const double step = 2.0 / width_, row_height = 2.0 / height_, whole = 4 * texture.mean_luminance;
  words_.resize(height_ + 1 + std::size_t{2} * height_ * (width_ + 1));
  for (std::uint32_t row = 0; row < height_; ++row) {
    double* sums = &words_[height_ + 1 + std::size_t{2} * row * (width_ + 1)];
    double p = 0, pp = 0;
    for (std::uint32_t column = 0; column <= width_; ++column) {
      sums[std::size_t{2} * column] = p;
      sums[std::size_t{2} * column + 1] = pp;
      if (column == width_) break;
      const double rise = texture.luminance[std::size_t{height_ - 1 - row} * width_ + column] / whole * step;
      pp += (p + rise / 2) * step;
      p += rise;
    }
    words_[row + 1] = words_[row] + p * row_height;
  }
  words_[height_] = 1;  // exactly, so that a full turn adds 0
  brightest_ = *std::ranges::max_element(texture.luminance) / texture.mean_luminance;
}

double TextureWeights::below(double y) const {
  const double at = (y + 1) / 2 * height_;
  const std::uint32_t row = cell_of(at, height_);
  return glm::mix(words_[row], words_[row + 1], std::clamp(at - row, 0.0, 1.0));
}

glm::dvec2 TextureWeights::row_sums(std::uint32_t row, double x) const {
  const double step = 2.0 / width_, at = (x + 1) / step;
  const std::uint32_t column = cell_of(at, width_);
  const double* sums = &words_[height_ + 1 + std::size_t{2} * (std::size_t{row} * (width_ + 1) + column)];
  const double beyond = (at - column) * step, rise = (sums[2] - sums[0]) / step * beyond;
  return {sums[0] + rise, sums[1] + (sums[0] + rise / 2) * beyond};
}

double TextureWeights::left_of(const glm::dvec2& from, const glm::dvec2& to) const {
  const glm::dvec2 &low = from.y < to.y ? from : to, &high = from.y < to.y ? to : from;
  const double rows = 0.5 * height_, rise = high.y - low.y;
  if (!(rise > 0)) return 0;
  const std::uint32_t last = cell_of((high.y + 1) * rows, height_);
  glm::dvec2 at = low;
  double sum = 0;
  for (std::uint32_t row = std::min(cell_of((low.y + 1) * rows, height_), last); row <= last; ++row) {
    glm::dvec2 next = high;
    if (row < last) {
      next.y = std::min((row + 1) / rows - 1, high.y);
      next.x = low.x + (high.x - low.x) * ((next.y - low.y) / rise);
    }
    const double wide = next.x - at.x;
    // Mean of P over x: the difference of PP, unless that cancels.
    const double mean = std::abs(wide) > 0x1p-20 ? (row_sums(row, next.x).y - row_sums(row, at.x).y) / wide
                                                 : row_sums(row, 0.5 * (at.x + next.x)).x;
    sum += mean * (next.y - at.y);
    at = next;
  }
  return from.y < to.y ? sum : -sum;
}

double TextureWeights::along_rim(double position) const {
  return position < 2 ? below(position - 1) : 1;
}

double TextureWeights::beyond(const Edge& edge, const glm::dvec2& reference) const {
  const double first = rim_position(reference, edge.from), last = rim_position(reference, edge.to);
  double along = last - first;  // the rim's length is 8
  // An edge whose ends are less than 90° apart passes at most 6 of the rim's length 8: it passes at most one of the
  // four axis directions. The rest of the turn passes three neighbouring ones, between which there is a whole side of
  // the square. So if one of `along` and `along` ± 8 is below 1 in magnitude, it is right, whatever its rounded sign;
  // otherwise the sign of `along` is certain.
  if (glm::dot(edge.from - reference, edge.to - reference) > 0 && std::abs(std::remainder(along, 8.0)) < 1) {
    along = std::remainder(along, 8.0);
  } else {
    along += edge.side > 0 && along < 0 ? 8 : edge.side < 0 && along > 0 ? -8 : 0;
  }
  const double round_trips = std::round((along - (last - first)) / 8);
  return along_rim(last) - along_rim(first) + round_trips - left_of(edge.from, edge.to);
}

double TextureWeights::weight_beyond(const Edge& edge, const glm::dvec2& reference) const {
  return beyond(edge, reference) + left_of(edge.from, rim_point(rim_position(reference, edge.from))) -
         left_of(edge.to, rim_point(rim_position(reference, edge.to)));
}

double TextureWeights::weight_of(std::span<const glm::dvec2> polygon) const {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) sum += left_of(polygon[i], polygon[(i + 1) % polygon.size()]);
  return sum;
}

}  // namespace penumbra::volumes
