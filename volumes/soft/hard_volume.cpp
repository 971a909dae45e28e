// SPDX-License-Identifier: Apache-2.0
// Crow 1977, Heidmann 1991, Everitt and Kilgard 2002: V is 1 where no shadow volume of the light's centre is counted.
// volume_count.cpp documents the count and its departures. ZP+ is S. Hornus, J. Hoberock, S. Lefebvre, J. Hart, ZP+:
// correct z-pass stencil shadows, I3D 2005. There the counts on the near plane are drawn from the light; here the near
// plane is at the eye, and the host computes the only count. volume_culling.cpp and shadow_tiles.cpp name the other
// variants' papers.

#include "volumes/soft/methods.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "visibility/method_repairs.hpp"
#include "volumes/raster/volume_count.hpp"
#include "volumes/raster/volume_culling.hpp"

#include <optional>

namespace penumbra::volumes {
namespace {

visibility::MeshVerdict hard_volume_verdict(const mesh::Diagnosis& mesh) {
  return {
      visibility::Verdict::approximate,
      visibility::reason_with("a hard shadow of the light's centre; as a hard shadow it is exact for every mesh", mesh,
                              {{mesh.zero_area_triangles.count, "triangles without area, which cast no shadow"}})};
}

enum class Variant { z_fail, z_pass, zp_plus, cc, split, hierarchical, tiles };

constexpr visibility::ChoiceOption kVariant{
    "variant",
    {{"z-fail", Variant::z_fail},
     {"z-pass", Variant::z_pass},
     {"zp+", Variant::zp_plus},
     {"cc", Variant::cc},
     {"split", Variant::split},
     {"hierarchical", Variant::hierarchical},
     {"tiles", Variant::tiles}},
    Variant::z_fail,
    "where and which volumes are counted. z-fail: beyond the surface; z-pass: between the camera and the surface, "
    "wrong if the camera is in shadow; zp+: as z-pass, beginning with the count at the camera; cc: without volumes "
    "that hide nothing new, others cut to where surfaces are; split: on the cheaper side of the surface; hierarchical: "
    "without triangles that hide nothing from any pixel; tiles: at only one pixel of each tile that no face of a "
    "volume touches"};

CountVariant count_variant(Variant variant) {
  return variant == Variant::z_pass    ? CountVariant::z_pass
         : variant == Variant::zp_plus ? CountVariant::z_pass_from_eye
                                       : CountVariant::z_fail;
}

visibility::ErrorRepairs hard_volume_repairs(const visibility::MethodDescription& method,
                                             const visibility::MethodOptions& given) {
  using visibility::ErrorCause;
  visibility::ErrorRepairs repairs = visibility::exact_centre_repairs(method, given);
  if (visibility::complete_options(method, given).at(kVariant.name()) == "z-pass") {
    visibility::repair_of(repairs, ErrorCause::view) = visibility::inseparable(
        ErrorCause::view, "z-pass is also wrong where the camera is in shadow, and the repair would correct that, too");
  }
  return repairs;
}

}  // namespace

visibility::MethodDescription hard_volume_description() {
  return {.name = "hard-volume",
          .family = visibility::Family::geometry,
          .paper = "Crow 1977, Heidmann 1991, Everitt and Kilgard 2002",
          .output = visibility::Output::scalar,
          .exact_for = "the hard shadow of the light's centre, of any triangle soup (all variants but z-pass)",
          .lights = visibility::kPlanarLights,
          .options = {kVariant.description()},
          .verdict_on = hard_volume_verdict,
          .repairs = hard_volume_repairs};
}

namespace {

class HardVolume final : public visibility::Method {
 public:
  HardVolume(const render::Device& device, const visibility::MethodOptions& options)
      : description_(hard_volume_description()),
        variant_(visibility::parse_options(description_, options)[kVariant]),
        count_(device, count_variant(variant_), Layers::every_triangle,
               variant_ == Variant::cc || variant_ == Variant::split) {
    if (variant_ == Variant::tiles) count_.decide_whole_tiles();
  }

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    count_.prepare_mesh(scene);
    if (variant_ == Variant::hierarchical) tree_ = visibility::make_triangle_tree(scene);
  }
  void prepare_light(const visibility::Light& light) override {
    visibility::check_light(description_, light);
    light_ = &light;
    planned_ = !is_for_a_view();
    if (planned_) count_.prepare_light(light);
  }
  void prepare_view(const visibility::ViewSamples& samples) override {
    samples_ = &samples;
    planned_ = !is_for_a_view();
    count_.prepare_view(samples);
  }
  [[nodiscard]] std::uint32_t max_tile_rows() const override { return count_.max_tile_rows(); }
  void evaluate(const visibility::Tile& tile) override {
    if (!planned_) plan();
    count_.count(tile);
  }

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
    std::map<std::string, std::uint64_t> all{{"silhouetteEdges", totals.silhouette_edges},
                                             {"caps", totals.caps},
                                             {"facesOnScreen", totals.faces_on_screen},
                                             {"farEndsOnScreen", totals.far_ends_on_screen},
                                             {"fragments", totals.fragments},
                                             {"countUpdates", totals.updates},
                                             {"pixelsCountedOnHost", totals.doubtful_pixels},
                                             {"largestCount", totals.largest_count}};
    all.insert(left_out_.begin(), left_out_.end());
    if (variant_ == Variant::split) all["togglingVolumes"] = totals.toggling_parts;
    if (variant_ == Variant::tiles) {
      all["tiles"] = totals.tiles;
      all["wholeTiles"] = totals.whole_tiles;
      all["pixelsDrawn"] = totals.counted_pixels;
    }
    if (variant_ == Variant::zp_plus) all["countedFromEye"] = totals.from_eye ? 1 : 0;
    return all;
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return count_.memory_bytes(); }

 private:
  /// Returns whether the volumes depend on the view.
  [[nodiscard]] bool is_for_a_view() const {
    return variant_ == Variant::cc || variant_ == Variant::split || variant_ == Variant::hierarchical;
  }
  void plan() {
    const ShadowCasters& casters = count_.casters();
    LeanVolumes lean = variant_ == Variant::cc      ? culled_and_clamped(*scene_, casters, *light_, *samples_)
                       : variant_ == Variant::split ? split_by_planes(casters, *light_, *samples_)
                                                    : culled_by_hierarchy(*scene_, casters, tree_, *light_, *samples_);
    count_.prepare_light(*light_, std::move(lean.volumes));
    left_out_ = std::move(lean.counters);
    planned_ = true;
  }

  visibility::MethodDescription description_;
  Variant variant_;
  VolumeCount count_;
  visibility::TriangleTree tree_;
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  const visibility::ViewSamples* samples_ = nullptr;
  bool planned_ = false;
  std::map<std::string, std::uint64_t> left_out_;
};

}  // namespace

std::unique_ptr<visibility::Method> make_hard_volume(const render::Device& device,
                                                     const visibility::MethodOptions& options) {
  return std::make_unique<HardVolume>(device, options);
}

}  // namespace penumbra::volumes
