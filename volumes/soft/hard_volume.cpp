// Crow 1977, Heidmann 1991, Everitt and Kilgard 2002: V is 1 where no shadow volume of the light's centre is counted.
// volume_count.cpp says how it counts, and where it departs from them.

#include "volumes/soft/methods.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "volumes/raster/volume_count.hpp"

namespace penumbra::volumes {
namespace {

visibility::MeshVerdict hard_volume_verdict(const mesh::Diagnosis& mesh) {
  return {
      visibility::Verdict::approximate,
      visibility::reason_with("a hard shadow of the light's centre, exact as such whatever is wrong with the mesh",
                              mesh, {{mesh.zero_area_triangles.count, "triangles without area, which cast nothing"}})};
}

constexpr visibility::ChoiceOption kVariant{
    "variant",
    {{"z-fail", CountVariant::z_fail}, {"z-pass", CountVariant::z_pass}},
    CountVariant::z_fail,
    "count volumes beyond the surface, or between it and the camera: wrong when the camera is in shadow"};

}  // namespace

visibility::MethodDescription hard_volume_description() {
  return {.name = "hard-volume",
          .family = visibility::Family::geometry,
          .paper = "Crow 1977, Heidmann 1991, Everitt and Kilgard 2002",
          .output = visibility::Output::scalar,
          .exact_for = "the hard shadow of the light's centre, of any triangle soup (z-fail)",
          .lights = visibility::kPlanarLights,
          .options = {kVariant.description()},
          .verdict_on = hard_volume_verdict};
}

namespace {

class HardVolume final : public visibility::Method {
 public:
  HardVolume(const render::Device& device, const visibility::MethodOptions& options)
      : description_(hard_volume_description()),
        count_(device, visibility::parse_options(description_, options)[kVariant]) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const visibility::SceneFloats& scene) override { count_.prepare_mesh(scene); }
  void prepare_light(const visibility::Light& light) override {
    visibility::check_light(description_, light);
    count_.prepare_light(light);
  }
  void prepare_view(const visibility::ViewSamples& samples) override { count_.prepare_view(samples); }
  [[nodiscard]] std::uint32_t max_tile_rows() const override { return count_.max_tile_rows(); }
  void evaluate(const visibility::Tile& tile) override { count_.count(tile); }

  void read_visibility(std::span<float> visibility) override {
    using Kind = VolumeCount::Kind;
    const std::span<const std::int32_t> counts = count_.counts();
    const std::span<const Kind> kinds = count_.kinds();
    PENUMBRA_ASSERT(visibility.size() == counts.size(), "{} values for a tile of {} pixels", visibility.size(),
                    counts.size());
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const bool lit = kinds[i] == Kind::lit || (kinds[i] == Kind::counted && counts[i] == 0);
      visibility[i] = lit ? 1.0f : 0.0f;
    }
  }

  std::vector<visibility::PassTime> take_pass_times() override { return count_.take_pass_times(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    const VolumeCount::Totals& totals = count_.totals();
    return {{"silhouetteEdges", totals.silhouette_edges},    {"caps", totals.caps},
            {"facesOnScreen", totals.faces_on_screen},       {"farEndsOnScreen", totals.far_ends_on_screen},
            {"pixelsCountedOnHost", totals.doubtful_pixels}, {"largestCount", totals.largest_count}};
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return count_.memory_bytes(); }

 private:
  visibility::MethodDescription description_;
  VolumeCount count_;
};

}  // namespace

std::unique_ptr<visibility::Method> make_hard_volume(const render::Device& device,
                                                     const visibility::MethodOptions& options) {
  return std::make_unique<HardVolume>(device, options);
}

}  // namespace penumbra::volumes
