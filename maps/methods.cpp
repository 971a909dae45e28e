#include "maps/methods.hpp"

#include "maps/backprojection/contours/methods.hpp"
#include "maps/backprojection/patches/methods.hpp"
#include "maps/backprojection/soft_shadow_map/methods.hpp"
#include "maps/filters/methods.hpp"
#include "maps/sampling/methods.hpp"
#include "maps/single_shadow/methods.hpp"

#include <array>

namespace penumbra::maps {

std::span<const engines::MethodRow> methods() {
  using engines::on_device;
  static const std::array kRows{
      on_device<bitmask_description, make_bitmask>(),
      on_device<backproject_description, make_backproject>(),
      on_device<backproject_peel_description, make_backproject_peel>(),
      on_device<layer_rays_description, make_layer_rays>(),
      on_device<packet_description, make_packet>(),
      on_device<contour_description, make_contour>(),
      on_device<pcss_description, make_pcss>(),
      on_device<vssm_description, make_vssm>(),
      on_device<soft_shadow_map_description, make_soft_shadow_map>(),
      on_device<accumulate_description, make_accumulate>(),
      on_device<adaptive_light_description, make_adaptive_light>(),
      on_device<deep_penumbra_description, make_deep_penumbra>(),
      on_device<layered_attenuation_description, make_layered_attenuation>(),
      on_device<occlusion_textures_description, make_occlusion_textures>(),
      on_device<convolution_description, make_convolution>(),
      on_device<penumbra_map_description, make_penumbra_map>(),
      on_device<smoothies_description, make_smoothies>(),
      on_device<brabec_seidel_description, make_brabec_seidel>(),
      on_device<kirsch_doellner_description, make_kirsch_doellner>(),
      on_device<parker_description, make_parker>(),
      on_device<arvo_description, make_arvo>(),
      on_device<pcf_description, make_pcf>(),
      on_device<shadow_map_description, make_shadow_map>(),
  };
  return kRows;
}

}  // namespace penumbra::maps
