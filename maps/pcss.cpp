// Fernando 2005, "Percentage-closer soft shadows". Departures: windows have the light's own shape in place of a
// square's, the near plane stands at the nearest depth of the map, every tap is compared with the receiver's plane, and
// a tap whose light point is below the receiver's horizon counts as hidden, as in every other method here.

#include "maps/pcss.hpp"

#include "maps/center_map.hpp"
#include "maps/light_shape.hpp"
#include "maps/mesh_verdict.hpp"
#include "maps/nearest.comp.spv.hpp"
#include "maps/nearest.shared.h"
#include "maps/pcss.comp.spv.hpp"
#include "maps/pcss.shared.h"
#include "render/compute_pass.hpp"

#include <fmt/format.h>

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

class Pcss final : public CenterMapMethod {
 public:
  Pcss(const render::Device& device, const visibility::MethodOptions& options)
      : CenterMapMethod(device, describe(), options),
        blocker_samples_(
            whole_number_option(description(), options, "blockerSamples", 1, kMostSamples, kBlockerSamples)),
        filter_samples_(whole_number_option(description(), options, "filterSamples", 1, kMostSamples, kFilterSamples)),
        nearest_pass_(device, {.name = "nearest caster",
                               .spirv = shaders::kNearestComp,
                               .push_bytes = sizeof(gpu::NearestPush),
                               .constants = {}}),
        pass_(device, {.name = "pcss look-up",
                       .spirv = shaders::kPcssComp,
                       .push_bytes = sizeof(gpu::PcssPush),
                       .constants = {}}),
        nearest_(device, "pcss nearest caster", 2 * sizeof(float)),
        pattern_(device, "pcss pattern", (std::uint64_t{blocker_samples_} + filter_samples_) * sizeof(glm::vec2)) {}

 private:
  void map_rendered(render::Commands& commands, const Map& map, std::uint32_t faces, const visibility::Light& light,
                    const LightFrame& frame) override {
    commands.fill(nearest_, 0x7f800000u);  // infinity
    const gpu::NearestPush push{options().size, faces};
    nearest_pass_.record(commands, push, {map.views, map.depths, nearest_}, std::uint64_t{faces} * options().size);

    std::vector<glm::vec2> pattern = light_pattern(light, frame, blocker_samples_);
    const std::vector<glm::vec2> filter = light_pattern(light, frame, filter_samples_);
    pattern.insert(pattern.end(), filter.begin(), filter.end());
    pattern_.write<glm::vec2>(pattern);
    smallest_near_ = static_cast<float>(half_width(light));
  }

  void record_lookup(render::Commands& commands, const gpu::LookupPush& lookup, const Receivers::Part& part,
                     const Map& map, const render::Buffer& visibility) override {
    const gpu::PcssPush push{lookup, blocker_samples_, filter_samples_, smallest_near_};
    pass_.record(commands, push, {*part.receivers, map.views, map.depths, nearest_, pattern_, visibility},
                 part.groups());
  }

  [[nodiscard]] std::uint64_t own_memory_bytes() const override { return nearest_.bytes() + pattern_.bytes(); }

  std::uint32_t blocker_samples_, filter_samples_;
  render::ComputePass nearest_pass_, pass_;
  render::Buffer nearest_, pattern_;
  float smallest_near_ = 0;
};

}  // namespace

visibility::MethodDescription pcss_description() {
  return describe();
}

std::unique_ptr<visibility::Method> make_pcss(const render::Device& device, const visibility::MethodOptions& options) {
  return std::make_unique<Pcss>(device, options);
}

}  // namespace penumbra::maps
