// SPDX-License-Identifier: Apache-2.0
// The method `raytrace`: one shadow ray for each light sample; the first oracle.
//
// Conditions (1) and (2) of the truth of a pair (horizon, emitting side) are decided exactly; (3) is decided by Embree.
// The open segment p→l is the ray p + t (l − p), 0 < t < 1: Embree reports t > tnear = 0 and t ≤ tfar, so tfar is the
// largest float below 1 (for a sun, whose light points are directions, infinity). A filter function rejects hits on the
// carrying triangle and on triangles exactly coplanar with it, and on the light's own body: an offset origin would lose
// contact shadows. Triangles that cast no shadow are not in the scene. Scene and rays are scaled so that float32
// neither underflows nor overflows (EmbreeRange).

#include "reference/ray_traced.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "reference/methods.hpp"
#include "reference/tracing_order.hpp"
#include "visibility/lights/horizon.hpp"
#include "visibility/masks/visible_share.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/receivers.hpp"

#include <glm/common.hpp>

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace penumbra::reference {
namespace {

using visibility::Light;
using visibility::SceneFloats;
using visibility::Tile;

constexpr std::uint64_t kMaxMaskBytes = std::uint64_t{64} << 20;  // of one tile: an interrupt waits for the tile's end
constexpr std::uint32_t kNeverMet = SceneFloats::kNoPlane;        // plane index of the light's own body

constexpr visibility::ChoiceOption kPacket{
    "packet",
    {{"auto", 0}, {"1", 1}, {"4", 4}, {"8", 8}, {"16", 16}},
    0,
    "shadow rays traced together; auto: as many as the processor's vectors hold"};

visibility::MeshVerdict ray_traced_verdict(const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::approximate,
          visibility::reason_with("rays in single precision: a pair within rounding of an edge may be wrong (measured: "
                                  "at most 2 in 100,000)",
                                  mesh,
                                  {{mesh.needles.count, "needles, which make more such pairs"},
                                   {mesh.t_junctions.count, "T-junctions, which make more such pairs"},
                                   {mesh.zero_area_triangles.count, "triangles without area, which cast no shadow"}})};
}

}  // namespace

void RayTraced::ignore_own_plane(const RTCFilterFunctionNArguments* hits) {
  const auto& context = *reinterpret_cast<const PixelContext*>(hits->context);
  for (unsigned i = 0; i < hits->N; ++i) {
    if (hits->valid[i] == 0) continue;
    const std::uint32_t plane = context.plane_of_primitive[RTCHitN_primID(hits->hit, hits->N, i)];
    const std::uint32_t own = context.carrier_planes[RTCRayN_id(hits->ray, hits->N, i)];
    if (plane == own || plane == kNeverMet) hits->valid[i] = 0;
  }
}

RayTraced::PixelContext RayTraced::context_of(const std::uint32_t* carrier_planes) const {
  PixelContext context{};
  rtcInitIntersectContext(&context.embree);
  context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context.embree.filter = ignore_own_plane;
  context.plane_of_primitive = plane_of_primitive_.data();
  context.carrier_planes = carrier_planes;
  return context;
}

RayTraced::RayTraced(const visibility::MethodOptions& options) {
  description_.name = "raytrace";
  description_.family = visibility::Family::reference;
  description_.paper =
      "Wald et al., Embree: a kernel framework for efficient CPU ray tracing (2014); watertight edges after Woop et "
      "al. "
      "(2013)";
  description_.output = visibility::Output::mask;
  description_.exact_for = "every light and any triangle soup, up to rounding in Embree's robust ray-triangle test";
  description_.lights = visibility::kEveryLight;
  description_.span = {0, 0x1p45F};  // EmbreeRange refuses larger distances, and possibly slightly smaller ones
  description_.verdict_on = ray_traced_verdict;
  description_.options = {kPacket.description()};
  width_ = visibility::parse_options(description_, options)[kPacket];
}

void RayTraced::prepare_mesh(const SceneFloats& scene) {
  scene_ = &scene;
  light_ = nullptr;
  std::vector<std::uint32_t> casting;
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.casts_shadow[i] != 0) casting.push_back(i);
  }
  common_answers_.reset();
  embree_.reset();  // frees the old scene first, so that two are never in memory
  embree_.emplace(scene, std::move(casting), EmbreeScene::Filter::by_context);
}

void RayTraced::prepare_light(const Light& light) {
  PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first");
  visibility::check_light(description_, light);
  light_ = &light;
  plane_of_primitive_.clear();
  for (const std::uint32_t triangle : embree_->triangles()) {
    plane_of_primitive_.push_back(scene_->emits[triangle] == light.index ? kNeverMet : scene_->plane[triangle]);
  }
  order_ = tracing_order(light);
  full_mask_.assign(light.words_per_mask(), 0xffffffffu);
  if (light.sample_count() % 32 != 0) full_mask_.back() = (1u << (light.sample_count() % 32)) - 1;

  bounds_ = point_bounds(light);
  if (!light.sun) embree_->range().require_light(light, bounds_);
  scaled_points_.clear();
  for (const glm::vec3& point : light.points) {
    scaled_points_.push_back(light.sun ? EmbreeRange::direction(point) : embree_->range().scaled(point));
  }
  if (light.dome && !common_answers_)
    common_answers_.emplace(*scene_, light.points);
  else if (light.dome)
    common_answers_->set_directions(light.points);
  counts_.rays = counts_.short_rays = counts_.horizon_pairs = counts_.common_pairs = 0;
}

std::uint32_t RayTraced::max_tile_rows() const {
  if (samples_ == nullptr || light_ == nullptr) return 1;
  const std::uint64_t row_bytes = std::uint64_t{samples_->width} * light_->words_per_mask() * sizeof(std::uint32_t);
  const std::uint64_t rows = std::max<std::uint64_t>(1, kMaxMaskBytes / std::max<std::uint64_t>(1, row_bytes));
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(rows, std::max(1u, samples_->height)));
}

void RayTraced::decide_short_rays(std::size_t pixel, const std::vector<glm::vec3>& scaled,
                                  std::vector<std::uint32_t>& above, std::span<std::uint32_t> visible) {
  const glm::vec3 p = embree_->range().scaled(samples_->p[pixel]);
  for (std::uint32_t sample = 0; sample < scaled.size(); ++sample) {
    const std::uint32_t bit = 1u << (sample % 32);
    const glm::vec3 toward = glm::abs(scaled[sample] - p);
    if ((above[sample / 32] & bit) == 0 || std::max({toward.x, toward.y, toward.z}) >= embree_->range().shortest_ray())
      continue;
    above[sample / 32] &= ~bit;
    counts_.short_rays.fetch_add(1, std::memory_order_relaxed);
    const visibility::PairTruth truth = visibility::decide_pair(*scene_, *samples_, pixel, *light_, sample);
    if (truth.outcome == visibility::PairOutcome::visible) visible[sample / 32] |= bit;
  }
}

template <int kWidth>
void RayTraced::trace_pixel(std::size_t pixel, Workspace& work, std::span<std::uint32_t> visible) {
  if (!visibility::is_receiver(*scene_, *light_, *samples_, pixel)) {
    std::copy(full_mask_.begin(), full_mask_.end(), visible.begin());
    return;
  }
  const auto carrier = static_cast<std::uint32_t>(samples_->triangle[pixel]);
  const glm::vec3 p = samples_->p[pixel];
  const EmbreeRange& range = embree_->range();
  const bool sphere = is_body(light_->kind);
  if (sphere) {
    if (!in_front_of_light(*light_, p)) return;
    light_points_for(*light_, p, work.points.data());
    std::ranges::transform(work.points, work.scaled.begin(), [&](const glm::vec3& l) { return range.scaled(l); });
  }
  const std::vector<glm::vec3>& points = sphere ? work.points : light_->points;
  const std::vector<glm::vec3>& scaled_points = sphere ? work.scaled : scaled_points_;
  const glm::vec3 origin = range.scaled(p);
  const visibility::HorizonTest horizon(*light_, scene_->corners(carrier), samples_->facing[pixel], bounds_);
  horizon.mask(points, work.above);
  std::uint64_t above_count = 0;
  for (const std::uint32_t word : work.above) above_count += static_cast<std::uint64_t>(std::popcount(word));
  counts_.horizon_pairs.fetch_add(points.size() - above_count, std::memory_order_relaxed);
  if (above_count == 0 || !in_front_of_light(*light_, p)) return;
  const bool one_ray = light_->sun && light_->sun->tangent == 0;  // all light samples are the same direction
  const std::size_t count = one_ray ? 1 : points.size();
  counts_.rays.fetch_add(one_ray ? 1 : above_count, std::memory_order_relaxed);
  if (!light_->sun) {  // a sun's rays are always long enough
    const glm::vec3 nearest =
        glm::max(glm::max(range.scaled(bounds_.lower) - origin, origin - range.scaled(bounds_.upper)), 0.0f);
    if (std::max({nearest.x, nearest.y, nearest.z}) < range.shortest_ray()) {
      decide_short_rays(pixel, scaled_points, work.above, visible);
    }
  }
  const glm::vec3 start = light_->sun ? glm::vec3(0) : origin;  // of the scaled segment
  // The largest float below 1; the rays of a sun have no end.
  const float end = light_->sun ? std::numeric_limits<float>::infinity() : 0x1.fffffep-1f;

  const std::uint32_t own_plane = scene_->plane[carrier];
  PixelContext context = context_of(&own_plane);  // all rays have the number 0
  typename Packet<kWidth>::Rays rays{};
  alignas(64) int valid[kWidth];
  for (std::size_t lane = 0; lane < kWidth; ++lane) {
    lanes(rays.org_x)[lane] = origin.x;
    lanes(rays.org_y)[lane] = origin.y;
    lanes(rays.org_z)[lane] = origin.z;
    lanes(rays.mask)[lane] = 0xffffffffu;
  }
  for (std::size_t first = 0; first < count; first += kWidth) {
    int alive = 0;
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      const std::uint32_t sample = order_[std::min(first + lane, count - 1)];
      const bool traced = first + lane < count && ((work.above[sample / 32] >> (sample % 32)) & 1u) != 0;
      valid[lane] = traced ? -1 : 0;
      alive |= valid[lane];
      const glm::vec3 direction = scaled_points[sample] - start;
      lanes(rays.dir_x)[lane] = direction.x;
      lanes(rays.dir_y)[lane] = direction.y;
      lanes(rays.dir_z)[lane] = direction.z;
      lanes(rays.tfar)[lane] = end;
    }
    if (alive == 0) continue;
    Packet<kWidth>::occluded(valid, embree_->handle(), &context.embree, &rays);
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      if (valid[lane] == 0 || lanes(rays.tfar)[lane] == kOccluded) continue;
      const std::uint32_t sample = order_[first + lane];
      visible[sample / 32] |= 1u << (sample % 32);
      if (one_ray) std::ranges::copy(full_mask_, visible.begin());
    }
  }
}

template <int kWidth>
void RayTraced::trace_tile(const Tile& tile) {
  const std::size_t words = light_->words_per_mask();
  const tbb::blocked_range2d<std::size_t> pixels(0, tile.row_count, 8, 0, samples_->width, 32);
  tbb::parallel_for(pixels, [&](const tbb::blocked_range2d<std::size_t>& block) {
    const std::vector<glm::vec3> room(is_body(light_->kind) ? light_->sample_count() : 0);
    Workspace work{room, room, std::vector<std::uint32_t>(words), {}, {}, {}};
    if (light_->dome) {
      constexpr std::size_t kRows = 8, kColumns = 16;
      for (std::size_t top = block.rows().begin(); top < block.rows().end(); top += kRows) {
        for (std::size_t left = block.cols().begin(); left < block.cols().end(); left += kColumns) {
          trace_to_dome<kWidth>(
              tile,
              {top, std::min(top + kRows, block.rows().end()), left, std::min(left + kColumns, block.cols().end())},
              work);
        }
      }
      return;
    }
    for (std::size_t row = block.rows().begin(); row != block.rows().end(); ++row) {
      for (std::size_t x = block.cols().begin(); x != block.cols().end(); ++x) {
        const std::size_t in_tile = row * samples_->width + x;
        trace_pixel<kWidth>(std::size_t{tile.first_row} * samples_->width + in_tile, work,
                            std::span(masks_).subspan(in_tile * words, words));
      }
    }
  });
  embree_->check();
}

void RayTraced::evaluate(const Tile& tile) {
  PENUMBRA_ASSERT(light_ != nullptr && samples_ != nullptr, "prepare_light and prepare_view come first");
  PENUMBRA_ASSERT(tile.row_count <= max_tile_rows() && tile.first_row + tile.row_count <= samples_->height,
                  "rows {} + {} of {}", tile.first_row, tile.row_count, samples_->height);
  tile_ = tile;
  masks_.assign(std::size_t{tile.row_count} * samples_->width * light_->words_per_mask(), 0u);
  switch (width_ != 0 ? width_ : embree_->native_width()) {
    case 1:
      return trace_tile<1>(tile);
    case 4:
      return trace_tile<4>(tile);
    case 16:
      return trace_tile<16>(tile);
    default:
      return trace_tile<8>(tile);
  }
}

void RayTraced::read_masks(std::span<std::uint32_t> masks) {
  PENUMBRA_ASSERT(masks.size() == masks_.size(), "{} words asked for, {} evaluated", masks.size(), masks_.size());
  std::copy(masks_.begin(), masks_.end(), masks.begin());
}

void RayTraced::read_visibility(std::span<float> visibility) {
  const std::size_t first = std::size_t{tile_.first_row} * samples_->width;
  visibility::visible_shares(*light_, masks_, std::span(samples_->n).subspan(first, visibility.size()), visibility);
}

std::unique_ptr<visibility::Method> make_ray_traced(const visibility::MethodOptions& options) {
  return std::make_unique<RayTraced>(options);
}

}  // namespace penumbra::reference
