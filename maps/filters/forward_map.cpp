// SPDX-License-Identifier: Apache-2.0
// Gathers the splats of a light's picture: Zhang 1998, "Forward shadow mapping", as described in the course notes of
// Eisemann et al. (2009, box in section 3.2). Departures: each view sample gathers the splats that reach it, with the
// same sums; a splat lies on the surface shown by its texel, with a B-spline as shape; and the receiver's plane is
// compared at each texel's centre (receiverPlane=off: the receiver's own depth).

#include "maps/filters/forward_map.comp.spv.hpp"
#include "maps/filters/forward_map_fitted.comp.spv.hpp"
#include "maps/filters/methods.hpp"
#include "maps/filters/repairs.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

namespace penumbra::maps {
namespace {

constexpr visibility::ChoiceOption<std::uint32_t, 3> kSplat{
    "splat",
    {{"box", 0}, {"tent", 1}, {"spline", 2}},
    1,
    "kernel of a texel's splat: constant over one texel; linear over two; a quadratic B-spline over three"};

visibility::MeshVerdict forward_map_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("the hard shadow of the light's centre, its edges faded over a texel or two", mesh);
}

}  // namespace

visibility::MethodDescription forward_map_description() {
  visibility::MethodDescription description{
      .name = "forward-map",
      .family = visibility::Family::image,
      .paper = "Zhang 1998",
      .output = visibility::Output::scalar,
      .exact_for = "nothing; in the limit of large maps the hard shadow of the light's centre",
      .lights = visibility::kPlanarLights,
      .textures = false,
      .on_request = true,
      .options = compared_map_option_descriptions(),
      .verdict_on = forward_map_verdict,
      .repairs = filter_repairs};
  description.options.push_back(kSplat.description());
  std::ranges::copy(view_fit_descriptions(), std::back_inserter(description.options));
  return description;
}

std::unique_ptr<visibility::Method> make_forward_map(const render::Device& device,
                                                     const visibility::MethodOptions& options) {
  MapRecipe recipe{.description = forward_map_description(),
                   .look_up_name = "forward map look-up",
                   .look_up = shaders::kForwardMapComp,
                   .fitted_look_up = shaders::kForwardMapFittedComp};
  recipe.constants = {visibility::parse_options(recipe.description, options)[kSplat]};
  return make_map_method(device, std::move(recipe), options);
}

}  // namespace penumbra::maps
