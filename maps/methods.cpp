// SPDX-License-Identifier: Apache-2.0
// Table of the family's methods, with their support of lights and surfaces with holes.

#include "maps/methods.hpp"

#include "engines/engine_by_light.hpp"
#include "maps/backprojection/contours/methods.hpp"
#include "maps/backprojection/patches/methods.hpp"
#include "maps/backprojection/soft_shadow_map/methods.hpp"
#include "maps/filters/methods.hpp"
#include "maps/host/dome_suns.hpp"
#include "maps/host/every_light.hpp"
#include "maps/host/options.hpp"
#include "maps/host/texel_widths.hpp"
#include "maps/sampling/methods.hpp"
#include "maps/screen/methods.hpp"
#include "maps/single_shadow/methods.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace penumbra::maps {

namespace {

/// Returns the kinds of light that a method is extended to with these options. A sun's light space (SunSpace) keeps
/// planes plane: it supports the camera's frustum, slices of depth and moves of pixels along surfaces (fit=view,
/// cascades, tiles), but neither the camera's own perspective (the warps, fit=faces) nor the previous picture
/// (reproject=). Spheres support none of these options, because each disk of a lamp sees only a part of the view
/// samples.
Given given_with(Given given, const visibility::MethodOptions& options) {
  const auto fit = options.find("fit");
  const auto reproject = options.find("reproject");
  const bool fits = fit != options.end() && fit->second != "receivers";
  const bool flat = fits && (fit->second == "view" || fit->second == "cascades" || fit->second == "tiles");
  const bool reprojects = reproject != options.end() && reproject->second != "off";
  if (fits || reprojects) given.spheres = false;
  if ((fits && !flat) || reprojects) given.suns = false;
  return given;
}

/// Returns a method's own options: all except the number of suns for a dome.
visibility::MethodOptions own_options(visibility::MethodOptions options) {
  options.erase(kDomeSuns.name());
  return options;
}

/// Completes a description with all lights that a method of this family can evaluate.
visibility::MethodDescription described(visibility::MethodDescription description, Given given) {
  description = for_every_light(std::move(description), given);
  description.texel_widths = texel_widths;
  description.options.push_back(kDomeSuns.description());
  return given.suns ? with_dome_suns(std::move(description)) : description;
}

/// Returns the table row of a method of this family, extended to all lights and surfaces in `kGiven`.
template <auto kDescribe, auto kMake, Given kGiven = Given{}>
engines::MethodRow row() {
  engines::MethodRow row = engines::on_device<kDescribe, kMake>();
  row.description = described(std::move(row.description), kGiven);
  row.describe = [](const visibility::MethodOptions& options) {
    visibility::MethodDescription description =
        described(engines::describe_with<kDescribe>(own_options(options)), given_with(kGiven, options));
    visibility::parse_options(description, options);
    return description;
  };
  row.make = [](const render::Machine& machine, const visibility::MethodOptions& options) {
    const Given given = given_with(kGiven, options);
    const visibility::MethodDescription all = described(engines::describe_with<kDescribe>(own_options(options)), given);
    const std::uint32_t suns = visibility::parse_options(all, options)[kDomeSuns];
    std::unique_ptr<visibility::Method> method = for_every_light(kMake(machine.device(), own_options(options)), given);
    return given.suns ? with_dome_suns(std::move(method), suns) : std::move(method);
  };
  return row;
}

engines::MethodRow slow_on_processors(engines::MethodRow row) {
  row.slow_on_processors = true;
  return row;
}

bool is_no_sphere(const visibility::Light& light) {
  return light.kind != visibility::LightKind::sphere;
}

/// Returns the table row of deep-penumbra. A sphere is replaced by up to 54 disks, each with lists for every texel of
/// its own map; in a face of a cube, three disks are side by side. So maps of a sphere have a quarter of `size` texels
/// on a side: a face of the cube then has about as many texels as a face of another light. With whole maps a sphere
/// would take minutes.
engines::MethodRow deep_penumbra_row() {
  engines::MethodRow row = maps::row<deep_penumbra_description, make_deep_penumbra>();
  row.make = [make = row.make, describe = row.describe](const render::Machine& machine,
                                                        const visibility::MethodOptions& options) {
    visibility::MethodOptions of_disks = options;
    const std::string size = visibility::complete_options(describe(options), options).at(kMapSize.name());
    of_disks[kMapSize.name()] = std::to_string(std::max(std::stoul(size) / 4, 8UL));
    return engines::make_engine_by_light({.usual = [=] { return make(machine, options); },
                                          .other = [=] { return make(machine, of_disks); },
                                          .is_usual = is_no_sphere});
  };
  return row;
}

/// Methods with penumbrae drawn along the borders of triangles, which are not the borders of holes.
constexpr Given kWithoutHoles{.suns = true, .spheres = true, .holes = false};
/// Methods with a flood on the screen, which would end at the border of the next disk of a lamp.
constexpr Given kWithoutSpheres{.suns = true, .spheres = false, .holes = true};

}  // namespace

bool passes_triangles(std::string_view name, const visibility::MethodOptions& options) {
  constexpr std::array kMethods{"shadow-map", "pcf", "pcss"};
  // With any other option, the camera or the triangles that texels belong to determine what is drawn, or OpenGL draws.
  constexpr std::array kOptions{"size",        "bias",     "depth",          "receiverPlane", "offsetFactor",
                                "offsetUnits", "suns",     "window",         "weights",       "taps",
                                "stages",      "softness", "blockerSamples", "filterSamples"};
  const auto is_known = [&](const auto& option) { return std::ranges::find(kOptions, option.first) != kOptions.end(); };
  return std::ranges::find(kMethods, name) != kMethods.end() && std::ranges::all_of(options, is_known);
}

std::span<const engines::MethodRow> methods() {
  static const std::array rows{
      row<bitmask_description, make_bitmask>(),
      slow_on_processors(row<backproject_description, make_backproject>()),
      slow_on_processors(row<backproject_peel_description, make_backproject_peel>()),
      row<layer_rays_description, make_layer_rays>(),
      row<packet_description, make_packet>(),
      slow_on_processors(row<contour_description, make_contour>()),
      row<pcss_description, make_pcss>(),
      row<vssm_description, make_vssm>(),
      row<soft_shadow_map_description, make_soft_shadow_map>(),
      slow_on_processors(row<accumulate_description, make_accumulate>()),
      slow_on_processors(row<adaptive_light_description, make_adaptive_light>()),
      deep_penumbra_row(),
      row<layered_attenuation_description, make_layered_attenuation>(),
      row<occlusion_textures_description, make_occlusion_textures>(),
      row<convolution_description, make_convolution>(),
      row<penumbra_map_description, make_penumbra_map, kWithoutHoles>(),
      row<smoothies_description, make_smoothies, kWithoutHoles>(),
      row<brabec_seidel_description, make_brabec_seidel>(),
      row<kirsch_doellner_description, make_kirsch_doellner>(),
      row<parker_description, make_parker>(),
      row<arvo_description, make_arvo, kWithoutSpheres>(),
      row<pcf_description, make_pcf>(),
      row<silhouette_map_description, make_silhouette_map, kWithoutHoles>(),
      row<forward_map_description, make_forward_map>(),
      row<shadow_map_description, make_shadow_map>(),
      engines::on_processor<make_ssao>(),
      engines::on_processor<make_hbao>(),
  };
  return rows;
}

}  // namespace penumbra::maps
