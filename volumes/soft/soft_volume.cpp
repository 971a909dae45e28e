// SPDX-License-Identifier: Apache-2.0
// U. Assarsson, T. Akenine-Möller, A geometry-based soft shadow volume algorithm using graphics hardware, SIGGRAPH
// 2003: shadow volumes of the light's centre count the layers there; a penumbra wedge for each edge finds the pixels
// where the edge changes that count for a part of the light, and adds the part. Departures: any soup, by signed
// multiplicity; sums of integers in a buffer instead of blending; clipping the edge by the light is itself the test of
// being in the wedge; signs in double decide an edge's orientation, as they decide the count, and where they cannot,
// the host does.

#include "volumes/soft/methods.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"
#include "volumes/soft/coverage_table.hpp"
#include "volumes/soft/fused_volume.hpp"
#include "volumes/soft/light_parts.hpp"
#include "volumes/soft/repairs.hpp"
#include "volumes/wedges/soft_visibility.hpp"
#include "volumes/soft/soft_volume.frag.spv.hpp"
#include "volumes/wedges/texture_weights.hpp"
#include "volumes/raster/volume_count.hpp"
#include "volumes/raster/wedge_builder.hpp"
#include "volumes/wedges/wedge_casters.hpp"
#include "volumes/raster/wedge_raster.hpp"

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

using visibility::Light;
using visibility::SceneFloats;
using visibility::Tile;
using visibility::ViewSamples;

constexpr visibility::ChoiceOption kSplit{
    "split",
    {{"1", 1U}, {"2", 2U}, {"3", 3U}},
    1U,
    "divide a rectangle light into split² lights, each with its own silhouettes and count"};
constexpr visibility::ChoiceOption kTable{
    "coverage",
    {{"analytic", false}, {"table", true}},
    false,
    "integrate the light beyond each edge, or look it up between 1024 points of the light"};
constexpr visibility::ChoiceOption kConstruction{"construction",
                                                 {{"original", Construction::original}, {"tight", Construction::tight}},
                                                 Construction::original,
                                                 "construction of the wedges, which limit the pixels that are tested"};
constexpr auto kWedges = wedges_option(
    "processor that builds silhouettes and wedges for each light (tight wedges are always built on the host)");
constexpr visibility::ChoiceOption kTests{
    "tests",
    {{"none", WedgeTests::none}, {"z", WedgeTests::z}, {"both", WedgeTests::both}},
    WedgeTests::both,
    "exclude pixels from the footprints of wedges by depth (z), or also by orientation (both) (Lengyel)"};

enum class Combined { sum, max, product, average, vote };
constexpr visibility::ChoiceOption kFusion{
    "fusion",
    {{"sum", Combined::sum},
     {"max", Combined::max},
     {"product", Combined::product},
     {"average", Combined::average},
     {"vote", Combined::vote}},
    Combined::sum,
    "sum: adds the shares hidden by all occluders; max, product, average: combine the shares of single objects: the "
    "largest, as if they were independent, or the mean of largest and sum; vote: as sum, but three points of the light "
    "vote on the number of layers"};

/// Handling of edges that pass the light's centre within rounding, as a view sample sees them.
enum class Sides { exact, published };
constexpr visibility::ChoiceOption kSides{
    "as",
    {{"repaired", Sides::exact}, {"published", Sides::published}},
    Sides::exact,
    "repaired: decides by exact signs on which side of the light's centre an edge passes; published: decides by "
    "floats; where they are wrong, V is wrong by a whole layer"};

visibility::MeshVerdict soft_volume_verdict(const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::approximate,
          visibility::reason_with(
              "the light centre's silhouettes are used for every light sample, and layers that overlap are added", mesh,
              {{mesh.boundary_edges.count,
                "boundary edges: each triangle of the surface counts on its own, and a solid that is not closed counts "
                "twice"},
               {mesh.zero_area_triangles.count, "triangles without area, which cast no shadow"}})};
}

}  // namespace

visibility::MethodDescription soft_volume_description() {
  return {.name = "soft-volume",
          .family = visibility::Family::geometry,
          .paper = "Assarsson and Akenine-Möller 2003",
          .output = visibility::Output::scalar,
          .exact_for =
              "occluders that do not overlap as seen from the view sample and whose silhouettes are those that "
              "the light's centre sees: planar ones, say",
          .lights = visibility::kPlanarLights - visibility::kPolygons,
          .options = {kSplit.description(), kTable.description(), kConstruction.description(), kWedges.description(),
                      kTests.description(), kFusion.description(), kSides.description()},
          .verdict_on = soft_volume_verdict,
          .repairs = soft_volume_repairs};
}

namespace {

/// The light, or one of the parts into which it is cut.
struct CountedPart {
  explicit CountedPart(const render::Device& device) : count(device, CountVariant::z_fail, Layers::one_a_solid) {}

  VolumeCount count;
  std::vector<VolumeCount> voters;  // counts at other points; empty: only the centre decides
  Light light;
  LightOutline outline;
  std::optional<TextureWeights> texture;
  std::vector<double> table;  // data of this light for the shader
  double weight = 1;          // fraction of the whole light
  LightWedges wedges;
  std::uint64_t facings_on_host = 0, edges_on_host = 0;  // as in WedgeBuilder::Built
  std::optional<std::vector<gpu::WedgeFace>> faces;      // for this view
  struct Host {
    Host(const SceneFloats& scene, const Light& light)
        : casters(casters_of(scene, light)), visibility(scene, light, casters) {}
    Casters casters;
    SoftVisibility visibility;
  };
  std::unique_ptr<Host> host;  // made for the first doubtful pixel
};

class SoftVolume final : public visibility::Method {
 public:
  SoftVolume(const render::Device& device, const visibility::ParsedOptions& options)
      : description_(soft_volume_description()),
        device_(&device),
        split_(options[kSplit]),
        table_(options[kTable]),
        builder_(device,
                 {.on = options[kWedges], .construction = options[kConstruction], .layers = Layers::one_a_solid}),
        tests_(options[kTests]),
        votes_(options[kFusion] == Combined::vote),
        sides_(votes_                                ? 2
               : options[kSides] == Sides::published ? 1
                                                     : 0) {
    for (std::uint32_t i = 0; i < split_ * split_; ++i) {
      parts_.push_back(std::make_unique<CountedPart>(device));
      for (std::uint32_t k = 0; votes_ && k < gpu::kVoters; ++k) {
        parts_.back()->voters.emplace_back(device, CountVariant::z_fail, Layers::one_a_solid);
      }
    }
  }

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }

  void prepare_mesh(const SceneFloats& scene) override {
    scene_ = &scene;
    builder_.prepare_mesh(scene);
    for (const auto& part : parts_) {
      part->count.prepare_scene(scene);
      for (VolumeCount& voter : part->voters) voter.prepare_mesh(scene);
    }
  }

  void prepare_light(const Light& light) override {
    visibility::check_light(description_, light);
    if (split_ > 1) {
      visibility::require_kind(light, visibility::kParallelograms,
                               "; method soft-volume can divide only rectangles: use split=1");
    }
    make_raster(light);
    const std::vector<Light> lights = volumes::light_parts(light, split_);
    for (std::size_t i = 0; i < parts_.size(); ++i) prepare(*parts_[i], lights[i]);
    double whole = 0;
    for (const auto& part : parts_) whole += part->weight;
    for (const auto& part : parts_) part->weight /= whole;
    prepared_ = nullptr;
    doubtful_ = overruled_ = undecided_ = 0;
  }

  void prepare_view(const ViewSamples& samples) override {
    samples_ = &samples;
    for (const auto& part : parts_) {
      part->count.prepare_view(samples);
      for (VolumeCount& voter : part->voters) voter.prepare_view(samples);
      part->faces.reset();
    }
  }

  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    return std::min(parts_.front()->count.max_tile_rows(), raster_->max_tile_rows(*samples_));
  }

  void evaluate(const Tile& tile) override {
    tile_ = tile;
    sums_.assign(std::size_t{tile.row_count} * samples_->width, 0.0);
    for (const auto& part : parts_) add(*part);
  }

  void read_visibility(std::span<float> visibility) override {
    PENUMBRA_ASSERT(visibility.size() == sums_.size(), "{} values for a tile of {} pixels", visibility.size(),
                    sums_.size());
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      visibility[i] = static_cast<float>(std::min(sums_[i], 1.0));
    }
  }

  std::vector<visibility::PassTime> take_pass_times() override;
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override;
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    std::uint64_t bytes = builder_.memory_bytes() + (raster_ ? raster_->memory_bytes() : 0);
    for (const auto& part : parts_) {
      bytes += part->count.memory_bytes();
      for (const VolumeCount& voter : part->voters) bytes += voter.memory_bytes();
    }
    return bytes;
  }

 private:
  void make_raster(const Light& light);
  void prepare(CountedPart& part, const Light& light);
  void add(CountedPart& part);
  void add_doubtful(CountedPart& part, const std::vector<std::size_t>& pixels);
  [[nodiscard]] double share_above(const CountedPart& part, std::size_t pixel) const;
  std::vector<std::int64_t> layers_by_vote(CountedPart& part);

  visibility::MethodDescription description_;
  const render::Device* device_;
  std::uint32_t split_;
  bool table_;
  WedgeBuilder builder_;
  WedgeTests tests_;
  bool votes_;
  gpu::uint sides_;                        // constant kSides of the shader
  std::vector<gpu::uint> kind_;            // constants of raster_: shape and measure
  const CountedPart* prepared_ = nullptr;  // the part whose table raster_ has
  std::unique_ptr<WedgeRaster> raster_;
  std::vector<std::unique_ptr<CountedPart>> parts_;
  const SceneFloats* scene_ = nullptr;
  const ViewSamples* samples_ = nullptr;
  Tile tile_;
  std::vector<double> sums_;  // sums of V over the parts
  std::uint64_t doubtful_ = 0, overruled_ = 0, undecided_ = 0;
};

/// The shader's constants depend on the light's shape and texture.
void SoftVolume::make_raster(const Light& light) {
  const gpu::uint shape = is_round(light.kind) ? gpu::kDisk : gpu::kRectangle;
  const gpu::uint measure = table_ ? gpu::kTable : light.texture ? gpu::kTexture : gpu::kArea;
  const std::vector<gpu::uint> kind{shape, measure, sides_};
  if (raster_ && kind == kind_) return;
  raster_ = std::make_unique<WedgeRaster>(*device_, WedgeShader{.name = "wedges",
                                                                .fragment = shaders::kSoftVolumeFrag,
                                                                .constants = kind,
                                                                .words = votes_ ? 1 + gpu::kVoters : 1});
  kind_ = kind;
}

void SoftVolume::prepare(CountedPart& part, const Light& light) {
  part.light = light;
  part.outline = light_outline(light);
  part.texture.reset();
  part.weight = 1;
  part.table.assign(1, 0.0);
  if (light.texture) {
    part.weight = light.texture->mean_luminance;
    if (part.weight > 0) part.texture.emplace(*light.texture);  // a part may be black
    if (part.texture) part.table = part.texture->words();
  }
  if (table_ && part.weight > 0) part.table = coverage_table(part.outline, part.texture ? &*part.texture : nullptr);
  WedgeBuilder::Built built = builder_.build(part.light);
  part.count.prepare_light(part.light, std::move(built.volumes));
  for (std::size_t k = 0; k < part.voters.size(); ++k) {
    const auto [center, u, v] = visibility::light_frame(part.light);
    const glm::vec3 l(center + gpu::kVoterAt[k][0] * u + gpu::kVoterAt[k][1] * v);
    VolumeCount& voter = part.voters[k];
    voter.prepare_light(part.light, voter.casters().seen_from(l, part.light));
  }
  part.wedges = std::move(built.wedges);
  part.facings_on_host = built.facings_on_host;
  part.edges_on_host = built.edges_on_host;
  part.faces.reset();
  part.host.reset();
}

/// Adds each pixel's V for this part.
void SoftVolume::add(CountedPart& part) {
  using Kind = VolumeCount::Kind;
  if (!(part.weight > 0)) return;
  if (!part.faces) part.faces = faces_of(part.wedges, *samples_, tests_, glm::dvec3(part.count.center()));
  part.count.count(tile_);
  const std::span<const Kind> kinds = part.count.kinds();
  const std::size_t first = std::size_t{tile_.first_row} * samples_->width;
  std::vector<gpu::WedgeReceiver> receivers(kinds.size());
  std::vector<std::uint8_t> away(kinds.size());
  for_each_index(kinds.size(), [&](std::size_t i) {
    if (kinds[i] != Kind::counted) return;
    const glm::vec3& p = samples_->p[first + i];
    away[i] = appears_in_place(samples_->camera, p, first + i) ? 0 : 1;
    receivers[i] = {p, away[i] == 0 ? 1u : 0u};
  });
  gpu::WedgePush push = wedge_push(part.light);
  if (part.texture) push.texels = part.texture->texels();
  if (prepared_ != &part) raster_->set_table(part.table);
  prepared_ = &part;
  raster_->add(*part.faces, receivers, push, tile_, samples_->width);

  std::vector<std::size_t> doubtful;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i] == Kind::counted && (away[i] != 0 || raster_->doubts()[i] != 0)) doubtful.push_back(i);
  }
  add_doubtful(part, doubtful);
  const std::vector<std::int64_t> voted = part.voters.empty() ? std::vector<std::int64_t>() : layers_by_vote(part);
  const std::size_t words = 1 + part.voters.size();
  for (const std::size_t i : doubtful) away[i] = 1;
  for_each_index(kinds.size(), [&](std::size_t i) {
    if (kinds[i] == Kind::lit) sums_[i] += part.weight;
    if (kinds[i] != Kind::counted || away[i] != 0) return;
    const auto layers = static_cast<double>(voted.empty() ? part.count.counts()[i] : voted[i]);
    const double blocked = layers + gpu::kSumUnit * static_cast<double>(raster_->sums()[i * words]);
    sums_[i] += part.weight * std::clamp(1 - blocked, 0.0, share_above(part, first + i));
  });
}

/// Returns the layers at the light's centre by majority of three points. Each point votes with its own count minus the
/// layers between it and the centre.
std::vector<std::int64_t> SoftVolume::layers_by_vote(CountedPart& part) {
  using Kind = VolumeCount::Kind;
  const std::span<const Kind> kinds = part.count.kinds();
  const std::size_t words = 1 + part.voters.size();
  for (VolumeCount& voter : part.voters) voter.count(tile_);
  std::vector<std::int64_t> layers(kinds.size());
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i] != Kind::counted) continue;
    std::vector<std::int64_t> votes{part.count.counts()[i]};
    for (std::size_t k = 0; k < part.voters.size(); ++k) {
      const VolumeCount& voter = part.voters[k];
      if (voter.kinds()[i] != Kind::counted) continue;  // below the horizon: no vote
      votes.push_back(voter.counts()[i] - raster_->sums()[i * words + 1 + k]);
    }
    const std::int64_t own = votes.front();
    std::ranges::sort(votes);
    layers[i] = votes.size() == 1 + part.voters.size() ? votes[votes.size() / 2] : own;
    overruled_ += layers[i] != own ? 1 : 0;
    undecided_ += std::ranges::adjacent_find(votes) == votes.end() && votes.size() > 1 ? 1 : 0;
  }
  return layers;
}

/// Adds pixels by exact signs, and with another reference point of the light where an edge ends at its centre.
void SoftVolume::add_doubtful(CountedPart& part, const std::vector<std::size_t>& pixels) {
  if (pixels.empty()) return;
  doubtful_ += pixels.size();
  if (!part.host) part.host = std::make_unique<CountedPart::Host>(*scene_, part.light);
  const std::size_t first = std::size_t{tile_.first_row} * samples_->width;
  tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
    const std::size_t pixel = first + pixels[i];
    const LitPoint point{samples_->p[pixel], static_cast<std::uint32_t>(samples_->triangle[pixel]),
                         samples_->facing[pixel]};
    sums_[pixels[i]] += part.weight * part.host->visibility.at(point, Viewer::center).visibility;
  });
}

/// Returns the share of the part above the plane of the pixel's carrier.
double SoftVolume::share_above(const CountedPart& part, std::size_t pixel) const {
  const auto [a, b, c] = scene_->corners(static_cast<std::uint32_t>(samples_->triangle[pixel]));
  const glm::dvec3 n = static_cast<double>(samples_->facing[pixel]) *
                       glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
  const glm::dvec3 o(part.light.center);
  return volumes::share_above(
      part.outline, glm::dot(n, o - glm::dvec3(a)),
      {glm::dot(n, glm::dvec3(part.light.center_u) - o), glm::dot(n, glm::dvec3(part.light.center_v) - o)});
}

std::vector<visibility::PassTime> SoftVolume::take_pass_times() {
  visibility::PassTimes all;
  all.add(builder_.take_pass_times());
  for (const auto& part : parts_) all.add(part->count.take_pass_times());
  if (raster_) all.add(raster_->take_pass_times());
  return all.take();
}

std::map<std::string, std::uint64_t> SoftVolume::counters() const {
  std::map<std::string, std::uint64_t> result{{"pixelsOnHost", doubtful_}};
  if (votes_) {
    result["pixelsOverruled"] = overruled_;
    result["pixelsWithoutMajority"] = undecided_;
  }
  for (const auto& part : parts_) {
    const VolumeCount::Totals& totals = part->count.totals();
    result["silhouetteEdges"] += totals.silhouette_edges;
    result["facingsOnHost"] += part->facings_on_host;
    result["edgesOnHost"] += part->edges_on_host;
    result["pixelsCountedOnHost"] += totals.doubtful_pixels;
    result["largestCount"] = std::max(result["largestCount"], totals.largest_count);
    for (const Wedge& wedge : part->wedges.wedges) {
      ++result["wedges" + std::string(wedge.outcome == WedgeOutcome::wedge ? "" : ":") +
               (wedge.outcome == WedgeOutcome::wedge ? "" : name_of(wedge.outcome))];
    }
    if (!part->faces) continue;
    result["wedgesOnScreen"] += part->faces->size();
    result["fragments"] += fragments_of(*part->faces);
  }
  return result;
}

}  // namespace

std::unique_ptr<visibility::Method> make_soft_volume(const render::Device& device,
                                                     const visibility::MethodOptions& options) {
  const visibility::ParsedOptions parsed = visibility::parse_options(soft_volume_description(), options);
  const auto rule = [&]() -> std::optional<Fusion> {
    switch (parsed[kFusion]) {
      case Combined::max:
        return Fusion::max;
      case Combined::product:
        return Fusion::product;
      case Combined::average:
        return Fusion::average;
      default:
        return std::nullopt;
    }
  }();
  if (!rule) return std::make_unique<SoftVolume>(device, parsed);
  visibility::MethodOptions alone = options;
  alone.erase("fusion");
  alone.erase("split");  // applied by the fusion to each part
  return make_fused(soft_volume_description(),
                    std::make_unique<SoftVolume>(device, visibility::parse_options(soft_volume_description(), alone)),
                    {.rule = *rule, .split = parsed[kSplit]});
}

}  // namespace penumbra::volumes
