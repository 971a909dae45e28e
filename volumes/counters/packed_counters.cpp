// SPDX-License-Identifier: Apache-2.0
// V. Forest, L. Barthe, M. Paulin, Accurate shadows by depth complexity sampling, Computer Graphics Forum 27 (2), 2008:
// counters of light samples in a few packed words for each view sample, changed by the silhouettes of the light's
// centre where their wedges are on the screen; shadow volumes of the centre give the constant. Departures: integers in
// 64 bits instead of floats that blend; any soup, by signed multiplicity; five certified signs instead of look-up
// tables of ±1; cases left open by rounding or overflow are decided exactly; any number of light samples, since the
// wedges are rasterised again for each word of a mask (docs/depth-complexity.md).

#include "volumes/counters/packed_counters.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "engines/device/open_judge.hpp"
#include "mesh/predicates.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "visibility/masks/visible_share.hpp"
#include "volumes/raster/carrier_horizon.hpp"
#include "volumes/wedges/light_hull.hpp"
#include "volumes/counters/methods.hpp"
#include "volumes/counters/packed_counters.frag.spv.hpp"
#include "volumes/counters/packed_counters.shared.h"
#include "volumes/raster/volume_count.hpp"
#include "volumes/raster/wedge_raster.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

namespace penumbra::volumes {
namespace {

using visibility::Light;
using visibility::SceneFloats;
using visibility::Tile;
using visibility::ViewSamples;

/// Returns the hull of all points that crossings depend on: the light's hull, its centre and its samples. Points that
/// rounding to float32 has moved out of the hull become corners, too.
LightHull hull_of(const Light& light) {
  constexpr std::uint32_t kSides = 8;  // sides of the polygon around a disk: loose, but fast
  LightHull hull = light_hull(light, kSides);
  const auto on_plane = [&](const glm::dvec3& x) {
    return mesh::side_of_plane(hull.corners[0], hull.corners[1], hull.corners[2], x) == mesh::Side::on;
  };
  const auto within = [](const glm::dvec2& x) { return std::max(std::abs(x.x), std::abs(x.y)) < 1 - 0x1p-10; };
  const glm::dvec3 center(visibility::center_of(light));
  const bool inside = is_parallelogram(light.kind) && on_plane(center) && std::ranges::all_of(hull.corners, on_plane) &&
                      std::ranges::all_of(light.points, [&](const glm::vec3& l) { return on_plane(glm::dvec3(l)); }) &&
                      std::ranges::all_of(light.coordinates, within);
  if (inside) return hull;
  hull.corners.push_back(center);
  for (const glm::vec3& l : light.points) hull.corners.emplace_back(l);
  return hull;
}

/// Returns the data that packed_counters.frag reads in a pass over these light samples. If they are fewer than `count`,
/// the last one is repeated, and its further counters are unused.
std::vector<double> table_of(const gpu::WedgePush& frame, std::span<const glm::vec3> points, std::size_t count) {
  const auto vector = [](const double(&x)[3]) { return glm::dvec3(x[0], x[1], x[2]); };
  glm::dvec2 lower(0), upper(0);  // relative to the centre
  double off = 0;
  for (const glm::vec3& l : points) {
    const glm::dvec3 from_center = glm::dvec3(l) - vector(frame.c);
    const glm::dvec2 at(glm::dot(vector(frame.u_dual), from_center), glm::dot(vector(frame.v_dual), from_center));
    lower = glm::min(lower, at);
    upper = glm::max(upper, at);
    off = std::max(off, std::abs(glm::dot(vector(frame.n), from_center)));
  }
  const glm::dvec2 room = 0x1p-10 * (upper - lower);
  const double least = 0.5 * std::min(room.x, room.y);
  std::vector<double> table{lower.x - room.x, lower.y - room.y, upper.x + room.x, upper.y + room.y, least, off};
  for (std::size_t j = 0; j < count; ++j) {
    const glm::vec3& l = points[std::min(j, points.size() - 1)];
    table.insert(table.end(), {l.x, l.y, l.z});
  }
  return table;
}

/// Returns whether the triangle touches the segment from the light's centre to this sample. False if its plane contains
/// the centre: then it has no silhouette.
bool touches(const std::array<glm::vec3, 3>& corners, const glm::vec3& center, const glm::vec3& l) {
  const auto& [a, b, c] = corners;
  const mesh::Side side = mesh::side_of_plane(a, b, c, center);
  if (side == mesh::Side::on || side == mesh::side_of_plane(a, b, c, l)) return false;
  bool front = false, back = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const mesh::Side passes = mesh::side_of_plane(center, l, corners[i], corners[(i + 1) % 3]);
    front = front || passes == mesh::Side::front;
    back = back || passes == mesh::Side::back;
  }
  return !(front && back);
}

class PackedCounters final : public DepthCounters {
 public:
  PackedCounters(const render::Device& device, const PackedOptions& options)
      : description_(depth_complexity_description({{"variant", "forest"}})),
        device_(&device),
        options_(options),
        count_(device, CountVariant::z_fail) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const SceneFloats& scene) override {
    scene_ = &scene;
    count_.prepare_mesh(scene);
    tree_ = visibility::make_triangle_tree(scene);
    on_plane_.assign(scene.triangles.size(), 0);
    for (const std::uint32_t plane : scene.plane) {
      if (plane != SceneFloats::kNoPlane) ++on_plane_[plane];
    }
  }
  void prepare_light(const Light& light) override;
  void prepare_view(const ViewSamples& samples) override {
    samples_ = &samples;
    count_.prepare_view(samples);
    faces_.reset();
  }
  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    const std::uint64_t row_bytes = std::uint64_t{12} * std::max(samples_->width, 1U) * light_->words_per_mask();
    const std::uint64_t rows = std::max<std::uint64_t>(kMostMaskBytes / row_bytes, 1);
    return std::min({count_.max_tile_rows(), raster_->max_tile_rows(*samples_),
                     static_cast<std::uint32_t>(std::min<std::uint64_t>(rows, samples_->height))});
  }
  void evaluate(const Tile& tile) override;

  void read_masks(std::span<std::uint32_t> masks) override {
    PENUMBRA_ASSERT(masks.size() == masks_.size(), "{} words for {} pixels", masks.size(), masks_.size());
    std::ranges::copy(masks_, masks.begin());
  }
  void read_visibility(std::span<float> visibility) override {
    visibility::visible_shares(*light_, masks_, visibility);
  }
  void read_counters(std::span<std::int32_t> counters) override;

  std::vector<visibility::PassTime> take_pass_times() override {
    visibility::PassTimes all;
    all.add(count_.take_pass_times());
    if (raster_) all.add(raster_->take_pass_times());
    all.add(host_times_.take());
    return all.take();
  }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override;
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    return count_.memory_bytes() + (raster_ ? raster_->memory_bytes() : 0);
  }

 private:
  [[nodiscard]] std::uint32_t per_word() const { return 64 / options_.counter_bits; }
  /// Number of light samples that each pass counts; those of the last pass may be fewer.
  [[nodiscard]] std::uint32_t per_pass() const { return std::min(light_->sample_count(), gpu::kMostPacked); }
  [[nodiscard]] std::uint32_t words() const { return (per_pass() + per_word() - 1) / per_word(); }
  [[nodiscard]] std::span<const glm::vec3> points_of(std::uint32_t pass) const {
    const std::size_t first = std::size_t{pass} * gpu::kMostPacked;
    return std::span(light_->points).subspan(first, std::min<std::size_t>(light_->points.size() - first, per_pass()));
  }
  [[nodiscard]] std::uint32_t all_samples(std::uint32_t pass) const { return ~0U >> (32 - points_of(pass).size()); }
  void refuse_what_reaches_through() const;
  [[nodiscard]] std::vector<gpu::WedgeReceiver> classify();
  [[nodiscard]] std::int64_t change_of(std::size_t pixel, std::uint32_t sample) const;
  [[nodiscard]] bool may_have_overflowed(std::size_t pixel) const;
  void resolve(std::size_t pixel, std::uint32_t pass);
  void count_open(const std::vector<gpu::WedgeReceiver>& receivers);
  void answer();

  static constexpr std::uint64_t kMostMaskBytes = std::uint64_t{1} << 28;  // three words for each word of a mask

  visibility::MethodDescription description_;
  const render::Device* device_;
  PackedOptions options_;
  VolumeCount count_;
  visibility::TriangleTree tree_;
  std::vector<std::uint32_t> on_plane_;  // number of triangles on each SceneFloats::plane
  std::unique_ptr<WedgeRaster> raster_;
  std::vector<std::uint32_t> constants_;  // specialization constants of raster_
  LightWedges wedges_;
  std::optional<std::vector<gpu::WedgeFace>> faces_;  // faces of this view
  const SceneFloats* scene_ = nullptr;
  const Light* light_ = nullptr;
  const ViewSamples* samples_ = nullptr;

  Tile tile_;
  // One word of a mask for each pixel and each pass over the light samples:
  std::vector<std::uint32_t> above_;  // the light samples above the carrier's plane
  std::vector<std::uint32_t> open_;   // light samples left to exact predicates
  std::vector<std::uint32_t> masks_;
  std::vector<std::uint8_t> overflowed_;  // for each pixel, 1 where a counter of some pass may have overflowed
  std::vector<std::int32_t> counters_;    // with keeps_counters
  std::map<std::string, std::uint64_t> totals_;
  visibility::PassTimes host_times_;
};

void PackedCounters::prepare_light(const Light& light) {
  visibility::check_light(description_, light);
  light_ = &light;
  refuse_what_reaches_through();
  const std::vector<std::uint32_t> constants{per_pass(), options_.counter_bits};
  if (!raster_ || constants != constants_) {
    raster_ = std::make_unique<WedgeRaster>(
        *device_,
        WedgeShader{
            .name = "wedges", .fragment = shaders::kPackedCountersFrag, .constants = constants, .words = words() + 1});
    constants_ = constants;
  }
  count_.prepare_light(light);
  wedges_.edges = count_.volumes().edges;
  std::vector<WedgeEdge> edges;
  for (const VolumeEdge& edge : wedges_.edges) edges.push_back({edge.a, edge.b, {}});
  wedges_.wedges = build_wedges(edges, hull_of(light), Construction::original);
  faces_.reset();
  totals_.clear();
}

/// Refuses triangles between the light's centre and a light sample, where D would change without an edge.
void PackedCounters::refuse_what_reaches_through() const {
  const glm::vec3 center = visibility::center_of(*light_);
  for (const glm::vec3& l : light_->points) {
    static_cast<void>(tree_.any_along(center, l, [&](std::uint32_t triangle) {
      if (scene_->emits[triangle] == light_->index || !touches(scene_->corners(triangle), center, l)) return false;
      throw InputError(
          "light \"{}\": triangle {} reaches through it, which depth-complexity variant=forest cannot count; use "
          "variant=soup, or move the light away from the triangle",
          light_->name, triangle);
    }));
  }
}

/// Returns the receivers that the wedges apply to. Leaves masks at values that are known without wedges. The receivers
/// are the same in each pass.
std::vector<gpu::WedgeReceiver> PackedCounters::classify() {
  using Kind = VolumeCount::Kind;
  const std::span<const Kind> kinds = count_.kinds();
  const std::size_t first = std::size_t{tile_.first_row} * samples_->width;
  std::vector<gpu::WedgeReceiver> receivers(kinds.size());
  const std::uint32_t passes = light_->words_per_mask();
  above_.assign(kinds.size() * passes, 0);
  open_.assign(kinds.size() * passes, 0);
  masks_.assign(kinds.size() * passes, 0);
  for_each_index(kinds.size(), [&](std::size_t i) {
    if (kinds[i] == Kind::lit) {
      for (std::uint32_t pass = 0; pass < passes; ++pass) masks_[i * passes + pass] = all_samples(pass);
      return;
    }
    const glm::vec3& p = samples_->p[first + i];
    if (!visibility::in_front_of_light(*light_, p)) return;
    const auto carrier = static_cast<std::uint32_t>(samples_->triangle[first + i]);
    const CarrierHorizon plane(*scene_, tree_, carrier, samples_->facing[first + i],
                               on_plane_[scene_->plane[carrier]] == 1);
    // If p is on a triangle, the sum over edges counts that triangle on the side to which p→l leaves it, but p→l does
    // not meet it.
    const bool doubtful = count_.doubts()[i] != 0 || !appears_in_place(samples_->camera, p, first + i);
    const bool counted = kinds[i] != Kind::dark && !doubtful;
    if (counted) receivers[i] = {p, 1};
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
      const Horizon horizon = plane.at(p, count_.center(), points_of(pass));
      above_[i * passes + pass] = horizon.above;
      open_[i * passes + pass] = counted ? horizon.open : horizon.above;
    }
  });
  return receivers;
}

/// Returns by how much edges changed the counter of one light sample of the pass: the counter's digit.
std::int64_t PackedCounters::change_of(std::size_t pixel, std::uint32_t sample) const {
  const std::uint32_t bits = options_.counter_bits;
  const std::uint64_t half = std::uint64_t{1} << (bits - 1);
  std::uint64_t word = static_cast<std::uint64_t>(raster_->sums()[pixel * (words() + 1) + sample / per_word()]);
  for (std::uint32_t i = 0; i < per_word(); ++i) word += half << (bits * i);
  const std::uint64_t digit = word >> (bits * (sample % per_word())) & (2 * half - 1);
  return static_cast<std::int64_t>(digit) - static_cast<std::int64_t>(half);
}

/// Returns whether a counter of the pass may have overflowed: no counter has changed by more than the last word.
bool PackedCounters::may_have_overflowed(std::size_t pixel) const {
  const std::int64_t most = (std::int64_t{1} << (options_.counter_bits - 1)) - 1;
  return raster_->sums()[pixel * (words() + 1) + words()] > most;
}

/// Computes a counted pixel's word of a mask from the sums of its pass.
void PackedCounters::resolve(std::size_t pixel, std::uint32_t pass) {
  const std::size_t word = pixel * light_->words_per_mask() + pass;
  const bool overflowed = may_have_overflowed(pixel);
  overflowed_[pixel] |= overflowed ? 1U : 0U;
  if (!options_.as_published) open_[word] |= overflowed ? above_[word] : raster_->doubts()[pixel] & above_[word];
  const auto samples = static_cast<std::uint32_t>(points_of(pass).size());
  for (std::uint32_t j = 0; j < samples; ++j) {
    const std::int64_t counter = count_.counts()[pixel] + change_of(pixel, j);
    const bool known = ((above_[word] & ~open_[word]) >> j & 1U) != 0;
    masks_[word] |= known && counter == 0 ? 1U << j : 0;
    if (!options_.keeps_counters || !known) continue;
    const std::size_t sample = std::size_t{pass} * gpu::kMostPacked + j;
    counters_[pixel * light_->sample_count() + sample] = static_cast<std::int32_t>(counter);
  }
}

void PackedCounters::evaluate(const Tile& tile) {
  tile_ = tile;
  if (!faces_) faces_ = faces_of(wedges_, *samples_, WedgeTests::both, glm::dvec3(count_.center()));
  count_.count(tile);
  const std::vector<gpu::WedgeReceiver> receivers = classify();
  overflowed_.assign(receivers.size(), 0);
  if (options_.keeps_counters) counters_.assign(receivers.size() * light_->sample_count(), DepthCounters::kNoCounter);
  const gpu::WedgePush frame = wedge_push(*light_);
  for (std::uint32_t pass = 0; pass < light_->words_per_mask(); ++pass) {
    raster_->set_table(table_of(frame, points_of(pass), per_pass()));
    raster_->add(*faces_, receivers, frame, tile, samples_->width);
    for_each_index(receivers.size(), [&](std::size_t i) {
      if (receivers[i].counted != 0) resolve(i, pass);
    });
  }
  count_open(receivers);
  answer();
}

void PackedCounters::count_open(const std::vector<gpu::WedgeReceiver>& receivers) {
  std::uint64_t overflows = 0, at_horizon = 0, open = 0;
  const std::uint32_t passes = light_->words_per_mask();
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    overflows += overflowed_[i];
    const bool dark = count_.kinds()[i] == VolumeCount::Kind::dark;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
      (dark ? at_horizon : open) += static_cast<std::uint64_t>(std::popcount(open_[i * passes + pass]));
    }
  }
  totals_["overflowPixels"] += overflows;
  totals_["horizonPairs"] += at_horizon;
  totals_["openPairs"] += open;
}

/// Decides open pairs exactly.
void PackedCounters::answer() {
  std::vector<device::OpenBits> questions;
  const std::uint32_t passes = light_->words_per_mask();
  for (std::size_t i = 0; i < open_.size(); ++i) {
    if (open_[i] == 0) continue;
    questions.push_back({static_cast<std::uint32_t>(i / passes), static_cast<std::uint32_t>(i % passes), open_[i]});
  }
  if (questions.empty()) return;
  const std::size_t first = std::size_t{tile_.first_row} * samples_->width;
  const device::MaskLayout layout{.words = passes};
  const std::vector<device::gpu::MaskWord> decided = host_times_.add("exact predicates", [&] {
    return device::decide({{*scene_, tree_, *samples_, *light_}, layout, first}, questions);
  });
  for (const device::gpu::MaskWord& word : decided) {
    masks_[word.word] = (masks_[word.word] & ~word.decided) | word.bits;
  }
}

void PackedCounters::read_counters(std::span<std::int32_t> counters) {
  PENUMBRA_ASSERT(options_.keeps_counters && counters.size() == counters_.size(), "{} counters, not {}",
                  counters.size(), counters_.size());
  std::ranges::copy(counters_, counters.begin());
}

std::map<std::string, std::uint64_t> PackedCounters::counters() const {
  std::map<std::string, std::uint64_t> result = totals_;
  const VolumeCount::Totals& totals = count_.totals();
  result["silhouetteEdges"] = totals.silhouette_edges;
  result["pixelsCountedOnHost"] = totals.doubtful_pixels;
  result["largestCount"] = totals.largest_count;
  result["wedgesOnScreen"] = faces_ ? faces_->size() : 0;
  result["fragments"] = faces_ ? fragments_of(*faces_) : 0;
  return result;
}

}  // namespace

std::unique_ptr<DepthCounters> make_packed_counters(const render::Device& device, const PackedOptions& options) {
  const std::uint32_t bits = options.counter_bits;
  PENUMBRA_ASSERT(bits == 6 || bits == 8 || bits == 16, "{} bits", bits);
  return std::make_unique<PackedCounters>(device, options);
}

}  // namespace penumbra::volumes
