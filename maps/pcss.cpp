// Fernando 2005, "Percentage-closer soft shadows". Departures: windows have the light's own shape in place of a
// square's, the near plane stands at the nearest depth of the map, every tap is compared with the receiver's plane, and
// a tap whose light point is below the receiver's horizon counts as hidden, as in every other method here.

#include "maps/pcss.hpp"

#include "maps/light_shape.hpp"
#include "maps/map_method.hpp"
#include "maps/mesh_verdict.hpp"
#include "maps/nearest_caster.hpp"
#include "maps/pcss.comp.spv.hpp"
#include "maps/pcss.shared.h"

#include <fmt/format.h>

#include <utility>

namespace penumbra::maps {
namespace {

constexpr std::uint32_t kMostSamples = 1024, kBlockerSamples = 64, kFilterSamples = 64;

visibility::MeshVerdict verdict_on(const mesh::Diagnosis& mesh) {
  return judge_for_maps("one map, and one mean height for all that shades a pixel", mesh);
}

visibility::MethodDescription describe() {
  visibility::MethodDescription description{
      .name = "pcss",
      .family = visibility::Family::image,
      .paper = "Fernando 2005",
      .output = visibility::Output::scalar,
      .exact_for =
          "nothing; in the limit of large maps and many samples, where all blockers lie in one plane parallel to "
          "the light and cover the search window or none of it",
      .lights = planar_lights(),
      .options = map_option_descriptions(),
      .verdict_on = verdict_on};
  const std::string values = fmt::format("1 … {}", kMostSamples);
  description.options.push_back(
      {"blockerSamples", values, fmt::format("{}", kBlockerSamples), "taps of the blocker search"});
  description.options.push_back({"filterSamples", values, fmt::format("{}", kFilterSamples), "taps of the filter"});
  return description;
}

}  // namespace

visibility::MethodDescription pcss_description() {
  return describe();
}

std::unique_ptr<visibility::Method> make_pcss(const render::Device& device, const visibility::MethodOptions& options) {
  MapRecipe recipe{.description = describe(), .look_up_name = "pcss look-up", .look_up = shaders::kPcssComp};
  const auto taps = [&](const char* key, std::uint32_t otherwise) {
    return whole_number_option(recipe.description, options, key, 1, kMostSamples, otherwise);
  };
  const std::uint32_t blocker_samples = taps("blockerSamples", kBlockerSamples);
  const std::uint32_t filter_samples = taps("filterSamples", kFilterSamples);
  recipe.products.push_back(std::make_unique<NearestCaster>(device));
  recipe.products.push_back(
      std::make_unique<LightPattern>(device, std::initializer_list<std::uint32_t>{blocker_samples, filter_samples}));
  // Taps at height z over the light lie 1/z times the light's outline around the receiver, and z is half the light's
  // width at least (smallest_near).
  recipe.beside = [](const visibility::Light& light, const LightFrame& frame) {
    return half_extent(light, frame) / half_width(light);
  };
  recipe.push_words = sizeof(gpu::PcssPush) / sizeof(std::uint32_t);
  recipe.push = [blocker_samples, filter_samples](const visibility::Light& light) {
    return push_words(gpu::PcssPush{blocker_samples, filter_samples, static_cast<float>(half_width(light))});
  };
  return make_map_method(device, std::move(recipe), options);
}

}  // namespace penumbra::maps
