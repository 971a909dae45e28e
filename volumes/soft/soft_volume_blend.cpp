// SPDX-License-Identifier: Apache-2.0
// V. Forest, L. Barthe, M. Paulin, Realistic soft shadows by penumbra-wedges blending, Graphics Hardware 2006: four
// quarters of the light are evaluated at once; their common corner is the point from which silhouettes are seen; and in
// each quarter a box around the covered part reduces the contributions of further occluders. Departures: an occluder is
// an object of the scene, and occluders are processed in the scene's order, so the result does not depend on the order
// of triangles; boxes include covered corners of the light, too.

#include "volumes/soft/methods.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"
#include "volumes/soft/blended_cover.hpp"
#include "volumes/soft/repairs.hpp"
#include "volumes/wedges/soft_visibility.hpp"
#include "volumes/soft/soft_volume_blend.frag.spv.hpp"
#include "volumes/soft/soft_volume_blend.shared.h"
#include "volumes/raster/volume_count.hpp"
#include "volumes/raster/wedge_builder.hpp"
#include "volumes/wedges/wedge_casters.hpp"
#include "volumes/raster/wedge_raster.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

using visibility::Light;
using visibility::SceneFloats;
using visibility::Tile;
using visibility::ViewSamples;

constexpr std::size_t kMostOccluders = 32;  // each has its own passes; further objects share those of the last one

constexpr auto kBlendWedges =
    wedges_option("processor that builds silhouettes and wedges for each light, object by object");

visibility::MeshVerdict soft_volume_blend_verdict(const mesh::Diagnosis& mesh) {
  return {
      visibility::Verdict::approximate,
      visibility::reason_with(
          "the light centre's silhouettes are used for every light sample, and overlap of objects is estimated by "
          "boxes",
          mesh, {{mesh.boundary_edges.count, "boundary edges: each triangle of an open surface counts on its own"}})};
}

}  // namespace

visibility::MethodDescription soft_volume_blend_description() {
  return {.name = "soft-volume-blend",
          .family = visibility::Family::geometry,
          .paper = "Forest, Barthe and Paulin 2006",
          .output = visibility::Output::scalar,
          .exact_for =
              "cases for which soft-volume is exact, if the boxes around occluders in each quarter of the light do not "
              "overlap",
          .lights = visibility::kParallelograms,
          .textures = false,
          .options = {kBlendWedges.description()},
          .verdict_on = soft_volume_blend_verdict,
          .repairs = soft_volume_blend_repairs};
}

namespace {

/// An object, as a scene in which nothing else casts shadows.
struct Occluder {
  Occluder(const render::Device& device, WedgesOn wedges_on, const SceneFloats& all, std::size_t object, bool and_later)
      : scene(all),
        count(device, CountVariant::z_fail, Layers::one_a_solid),
        builder(device, {.on = wedges_on, .layers = Layers::one_a_solid}) {
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
      const bool own = scene.object[t] == object || (and_later && scene.object[t] > object);
      if (!own) scene.casts_shadow[t] = 0;
    }
    count.prepare_scene(scene);
    builder.prepare_mesh(scene);
  }

  SceneFloats scene;
  VolumeCount count;
  WedgeBuilder builder;
  LightWedges wedges;
  std::uint64_t facings_on_host = 0, edges_on_host = 0;  // as in WedgeBuilder::Built
  std::optional<std::vector<gpu::WedgeFace>> faces;      // for this view
};

/// Returns a quarter's cover by one occluder, from the sums of its edges' words and the count at the centre.
Cover cover_of(std::span<const std::int64_t> words, std::uint32_t quarter, std::int32_t count) {
  const auto number = [&](std::size_t word) { return gpu::kSumUnit * static_cast<double>(words[word]); };
  const std::size_t at = std::size_t{quarter} * gpu::kQuarterWords;
  Cover cover;
  cover.share = std::clamp(count + number(at), 0.0, 1.0);
  if (cover.share <= 0) return cover;
  const auto grow = [&](double x, double y) {
    cover.box = {std::min(cover.box[0], x), std::min(cover.box[1], y), std::max(cover.box[2], x),
                 std::max(cover.box[3], y)};
  };
  if (words[at + 1] != 0 || words[at + 2] != 0 || words[at + 3] != 0 || words[at + 4] != 0) {
    grow(1 - number(at + 1), 1 - number(at + 2));
    grow(number(at + 3), number(at + 4));
  }
  // The points of the light at the quarter's other corners which, mirrored into [0, 1]², are (1, 0), (1, 1) and (0, 1).
  constexpr std::array<std::array<std::uint32_t, 3>, 4> kAround{{{0, 1, 2}, {4, 3, 2}, {0, 7, 6}, {4, 5, 6}}};
  const auto covered = [&](std::uint32_t point) { return count + words[gpu::kPointWord + point] > 0; };
  if (count > 0) grow(0, 0);
  if (covered(kAround[quarter][0])) grow(1, 0);
  if (covered(kAround[quarter][1])) grow(1, 1);
  if (covered(kAround[quarter][2])) grow(0, 1);
  return cover;
}

class SoftVolumeBlend final : public visibility::Method {
 public:
  SoftVolumeBlend(const render::Device& device, const visibility::MethodOptions& options)
      : description_(soft_volume_blend_description()),
        device_(&device),
        wedges_on_(visibility::parse_options(description_, options)[kBlendWedges]),
        raster_(device, {"blended wedges", shaders::kSoftVolumeBlendFrag, {}, gpu::kBlendWords, false}) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }

  void prepare_mesh(const SceneFloats& scene) override;
  void prepare_light(const Light& light) override;
  void prepare_view(const ViewSamples& samples) override {
    samples_ = &samples;
    for (const auto& occluder : occluders_) {
      occluder->count.prepare_view(samples);
      occluder->faces.reset();
    }
  }
  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    std::uint32_t rows = raster_.max_tile_rows(*samples_);
    for (const auto& occluder : occluders_) rows = std::min(rows, occluder->count.max_tile_rows());
    return rows;
  }
  void evaluate(const Tile& tile) override;

  void read_visibility(std::span<float> visibility) override {
    PENUMBRA_ASSERT(visibility.size() == visibility_.size(), "{} values for a tile of {} pixels", visibility.size(),
                    visibility_.size());
    std::ranges::copy(visibility_, visibility.begin());
  }
  std::vector<visibility::PassTime> take_pass_times() override {
    visibility::PassTimes all;
    for (const auto& occluder : occluders_) {
      all.add(occluder->builder.take_pass_times());
      all.add(occluder->count.take_pass_times());
    }
    all.add(raster_.take_pass_times());
    return all.take();
  }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override;
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    std::uint64_t bytes = raster_.memory_bytes();
    for (const auto& occluder : occluders_) bytes += occluder->count.memory_bytes() + occluder->builder.memory_bytes();
    return bytes;
  }

 private:
  using Covers = std::array<Cover, 4>;
  void add(Occluder& occluder, const Tile& tile);
  void add_doubtful(const Tile& tile);

  visibility::MethodDescription description_;
  const render::Device* device_;
  WedgesOn wedges_on_;
  WedgeRaster raster_;
  std::vector<std::unique_ptr<Occluder>> occluders_;
  const SceneFloats* scene_ = nullptr;
  const Light* light_ = nullptr;
  const ViewSamples* samples_ = nullptr;
  std::vector<Covers> covers_;
  std::vector<std::uint8_t> on_host_;
  std::vector<float> visibility_;
  std::uint64_t doubtful_ = 0;
};

void SoftVolumeBlend::prepare_mesh(const SceneFloats& scene) {
  scene_ = &scene;
  occluders_.clear();
  std::vector<std::uint8_t> casts;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    if (scene.object[t] >= casts.size()) casts.resize(scene.object[t] + std::size_t{1});
    casts[scene.object[t]] |= scene.casts_shadow[t];
  }
  for (std::size_t object = 0; object < casts.size() && occluders_.size() < kMostOccluders; ++object) {
    if (casts[object] == 0) continue;
    const bool last = occluders_.size() + 1 == kMostOccluders;
    occluders_.push_back(std::make_unique<Occluder>(*device_, wedges_on_, scene, object, last));
  }
  // If nothing casts shadows, one occluder without triangles is used: its count includes the horizon.
  if (occluders_.empty())
    occluders_.push_back(std::make_unique<Occluder>(*device_, wedges_on_, scene, casts.size(), false));
}

void SoftVolumeBlend::prepare_light(const Light& light) {
  visibility::check_light(description_, light);
  light_ = &light;
  for (const auto& occluder : occluders_) {
    WedgeBuilder::Built built = occluder->builder.build(light);
    occluder->count.prepare_light(light, std::move(built.volumes));
    occluder->wedges = std::move(built.wedges);
    occluder->facings_on_host = built.facings_on_host;
    occluder->edges_on_host = built.edges_on_host;
    occluder->faces.reset();
  }
  doubtful_ = 0;
}

void SoftVolumeBlend::evaluate(const Tile& tile) {
  const std::size_t pixels = std::size_t{tile.row_count} * samples_->width;
  covers_.assign(pixels, {});
  on_host_.assign(pixels, 0);
  visibility_.assign(pixels, 1.0F);
  for (const auto& occluder : occluders_) add(*occluder, tile);
  for_each_index(pixels, [&](std::size_t i) {
    double sum = 0;
    for (const Cover& cover : covers_[i]) sum += cover.share;
    visibility_[i] *= static_cast<float>(1 - sum / 4);
  });
  add_doubtful(tile);
}

/// Blends in this occluder's cover. Leaves V at 0 where the light's centre is below the horizon.
void SoftVolumeBlend::add(Occluder& occluder, const Tile& tile) {
  using Kind = VolumeCount::Kind;
  if (!occluder.faces) {
    occluder.faces = faces_of(occluder.wedges, *samples_, WedgeTests::both, glm::dvec3(occluder.count.center()));
  }
  occluder.count.count(tile);
  const std::span<const Kind> kinds = occluder.count.kinds();
  const std::size_t first = std::size_t{tile.first_row} * samples_->width;
  std::vector<gpu::WedgeReceiver> receivers(kinds.size());
  for_each_index(kinds.size(), [&](std::size_t i) {
    if (kinds[i] == Kind::dark) visibility_[i] = 0;
    if (kinds[i] != Kind::counted) return;
    const glm::vec3& p = samples_->p[first + i];
    if (!appears_in_place(samples_->camera, p, first + i)) on_host_[i] = 1;
    receivers[i] = {p, on_host_[i] == 0 ? 1u : 0u};
  });
  raster_.add(*occluder.faces, receivers, wedge_push(*light_), tile, samples_->width);
  for_each_index(kinds.size(), [&](std::size_t i) {
    if (kinds[i] != Kind::counted) return;
    if (raster_.doubts()[i] != 0) on_host_[i] = 1;
    const auto words = raster_.sums().subspan(i * gpu::kBlendWords, gpu::kBlendWords);
    for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
      Cover& there = covers_[i][quarter];
      there = blend(there, cover_of(words, quarter, occluder.count.counts()[i]));
    }
  });
}

/// Handles pixels with doubtful signs: soft-volume's sum, without boxes.
void SoftVolumeBlend::add_doubtful(const Tile& tile) {
  const auto doubtful = static_cast<std::uint64_t>(std::ranges::count(on_host_, 1));
  if (doubtful == 0) return;
  doubtful_ += doubtful;
  const Casters casters = casters_of(*scene_, *light_);
  const SoftVisibility soft(*scene_, *light_, casters);
  const std::size_t first = std::size_t{tile.first_row} * samples_->width;
  for_each_index(on_host_.size(), [&](std::size_t i) {
    if (on_host_[i] == 0) return;
    const LitPoint point{samples_->p[first + i], static_cast<std::uint32_t>(samples_->triangle[first + i]),
                         samples_->facing[first + i]};
    visibility_[i] = static_cast<float>(soft.at(point, Viewer::center).visibility);
  });
}

std::map<std::string, std::uint64_t> SoftVolumeBlend::counters() const {
  std::map<std::string, std::uint64_t> result{{"occluders", occluders_.size()}, {"pixelsOnHost", doubtful_}};
  for (const auto& occluder : occluders_) {
    result["silhouetteEdges"] += occluder->wedges.edges.size();
    result["facingsOnHost"] += occluder->facings_on_host;
    result["edgesOnHost"] += occluder->edges_on_host;
    if (!occluder->faces) continue;
    result["wedgesOnScreen"] += occluder->faces->size();
    result["fragments"] += fragments_of(*occluder->faces);
  }
  return result;
}

}  // namespace

double Cover::box_area() const {
  return std::max(0.0, box[2] - box[0]) * std::max(0.0, box[3] - box[1]);
}

Cover blend(const Cover& there, const Cover& added) {
  if (added.share <= 0) return there;
  Cover result;
  const Cover common{0,
                     {std::max(there.box[0], added.box[0]), std::max(there.box[1], added.box[1]),
                      std::min(there.box[2], added.box[2]), std::min(there.box[3], added.box[3])}};
  double kept = 1;
  if (there.box_area() > 0 && added.box_area() > 0) {
    kept -= common.box_area() / added.box_area() * std::min(there.share / there.box_area(), 1.0);
  }
  // Boxes are a heuristic; the whole is certainly no less than either part.
  result.share = std::clamp(there.share + added.share * kept, std::max(there.share, added.share), 1.0);
  result.box = {std::min(there.box[0], added.box[0]), std::min(there.box[1], added.box[1]),
                std::max(there.box[2], added.box[2]), std::max(there.box[3], added.box[3])};
  return result;
}

std::unique_ptr<visibility::Method> make_soft_volume_blend(const render::Device& device,
                                                           const visibility::MethodOptions& options) {
  return std::make_unique<SoftVolumeBlend>(device, options);
}

}  // namespace penumbra::volumes
