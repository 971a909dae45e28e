// SPDX-License-Identifier: Apache-2.0
// Part of RayTraced: rays to a dome, for blocks of pixels. Directions with one answer for all pixels of a block are
// found first (CommonAnswers); packets are rays of neighbouring pixels in one direction.

#include "reference/ray_traced.hpp"

#include "visibility/lights/horizon.hpp"
#include "visibility/receivers.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace penumbra::reference {

using visibility::SceneFloats;
using visibility::Tile;

template <int kWidth>
void RayTraced::trace_neighbours(const Tile& tile, std::span<const std::size_t> pixels, Workspace& work) {
  const std::size_t words = light_->words_per_mask();
  const auto mask_of = [&](std::size_t lane) { return std::span(masks_).subspan(pixels[lane] * words, words); };
  std::array<std::uint32_t, kWidth> planes{};
  typename Packet<kWidth>::Rays rays{};
  work.above_all.assign(kWidth * words, 0);
  std::uint64_t above_count = 0, asked_count = 0, pairs = 0;
  const auto count_of = [](std::uint32_t word) { return static_cast<std::uint64_t>(std::popcount(word)); };
  std::size_t known = pixels.size();  // pixel whose horizon is in work.above
  for (std::size_t lane = 0; lane < pixels.size(); ++lane) {
    const std::size_t pixel = std::size_t{tile.first_row} * samples_->width + pixels[lane];
    if (!visibility::is_receiver(*scene_, *light_, *samples_, pixel)) {
      std::ranges::copy(full_mask_, mask_of(lane).begin());
      continue;
    }
    const auto carrier = static_cast<std::uint32_t>(samples_->triangle[pixel]);
    if (known == pixels.size() || samples_->triangle[pixel] != samples_->triangle[known] ||
        samples_->facing[pixel] != samples_->facing[known]) {
      visibility::HorizonTest(*light_, scene_->corners(carrier), samples_->facing[pixel], bounds_)
          .mask(light_->points, work.above);
    }
    known = pixel;
    for (std::size_t word = 0; word < words; ++word) {
      const std::uint32_t above = work.above[word], asked = above & ~(work.clear[word] | work.blocked[word]);
      above_count += count_of(above);
      asked_count += count_of(asked);
      mask_of(lane)[word] = above & work.clear[word];
      work.above_all[word * kWidth + lane] = asked;
    }
    pairs += light_->points.size();
    const glm::vec3 origin = embree_->range().scaled(samples_->p[pixel]);
    lanes(rays.org_x)[lane] = origin.x;
    lanes(rays.org_y)[lane] = origin.y;
    lanes(rays.org_z)[lane] = origin.z;
    lanes(rays.mask)[lane] = 0xffffffffu;
    lanes(rays.id)[lane] = static_cast<unsigned>(lane);
    planes[lane] = scene_->plane[carrier];
  }
  counts_.horizon_pairs.fetch_add(pairs - above_count, std::memory_order_relaxed);
  counts_.rays.fetch_add(asked_count, std::memory_order_relaxed);
  counts_.common_pairs.fetch_add(above_count - asked_count, std::memory_order_relaxed);

  PixelContext context = context_of(planes.data());
  alignas(64) int valid[kWidth] = {};
  for (std::size_t word = 0; word < words; ++word) {
    std::array<std::uint32_t, kWidth> asked{}, seen{};
    std::uint32_t left = 0;
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      asked[lane] = work.above_all[word * kWidth + lane];
      left |= asked[lane];
    }
    for (; left != 0; left &= left - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(left));
      const glm::vec3 direction = scaled_points_[32 * word + bit];
      for (std::size_t lane = 0; lane < kWidth; ++lane) {  // without branches, so that compilers vectorise the loop
        valid[lane] = -static_cast<int>(asked[lane] >> bit & 1U);
        lanes(rays.dir_x)[lane] = direction.x;
        lanes(rays.dir_y)[lane] = direction.y;
        lanes(rays.dir_z)[lane] = direction.z;
        lanes(rays.tfar)[lane] = std::numeric_limits<float>::infinity();
      }
      Packet<kWidth>::occluded(valid, embree_->handle(), &context.embree, &rays);
      for (std::size_t lane = 0; lane < kWidth; ++lane)
        seen[lane] |= static_cast<std::uint32_t>(lanes(rays.tfar)[lane] != kOccluded) << bit;
    }
    for (std::size_t lane = 0; lane < pixels.size(); ++lane) mask_of(lane)[word] |= seen[lane] & asked[lane];
  }
}

void RayTraced::find_common(const Tile& tile, const Block& block, Workspace& work) const {
  work.clear.assign(light_->words_per_mask(), 0);
  work.blocked.assign(light_->words_per_mask(), 0);
  std::uint32_t plane = SceneFloats::kNoPlane;
  visibility::Bounds box;
  bool is_flat = true;
  for (std::size_t row = block.top; row < block.bottom; ++row) {
    for (std::size_t x = block.left; x < block.right; ++x) {
      const std::size_t pixel = (tile.first_row + row) * samples_->width + x;
      if (!visibility::is_receiver(*scene_, *light_, *samples_, pixel)) continue;
      const glm::vec3& p = samples_->p[pixel];
      const std::uint32_t own = scene_->plane[static_cast<std::uint32_t>(samples_->triangle[pixel])];
      if (plane == SceneFloats::kNoPlane) {
        plane = own;
        box = {p, p};
      }
      is_flat = is_flat && plane == own;
      box = {glm::min(box.lower, p), glm::max(box.upper, p)};
    }
  }
  if (plane == SceneFloats::kNoPlane) return;
  common_answers_->add_blocked(box, work.blocked);
  if (!is_flat) return;
  for (std::size_t word = 0; word < work.clear.size(); ++word)
    work.clear[word] = full_mask_[word] & ~work.blocked[word];
  common_answers_->keep_clear(box, plane, work.clear);
}

template <int kWidth>
void RayTraced::trace_to_dome(const Tile& tile, const Block& block, Workspace& work) {
  constexpr std::size_t kRows = kWidth >= 16 ? 4 : kWidth >= 4 ? 2 : 1, kColumns = kWidth / kRows;
  find_common(tile, block, work);
  std::vector<std::size_t> neighbours;
  for (std::size_t top = block.top; top < block.bottom; top += kRows) {
    for (std::size_t left = block.left; left < block.right; left += kColumns) {
      neighbours.clear();
      for (std::size_t row = top; row < std::min(top + kRows, block.bottom); ++row) {
        for (std::size_t x = left; x < std::min(left + kColumns, block.right); ++x)
          neighbours.push_back(row * samples_->width + x);
      }
      trace_neighbours<kWidth>(tile, neighbours, work);
    }
  }
}

template void RayTraced::trace_to_dome<1>(const Tile& tile, const Block& block, Workspace& work);
template void RayTraced::trace_to_dome<4>(const Tile& tile, const Block& block, Workspace& work);
template void RayTraced::trace_to_dome<8>(const Tile& tile, const Block& block, Workspace& work);
template void RayTraced::trace_to_dome<16>(const Tile& tile, const Block& block, Workspace& work);

}  // namespace penumbra::reference
