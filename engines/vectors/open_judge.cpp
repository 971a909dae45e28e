// SPDX-License-Identifier: Apache-2.0
// Exact decisions, for methods on vector units, about light samples that float arithmetic left open.

#include "engines/vectors/open_judge.hpp"

#include "visibility/sphere_point.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>

namespace penumbra::vectors {

std::uint32_t ExactOpenJudge::depth(const GridSample& sample, std::uint32_t light_sample) {
  ++pairs_;
  return judge_.depth(sample.pixel, light_point(sample, light_sample));
}

glm::vec3 ExactOpenJudge::light_point(const GridSample& sample, std::uint32_t light_sample) {
  if (!is_body(judge_.light.kind)) return judge_.light.points[light_sample];
  if (!seen_ || seen_->pixel != sample.pixel)
    seen_ = {sample.pixel, visibility::light_frame_from(judge_.light, judge_.samples.p[sample.pixel])};
  return visibility::sphere_point(seen_->disk, judge_.light.coordinates[light_sample]);
}

glm::dvec3 ExactOpenJudge::direction_to(const GridSample& sample, std::uint32_t light_sample) {
  return visibility::direction_to(judge_.light, judge_.samples.p[sample.pixel], light_point(sample, light_sample));
}

std::optional<std::uint32_t> ExactOpenJudge::depth_in_plane(const GridSample& sample, const glm::dvec2& st) {
  ++pairs_;
  return judge_.depth_in_plane(sample.pixel, st);
}

HorizonLine ExactOpenJudge::horizon(const GridSample& sample) {
  const auto carrier = static_cast<std::uint32_t>(judge_.samples.triangle[sample.pixel]);
  const auto corners = judge_.scene.corners(carrier);
  const glm::dvec3 a(corners[0]);
  const auto [center, u, v] = visibility::light_frame_from(judge_.light, judge_.samples.p[sample.pixel]);
  const glm::dvec3 e1 = glm::dvec3(corners[1]) - a, e2 = glm::dvec3(corners[2]) - a;
  const glm::dvec3 n = glm::cross(e1, e2) * static_cast<double>(judge_.samples.facing[sample.pixel]);
  const glm::dvec3 from = judge_.light.sun ? center : center - a;
  // A determinant of three differences (certain_meeting.cpp) has an error below 2⁻⁴⁶ of the product of their lengths.
  const double lengths = 0x1p-46 * glm::length(e1) * glm::length(e2);
  return {{glm::dot(n, u), glm::dot(n, v), glm::dot(n, from)},
          lengths * glm::dvec3(glm::length(u), glm::length(v), glm::length(from))};
}

glm::dvec3 ExactOpenJudge::normal_towards(const GridSample& sample, std::uint32_t triangle) {
  const auto corners = judge_.scene.corners(triangle);
  const glm::dvec3 a(corners[0]), e1 = glm::dvec3(corners[1]) - a, e2 = glm::dvec3(corners[2]) - a;
  const glm::dvec3 n = glm::cross(e1, e2);  // off by up to 2⁻⁵⁰ |e1| |e2|: its direction is known to a thousandth
  if (!(glm::length(n) > 0x1p-40 * glm::length(e1) * glm::length(e2))) return glm::dvec3(0);
  const mesh::Side side = mesh::side_of_plane(corners[0], corners[1], corners[2], judge_.samples.p[sample.pixel]);
  return side == mesh::Side::front ? n : side == mesh::Side::back ? -n : glm::dvec3(0);
}

void ExactOpenJudge::decide(const GridSample& sample, const Open& open, SampleMask& mask) {
  ++pixels_;
  const auto each = [&](const std::vector<std::uint32_t>& numbers, const auto& visit) {
    numbers_ = numbers;
    std::sort(numbers_.begin(), numbers_.end());
    numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
    for (const std::uint32_t number : numbers_) visit(number);
  };
  if (open.pixel) {
    for (std::uint32_t one = 0; one < grid_.sample_count; ++one) decide_one(sample, one, mask);
  } else {
    each(open.rows, [&](std::uint32_t row) { decide_row(sample, row, mask); });
    each(open.samples, [&](std::uint32_t one) { decide_one(sample, one, mask); });
  }
  mask.visible = 0;
  for (std::size_t i = 0; i < mask_words(grid_); ++i)
    mask.visible += static_cast<std::uint32_t>(std::popcount(mask.bits[i]));
}

void ExactOpenJudge::decide_row(const GridSample& sample, std::uint32_t row, SampleMask& mask) {
  for (std::uint32_t column = 0; column < grid_.columns; ++column)
    decide_one(sample, row * grid_.columns + column, mask);
}

void ExactOpenJudge::decide_one(const GridSample& sample, std::uint32_t light_sample, SampleMask& mask) {
  ++pairs_;
  const std::size_t at = mask_bit(grid_, light_sample);
  std::uint16_t& word = mask.bits[at / 16];
  const std::uint32_t bit = 1U << at % 16;
  const bool visible = judge_.is_visible(sample.pixel, light_point(sample, light_sample));
  word = static_cast<std::uint16_t>(visible ? word | bit : word & ~bit);
}

}  // namespace penumbra::vectors
