// Williams 1978, "Casting curved shadows on curved surfaces". Departures: the receiver's plane is compared at the
// texel's centre in place of a constant bias (lookup.glsl), and up to five faces hold what one perspective image cannot
// (map_fit.cpp).

#include "maps/shadow_map.hpp"

#include "maps/center_map.hpp"
#include "maps/mesh_verdict.hpp"
#include "maps/shadow_map.comp.spv.hpp"
#include "render/compute_pass.hpp"

namespace penumbra::maps {
namespace {

visibility::MeshVerdict verdict_on(const mesh::Diagnosis& mesh) {
  return judge_for_maps("a hard shadow of the light's centre, its edges off by up to half a texel", mesh);
}

visibility::MethodDescription describe() {
  return {.name = "shadow-map",
          .family = visibility::Family::image,
          .paper = "Williams 1978",
          .output = visibility::Output::scalar,
          .exact_for = "nothing; in the limit of large maps the hard shadow of the light's centre",
          .lights = planar_lights(),
          .options = map_option_descriptions(),
          .verdict_on = verdict_on};
}

class ShadowMap final : public CenterMapMethod {
 public:
  ShadowMap(const render::Device& device, const visibility::MethodOptions& options)
      : CenterMapMethod(device, describe(), options),
        pass_(device, {.name = "shadow map look-up",
                       .spirv = shaders::kShadowMapComp,
                       .push_bytes = sizeof(gpu::LookupPush),
                       .constants = {}}) {}

 private:
  void record_lookup(render::Commands& commands, const gpu::LookupPush& push, const Receivers::Part& part,
                     const Map& map, const render::Buffer& visibility) override {
    pass_.record(commands, push, {*part.receivers, map.views, map.depths, visibility}, part.groups());
  }

  render::ComputePass pass_;
};

}  // namespace

visibility::MethodDescription shadow_map_description() {
  return describe();
}

std::unique_ptr<visibility::Method> make_shadow_map(const render::Device& device,
                                                    const visibility::MethodOptions& options) {
  return std::make_unique<ShadowMap>(device, options);
}

}  // namespace penumbra::maps
