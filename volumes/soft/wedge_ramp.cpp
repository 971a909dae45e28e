// T. Akenine-Möller, U. Assarsson, Approximate soft shadows on arbitrary surfaces using penumbra wedges, EGWR 2002:
// hard shadow volumes of the light's centre, and between the front and back plane of a wedge an edge, in place of the
// hard step, light that falls linearly. Departures: any soup and rectangle, disk and ellipse lights, not a sphere;
// integer sums.

#include "volumes/soft/methods.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"
#include "volumes/soft/ramp_wedges.hpp"
#include "volumes/raster/volume_count.hpp"
#include "volumes/raster/wedge_raster.hpp"
#include "volumes/soft/wedge_ramp.frag.spv.hpp"

#include <algorithm>
#include <optional>

namespace penumbra::volumes {
namespace {

using visibility::Light;
using visibility::SceneFloats;
using visibility::Tile;
using visibility::ViewSamples;

visibility::MeshVerdict wedge_ramp_verdict(const mesh::Diagnosis& mesh) {
  return {
      visibility::Verdict::approximate,
      visibility::reason_with(
          "a linear ramp stands for the covered area, the light's centre's silhouettes for all, and layers are added",
          mesh, {{mesh.boundary_edges.count, "boundary edges: what is not closed counts triangle by triangle"}})};
}

}  // namespace

visibility::MethodDescription wedge_ramp_description() {
  return {.name = "wedge-ramp",
          .family = visibility::Family::geometry,
          .paper = "Akenine-Möller and Assarsson 2002",
          .output = visibility::Output::scalar,
          .exact_for = "nothing but umbra and full light of one occluder with a simple silhouette",
          .lights = visibility::kPlanarLights - visibility::kPolygons,
          .textures = false,
          .options = {},
          .verdict_on = wedge_ramp_verdict};
}

namespace {

class WedgeRamp final : public visibility::Method {
 public:
  WedgeRamp(const render::Device& device, const visibility::MethodOptions& options)
      : description_(wedge_ramp_description()),
        count_(device, CountVariant::z_fail, Layers::one_a_solid),
        raster_(device, {"wedge ramps", shaders::kWedgeRampFrag, {}}) {
    visibility::parse_options(description_, options);
  }

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }

  void prepare_mesh(const SceneFloats& scene) override {
    scene_ = &scene;
    count_.prepare_mesh(scene);
  }
  void prepare_light(const Light& light) override {
    visibility::check_light(description_, light);
    light_ = &light;
    count_.prepare_light(light);
    wedges_ = ramp_wedges_of(count_.volumes(), light);
    const std::vector<double> words = ramp_words(wedges_);
    if (!words.empty()) raster_.set_table(words);
    faces_.reset();
    doubtful_ = 0;
  }
  void prepare_view(const ViewSamples& samples) override {
    samples_ = &samples;
    count_.prepare_view(samples);
    faces_.reset();
  }
  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    return std::min(count_.max_tile_rows(), raster_.max_tile_rows(*samples_));
  }
  void evaluate(const Tile& tile) override;

  void read_visibility(std::span<float> visibility) override {
    PENUMBRA_ASSERT(visibility.size() == visibility_.size(), "{} values for a tile of {} pixels", visibility.size(),
                    visibility_.size());
    std::ranges::copy(visibility_, visibility.begin());
  }
  std::vector<visibility::PassTime> take_pass_times() override {
    visibility::PassTimes all;
    all.add(count_.take_pass_times());
    all.add(raster_.take_pass_times());
    return all.take();
  }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    const auto hard = std::ranges::count(wedges_.wedges, WedgeOutcome::empty, &Wedge::outcome);
    return {{"silhouetteEdges", wedges_.edges.size()},
            {"hardEdges", static_cast<std::uint64_t>(hard)},
            {"wedgesOnScreen", faces_ ? faces_->size() : 0},
            {"fragments", faces_ ? fragments_of(*faces_) : 0},
            {"pixelsOnHost", doubtful_}};
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return count_.memory_bytes() + raster_.memory_bytes(); }

 private:
  visibility::MethodDescription description_;
  VolumeCount count_;
  WedgeRaster raster_;
  const SceneFloats* scene_ = nullptr;
  const Light* light_ = nullptr;
  const ViewSamples* samples_ = nullptr;
  LightWedges wedges_;
  std::optional<std::vector<gpu::WedgeFace>> faces_;
  std::vector<float> visibility_;
  std::uint64_t doubtful_ = 0;
};

void WedgeRamp::evaluate(const Tile& tile) {
  using Kind = VolumeCount::Kind;
  if (!faces_) faces_ = faces_of(wedges_, *samples_, WedgeTests::both, glm::dvec3(count_.center()));
  count_.count(tile);
  const std::span<const Kind> kinds = count_.kinds();
  const std::size_t first = std::size_t{tile.first_row} * samples_->width;
  std::vector<gpu::WedgeReceiver> receivers(kinds.size());
  std::vector<std::uint8_t> on_host(kinds.size());
  mesh::for_each_index(kinds.size(), [&](std::size_t i) {
    if (kinds[i] != Kind::counted) return;
    const glm::vec3& p = samples_->p[first + i];
    on_host[i] = appears_in_place(samples_->camera, p, first + i) ? 0 : 1;
    receivers[i] = {p, on_host[i] == 0 ? 1u : 0u};
  });
  raster_.add(*faces_, receivers, wedge_push(*light_), tile, samples_->width);
  visibility_.resize(kinds.size());
  mesh::for_each_index(kinds.size(), [&](std::size_t i) {
    visibility_[i] = kinds[i] == Kind::lit ? 1.0F : 0.0F;
    if (kinds[i] != Kind::counted) return;
    if (raster_.doubts()[i] != 0) on_host[i] = 1;
    const double sum = on_host[i] != 0 ? ramp_sum(wedges_, *light_, samples_->p[first + i])
                                       : gpu::kSumUnit * static_cast<double>(raster_.sums()[i]);
    visibility_[i] = static_cast<float>(std::clamp(1 - count_.counts()[i] - sum, 0.0, 1.0));
  });
  doubtful_ += static_cast<std::uint64_t>(std::ranges::count(on_host, 1));
}

}  // namespace

std::unique_ptr<visibility::Method> make_wedge_ramp(const render::Device& device,
                                                    const visibility::MethodOptions& options) {
  return std::make_unique<WedgeRamp>(device, options);
}

}  // namespace penumbra::volumes
