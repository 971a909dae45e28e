// SPDX-License-Identifier: Apache-2.0
// Computes percentage-closer soft shadows: Fernando 2005, "Percentage-closer soft shadows". Departures: windows have
// the light's own shape in place of a square, the near plane is at the nearest depth of the map, every tap is compared
// with the receiver's plane, and a tap whose light point is below the receiver's horizon counts as hidden, as in every
// other method here; a filter tap is weighted by the light's texture at its light point.

#include "maps/filters/methods.hpp"

#include "base/error.hpp"
#include "maps/products/light_shape.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/filters/repairs.hpp"
#include "maps/products/nearest_caster.hpp"
#include "maps/filters/pcss.comp.spv.hpp"
#include "maps/filters/pcss_fitted.comp.spv.hpp"
#include "maps/filters/pcss.shared.h"

#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

namespace penumbra::maps {
namespace {

constexpr visibility::IntegerOption kBlockerSamples{"blockerSamples", 1, 1024, 64, "taps of the blocker search"};
constexpr visibility::IntegerOption kFilterSamples{"filterSamples", 1, 1024, 64, "taps of the filter"};

/// Light points of both kinds of taps: x and y in the light's basis and a weight: 1, or the texture's luminance there
/// divided by its maximum. With a constant texture V has the same bytes as without a texture.
class PcssTaps final : public MapProduct {
 public:
  PcssTaps(const render::Device& device, std::uint32_t blocker, std::uint32_t filter)
      : blocker_(blocker), filter_(filter), taps_(device, "pcss taps", (blocker + filter) * sizeof(glm::vec3)) {}

  void record(render::Commands& /*commands*/, const MapSet& maps) override {
    std::vector<glm::vec3> taps;
    for (const glm::vec2& at : light_pattern(maps.light, maps.basis, blocker_)) taps.emplace_back(at, 1.0F);
    for (const glm::vec2& at : light_pattern(maps.light, maps.basis, filter_)) taps.emplace_back(at, 1.0F);
    if (maps.light.texture) weigh(maps, std::span(taps).last(filter_));
    taps_.write<glm::vec3>(taps);
  }
  [[nodiscard]] const render::Buffer& buffer() const override { return taps_; }
  [[nodiscard]] bool leaves_triangles() const override { return true; }

 private:
  void weigh(const MapSet& maps, std::span<glm::vec3> taps) const {
    const visibility::LightTexture& texture = *maps.light.texture;
    const LightAxes axes = light_axes(maps.light, maps.basis);
    const glm::dmat2 to_light = glm::inverse(glm::dmat2(axes.u, axes.v));
    const double brightest = std::ranges::max(texture.luminance);
    bool lit = false;
    for (glm::vec3& tap : taps) {
      tap.z = static_cast<float>(texture.luminance[texture.texel_at(to_light * glm::dvec2(tap))] / brightest);
      lit = lit || tap.z > 0;
    }
    if (lit) return;
    throw InputError(
        "light \"{}\": all {} filter taps of pcss lie on black texels of its {}x{} texture; take more filterSamples or "
        "a coarser texture",
        maps.light.name, filter_, texture.width, texture.height);
  }

  std::uint32_t blocker_, filter_;
  render::Buffer taps_;
};

visibility::MeshVerdict pcss_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("one map, and one mean height for all casters that shade a pixel", mesh);
}

}  // namespace

visibility::MethodDescription pcss_description() {
  visibility::MethodDescription description{
      .name = "pcss",
      .family = visibility::Family::image,
      .paper = "Fernando 2005",
      .output = visibility::Output::scalar,
      .exact_for =
          "nothing; in the limit of large maps and many samples, scenes in which all blockers lie in one plane "
          "parallel to the light and cover all or none of the search window",
      .lights = visibility::kPlanarLights,
      .options = compared_map_option_descriptions(),
      .verdict_on = pcss_verdict,
      .repairs = filter_repairs};
  description.options.push_back(kBlockerSamples.description());
  description.options.push_back(kFilterSamples.description());
  for (const auto& option : {kOffsetFactor.description(), kOffsetUnits.description()}) {
    description.options.push_back(option);
  }
  std::ranges::copy(view_fit_descriptions(), std::back_inserter(description.options));
  return description;
}

std::unique_ptr<visibility::Method> make_pcss(const render::Device& device, const visibility::MethodOptions& options) {
  MapRecipe recipe{.description = pcss_description(),
                   .look_up_name = "pcss look-up",
                   .look_up = shaders::kPcssComp,
                   .fitted_look_up = shaders::kPcssFittedComp};
  const visibility::ParsedOptions parsed = visibility::parse_options(recipe.description, options);
  const std::uint32_t blocker_samples = parsed[kBlockerSamples], filter_samples = parsed[kFilterSamples];
  recipe.products.push_back(std::make_unique<NearestCaster>(device));
  recipe.products.push_back(std::make_unique<PcssTaps>(device, blocker_samples, filter_samples));
  // Taps at height z over the light lie 1/z times the light's outline around the receiver, and z is at least half the
  // light's width (smallest_near).
  recipe.beside = [](const visibility::Light& light, const LightBasis& basis) {
    return half_extent(light, basis) / half_width(light);
  };
  recipe.push_words = sizeof(gpu::PcssPush) / sizeof(std::uint32_t);
  recipe.push = [blocker_samples, filter_samples](const visibility::Light& light) {
    return push_words(gpu::PcssPush{blocker_samples, filter_samples, static_cast<float>(half_width(light))});
  };
  return make_map_method(device, std::move(recipe), options);
}

}  // namespace penumbra::maps
