// SPDX-License-Identifier: Apache-2.0
// Host of mask methods on vector units: regions of pixels in parallel, each divided into blocks and clusters whose
// light samples the method decides.

#include "engines/vectors/mask_method.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "engines/vectors/near_casters.hpp"
#include "engines/vectors/open_judge.hpp"
#include "visibility/masks/visible_share.hpp"
#include "visibility/tree/tree_refit.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

namespace penumbra::vectors {
namespace {

constexpr std::uint32_t kBlock = 8, kSmallBlock = 4;  // pixels on a side of a block, whose clusters share lists
constexpr std::uint32_t kRegion = 16;                 // pixels on a side of a region, whose blocks share the roots of
                                                      // traversals
constexpr std::size_t kRegionPixels = std::size_t{kRegion} * kRegion;
// Mask memory per tile: enough to keep all threads busy; more would cost page faults.
constexpr std::size_t kMaskBytesOfThread = std::size_t{16} << 20U, kMostMaskBytes = std::size_t{256} << 20U;

/// Positions of a region's pixels in Z order, so that consecutive pixels are neighbours.
struct Spot {
  std::uint32_t x = 0, y = 0;
};
constexpr auto kSpots = [] {
  std::array<Spot, kRegionPixels> spots;
  for (std::uint32_t i = 0; i < spots.size(); ++i) {
    for (std::uint32_t bit = 0; 1U << 2 * bit < spots.size(); ++bit) {
      spots[i].x |= (i >> 2 * bit & 1) << bit;
      spots[i].y |= (i >> (2 * bit + 1) & 1) << bit;
    }
  }
  return spots;
}();

}  // namespace

/// Buffers of one thread.
struct MaskMethod::Buffers {
  std::vector<GridSample> samples;
  std::vector<SampleMask> masks;
  std::vector<LightCone> cones;  // cones of the region's view samples
  NearSpheres near_region, near_cluster;
  LightGrid turned;              // the grid oriented toward a region or a cluster
  std::uint64_t turned_for = 0;  // number of the light for which `turned` was made
};

/// Buffers are per method: while a thread waits for one method's work it may run work of another method.
struct MaskMethod::AllBuffers {
  tbb::enumerable_thread_specific<Buffers> of_thread;
};

MaskMethod::Buffers& MaskMethod::buffers() const {
  return buffers_->of_thread.local();
}

namespace {

/// Returns eight bytes, as a matrix of bits, transposed: bit r of byte c becomes bit c of byte r (H. S. Warren,
/// Hacker's Delight, 2nd ed., 7-3).
std::uint64_t transposed(std::uint64_t bits) {
  std::uint64_t moved = (bits ^ (bits >> 7U)) & 0x00aa00aa00aa00aaU;
  bits ^= moved ^ (moved << 7U);
  moved = (bits ^ (bits >> 14U)) & 0x0000cccc0000ccccU;
  bits ^= moved ^ (moved << 14U);
  moved = (bits ^ (bits >> 28U)) & 0x00000000f0f0f0f0U;
  return bits ^ moved ^ (moved << 28U);
}

/// Copies bits of light samples in rows from column order (mask_bit) to their own order, into a cleared mask.
void add_rows(const LightGrid& grid, const std::uint16_t* from, std::span<std::uint32_t> mask) {
  for (std::uint32_t row = 0; row < grid.rows; row += 8) {
    for (std::uint32_t column = 0; column < grid.columns; column += 8) {
      std::uint64_t block = 0;  // a byte for each column
      for (std::uint32_t i = 0; i < std::min(grid.columns - column, 8U); ++i) {
        const std::size_t bit = std::size_t{column + i} * grid.padded_rows + row;
        block |= std::uint64_t{from[bit / 16] >> bit % 16 & 0xffU} << 8 * i;
      }
      block = transposed(block);
      for (std::uint32_t i = 0; i < std::min(grid.rows - row, 8U); ++i) {
        const auto bits = static_cast<std::uint32_t>(block >> 8 * i & 0xffU);
        const std::size_t at = std::size_t{row + i} * grid.columns + column;
        mask[at / 32] |= bits << at % 32;
        if (at % 32 > 24 && bits >> (32 - at % 32) != 0) mask[at / 32 + 1] |= bits >> (32 - at % 32);
      }
    }
  }
}

void add_tiles(const LightGrid& grid, const std::uint16_t* from, std::uint32_t samples, std::span<std::uint32_t> mask) {
  for (std::uint32_t j = 0; j < samples; ++j) {
    const std::size_t bit = mask_bit(grid, j);
    mask[j / 32] |= (from[bit / 16] >> bit % 16 & 1U) << (j % 32);
  }
}

}  // namespace

MaskMethod::MaskMethod(visibility::MethodDescription description, std::string pass)
    : description_(std::move(description)), pass_(std::move(pass)), buffers_(std::make_unique<AllBuffers>()) {}

MaskMethod::~MaskMethod() = default;

void MaskMethod::prepare_mesh(const visibility::SceneFloats& scene) {
  prepare_tree(scene);
  prepare_triangles();
}

void MaskMethod::prepare_tree(const visibility::SceneFloats& scene) {
  scene_ = &scene;
  scale_ = visibility::device_scale(scene);
  if (refit_tree()) {
    count_for_mesh("treesRefit");
  } else {
    triangles_ = {};  // clears the triangles of the previous scene
    tree_ = visibility::make_triangle_tree(scene);
    if (expects_frames_) built_cost_ = visibility::tree_cost(tree_);
    count_for_mesh("treesBuilt");
  }
}

void MaskMethod::prepare_triangles() {
  triangles_ = wide_triangle_tree(*scene_, tree_, scale_, std::move(triangles_));
  normals_ = KnownNormals(*scene_);
}

bool MaskMethod::refit_tree() {
  if (!expects_frames_ || tree_.nodes.empty() || !visibility::holds_casters(tree_, *scene_)) return false;
  visibility::refit_triangle_tree(tree_, *scene_);
  return visibility::tree_cost(tree_) <= visibility::kMostGrowth * built_cost_;
}

void MaskMethod::prepare_light(const visibility::Light& light) {
  visibility::check_light(description_, light);
  PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first: {}", light.name);
  light_ = &light;
  counters_.clear();
  ++light_number_;
  grids_.clear();
  cone_.reset();
  if (!visibility::is_planar(light.kind)) {
    cone_.emplace(light, *scene_, tree_, ConeOptions{description_.name, asks_for_light_samples(), cuts_casters()});
    static_cast<void>(prepare_casters());
    grids_.push_back(cone_->make_grid());
    return;
  }
  const GridShape shape = grid_shape();
  device_light_ = shape.frame;
  visibility::check_size(light, device_light_, description_.name);
  const bool cut = prepare_casters();
  const auto scaled = [&](const glm::vec3& x) { return glm::dvec3(x) * static_cast<double>(scale_); };
  const float reach = shape.reach * visibility::reach_of(*scene_, device_light_, scale_);
  for (const float side : {1.0F, -1.0F}) {
    if (side < 0 && !light.two_sided) continue;
    grids_.push_back(make_light_grid({device_light_,
                                      {scaled(light.center), scaled(light.center_u), scaled(light.center_v)},
                                      shape.is_rectangle,
                                      shape.rows,
                                      shape.columns,
                                      static_cast<std::uint32_t>(light.index),
                                      side,
                                      reach,
                                      cut ? 4 * reach : 0,
                                      scale_,
                                      light.points,
                                      shape.window}));
  }
}

MaskMethod::GridShape MaskMethod::grid_shape() const {
  GridShape shape{visibility::make_device_light(*light_, scale_), is_parallelogram(light_->kind)};
  if (shape.frame.rows) {
    shape.rows = light_->rows;
    shape.columns = light_->columns;
  }
  return shape;
}

std::uint32_t MaskMethod::max_tile_rows() const {
  PENUMBRA_ASSERT(samples_ != nullptr && light_ != nullptr, "prepare_light and prepare_view come first");
  const auto threads = static_cast<std::size_t>(std::max(tbb::this_task_arena::max_concurrency(), 1));
  const std::size_t row_bytes = mask_words(grids_[0]) * 2 * samples_->width;
  // Regions are whole if there is any space for them, regardless of the number of threads.
  const std::size_t plenty = std::max<std::size_t>(threads * kMaskBytesOfThread / row_bytes, kRegion),
                    fit = std::min(plenty, kMostMaskBytes / row_bytes);
  const std::size_t rows = fit >= kRegion ? fit / kRegion * kRegion : fit;
  return static_cast<std::uint32_t>(std::clamp<std::size_t>(rows, 1, samples_->height));
}

void MaskMethod::evaluate(const visibility::Tile& tile) {
  tile_ = tile;
  const std::size_t pixels = std::size_t{tile.row_count} * samples_->width;
  if (const std::size_t words = pixels * mask_words(grids_[0]); masks_.size() < words) {
    masks_.clear();
    masks_.resize(words);
  }
  visible_.assign(pixels, 0);
  const auto start = std::chrono::steady_clock::now();
  do_tile();
  milliseconds_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  counters_["openPixels"] += open_pixels_.exchange(0);
  counters_["openPairs"] += open_pairs_.exchange(0);
  count(counters_);
}

void MaskMethod::repeat() {
  do_tile();
  open_pixels_ = 0;
  open_pairs_ = 0;
  std::map<std::string, std::uint64_t> discarded;
  count(discarded);
}

void MaskMethod::do_tile() {
  const std::uint32_t across = (samples_->width + kRegion - 1) / kRegion,
                      down = (tile_.row_count + kRegion - 1) / kRegion;
  tbb::parallel_for(std::uint32_t{0}, across * down, [&](std::uint32_t region) {
    for (const LightGrid& grid : grids_) do_region(grid, region % across * kRegion, region / across * kRegion);
  });
}

LightGrid& MaskMethod::turned_grid() const {
  Buffers& own = buffers();
  if (std::exchange(own.turned_for, light_number_) != light_number_) own.turned = grids_[0];
  return own.turned;
}

void MaskMethod::do_region(const LightGrid& grid, std::uint32_t left, std::uint32_t top) {
  const visibility::PairJudge pairs{*scene_, tree_, *samples_, *light_};
  ExactOpenJudge judge(pairs, grid);
  const ViewInput view{*scene_, *samples_, device_light_, grid, normals_, scale_};
  std::vector<GridSample>& samples = buffers().samples;
  // for each small block of the region, the end of its view samples in `samples`
  std::array<std::size_t, kRegionPixels / (std::size_t{kSmallBlock} * kSmallBlock)> ends{};
  samples.resize(kRegionPixels);
  std::vector<LightCone>& cones = buffers().cones;
  cones.resize(cone_ ? kRegionPixels : 0);
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < kRegionPixels; ++i) {
    const std::uint32_t x = left + kSpots[i].x, y = top + kSpots[i].y;
    if (x < samples_->width && y < tile_.row_count) {
      const std::size_t pixel = std::size_t{y} * samples_->width + x;
      GridSample& at = samples[count];
      at.cone = static_cast<std::uint32_t>(count);
      const auto number = static_cast<std::uint32_t>(first_pixel() + pixel);
      const SampleClass kind = cone_ ? cone_->classify(view, number, at, cones[count]) : classify(view, number, at);
      if (kind == SampleClass::in_front) ++count;
      if (kind == SampleClass::all_visible) visible_[pixel] = light_->sample_count();
      if (kind == SampleClass::open && grid.side > 0 && !decide_open(at))
        decide_all(at, judge);  // only for one of the light's two sides, not twice
    }
    ends[i / (kSmallBlock * kSmallBlock)] = count;
  }
  samples.resize(count);
  if (count > 0) {
    const Blocks blocks = enter_region(grid, samples);
    const std::size_t step = blocks == Blocks::small ? 1 : kBlock * kBlock / (kSmallBlock * kSmallBlock);
    std::size_t begin = 0;
    for (std::size_t i = step; i <= ends.size(); i += step) {
      do_block(grid, std::span(samples).subspan(begin, ends[i - 1] - begin), judge);
      begin = ends[i - 1];
    }
  }
  open_pixels_ += judge.pixels();
  open_pairs_ += judge.pairs();
}

Blocks MaskMethod::enter_region(const LightGrid& grid, std::span<GridSample> samples) {
  if (!cone_) return begin_region(grid, make_cluster(grid, samples));
  LightGrid& turned = turned_grid();
  turned.cones->of = buffers().cones;
  find_near_disks(turned, samples, cone_->near().spheres, buffers().near_region);
  return begin_region(turned, cone_->turn(turned, samples) ? make_cluster(turned, samples) : everything(samples));
}

void MaskMethod::do_block(const LightGrid& grid, std::span<GridSample> block, OpenJudge& judge) {
  if (block.empty()) return;
  std::vector<SampleMask>& masks = buffers().masks;
  std::size_t begin = 0;
  for (const std::size_t end : split_at_gaps(block)) {
    const auto cluster = block.subspan(begin, end - begin);
    masks.clear();
    for (const GridSample& at : cluster) masks.push_back({mask_of(at), 0});
    if (!cone_) {
      do_cluster(grid, cluster, judge, masks);
    } else if (cone_->turn(turned_grid(), cluster)) {
      do_turned(cluster, judge, masks);
    } else {
      for (std::size_t i = 0; i < cluster.size(); ++i) {
        const bool sees_it = cone_->turn(turned_grid(), cluster.subspan(i, 1));
        PENUMBRA_ASSERT(sees_it, "light {}: no rectangle for pixel {}", light_->name, cluster[i].pixel);
        do_turned(cluster.subspan(i, 1), judge, std::span(masks).subspan(i, 1));
      }
    }
    for (std::size_t i = 0; i < cluster.size(); ++i) visible_[tile_pixel(cluster[i])] = masks[i].visible;
    begin = end;
  }
}

void MaskMethod::do_turned(std::span<const GridSample> samples, OpenJudge& judge, std::span<SampleMask> masks) {
  LightGrid& turned = turned_grid();
  Buffers& own = buffers();
  find_near_disks(turned, samples, own.near_region, own.near_cluster);
  turned.cones->near = own.near_cluster.count == 0 ? nullptr : &own.near_cluster;
  turned.cones->casters = &cone_->near();
  do_cluster(turned, samples, judge, masks);
}

void MaskMethod::decide_all(const GridSample& sample, OpenJudge& judge) {
  Open open;
  open.pixel = true;
  SampleMask mask{mask_of(sample), 0};
  std::fill_n(mask.bits, mask_words(grids_[0]), std::uint16_t{0});
  judge.decide(sample, open, mask);
  visible_[tile_pixel(sample)] = mask.visible;
}

void MaskMethod::read_masks(std::span<std::uint32_t> masks) {
  const std::uint32_t words = light_->words_per_mask(), count = light_->sample_count();
  const LightGrid& grid = grids_[0];
  const std::size_t own = mask_words(grid);
  PENUMBRA_ASSERT(grid.tiles || std::size_t{grid.rows} * grid.columns == count, "{} light samples in {} x {}", count,
                  grid.rows, grid.columns);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, visible_.size(), 256), [&](const auto& range) {
    for (std::size_t pixel = range.begin(); pixel < range.end(); ++pixel) {
      const auto mask = masks.subspan(pixel * words, words);
      const bool all = visible_[pixel] == count;
      std::fill(mask.begin(), mask.end(), all ? 0xffffffffU : 0U);
      if (all && count % 32 != 0) mask.back() = (1U << count % 32) - 1;
      if (all || visible_[pixel] == 0) continue;
      const std::uint16_t* from = &masks_[pixel * own];
      grid.tiles ? add_tiles(grid, from, count, mask) : add_rows(grid, from, mask);
    }
  });
}

void MaskMethod::read_visibility(std::span<float> visibility) {
  if (!light_->weights.empty()) {
    std::vector<std::uint32_t> masks(visibility.size() * light_->words_per_mask());
    read_masks(masks);
    visibility::visible_shares(*light_, masks, visibility);
    return;
  }
  const auto all = static_cast<double>(light_->sample_count());
  std::transform(visible_.begin(), visible_.end(), visibility.begin(),
                 [&](std::uint32_t count) { return static_cast<float>(count / all); });
}

std::vector<visibility::PassTime> MaskMethod::take_pass_times() {
  return {{pass_, std::exchange(milliseconds_, 0)}};
}

std::uint64_t MaskMethod::memory_bytes() const {
  return bytes_of(triangles_) + bytes_of(tree_) + normals_.memory_bytes() + masks_.size() * sizeof(masks_[0]) +
         visible_.size() * sizeof(visible_[0]);
}

}  // namespace penumbra::vectors
