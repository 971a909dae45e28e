// SPDX-License-Identifier: Apache-2.0
// Light samples that a triangle hides from a view sample: Eisemann and Décoret 2007, section 4; planes instead of a
// projection as in Sintorn, Eisemann and Assarsson 2008, section 4.3 (for lights that are not planar): no division, and
// no clipping.

#include "engines/pairs/blocked_samples.hpp"

#include "visibility/pair_truth.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engines/pairs/blocked_samples.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#ifndef PENUMBRA_PAIRS_HALF_SPACES
#define PENUMBRA_PAIRS_HALF_SPACES
namespace penumbra::pairs {

/// The half-space normal · w + offset ≥ 0, evaluated with an error below `error`.
struct HalfSpace {
  glm::dvec3 normal{0};
  double offset = 0, error = 0;
};
using HalfSpaces = std::array<HalfSpace, 4>;

struct HalfSpaceBits {
  std::uint32_t inside = 0, open = 0;
};

}  // namespace penumbra::pairs
#endif

HWY_BEFORE_NAMESPACE();
namespace penumbra::pairs::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Classifies 32 light samples: those certainly inside all half-spaces, and those that are neither certainly inside all
/// nor certainly outside of one.
HalfSpaceBits in_all_here(const HalfSpaces& spaces, const double* directions, std::size_t stride) {
  const hn::CappedTag<double, 8> d;
  const std::size_t lanes = hn::Lanes(d);
  HalfSpaceBits bits;
  for (std::size_t i = 0; i < 32; i += lanes) {
    const auto x = hn::LoadU(d, directions + i), y = hn::LoadU(d, directions + stride + i),
               z = hn::LoadU(d, directions + 2 * stride + i);
    auto least = hn::Set(d, 1.0);  // positive: certainly inside all; 0: open; negative: outside of one
    auto certain = hn::Set(d, 1.0);
    for (const HalfSpace& space : spaces) {
      const auto value = hn::MulAdd(hn::Set(d, space.normal.x), x,
                                    hn::MulAdd(hn::Set(d, space.normal.y), y,
                                               hn::MulAdd(hn::Set(d, space.normal.z), z, hn::Set(d, space.offset))));
      const auto error = hn::Set(d, space.error);
      least = hn::Min(least, hn::Add(value, error));
      certain = hn::Min(certain, hn::Sub(value, error));
    }
    const auto zero = hn::Zero(d);
    std::uint8_t inside[8] = {}, possible[8] = {};
    hn::StoreMaskBits(d, hn::Gt(certain, zero), inside);
    hn::StoreMaskBits(d, hn::Ge(least, zero), possible);
    const auto in = static_cast<std::uint32_t>(inside[0]), may = static_cast<std::uint32_t>(possible[0]);
    bits.inside |= in << i;
    bits.open |= (may & ~in) << i;
  }
  return bits;
}

}  // namespace
}  // namespace penumbra::pairs::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::pairs {
namespace {

HWY_EXPORT(in_all_here);

/// Whether all, or none, of a box's w are certainly in a half-space.
struct BoxSide {
  bool all = false, none = false;
};
BoxSide side_of(const HalfSpace& space, const glm::dvec3& middle, const glm::dvec3& half) {
  const double at = glm::dot(space.normal, middle) + space.offset, reach = glm::dot(glm::abs(space.normal), half);
  return {at - reach > 2 * space.error, at + reach < -2 * space.error};
}

}  // namespace

BlockedSamples::BlockedSamples(const visibility::Light& light)
    : light_(&light), padded_((light.points.size() + 31) / 32 * 32), directions_(3 * padded_) {
  if (!light.sun) origin_ = glm::dvec3(light.points.front());
  glm::dvec3 lower(std::numeric_limits<double>::max()), upper(-lower);
  for (std::size_t j = 0; j < padded_; ++j) {
    const glm::dvec3 w = glm::dvec3(light.points[std::min(j, light.points.size() - 1)]) - origin_;
    lower = glm::min(lower, w);
    upper = glm::max(upper, w);
    farthest_ = std::max(farthest_, glm::length(w));
    for (int axis = 0; axis < 3; ++axis) directions_[static_cast<std::size_t>(axis) * padded_ + j] = w[axis];
  }
  middle_ = 0.5 * (lower + upper);
  half_ = 0.5 * (upper - lower) * (1 + 0x1p-40);
}

void BlockedSamples::hide(const glm::vec3& p, const std::array<glm::vec3, 3>& corners, std::span<std::uint32_t> visible,
                          PairCounts& counts, std::size_t first_word) const {
  ++counts.triangles;
  const glm::dvec3 at(p), to_origin = light_->sun ? glm::dvec3(0) : origin_ - at;
  const std::array d{glm::dvec3(corners[0]) - at, glm::dvec3(corners[1]) - at, glm::dvec3(corners[2]) - at};
  const std::array length{glm::length(d[0]), glm::length(d[1]), glm::length(d[2])};
  const double direction = farthest_ + glm::length(to_origin);
  const glm::dvec3 first(corners[0]), e1 = glm::dvec3(corners[1]) - first, e2 = glm::dvec3(corners[2]) - first;
  const glm::dvec3 normal = glm::cross(e1, e2);
  // p's side of the plane; the half-spaces for the light's side below have the same normal.
  const double normal_error = kDeterminant * glm::length(e1) * glm::length(e2), height = -glm::dot(normal, d[0]);
  const bool certain = std::abs(height) > normal_error * length[0];
  const double turn = height < 0 ? 1 : -1;  // D has the opposite sign of height

  HalfSpaces spaces;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    const glm::dvec3 n = turn * glm::cross(d[i], d[next]);
    spaces[i] = {n, glm::dot(n, to_origin), kDeterminant * direction * length[i] * length[next]};
  }
  const glm::dvec3 from = light_->sun ? glm::dvec3(0) : origin_ - first;
  spaces[3] = {turn * normal, turn * glm::dot(normal, from), normal_error * (farthest_ + glm::length(from))};
  std::array<BoxSide, 4> sides;
  std::ranges::transform(spaces, sides.begin(), [&](const HalfSpace& space) { return side_of(space, middle_, half_); });
  if (!certain) {
    // All three half-spaces may have the wrong orientation, but have the same one: the triangle is certainly missed if
    // the whole light is inside of one and outside of another.
    const auto edges = std::span(sides).first(3);
    if (std::ranges::any_of(edges, &BoxSide::all) && std::ranges::any_of(edges, &BoxSide::none)) {
      ++counts.missed;
      return;
    }
    for (std::size_t word = 0; word < visible.size(); ++word)
      decide(p, corners, first_word + word, visible[word], visible[word], counts);
    return;
  }
  if (std::ranges::any_of(sides, &BoxSide::none)) {
    ++counts.missed;
    return;
  }
  if (std::ranges::all_of(sides, &BoxSide::all)) {
    ++counts.covered;
    std::ranges::fill(visible, 0U);
    return;
  }
  const auto in_all = HWY_DYNAMIC_DISPATCH(in_all_here);
  for (std::size_t word = 0; word < visible.size(); ++word) {
    if (visible[word] == 0) continue;
    const std::size_t number = first_word + word;
    const HalfSpaceBits bits = in_all(spaces, &directions_[32 * number], padded_);
    counts.pairs += 32;
    visible[word] &= ~bits.inside;
    const std::uint32_t open = bits.open & visible[word];
    if (open != 0) decide(p, corners, number, open, visible[word], counts);
  }
}

void BlockedSamples::decide(const glm::vec3& p, const std::array<glm::vec3, 3>& corners, std::size_t word,
                            std::uint32_t open, std::uint32_t& visible, PairCounts& counts) const {
  for (; open != 0; open &= open - 1) {
    const auto bit = static_cast<std::uint32_t>(std::countr_zero(open));
    ++counts.exact;
    if (visibility::segment_meets_triangle(p, light_->points[32 * word + bit], corners, *light_).meets)
      visible &= ~(1U << bit);
  }
}

}  // namespace penumbra::pairs
#endif
