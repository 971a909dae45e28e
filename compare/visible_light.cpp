// SPDX-License-Identifier: Apache-2.0
// Computes equation 1.3 of Eisemann, Schwarz, Assarsson, Wimmer: Real-Time Shadows (2011), direct light on diffuse
// surfaces, from masks. Departures: instead of point samples, a visible cell counts with its form factor, and sums of
// samples are scaled by the known result of the whole light. Loops over 32 samples are written for automatic
// vectorisation.
#include "compare/visible_light.hpp"

#include "base/assert.hpp"
#include "visibility/lights/part_form_factors.hpp"
#include "visibility/skies/sky.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

namespace penumbra::compare {
namespace {

using visibility::Light;
using visibility::UnshadowedLight;

using Mask = std::span<const std::uint32_t>;

constexpr std::size_t kBlock = 32;  // samples in one word of a mask
constexpr std::size_t kLanes = 4;   // partial sums, so that additions are independent of one another

/// Factors 0 or 1 from the bits of four neighbouring samples.
constexpr auto kFactors = [] {
  std::array<std::array<double, kLanes>, 16> factors{};
  for (unsigned bits = 0; bits < 16; ++bits) {
    for (unsigned lane = 0; lane < kLanes; ++lane) factors[bits][lane] = bits >> lane & 1;
  }
  return factors;
}();

/// Light points of a block.
struct Block {
  const double *x, *y, *z;
};

/// Returns max(0, n · d) / d⁴ of the block's samples: cos θp · cos θl / d² up to a factor common to all.
std::array<double, kBlock> weigh(const glm::dvec3& p, const glm::dvec3& n, const Block& block) {
  const double *x = block.x, *y = block.y, *z = block.z;
  std::array<double, kBlock> weight;
  for (std::size_t j = 0; j < kBlock; ++j) {
    const double dx = x[j] - p.x, dy = y[j] - p.y, dz = z[j] - p.z;
    const double squared = dx * dx + dy * dy + dz * dz;
    // d = 0 makes the numerator 0 as well; float32 coordinates keep every other d⁴ above 1e-180.
    weight[j] = std::max(0.0, n.x * dx + n.y * dy + n.z * dz) / std::max(squared * squared, 1e-300);
  }
  return weight;
}

/// Returns a word whose bit j is set if n · d > 0.
std::uint32_t above_horizon(const glm::dvec3& p, const glm::dvec3& n, const Block& block) {
  std::array<double, kBlock> height;
  for (std::size_t j = 0; j < kBlock; ++j)
    height[j] = n.x * (block.x[j] - p.x) + n.y * (block.y[j] - p.y) + n.z * (block.z[j] - p.z);
  std::uint32_t bits = 0;
  for (std::size_t j = 0; j < kBlock; ++j) bits |= std::uint32_t{height[j] > 0} << j;
  return bits;
}

double sum_of(const std::array<double, kBlock>& weight, std::uint32_t bits) {
  std::array<double, kLanes> sum{};
  for (std::size_t j = 0; j < kBlock; j += kLanes) {
    const auto& factor = kFactors[bits >> j & 15];
    for (std::size_t lane = 0; lane < kLanes; ++lane) sum[lane] += weight[j + lane] * factor[lane];
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

glm::dvec3 sum_of(const std::array<double, kBlock>& weight, std::uint32_t bits, const glm::vec3* colors) {
  glm::dvec3 sum(0);
  for (; bits != 0; bits &= bits - 1) {
    const auto j = static_cast<std::size_t>(std::countr_zero(bits));
    sum += weight[j] * glm::dvec3(colors[j]);
  }
  return sum;
}

/// Returns the first sample from `from` on, before `end`, whose bit is `wanted`; otherwise `end`.
std::uint32_t find_bit(Mask mask, std::uint32_t from, std::uint32_t end, bool wanted) {
  while (from < end) {
    const std::uint32_t word = wanted ? mask[from / 32] : ~mask[from / 32];
    if (const std::uint32_t left = word >> from % 32; left != 0) {
      return std::min(end, from + static_cast<std::uint32_t>(std::countr_zero(left)));
    }
    from = (from / 32 + 1) * 32;
  }
  return end;
}

/// Returns the transmittance of all light samples in the mask, if they have the same; otherwise nullopt.
std::optional<float> shared_transmittance(Mask mask, std::span<const float> transmittances) {
  std::optional<float> shared;
  for (std::size_t j = 0; j < transmittances.size(); ++j) {
    if ((mask[j / 32] >> j % 32 & 1u) == 0) continue;
    if (shared && *shared != transmittances[j]) return std::nullopt;
    shared = transmittances[j];
  }
  return shared ? shared : std::optional(1.0F);  // empty mask: nothing is dimmed
}

std::vector<std::uint32_t> full_mask(std::uint32_t sample_count) {
  std::vector<std::uint32_t> mask((sample_count + 31) / 32, 0xffffffffu);
  if (sample_count % 32 != 0) mask.back() = (1u << sample_count % 32) - 1;
  return mask;
}

}  // namespace

VisibleLight::Points::Points(std::span<const glm::vec3> points)
    : x((points.size() + kBlock - 1) / kBlock * kBlock), y(x.size()), z(x.size()) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    x[i] = points[i].x;
    y[i] = points[i].y;
    z[i] = points[i].z;
  }
}

VisibleLight::VisibleLight(const Light& light)
    : light_(&light), points_(light.points), all_(full_mask(light.sample_count())) {}

glm::dvec3 VisibleLight::of_dome(const LitPoint& at, Mask mask, std::span<const float> transmittances) const {
  const glm::dvec3 n = at.seen.normal();
  double all = 0;
  glm::dvec3 some(0);
  for (std::size_t j = 0; j < light_->points.size(); ++j) {
    const double cosine = std::max(0.0, n.x * points_.x[j] + n.y * points_.y[j] + n.z * points_.z[j]);
    all += cosine;
    if ((mask[j / 32] >> j % 32 & 1u) == 0) continue;
    const double left = transmittances.empty() ? cosine : cosine * double{transmittances[j]};
    some += light_->dome->sky == nullptr ? glm::dvec3(left) : left * glm::dvec3(light_->sample_colors[j]);
  }
  // For a picture, only the light of its samples is known; for uniform radiance, the whole form factor is known.
  if (light_->dome->sky) return light_->dome->power / static_cast<double>(light_->sample_count()) * some;
  return all > 0 ? at.seen.whole() * (some / all) : glm::dvec3(0);
}

glm::dvec3 VisibleLight::unshadowed(const LitPoint& at) const {
  if (light_->dome && light_->dome->sky) return of_dome(at, all_);
  const double whole = at.seen.whole();
  if (!light_->texture || whole == 0) return glm::dvec3(whole);
  return of_samples(at, whole, all_);
}

glm::dvec3 VisibleLight::whole(const LitPoint& at) const {
  if (!light_->dome || !light_->dome->sky) return unshadowed(at);
  const visibility::Sky& sky = *light_->dome->sky;
  const glm::dvec3& n = at.seen.normal();
  return glm::max(sky.form_factor(sky.above(n), n), glm::dvec3(0));
}

glm::dvec3 VisibleLight::visible(const LitPoint& at, Mask mask, std::span<const float> transmittances) const {
  PENUMBRA_ASSERT(mask.size() == all_.size(), "{} words of {}", mask.size(), all_.size());
  if (light_->dome) return of_dome(at, mask, transmittances);
  if (!transmittances.empty()) {
    const std::optional<float> shared = shared_transmittance(mask, transmittances);
    if (shared) return static_cast<double>(*shared) * visible(at, mask);
    const double whole = at.seen.shines() ? at.seen.whole() : 0;
    return whole > 0 ? of_samples(at, whole, mask, transmittances) : glm::dvec3(0);
  }
  if (!sees_any(mask) || !at.seen.shines()) return glm::dvec3(0);
  if (sees_all(mask)) return unshadowed(at);
  const bool cells = is_parallelogram(light_->kind) && light_->rows != 0 && !light_->texture;
  const double whole = at.seen.whole();
  return cells ? of_runs(at, whole, mask) : of_samples(at, whole, mask);
}

bool VisibleLight::sees_all(Mask mask) const {
  std::uint32_t missing = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) missing |= ~mask[i] & all_[i];
  return missing == 0;
}

bool VisibleLight::sees_any(Mask mask) const {
  std::uint32_t some = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) some |= mask[i] & all_[i];
  return some != 0;
}

double VisibleLight::cell_border(std::uint32_t row, std::uint32_t column) const {
  if (column == 0) return -1;
  if (column == light_->columns) return 1;
  const double shift = light_->row_shift.empty() ? 0.0 : light_->row_shift[row];
  return 2 * (column + shift) / light_->columns - 1;
}

double VisibleLight::of_cells(const UnshadowedLight& seen, Mask mask) const {
  const std::uint32_t columns = light_->columns;
  const auto t = [&](std::uint32_t row) { return 2.0 * row / light_->rows - 1; };
  thread_local visibility::FourCorneredParts boxes;
  boxes.clear();
  const auto add_box = [&](const glm::dvec2& low, const glm::dvec2& high) {
    boxes.add({low, {high.x, low.y}, high, {low.x, high.y}});
  };
  std::uint32_t full = 0;  // number of completely visible rows just before this one: they form one rectangle
  const auto add_full = [&](std::uint32_t end) {
    if (full != 0) add_box({-1, t(end - full)}, {1, t(end)});
    full = 0;
  };
  for (std::uint32_t row = 0; row < light_->rows; ++row) {
    const std::uint32_t begin = row * columns, end = begin + columns;
    std::uint32_t from = find_bit(mask, begin, end, true), to = find_bit(mask, from, end, false);
    if (from == begin && to == end) {
      ++full;
      continue;
    }
    add_full(row);
    for (; from < end; from = find_bit(mask, to, end, true), to = find_bit(mask, from, end, false)) {
      add_box({cell_border(row, from - begin), t(row)}, {cell_border(row, to - begin), t(row + 1)});
    }
  }
  add_full(light_->rows);
  return std::max(0.0, visibility::sum_of_parts(seen, boxes));
}

glm::dvec3 VisibleLight::of_runs(const LitPoint& at, double whole, Mask mask) const {
  if (at.seen.above_horizon()) return glm::dvec3(of_cells(at.seen, mask));
  // A sample below the horizon is never visible: its cell does not count, though part of the cell may be above.
  std::vector<std::uint32_t> above(mask.begin(), mask.end());
  for (std::size_t word = 0; word < all_.size(); ++word) {
    const std::size_t i = word * kBlock;
    const Block block{&points_.x[i], &points_.y[i], &points_.z[i]};
    above[word] |= above_horizon(glm::dvec3(at.p), at.seen.normal(), block) & all_[word];
  }
  const double known = of_cells(at.seen, above);
  return glm::dvec3(known > 0 ? whole * (of_cells(at.seen, mask) / known) : 0.0);
}

glm::dvec3 VisibleLight::of_samples(const LitPoint& at, double whole, Mask mask,
                                    std::span<const float> transmittances) const {
  std::vector<glm::vec3> facing;  // points of a sphere
  if (is_body(light_->kind)) {
    facing.resize(light_->sample_count());
    visibility::light_points_for(*light_, at.p, facing.data());
  }
  const glm::dvec3 from = light_->sun ? glm::dvec3(0) : glm::dvec3(at.p);  // points are directions
  const Points own(facing);
  const Points& points = facing.empty() ? points_ : own;
  double all = 0, some = 0;
  glm::dvec3 colored(0);
  for (std::size_t word = 0; word < all_.size(); ++word) {
    const std::size_t i = word * kBlock;
    auto weight = weigh(from, at.seen.normal(), {&points.x[i], &points.y[i], &points.z[i]});
    const std::uint32_t bits = mask[word] & all_[word];
    all += sum_of(weight, all_[word]);
    const std::size_t dimmed = std::min(transmittances.size() - std::min(transmittances.size(), i), kBlock);
    for (std::size_t j = 0; j < dimmed; ++j) weight[j] *= double{transmittances[i + j]};
    if (light_->texture) {
      colored += sum_of(weight, bits, &light_->sample_colors[i]);
    } else {
      some += sum_of(weight, bits);
    }
  }
  if (!(all > 0)) return glm::dvec3(0);  // every sample is at or below the horizon
  return light_->texture ? whole / all * colored : glm::dvec3(whole * (some / all));
}

}  // namespace penumbra::compare
