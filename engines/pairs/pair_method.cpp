// SPDX-License-Identifier: Apache-2.0
// Base of methods that start from all pairs of a view sample and a light sample and remove the hidden ones.

#include "engines/pairs/pair_method.hpp"

#include "base/assert.hpp"
#include "visibility/lights/horizon.hpp"
#include "visibility/receivers.hpp"
#include "visibility/masks/visible_share.hpp"

#include <glm/common.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

namespace penumbra::pairs {
namespace {

constexpr std::size_t kMostMaskBytes = std::size_t{256} << 20U;  // bytes of a tile's masks

}  // namespace

PairMethod::PairMethod(visibility::MethodDescription description, std::string pass)
    : description_(std::move(description)), pass_(std::move(pass)) {}

void PairMethod::prepare_mesh(const visibility::SceneFloats& scene) {
  scene_ = &scene;
  light_ = nullptr;
  tree_ = visibility::make_triangle_tree(scene);
}

void PairMethod::prepare_light(const visibility::Light& light) {
  PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first: {}", light.name);
  visibility::check_light(description_, light);
  light_ = &light;
  order_ = light_order(light);
  if (!order_.empty()) {
    sorted_ = light;
    for (std::size_t i = 0; i < order_.size(); ++i) {
      sorted_.points[i] = light.points[order_[i]];
      if (!light.weights.empty()) sorted_.weights[i] = light.weights[order_[i]];
    }
    light_ = &sorted_;
  }
  bounds_ = visibility::point_bounds(light);
  blocked_ = BlockedSamples(*light_);
  words_ = light.words_per_mask();
  full_.assign(words_, 0xffffffffU);
  if (light.sample_count() % 32 != 0) full_.back() = (1U << light.sample_count() % 32) - 1;
  counters_.clear();
  prepare_casters();
}

std::uint32_t PairMethod::max_tile_rows() const {
  PENUMBRA_ASSERT(samples_ != nullptr && light_ != nullptr, "prepare_light and prepare_view come first");
  const std::size_t row_bytes = std::max<std::size_t>(std::size_t{samples_->width} * words_ * 4, 1);
  return static_cast<std::uint32_t>(
      std::clamp<std::size_t>(kMostMaskBytes / row_bytes, 1, std::max(1U, samples_->height)));
}

/// Decides conditions (1) and (2) of the truth of a pair, exactly.
void PairMethod::start(std::size_t pixel) {
  const std::span<std::uint32_t> mask = visible(static_cast<std::uint32_t>(pixel));
  if (!visibility::is_receiver(*scene_, *light_, *samples_, pixel)) {
    std::ranges::copy(full_, mask.begin());
    return;
  }
  const auto carrier = static_cast<std::uint32_t>(samples_->triangle[pixel]);
  if (!visibility::in_front_of_light(*light_, samples_->p[pixel])) {
    std::ranges::fill(mask, 0U);
    return;
  }
  const visibility::HorizonTest horizon(*light_, scene_->corners(carrier), samples_->facing[pixel], bounds_);
  if (horizon.all_above()) {
    std::ranges::copy(full_, mask.begin());
  } else {
    horizon.mask(light_->points, mask);
  }
}

void PairMethod::evaluate(const visibility::Tile& tile) {
  PENUMBRA_ASSERT(samples_ != nullptr && light_ != nullptr, "prepare_light and prepare_view come first");
  PENUMBRA_ASSERT(tile.first_row + tile.row_count <= samples_->height, "rows {} + {} of {}", tile.first_row,
                  tile.row_count, samples_->height);
  const auto begin = std::chrono::steady_clock::now();
  first_pixel_ = std::size_t{tile.first_row} * samples_->width;
  const std::size_t count = std::size_t{tile.row_count} * samples_->width;
  masks_.resize(count * words_);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 256), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) start(first_pixel_ + i);
  });
  std::vector<std::uint32_t> pixels;
  for (std::size_t pixel = first_pixel_; pixel < first_pixel_ + count; ++pixel) {
    const auto number = static_cast<std::uint32_t>(pixel);
    if (visibility::is_receiver(*scene_, *light_, *samples_, pixel) && sees_something(number)) pixels.push_back(number);
  }
  if (!pixels.empty() && !tree_.nodes.empty()) block(pixels, counters_);
  milliseconds_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

visibility::Bounds PairMethod::towards_light(const visibility::Bounds& box) const {
  if (!light_->sun) return {glm::min(box.lower, bounds_.lower), glm::max(box.upper, bounds_.upper)};
  visibility::Bounds bounds = box;
  for (int axis = 0; axis < 3; ++axis) {  // rays have no end
    if (bounds_.lower[axis] < 0) bounds.lower[axis] = -std::numeric_limits<float>::infinity();
    if (bounds_.upper[axis] > 0) bounds.upper[axis] = std::numeric_limits<float>::infinity();
  }
  return bounds;
}

void PairMethod::try_all(std::uint32_t pixel, PairCounts& counts) {
  const glm::vec3& p = samples_->p[pixel];
  for_each_towards_light(p, p, [&](std::uint32_t triangle) { hide(triangle, pixel, counts); });
}

void PairMethod::add(const PairCounts& counts) {
  counters_["trianglesTried"] += counts.triangles;
  counters_["trianglesBesideLight"] += counts.missed;
  counters_["trianglesOverLight"] += counts.covered;
  counters_["pairsTried"] += counts.pairs;
  counters_["pairsByExactPredicates"] += counts.exact;
}

void PairMethod::read_masks(std::span<std::uint32_t> masks) {
  PENUMBRA_ASSERT(masks.size() == masks_.size(), "{} words asked for, {} evaluated", masks.size(), masks_.size());
  if (order_.empty()) {
    std::ranges::copy(masks_, masks.begin());
    return;
  }
  std::ranges::fill(masks, 0U);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, masks.size() / words_, 256), [&](const auto& range) {
    for (std::size_t pixel = range.begin(); pixel < range.end(); ++pixel) {
      for (std::size_t i = 0; i < order_.size(); ++i) {
        const std::uint32_t bit = masks_[pixel * words_ + i / 32] >> i % 32 & 1;
        masks[pixel * words_ + order_[i] / 32] |= bit << order_[i] % 32;
      }
    }
  });
}

void PairMethod::read_visibility(std::span<float> visibility) {
  visibility::visible_shares(*light_, masks_, visibility);
}

std::vector<visibility::PassTime> PairMethod::take_pass_times() {
  return {{pass_, std::exchange(milliseconds_, 0)}};
}

std::uint64_t PairMethod::memory_bytes() const {
  return tree_.nodes.size() * sizeof(tree_.nodes[0]) + tree_.leaves.size() * sizeof(tree_.leaves[0]) +
         masks_.capacity() * sizeof(masks_[0]);
}

}  // namespace penumbra::pairs
