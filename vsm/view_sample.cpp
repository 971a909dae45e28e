// SPDX-License-Identifier: Apache-2.0
// `view-sample`: selects one of its two engines for each light, or the published variant.

#include "vsm/methods.hpp"

#include "base/error.hpp"
#include "engines/engine_by_light.hpp"
#include "engines/engine_choice.hpp"
#include "visibility/masks/dome_method.hpp"
#include "visibility/method_repairs.hpp"
#include "vsm/vectors/view_sample_vectors.hpp"
#include "vsm/view_sample_lists.hpp"
#include "vsm/view_sample_vulkan.hpp"

#include <utility>
#include <vector>

namespace penumbra::vsm {
namespace {

visibility::MeshVerdict view_sample_verdict(const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::exact,
          visibility::reason_with("every pair is decided exactly, for every mesh", mesh,
                                  {{mesh.boundary_loops, "open boundaries, where light passes as it should"},
                                   {mesh.zero_area_triangles.count, "triangles without area, which cast no shadow"}})};
}

enum class Variant : std::uint8_t { tree, sintorn };
constexpr visibility::ChoiceOption kVariant{
    "variant",
    {{"tree", Variant::tree}, {"sintorn", Variant::sintorn}},
    Variant::tree,
    "tree: find pairs by a hierarchy of triangles; sintorn: as published, view samples in lists of light pixels; on "
    "the processor, for all lights but spheres"};

bool is_planar_light(const visibility::Light& light) {
  return visibility::is_planar(light.kind);
}

}  // namespace

visibility::MethodDescription view_sample_description(const visibility::MethodOptions& given) {
  visibility::MethodDescription description{
      .name = "view-sample",
      .family = visibility::Family::geometry,
      .paper = "Eisemann and Décoret 2007; Sintorn, Eisemann and Assarsson 2008",
      .output = visibility::Output::mask,
      .exact_for = "every pair of view sample and light sample, for any triangle soup",
      .lights = visibility::kEveryLight,
      .bytes_per_triangle = 100,
      .options = {engines::kEngine.description(), kVariant.description()},
      .span = visibility::kFloatSpan,
      .verdict_on = view_sample_verdict,
      .repairs = visibility::exact_pair_repairs,
  };
  const visibility::ParsedOptions options = visibility::parse_options(description, given);
  const bool published = options[kVariant] == Variant::sintorn,
             on_device = options[engines::kEngine] == engines::Engine::vulkan;
  if (published) description.lights = description.lights - visibility::kBodies - visibility::kDomes;
  if (on_device) description.lights = description.lights & visibility::kPlanarLights;
  return description;
}

std::unique_ptr<visibility::Method> make_view_sample(const render::Machine& machine,
                                                     const visibility::MethodOptions& given) {
  const visibility::ParsedOptions options = visibility::parse_options(view_sample_description(), given);
  if (options[kVariant] == Variant::sintorn) {
    if (options[engines::kEngine] == engines::Engine::vulkan) {
      throw UsageError("view-sample: variant=sintorn runs only on the processor; omit engine=vulkan");
    }
    return make_view_sample_lists(view_sample_description(given));
  }
  const auto native = [] { return visibility::with_domes(make_view_sample_on_vectors(view_sample_description())); };
  if (engines::runs_on_vectors(machine, options[engines::kEngine])) return native();
  if (options[engines::kEngine] == engines::Engine::vulkan) return make_vulkan_view_sample(machine.device());
  return engines::make_engine_by_light(
      {[machine] { return make_vulkan_view_sample(machine.device()); }, native, is_planar_light});
}

bool view_sample_on_vectors(const render::Machine& machine, const visibility::MethodOptions& given,
                            const visibility::Light& light) {
  const visibility::ParsedOptions options = visibility::parse_options(view_sample_description(), given);
  const engines::Engine engine = options[engines::kEngine];
  return options[kVariant] == Variant::sintorn || engines::runs_on_vectors(machine, engine) ||
         (engine == engines::Engine::automatic && !is_planar_light(light));
}

}  // namespace penumbra::vsm
