// SPDX-License-Identifier: Apache-2.0
// G. Johnson, W. Hunt, A. Hux, W. Mark, C. Burns and S. Junkins, Soft irregular shadow mapping: fast, high-quality, and
// robust soft shadows, I3D 2009: an irregular shadow map decides the umbra of the light's centre; the penumbra wedge of
// each silhouette edge of the centre is drawn, in light space, over view samples in a grid shaped like the light's
// frustum; for each view sample inside, the signed area that the edge covers is added, by an arc cosine.
//
// Departures (docs/soft-irregular.md). Cells of the grid are lists of light pixels without slices of depth: a wedge
// skips lists that end in front of it. The umbra is decided by exact predicates, without bias. A view sample outside of
// the frustum tests every edge. Polygons and textures, which have no arcs, are supported. Two options remove the
// method's own approximations: silhouettes=receiver, fusion=union.

#include "volumes/soft/methods.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "engines/pairs/far_plane.hpp"
#include "engines/pairs/list_raster.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/receivers.hpp"
#include "volumes/soft/repairs.hpp"
#include "volumes/wedges/soft_visibility.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace penumbra::volumes {
namespace {

constexpr double kPerLightPixel = 2;            ///< average number of view samples
constexpr std::size_t kMostPixels = 1U << 18U;  ///< most pixels of a tile, each of which has a projection and a list of
                                                ///< edges

enum class Umbra : std::uint8_t { map, layers };
constexpr visibility::ChoiceOption kUmbra{
    "umbra",
    {{"map", Umbra::map}, {"layers", Umbra::layers}},
    Umbra::map,
    "map: store only whether the light's centre is visible, as published; layers: count how many layers hide it"};
constexpr visibility::ChoiceOption kArc{
    "arc",
    {{"cosine", Arc::cosine}, {"tangent", Arc::tangent}},
    Arc::cosine,
    "disks and ellipses: the angle of a sector by an arc cosine, as published, or by "
    "arc tangents, which keep small angles"};

constexpr visibility::ChoiceOption kSilhouettes{"silhouettes",
                                                {{"centre", Viewer::center}, {"receiver", Viewer::receiver}},
                                                Viewer::center,
                                                "centre: for all view samples those that the light's centre sees, as "
                                                "published; receiver: those that each view sample sees"};
enum class Overlap : std::uint8_t { sum, joined };
constexpr visibility::ChoiceOption kOverlap{"fusion",
                                            {{"sum", Overlap::sum}, {"union", Overlap::joined}},
                                            Overlap::sum,
                                            "sum: a part of the light that two layers hide counts twice; union: V is "
                                            "the fraction of light samples that no layer hides, with umbra=layers"};

visibility::MeshVerdict soft_irregular_verdict(const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::approximate,
          visibility::reason_with(
              "the light centre's silhouettes are used for every light sample, and light leaks where one occluder's "
              "edge adds light although another occluder hides the centre",
              mesh,
              {{mesh.boundary_edges.count, "boundary edges: each triangle of the surface counts on its own"},
               {mesh.zero_area_triangles.count, "triangles without area, which cast no shadow"}})};
}

visibility::MethodDescription describe_soft_irregular() {
  return {.name = "soft-irregular",
          .family = visibility::Family::geometry,
          .paper = "Johnson, Hunt, Hux, Mark, Burns and Junkins 2009",
          .output = visibility::Output::scalar,
          .exact_for =
              "one occluder at a time, of one layer, whose silhouettes from the view sample are those from the "
              "light's centre",
          .lights = visibility::kPlanarLights,
          .on_request = true,
          .options = {kUmbra.description(), kArc.description(), kSilhouettes.description(), kOverlap.description()},
          .verdict_on = soft_irregular_verdict,
          .repairs = soft_irregular_repairs};
}

/// A view sample in front of the light, and its results.
struct Receiver {
  std::uint32_t pixel = 0;  ///< pixel of the tile
  LitPoint at;
  LightProjection projection;
  std::optional<std::int32_t> layers = {};             ///< layers at the light's centre; nullopt: p is not in the map
  std::vector<SoftVisibility::Silhouette> edges = {};  ///< edges that may appear on the light, ascending
  bool tries_all = false;
};

class SoftIrregular final : public visibility::Method {
 public:
  explicit SoftIrregular(const visibility::MethodOptions& given) : description_(describe_soft_irregular()) {
    const visibility::ParsedOptions options = visibility::parse_options(description_, given);
    umbra_ = options[kUmbra];
    arc_ = options[kArc];
    viewer_ = options[kSilhouettes];
    overlap_ = options[kOverlap];
    if (overlap_ == Overlap::joined && umbra_ == Umbra::map)
      throw UsageError("soft-irregular: fusion=union joins all layers, but the map has only one: add umbra=layers");
  }

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void want_pixels(std::span<const std::uint32_t> pixels) override { wanted_.emplace(pixels.begin(), pixels.end()); }
  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    light_ = nullptr;
  }
  void prepare_light(const visibility::Light& light) override {
    PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first: {}", light.name);
    visibility::check_light(description_, light);
    light_ = &light;
    casters_ = casters_of(*scene_, light);
    seen_.emplace(*scene_, light, casters_, arc_);
    box_ = pairs::make_light_box(light);
    for (const glm::vec3& corner : light.outline) {  // the outline may extend beyond the light's samples
      const glm::dvec2 at(box_.place(glm::dvec3(corner)));
      box_.lower = glm::min(box_.lower, at);
      box_.upper = glm::max(box_.upper, at);
    }
    counters_.clear();
  }
  void prepare_view(const visibility::ViewSamples& samples) override { samples_ = &samples; }
  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    PENUMBRA_ASSERT(samples_ != nullptr, "prepare_view comes first");
    return static_cast<std::uint32_t>(std::clamp<std::size_t>(kMostPixels / samples_->width, 1, samples_->height));
  }
  void evaluate(const visibility::Tile& tile) override;
  void read_visibility(std::span<float> visibility) override {
    PENUMBRA_ASSERT(visibility.size() == visibility_.size(), "{} pixels asked for, {} evaluated", visibility.size(),
                    visibility_.size());
    std::ranges::copy(visibility_, visibility.begin());
  }
  std::vector<visibility::PassTime> take_pass_times() override { return times_.take(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return bytes_; }

 private:
  [[nodiscard]] std::vector<Receiver> receivers_of(const visibility::Tile& tile);
  void draw_umbra(std::vector<Receiver>& receivers);
  void draw_wedges(std::vector<Receiver>& receivers);
  void resolve(const std::vector<Receiver>& receivers);
  /// Returns the frusta on the emitting sides of the light.
  [[nodiscard]] std::vector<pairs::FarPlane> planes(const pairs::LightBox& box,
                                                    const std::vector<Receiver>& receivers) const;
  template <typename Stage>
  void timed(const char* name, const Stage& stage) {
    const auto begin = std::chrono::steady_clock::now();
    stage();
    times_.add({name, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count()});
  }

  visibility::MethodDescription description_;
  Umbra umbra_ = Umbra::map;
  Arc arc_ = Arc::cosine;
  Viewer viewer_ = Viewer::center;
  Overlap overlap_ = Overlap::sum;
  std::optional<std::vector<std::uint32_t>> wanted_;  // pixels, ascending; nullopt: all
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  const visibility::ViewSamples* samples_ = nullptr;
  Casters casters_;
  std::optional<SoftVisibility> seen_;
  pairs::LightBox box_;
  std::vector<float> visibility_;  // of the tile
  visibility::PassTimes times_;
  std::map<std::string, std::uint64_t> counters_;
  std::uint64_t bytes_ = 0;
};

void SoftIrregular::evaluate(const visibility::Tile& tile) {
  PENUMBRA_ASSERT(samples_ != nullptr && light_ != nullptr, "prepare_light and prepare_view come first");
  std::vector<Receiver> receivers = receivers_of(tile);
  if (viewer_ == Viewer::center) {
    timed("irregular shadow map", [&] { draw_umbra(receivers); });
    timed("wedges", [&] { draw_wedges(receivers); });
  }
  timed("areas", [&] { resolve(receivers); });
}

/// Returns the receivers. All other pixels get V = 1; or 0 where the light does not emit; or, if not wanted, not a
/// number.
std::vector<Receiver> SoftIrregular::receivers_of(const visibility::Tile& tile) {
  const std::size_t first = std::size_t{tile.first_row} * samples_->width;
  visibility_.assign(std::size_t{tile.row_count} * samples_->width, 1);
  std::vector<Receiver> receivers;
  for (std::size_t i = 0; i < visibility_.size(); ++i) {
    const std::size_t pixel = first + i;
    if (wanted_ && !std::ranges::binary_search(*wanted_, static_cast<std::uint32_t>(pixel))) {
      visibility_[i] = std::numeric_limits<float>::quiet_NaN();
      continue;
    }
    if (!visibility::is_receiver(*scene_, *light_, *samples_, pixel)) continue;
    const glm::vec3& p = samples_->p[pixel];
    visibility_[i] = 0;
    if (!visibility::in_front_of_light(*light_, p)) continue;
    receivers.push_back({.pixel = static_cast<std::uint32_t>(i),
                         .at = {p, static_cast<std::uint32_t>(samples_->triangle[pixel]), samples_->facing[pixel]},
                         .projection = LightProjection(*light_, p)});
  }
  return receivers;
}

std::vector<pairs::FarPlane> SoftIrregular::planes(const pairs::LightBox& box,
                                                   const std::vector<Receiver>& receivers) const {
  std::vector<std::uint32_t> all(receivers.size());
  std::iota(all.begin(), all.end(), 0U);
  std::vector<glm::vec3> places;
  places.reserve(receivers.size());
  for (const Receiver& receiver : receivers) places.push_back(receiver.at.p);
  const double reach = 2 * std::max(glm::length(glm::dvec3(scene_->lower)), glm::length(glm::dvec3(scene_->upper))) +
                       glm::length(box.origin) + glm::length(box.lower) + glm::length(box.upper);
  std::vector<pairs::FarPlane> planes;
  for (const double side : {1.0, -1.0}) {
    if (side < 0 && !light_->two_sided) continue;
    planes.emplace_back(box, side, reach, all, places, kPerLightPixel);
  }
  return planes;
}

/// Draws each triangle's footprint, as seen from the light's centre, over Aila and Laine's lists of view samples.
void SoftIrregular::draw_umbra(std::vector<Receiver>& receivers) {
  pairs::LightBox center = box_;
  center.origin = glm::dvec3(visibility::center_of(*light_));
  center.lower = center.upper = glm::dvec2(0);
  std::vector<std::uint32_t> triangles;
  for (const std::uint32_t triangle : casters_.triangle) {
    if (seen_->counts_at_center(triangle)) triangles.push_back(triangle);
  }
  for (pairs::FarPlane& plane : planes(center, receivers)) {
    if (plane.empty()) continue;
    for (std::uint32_t i = 0; i < plane.heights().size(); ++i) receivers[plane.pixel(i)].layers = 0;
    struct Tests {
      std::uint64_t count = 0;
    };
    const pairs::ListCounts drawn = pairs::draw<Tests>(
        {plane.light_pixels(), plane.heights(), triangles},
        [&](std::uint32_t triangle) { return plane.footprint(scene_->corners(triangle)); },
        [&](std::uint32_t triangle) { return plane.nearest(scene_->corners(triangle)); },
        [&](std::uint32_t triangle, std::uint32_t number, Tests& tests) {
          Receiver& receiver = receivers[plane.pixel(number)];
          ++tests.count;
          *receiver.layers += seen_->layer_at_center(receiver.at, triangle);
          return umbra_ == Umbra::layers || *receiver.layers == 0;
        },
        [&](const Tests& tests) { counters_["umbraTests"] += tests.count; });
    counters_["umbraFootprints"] += drawn.footprints;
    counters_["longestList"] = std::max<std::uint64_t>(counters_["longestList"], plane.light_pixels().longest_list());
  }
}

void SoftIrregular::draw_wedges(std::vector<Receiver>& receivers) {
  const auto& silhouettes = seen_->silhouettes_of_center();
  std::vector<std::uint32_t> numbers(silhouettes.size());
  std::iota(numbers.begin(), numbers.end(), 0U);
  const auto ends_of = [&](std::uint32_t number) {
    const auto [a, b] = casters_.graph.edges[silhouettes[number].first];
    const glm::vec3 from(casters_.positions[a]), to(casters_.positions[b]);
    return std::array{from, to, to};
  };
  counters_["silhouetteEdges"] = silhouettes.size();
  std::uint64_t bytes = receivers.size() * sizeof(Receiver);
  for (pairs::FarPlane& plane : planes(box_, receivers)) {
    for (const std::uint32_t outside : plane.outside()) receivers[outside].tries_all = true;
    if (plane.empty()) continue;
    struct Found {
      std::uint64_t tested = 0, kept = 0;
    };
    const pairs::ListCounts drawn = pairs::draw<Found>(
        {plane.light_pixels(), plane.heights(), numbers},
        [&](std::uint32_t number) { return plane.footprint(ends_of(number)); },
        [&](std::uint32_t number) { return plane.nearest(ends_of(number)); },
        [&](std::uint32_t number, std::uint32_t place, Found& found) {
          Receiver& receiver = receivers[plane.pixel(place)];
          ++found.tested;
          if (!seen_->may_appear(receiver.projection, silhouettes[number].first)) return true;
          ++found.kept;
          receiver.edges.push_back(silhouettes[number]);
          return true;
        },
        [&](const Found& found) {
          counters_["wedgeTests"] += found.tested;
          counters_["edgesOnLight"] += found.kept;
        });
    counters_["wedgeFootprints"] += drawn.footprints;
    counters_["listsTouched"] += drawn.lists;
    bytes += plane.light_pixels().bytes();
  }
  for (const Receiver& receiver : receivers) {
    bytes += receiver.edges.capacity() * sizeof(receiver.edges[0]);
    counters_["viewSamplesOutside"] += receiver.tries_all ? 1U : 0U;
  }
  bytes_ = std::max(bytes_, bytes);
}

void SoftIrregular::resolve(const std::vector<Receiver>& receivers) {
  const std::vector<glm::dvec2> points =
      overlap_ == Overlap::joined ? seen_->light_samples() : std::vector<glm::dvec2>();
  const bool at_most_one = umbra_ == Umbra::map;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, receivers.size(), 64), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const Receiver& receiver = receivers[i];
      const LayerSum sum = viewer_ == Viewer::receiver
                               ? seen_->at(receiver.at, viewer_, at_most_one)
                               : seen_->at_center(receiver.at,
                                                  receiver.tries_all ? std::span(seen_->silhouettes_of_center())
                                                                     : std::span(receiver.edges),
                                                  {receiver.layers, at_most_one});
      const bool joins = overlap_ == Overlap::joined;
      visibility_[receiver.pixel] =
          static_cast<float>(joins ? SoftVisibility::visible_share(sum, points, light_->weights) : sum.visibility);
    }
  });
}

}  // namespace

std::unique_ptr<visibility::Method> make_soft_irregular(const visibility::MethodOptions& options) {
  return std::make_unique<SoftIrregular>(options);
}

}  // namespace penumbra::volumes
