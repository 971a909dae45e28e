// Edge scatter on a processor: blocks of pixels on all cores, each from its lists to its bits in one go.

#include "volumes/edge_scatter_native.hpp"

#include "base/assert.hpp"
#include "visibility/pair_judge.hpp"
#include "visibility/visible_share.hpp"
#include "volumes/edge_sides.hpp"
#include "native/clusters.hpp"
#include "volumes/native_scatter.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <optional>

namespace penumbra::volumes {
namespace {

using native::Outlook;

constexpr std::uint32_t kBlock = 8;    // pixels, whose clusters have lists
constexpr std::uint32_t kRegion = 16;  // pixels, whose blocks begin their walks at the same roots
constexpr std::size_t kMostMaskBytes = std::size_t{256} << 20U;  // of a tile

/// Where the pixels of a region are: in Z order, so that those that follow one another are neighbours.
struct Spot {
  std::uint32_t x, y;
};
Spot spot(std::uint32_t i) {
  Spot at{0, 0};
  for (std::uint32_t bit = 0; 1U << 2 * bit < kRegion * kRegion; ++bit) {
    at.x |= (i >> 2 * bit & 1) << bit;
    at.y |= (i >> (2 * bit + 1) & 1) << bit;
  }
  return at;
}

/// What is not certain by exact predicates, on the spot.
class OpenJudge final : public Judge {
 public:
  OpenJudge(const visibility::PairJudge& judge, const Frame& frame) : judge_(judge), frame_(frame) {}

  std::uint32_t depth(const Placed& sample, std::uint32_t light_sample) override {
    ++samples_;
    return judge_.depth(sample.pixel, judge_.light.points[light_sample]);
  }

  void decide(const Placed& sample, const native::Open& open, Seen& seen) override {
    ++pixels_;
    if (open.pixel) {
      for (std::uint32_t row = 0; row < frame_.rows; ++row) decide_row(sample, row, seen);
    } else {
      for (const std::uint32_t row : sorted(open.rows)) decide_row(sample, row, seen);
      for (const std::uint32_t one : sorted(open.samples)) decide_one(sample, one, seen);
    }
    seen.visible = 0;
    const std::size_t words = std::size_t{frame_.columns} * frame_.padded_rows / 16;
    for (std::size_t i = 0; i < words; ++i) seen.visible += static_cast<std::uint32_t>(std::popcount(seen.mask[i]));
  }

  [[nodiscard]] std::uint64_t pixels() const { return pixels_; }
  [[nodiscard]] std::uint64_t samples() const { return samples_; }

 private:
  static const std::vector<std::uint32_t>& sorted(const std::vector<std::uint32_t>& numbers) {
    thread_local std::vector<std::uint32_t> unique;
    unique = numbers;
    std::sort(unique.begin(), unique.end());
    unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
    return unique;
  }
  void decide_row(const Placed& sample, std::uint32_t row, Seen& seen) {
    for (std::uint32_t column = 0; column < frame_.columns; ++column)
      decide_one(sample, row * frame_.columns + column, seen);
  }
  void decide_one(const Placed& sample, std::uint32_t number, Seen& seen) {
    const std::uint32_t row = number / frame_.columns, column = number % frame_.columns;
    ++samples_;
    std::uint16_t& word = seen.mask[(std::size_t{column} * frame_.padded_rows + row) / 16];
    const std::uint32_t bit = 1U << row % 16;
    const bool visible = judge_.is_visible(sample.pixel, judge_.light.points[number]);
    word = static_cast<std::uint16_t>(visible ? word | bit : word & ~bit);
  }

  const visibility::PairJudge& judge_;
  const Frame& frame_;
  std::uint64_t pixels_ = 0, samples_ = 0;
};

class NativeEdgeScatter final : public visibility::Method {
 public:
  explicit NativeEdgeScatter(visibility::MethodDescription description)
      : description_(std::move(description)), sides_(description_.name) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }

  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    scale_ = render::device_scale(scene);
    tree_ = visibility::make_triangle_tree(scene);
    triangles_ = native::wide_triangle_tree(scene, tree_, scale_);
    normal_is_known_.resize(scene.triangles.size());
    tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(scene.triangles.size()), [&](std::uint32_t i) {
      normal_is_known_[i] = render::normal_is_known(scene.corners(i)) ? 1 : 0;
    });
    whole_ = wide_edges(sides_.prepare_mesh(scene));
  }

  void prepare_light(const visibility::Light& light) override {
    visibility::check_light(description_, light);
    PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first: {}", light.name);
    light_ = &light;
    counters_.clear();
    frame_ = visibility::make_light_frame(light, scale_);
    PENUMBRA_ASSERT(frame_.rows, "light {} has no rows that a step describes", light.name);
    const SidedRecords records = sides_.prepare_light(light, frame_, scale_);
    front_.reset();
    back_.reset();
    if (records.front) front_ = wide_edges(*records.front);
    if (records.back) back_ = wide_edges(*records.back);
    frames_.clear();
    for (const float side : {1.0F, -1.0F}) {
      if (side < 0 && !light.two_sided) continue;
      frames_.push_back(native::make_frame({frame_, light.rows, light.columns, static_cast<std::uint32_t>(light.index),
                                            side, reach(), records.cut ? 4 * reach() : 0}));
    }
  }

  void prepare_view(const visibility::ViewSamples& samples) override { samples_ = &samples; }

  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    PENUMBRA_ASSERT(samples_ != nullptr && light_ != nullptr, "prepare_light and prepare_view come first");
    const std::size_t rows = kMostMaskBytes / (mask_words() * 2 * samples_->width) / kRegion * kRegion;
    return static_cast<std::uint32_t>(
        std::clamp<std::size_t>(rows, std::min(kRegion, samples_->height), samples_->height));
  }

  void evaluate(const visibility::Tile& tile) override {
    tile_ = tile;
    const std::size_t pixels = std::size_t{tile.row_count} * samples_->width;
    masks_.resize(std::max(masks_.size(), pixels * mask_words()));
    visible_.assign(pixels, 0);
    const auto start = std::chrono::steady_clock::now();
    const std::uint32_t across = (samples_->width + kRegion - 1) / kRegion,
                        down = (tile.row_count + kRegion - 1) / kRegion;
    tbb::parallel_for(std::uint32_t{0}, across * down, [&](std::uint32_t region) {
      Scratch& scratch = scratch_.local();
      for (const Frame& frame : frames_)
        do_region(frame, {region % across * kRegion, region / across * kRegion}, scratch);
    });
    milliseconds_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    for (Scratch& scratch : scratch_) {
      counters_["openPixels"] += std::exchange(scratch.open_pixels, 0);
      counters_["openPairs"] += std::exchange(scratch.open_samples, 0);
      counters_["listedEdges"] += std::exchange(scratch.listed, 0);
    }
  }

  void read_masks(std::span<std::uint32_t> masks) override {
    const std::uint32_t words = light_->words_per_mask(), count = light_->sample_count(), columns = light_->columns;
    const std::size_t own = mask_words(), padded = frames_.front().padded_rows;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, visible_.size(), 256), [&](const auto& range) {
      for (std::size_t pixel = range.begin(); pixel < range.end(); ++pixel) {
        const auto mask = masks.subspan(pixel * words, words);
        std::fill(mask.begin(), mask.end(), 0U);
        if (visible_[pixel] == 0) continue;
        const std::uint16_t* from = &masks_[pixel * own];
        for (std::uint32_t j = 0; j < count; ++j) {
          const std::size_t bit = j % columns * padded + j / columns;
          const bool visible = visible_[pixel] == count || (from[bit / 16] >> bit % 16 & 1) != 0;
          mask[j / 32] |= (visible ? 1U : 0U) << (j % 32);
        }
      }
    });
  }

  void read_visibility(std::span<float> visibility) override {
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

  std::vector<visibility::PassTime> take_pass_times() override {
    return {{"scatter edges", std::exchange(milliseconds_, 0)}};
  }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    const auto bytes = [](const auto& tree) {
      return tree.nodes.size() * sizeof(tree.nodes[0]) + tree.leaves.size() * sizeof(tree.leaves[0]);
    };
    return bytes(whole_) + bytes(triangles_) + (front_ ? bytes(*front_) : 0) + (back_ ? bytes(*back_) : 0) +
           masks_.size() * sizeof(masks_[0]) + visible_.size() * sizeof(visible_[0]);
  }

 private:
  [[nodiscard]] std::size_t mask_words() const { return std::size_t{light_->columns} * ((light_->rows + 15) / 16); }
  /// At least the largest coordinate, in size, of anything in the scene, scaled.
  [[nodiscard]] float reach() const {
    float reach = 0;
    for (int i = 0; i < 3; ++i) {
      reach = std::max({reach, std::abs(frame_.center[i]) + std::abs(frame_.u[i]) + std::abs(frame_.v[i]),
                        std::abs(scene_->lower[i]) * scale_, std::abs(scene_->upper[i]) * scale_});
    }
    return reach;
  }
  [[nodiscard]] native::WideEdgeTree wide_edges(const std::vector<EdgeRecord>& records) const {
    const EdgeTexels texels = edge_texels(records, scale_);
    return texels.depth == 0 ? native::WideEdgeTree{} : native::wide_edge_tree(texels.nodes, texels.slots);
  }
  [[nodiscard]] const native::WideEdgeTree& edges_of(const Frame& frame) const {
    return frame.side < 0 && back_ ? *back_ : front_ ? *front_ : whole_;
  }

  void do_region(const Frame& frame, const Spot& corner, Scratch& scratch) {
    const visibility::PairJudge pairs{*scene_, tree_, *samples_, *light_};
    OpenJudge judge(pairs, frame);
    const native::ViewInput view{*scene_, *samples_, frame_, frame, normal_is_known_, scale_};
    const std::size_t first_pixel = std::size_t{tile_.first_row} * samples_->width;
    std::vector<Placed>& placed = scratch.placed;
    std::array<std::size_t, kRegion * kRegion / (kBlock * kBlock)> ends{};  // of its blocks
    placed.resize(kRegion * kRegion);
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < kRegion * kRegion; ++i) {
      const Spot place = spot(i);
      const std::uint32_t x = corner.x + place.x, y = corner.y + place.y;
      if (x < samples_->width && y < tile_.row_count) {
        const auto pixel = static_cast<std::uint32_t>(first_pixel + std::size_t{y} * samples_->width + x);
        Placed& at = placed[count];
        const Outlook outlook = native::look(view, pixel, at);
        if (outlook == Outlook::scattered) ++count;
        if (outlook == Outlook::all) visible_[pixel - first_pixel] = light_->sample_count();
        if (outlook == Outlook::open && frame.side > 0) decide_all(at, judge);  // one of two sides asks
      }
      ends[i / (kBlock * kBlock)] = count;
    }
    placed.resize(count);
    if (count > 0) {
      const native::Cluster all = native::make_cluster(frame, placed);
      native::find_roots({frame, edges_of(frame), triangles_, all}, scratch.roots);
      std::size_t begin = 0;
      for (const std::size_t end : ends) {
        do_block(frame, std::span(placed).subspan(begin, end - begin), judge, scratch);
        begin = end;
      }
    }
    scratch.open_pixels += judge.pixels();
    scratch.open_samples += judge.samples();
  }

  void decide_all(const Placed& sample, OpenJudge& judge) {
    const std::size_t pixel = sample.pixel - std::size_t{tile_.first_row} * samples_->width;
    native::Open open;
    open.pixel = true;
    Seen seen{&masks_[pixel * mask_words()], 0};
    std::fill_n(seen.mask, mask_words(), std::uint16_t{0});
    judge.decide(sample, open, seen);
    visible_[pixel] = seen.visible;
  }

  void do_block(const Frame& frame, std::span<Placed> block, OpenJudge& judge, Scratch& scratch) {
    if (block.empty()) return;
    std::size_t begin = 0;
    for (const std::size_t end : native::split_at_gaps(block)) {
      do_cluster(frame, block.subspan(begin, end - begin), judge, scratch);
      begin = end;
    }
  }

  void do_cluster(const Frame& frame, std::span<const Placed> placed, OpenJudge& judge, Scratch& scratch) {
    const std::size_t first_pixel = std::size_t{tile_.first_row} * samples_->width;
    scratch.edges.count = scratch.triangles.count = 0;
    native::Cluster cluster;
    if (!scratch.roots.edges.empty() || !scratch.roots.triangles.empty()) {
      cluster = native::make_cluster(frame, placed);
      native::find({frame, edges_of(frame), triangles_, cluster}, scratch.roots, scratch.stack, scratch.edges,
                   scratch.triangles);
      scratch.listed += scratch.edges.count;
    }
    const auto seen_of = [&](const Placed& at) { return Seen{&masks_[(at.pixel - first_pixel) * mask_words()], 0}; };
    if (scratch.edges.count + scratch.triangles.count == 0) {
      for (const Placed& at : placed) {
        Seen seen = seen_of(at);
        see_all(frame, at, scratch.open, judge, seen);
        visible_[at.pixel - first_pixel] = seen.visible;
      }
      return;
    }
    scratch.samples.clear();
    scratch.seen.clear();
    for (const Placed& at : placed) {
      scratch.samples.push_back(native::complete(frame, cluster, at));
      scratch.seen.push_back(seen_of(at));
    }
    scatter({frame, triangles_, cluster, scratch.samples, scratch.edges, scratch.triangles}, scratch, judge,
            scratch.seen);
    for (std::size_t i = 0; i < placed.size(); ++i) visible_[placed[i].pixel - first_pixel] = scratch.seen[i].visible;
  }

  visibility::MethodDescription description_;
  EdgeSides sides_;
  const visibility::SceneFloats* scene_ = nullptr;
  float scale_ = 1;
  visibility::TriangleTree tree_;
  std::vector<std::uint8_t> normal_is_known_;  // of each triangle
  native::WideTriangleTree triangles_;
  native::WideEdgeTree whole_;
  const visibility::Light* light_ = nullptr;
  visibility::LightFrame frame_;
  std::vector<Frame> frames_;
  std::optional<native::WideEdgeTree> front_, back_;  // where `whole_` will not do
  const visibility::ViewSamples* samples_ = nullptr;
  visibility::Tile tile_;
  std::vector<std::uint16_t> masks_;  // of the tile: bit column · padded_rows + row; unless all or none are visible
  std::vector<std::uint32_t> visible_;
  tbb::enumerable_thread_specific<Scratch> scratch_;
  double milliseconds_ = 0;
  std::map<std::string, std::uint64_t> counters_;
};

}  // namespace

std::unique_ptr<visibility::Method> make_native_edge_scatter(visibility::MethodDescription description) {
  return std::make_unique<NativeEdgeScatter>(std::move(description));
}

}  // namespace penumbra::volumes
