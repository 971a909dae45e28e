// Williams 1978, "Casting curved shadows on curved surfaces". Departures: the receiver's plane is compared at the
// texel's centre in place of a constant bias (taps.glsl), and up to five faces hold what one perspective image cannot
// (map_fit.cpp).

#include "maps/filters/shadow_map.hpp"

#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/filters/repairs.hpp"
#include "maps/filters/shadow_map.comp.spv.hpp"

namespace penumbra::maps {
namespace {

visibility::MeshVerdict shadow_map_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("a hard shadow of the light's centre, its edges off by up to half a texel", mesh);
}

}  // namespace

visibility::MethodDescription shadow_map_description() {
  return {.name = "shadow-map",
          .family = visibility::Family::image,
          .paper = "Williams 1978",
          .output = visibility::Output::scalar,
          .exact_for = "nothing; in the limit of large maps the hard shadow of the light's centre",
          .lights = planar_lights(),
          .textures = false,
          .options = compared_map_option_descriptions(),
          .verdict_on = shadow_map_verdict,
          .repairs = filter_repairs};
}

std::unique_ptr<visibility::Method> make_shadow_map(const render::Device& device,
                                                    const visibility::MethodOptions& options) {
  return make_map_method(device,
                         {.description = shadow_map_description(),
                          .look_up_name = "shadow map look-up",
                          .look_up = shaders::kShadowMapComp},
                         options);
}

}  // namespace penumbra::maps
