// SPDX-License-Identifier: Apache-2.0
// T. Akenine-Möller, U. Assarsson, Approximate soft shadows on arbitrary surfaces using penumbra wedges, EGWR 2002:
// hard shadow volumes of the light's centre; for each edge, light that falls linearly between the front and the back
// plane of a wedge replaces the hard step. Departures: any soup; rectangle, disk and ellipse lights, not a sphere;
// integer sums.

#include "volumes/soft/methods.hpp"

#include "base/parallel.hpp"
#include "volumes/soft/hard_and_wedges.hpp"
#include "volumes/soft/ramp_wedges.hpp"
#include "volumes/soft/repairs.hpp"
#include "volumes/soft/wedge_ramp.frag.spv.hpp"

#include <algorithm>

namespace penumbra::volumes {
namespace {

using visibility::Light;
using visibility::Tile;

visibility::MeshVerdict wedge_ramp_verdict(const mesh::Diagnosis& mesh) {
  return {
      visibility::Verdict::approximate,
      visibility::reason_with(
          "a linear ramp replaces the covered area, the light centre's silhouettes are used for every light sample, "
          "and layers are added",
          mesh, {{mesh.boundary_edges.count, "boundary edges: each triangle of an open surface counts on its own"}})};
}

}  // namespace

visibility::MethodDescription wedge_ramp_description() {
  return {.name = "wedge-ramp",
          .family = visibility::Family::geometry,
          .paper = "Akenine-Möller and Assarsson 2002",
          .output = visibility::Output::scalar,
          .exact_for = "only the umbra and the fully lit region of one occluder with a simple silhouette",
          .lights = visibility::kPlanarLights - visibility::kPolygons,
          .textures = false,
          .options = {},
          .verdict_on = wedge_ramp_verdict,
          .repairs = wedge_ramp_repairs};
}

namespace {

class WedgeRamp final : public HardAndWedges {
 public:
  WedgeRamp(const render::Device& device, const visibility::MethodOptions& options)
      : HardAndWedges(wedge_ramp_description(), options, VolumeCount(device, CountVariant::z_fail, Layers::one_a_solid),
                      WedgeRaster(device, {"wedge ramps", shaders::kWedgeRampFrag, {}})) {}

  void prepare_light(const Light& light) override {
    visibility::check_light(description_, light);
    light_ = &light;
    count_.prepare_light(light);
    wedges_ = ramp_wedges_of(count_.volumes(), light);
    const std::vector<double> words = ramp_words(wedges_);
    if (!words.empty()) raster_.set_table(words);
    faces_.reset();
    on_host_ = 0;
  }
  void evaluate(const Tile& tile) override;

  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    auto counters = HardAndWedges::counters();
    counters["hardEdges"] =
        static_cast<std::uint64_t>(std::ranges::count(wedges_.wedges, WedgeOutcome::empty, &Wedge::outcome));
    return counters;
  }
};

void WedgeRamp::evaluate(const Tile& tile) {
  using Kind = VolumeCount::Kind;
  if (!faces_) faces_ = faces_of(wedges_, *samples_, WedgeTests::both, glm::dvec3(count_.center()));
  count_.count(tile);
  const std::span<const Kind> kinds = count_.kinds();
  const std::size_t first = std::size_t{tile.first_row} * samples_->width;
  std::vector<gpu::WedgeReceiver> receivers(kinds.size());
  std::vector<std::uint8_t> on_host(kinds.size());
  for_each_index(kinds.size(), [&](std::size_t i) {
    if (kinds[i] != Kind::counted) return;
    const glm::vec3& p = samples_->p[first + i];
    on_host[i] = appears_in_place(samples_->camera, p, first + i) ? 0 : 1;
    receivers[i] = {p, on_host[i] == 0 ? 1u : 0u};
  });
  raster_.add(*faces_, receivers, wedge_push(*light_), tile, samples_->width);
  visibility_.resize(kinds.size());
  for_each_index(kinds.size(), [&](std::size_t i) {
    visibility_[i] = kinds[i] == Kind::lit ? 1.0F : 0.0F;
    if (kinds[i] != Kind::counted) return;
    if (raster_.doubts()[i] != 0) on_host[i] = 1;
    const double sum = on_host[i] != 0 ? ramp_sum(wedges_, *light_, samples_->p[first + i])
                                       : gpu::kSumUnit * static_cast<double>(raster_.sums()[i]);
    visibility_[i] = static_cast<float>(std::clamp(1 - count_.counts()[i] - sum, 0.0, 1.0));
  });
  on_host_ += static_cast<std::uint64_t>(std::ranges::count(on_host, 1));
}

}  // namespace

std::unique_ptr<visibility::Method> make_wedge_ramp(const render::Device& device,
                                                    const visibility::MethodOptions& options) {
  return std::make_unique<WedgeRamp>(device, options);
}

}  // namespace penumbra::volumes
