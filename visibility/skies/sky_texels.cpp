// SPDX-License-Identifier: Apache-2.0
// Integrals of a picture in latitude and longitude along great circles, by prefix sums and closed forms: Green's
// theorem on the sphere. Not from a paper; for one radiance it becomes Lambert's sum
// (visibility/lights/form_factor.hpp).

#include "visibility/skies/sky_texels.hpp"

#include "base/memory.hpp"
#include "visibility/skies/sky_walk.hpp"

#include <glm/geometric.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace penumbra::visibility {

using std::numbers::pi;

namespace {

/// Fewer columns would make azimuths ambiguous: an arc, whose azimuths differ by less than π, crosses less than half of
/// the columns and one.
constexpr std::size_t kFewestColumns = 8;

}  // namespace

SkyArc::SkyArc(const glm::dvec3& from, const glm::dvec3& to) : a(glm::normalize(from)), b(glm::normalize(to)) {
  const glm::dvec3 across = glm::cross(a, b);
  const double length = glm::length(across);
  if (!(length > 0)) return;
  axis = across / length;
  along = glm::cross(axis, a);
  is_empty = axis.z == 0;
}

double SkyArc::turn_of(const glm::dvec3& direction) const {
  return std::atan2(glm::dot(direction, along), glm::dot(direction, a));
}

SkyTexels::SkyTexels(const scenes::Texture& picture, bool half) {
  const std::size_t copies = picture.width < kFewestColumns ? (kFewestColumns - 1) / picture.width + 1 : 1;
  columns_ = picture.width * copies;
  width_ = 2 * pi / static_cast<double>(columns_);
  // Rows that are above z = 0 at least in part, and for half a dome a black one below.
  const std::size_t lit = half ? (std::size_t{picture.height} + 1) / 2 : picture.height;
  rows_ = half ? lit + 1 : lit;
  blocks_ = (rows_ + kStep - 1) / kStep;
  require_memory(columns_ * (rows_ * sizeof(glm::vec3) + blocks_ * sizeof(Sums)), "the sums of a sky's picture",
                 "take a smaller picture");
  for (std::size_t row = 0; row <= rows_; ++row) {
    const bool level = half ? row == lit : 2 * row == rows_;
    const double latitude = level          ? 0
                            : row == 0     ? pi / 2
                            : row == rows_ ? -pi / 2
                                           : pi * (0.5 - static_cast<double>(row) / picture.height);
    const double z = row == 0 ? 1 : row == rows_ ? -1 : std::sin(latitude);
    const double flat = row == 0 || row == rows_ ? 0 : std::cos(latitude);
    const double slope = flat > 0 ? z / flat : z * std::numeric_limits<double>::infinity();
    borders_.push_back({slope, latitude, z, flat, (z * flat + latitude) / 2});
  }
  for (std::size_t column = 0; column <= columns_; ++column) {
    const double azimuth = width_ * static_cast<double>(column % columns_);
    meridians_.emplace_back(std::cos(azimuth), std::sin(azimuth));
  }
  colors_.resize(columns_ * rows_);
  sums_.resize(columns_ * blocks_);
  columns_whole_.resize(columns_);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, columns_, 16), [&](const auto& range) {
    for (std::size_t column = range.begin(); column != range.end(); ++column) {
      const std::size_t x = (columns_ - 1 - column) / copies;
      for (std::size_t row = 0; row < lit; ++row)
        colors_[column * rows_ + row] = picture.texels[row * picture.width + x];
      Sums sums;
      for (std::size_t row = 0; row < rows_; ++row) {
        if (row % kStep == 0) sums_[column * blocks_ + row / kStep] = sums;
        add_row(sums, column, row);
      }
      columns_whole_[column] = sums;
    }
  });
  up_to_.emplace_back(0.0);
  for (std::size_t column = 0; column < columns_; ++column) {
    const glm::dvec2 turn = meridians_[column + 1] - meridians_[column];
    const Sums& sums = columns_whole_[column];
    SkyFlux flux = up_to_.back();
    for (int color = 0; color < 3; ++color)
      flux[color] += glm::dvec3(sums.level[color] * turn.y, -sums.level[color] * turn.x, sums.upward[color] * width_);
    up_to_.push_back(flux);
  }
  double all = 0;
  for (std::size_t row = 0; row < lit; ++row) {
    double sum = 0;
    for (std::size_t column = 0; column < columns_; ++column) {
      sum += luminance_of(radiance(column, row));
    }
    all += sum * (borders_[row].z - borders_[row + 1].z);
  }
  mean_ = all / static_cast<double>(columns_) / (half ? 1 : 2);
}

void SkyTexels::add_row(Sums& sums, std::size_t column, std::size_t row) const {
  const Border &upper = borders_[row], &lower = borders_[row + 1];
  const glm::dvec3 color = radiance(column, row);
  sums.level += (upper.a - lower.a) * color;
  sums.upward += 0.5 * (upper.z - lower.z) * (upper.z + lower.z) * color;
}

SkyTexels::Texel SkyTexels::texel(const SkyCell& cell, SkyPole pole) const {
  const auto& [column, row] = cell;
  const std::size_t block = row / kStep;
  Sums sums = sums_[column * blocks_ + block];
  for (std::size_t above = block * kStep; above < row; ++above) add_row(sums, column, above);
  const Border& upper = borders_[row];
  Texel texel{radiance(column, row), sums.level, sums.upward};
  texel.k1 += upper.a * texel.radiance;
  texel.k2 -= 0.5 * upper.flat * upper.flat * texel.radiance;
  if (pole == SkyPole::north) return texel;
  texel.k1 -= columns_whole_[column].level;
  texel.k2 -= columns_whole_[column].upward;
  return texel;
}

double SkyTexels::add_part(const SkyCell& cell, SkyPole pole, const SkyPoint& from, const SkyPoint& to,
                           const glm::dvec3& axis, SkyFlux& flux) const {
  const auto& [radiance, k1, k2] = texel(cell, pole);
  const double sine = to.sine - from.sine, cosine = to.cosine - from.cosine;
  const double high_sine = 0.5 * (to.latitude * to.sine - from.latitude * from.sine);
  const double high_cosine = 0.5 * (to.latitude * to.cosine - from.latitude * from.cosine);
  const double across = to.across - from.across, turn = 0.5 * (to.turn - from.turn);
  for (int color = 0; color < 3; ++color) {
    const double c = radiance[color];
    flux[color] += c * turn * axis + glm::dvec3(k1[color] * sine - c * high_sine, c * high_cosine - k1[color] * cosine,
                                                k2[color] * across);
  }
  return 2 * turn * luminance_of(radiance);
}

double SkyTexels::across_of(std::size_t column, double cosine, double sine) const {
  const glm::dvec2& left = meridians_[column];
  return std::atan2(sine * left.x - cosine * left.y, cosine * left.x + sine * left.y);
}

SkyPoint SkyTexels::point_of(const SkyArc& arc, const glm::dvec3& direction, std::size_t column) const {
  const double flat = std::hypot(direction.x, direction.y);
  SkyPoint point;
  if (flat > 0) {
    point.cosine = direction.x / flat;
    point.sine = direction.y / flat;
  } else {  // a pole, which has any azimuth
    point.cosine = meridians_[column].x;
    point.sine = meridians_[column].y;
  }
  point.latitude = std::atan2(direction.z, flat);
  point.across = across_of(column, point.cosine, point.sine);
  point.turn = arc.turn_of(direction);
  return point;
}

SkyTexels::Place SkyTexels::place_of(const SkyArc& arc, const glm::dvec3& direction) const {
  const double azimuth = std::atan2(direction.y, direction.x), flat = std::hypot(direction.x, direction.y);
  Place place;
  const double column = std::floor((azimuth < 0 ? azimuth + 2 * pi : azimuth) / width_);
  place.cell.column = std::min(static_cast<std::size_t>(std::max(column, 0.0)), columns_ - 1);
  place.point = point_of(arc, direction, place.cell.column);
  place.slope = flat > 0 ? direction.z / flat : direction.z * std::numeric_limits<double>::infinity();
  const auto below = std::ranges::upper_bound(borders_, place.slope, std::greater<>(), &Border::slope);
  place.cell.row = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(below - borders_.begin() - 1, 0, static_cast<std::ptrdiff_t>(rows_) - 1));
  return place;
}

double SkyTexels::integrate(const SkyArc& arc, SkyPole pole, SkyFlux& flux) const {
  double exposure = 0;
  walk(arc, [&](const SkyCell& cell, const SkyPoint& from, const SkyPoint& to) {
    exposure += add_part(cell, pole, from, to, arc.axis, flux);
  });
  return exposure;
}

SkyFlux SkyTexels::wedge(double azimuth) const {
  const auto column =
      static_cast<std::size_t>(std::clamp(std::floor(azimuth / width_), 0.0, static_cast<double>(columns_ - 1)));
  SkyFlux flux = up_to_[column];
  const Sums& sums = columns_whole_[column];
  const double across = azimuth - width_ * static_cast<double>(column);
  const glm::dvec2 turn = glm::dvec2(std::cos(azimuth), std::sin(azimuth)) - meridians_[column];
  for (int color = 0; color < 3; ++color)
    flux[color] += glm::dvec3(sums.level[color] * turn.y, -sums.level[color] * turn.x, sums.upward[color] * across);
  return flux;
}

}  // namespace penumbra::visibility
