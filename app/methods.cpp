#include "app/methods.hpp"

#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "visibility/lights/device_light.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <type_traits>

// A family that this build goes without is not a CMake target; its methods are then not in the table.
#ifdef PENUMBRA_HAS_VSM
#include "vsm/alias_free.hpp"
#include "vsm/hierarchical_penumbra.hpp"
#include "vsm/view_sample.hpp"
#include "vsm/view_sample_planar.hpp"
#endif
#ifdef PENUMBRA_HAS_VOLUMES
#include "volumes/counters/depth_complexity.hpp"
#include "volumes/scatter/edge_scatter.hpp"
#include "volumes/soft/hard_volume.hpp"
#include "volumes/soft/soft_irregular.hpp"
#include "volumes/soft/soft_volume.hpp"
#include "volumes/soft/soft_volume_blend.hpp"
#include "volumes/soft/wedge_ramp.hpp"
#endif
#ifdef PENUMBRA_HAS_MAPS
#include "maps/backprojection/patches/backproject.hpp"
#include "maps/backprojection/patches/backproject_peel.hpp"
#include "maps/backprojection/patches/bitmask.hpp"
#include "maps/backprojection/contours/contour.hpp"
#include "maps/backprojection/contours/packet.hpp"
#include "maps/backprojection/soft_shadow_map/soft_shadow_map.hpp"
#include "maps/sampling/accumulate.hpp"
#include "maps/sampling/adaptive_light.hpp"
#include "maps/sampling/deep_penumbra.hpp"
#include "maps/sampling/layered_attenuation.hpp"
#include "maps/filters/convolution.hpp"
#include "maps/filters/occlusion_textures.hpp"
#include "maps/filters/pcf.hpp"
#include "maps/filters/pcss.hpp"
#include "maps/filters/shadow_map.hpp"
#include "maps/filters/vssm.hpp"
#endif
#ifdef PENUMBRA_HAS_REFERENCE
#include "reference/exact_method.hpp"
#include "reference/ray_traced.hpp"
#endif

namespace penumbra::app {
namespace {

using visibility::Family;
using visibility::Light;
using visibility::Method;
using visibility::MethodDescription;
using visibility::MethodOptions;

/// Of a method with two engines: does it run on the processor?
using OnVectors = bool (*)(const render::Machine&, const MethodOptions&, const Light&);

struct TableRow {
  const MethodDescription& (*describe)();
  MethodDescription (*describe_with)(const MethodOptions&);  ///< what these options make of it
  std::unique_ptr<Method> (*make)(const render::Machine&, const MethodOptions&);
  bool on_device = false;
  OnVectors on_vectors = nullptr;  ///< none: a method with one engine
};

template <auto kDescribe>
MethodDescription describe_with(const MethodOptions& options) {
  if constexpr (std::is_invocable_v<decltype(kDescribe), const MethodOptions&>) {
    return kDescribe(options);
  } else {
    MethodDescription description = kDescribe();
    visibility::parse_options(description, options);
    return description;
  }
}

/// A method that runs on the Vulkan device, or on one of two engines.
template <auto kDescribe, auto kMake>
[[maybe_unused]] TableRow on_device(OnVectors on_vectors = nullptr) {
  return {[]() -> const MethodDescription& {
            static const MethodDescription description = describe_with<kDescribe>({});
            return description;
          },
          describe_with<kDescribe>,
          [](const render::Machine& machine, const MethodOptions& options) {
            if constexpr (std::is_invocable_v<decltype(kMake), const render::Machine&, const MethodOptions&>) {
              return kMake(machine, options);
            } else {
              return kMake(machine.device(), options);
            }
          },
          true, on_vectors};
}

/// A method that runs on the processor: an instance can be asked what it is, without a Vulkan device.
template <auto kMake>
[[maybe_unused]] TableRow on_processor() {
  return {[]() -> const MethodDescription& {
            static const MethodDescription description = kMake({})->description();
            return description;
          },
          [](const MethodOptions& options) { return MethodDescription(kMake(options)->description()); },
          [](const render::Machine&, const MethodOptions& options) { return kMake(options); }, false};
}

/// The table of methods: one line a method; within a family the best comes first.
const std::vector<TableRow>& table() {
  static const std::vector<TableRow> rows = {
#ifdef PENUMBRA_HAS_VOLUMES
      on_device<volumes::edge_scatter_description, volumes::make_edge_scatter>(volumes::edge_scatter_on_vectors),
#endif
#ifdef PENUMBRA_HAS_VSM
      on_device<vsm::view_sample_description, vsm::make_view_sample>(vsm::view_sample_on_vectors),
#endif
#ifdef PENUMBRA_HAS_VOLUMES
      on_device<volumes::depth_complexity_description, volumes::make_depth_complexity>(
          volumes::depth_complexity_on_vectors),
      on_device<volumes::soft_volume_description, volumes::make_soft_volume>(),
      on_device<volumes::soft_volume_blend_description, volumes::make_soft_volume_blend>(),
      on_processor<volumes::make_soft_irregular>(),
      on_device<volumes::wedge_ramp_description, volumes::make_wedge_ramp>(),
      on_device<volumes::hard_volume_description, volumes::make_hard_volume>(),
#endif
#ifdef PENUMBRA_HAS_VSM
      on_processor<vsm::make_hierarchical_penumbra>(),
      on_processor<vsm::make_view_sample_planar>(),
      on_processor<vsm::make_alias_free>(),
#endif
#ifdef PENUMBRA_HAS_MAPS
      on_device<maps::bitmask_description, maps::make_bitmask>(),
      on_device<maps::backproject_description, maps::make_backproject>(),
      on_device<maps::backproject_peel_description, maps::make_backproject_peel>(),
      on_device<maps::packet_description, maps::make_packet>(),
      on_device<maps::contour_description, maps::make_contour>(),
      on_device<maps::pcss_description, maps::make_pcss>(),
      on_device<maps::vssm_description, maps::make_vssm>(),
      on_device<maps::soft_shadow_map_description, maps::make_soft_shadow_map>(),
      on_device<maps::accumulate_description, maps::make_accumulate>(),
      on_device<maps::adaptive_light_description, maps::make_adaptive_light>(),
      on_device<maps::deep_penumbra_description, maps::make_deep_penumbra>(),
      on_device<maps::layered_attenuation_description, maps::make_layered_attenuation>(),
      on_device<maps::occlusion_textures_description, maps::make_occlusion_textures>(),
      on_device<maps::convolution_description, maps::make_convolution>(),
      on_device<maps::pcf_description, maps::make_pcf>(),
      on_device<maps::shadow_map_description, maps::make_shadow_map>(),
#endif
#ifdef PENUMBRA_HAS_REFERENCE
      on_processor<reference::make_ray_traced>(),
      on_processor<reference::make_exact>(),
#endif
  };
  return rows;
}

/// Names of methods that a build may go without. They are never used for anything else.
constexpr std::array kNotThereYet = {"exact",
                                     "depth-complexity",
                                     "alias-free",
                                     "view-sample-planar",
                                     "view-sample",
                                     "soft-irregular",
                                     "hierarchical-penumbra",
                                     "shadow-map",
                                     "pcss",
                                     "accumulate",
                                     "edge-scatter",
                                     "raytrace"};

std::vector<std::string> names_of(const std::vector<const MethodDescription*>& methods) {
  std::vector<std::string> names;
  for (const MethodDescription* method : methods) names.push_back(method->name);
  return names;
}

const TableRow& find_row(std::string_view name) {
  const auto row = std::ranges::find_if(table(), [&](const TableRow& r) { return r.describe().name == name; });
  if (row != table().end()) return *row;
  const auto there = fmt::format("{}", fmt::join(names_of(all_methods()), ", "));
  if (std::ranges::find(kNotThereYet, name) != kNotThereYet.end()) {
    throw UsageError("method \"{}\" is not there yet; what is: {}", name, there);
  }
  throw UsageError("there is no method \"{}\"; what is there: {}{}", name, there,
                   did_you_mean(name, names_of(all_methods())));
}

}  // namespace

std::vector<const MethodDescription*> all_methods() {
  std::vector<const MethodDescription*> methods;
  for (const TableRow& row : table()) methods.push_back(&row.describe());
  return methods;
}

std::optional<std::vector<const MethodDescription*>> method_group(std::string_view group) {
  auto methods = all_methods();
  if (group == "all") return methods;
  if (group == "default") {
    std::erase_if(methods, [](const MethodDescription* method) {
      return method->family == Family::reference || method->on_request;
    });
    return methods;
  }
  for (const Family family : {Family::reference, Family::geometry, Family::image}) {
    if (group != visibility::name_of(family)) continue;
    std::erase_if(methods, [&](const MethodDescription* method) { return method->family != family; });
    return methods;
  }
  return std::nullopt;
}

const MethodDescription& describe_method(std::string_view name) {
  return find_row(name).describe();
}

MethodDescription describe_method(std::string_view name, const MethodOptions& options) {
  return find_row(name).describe_with(options);
}

std::unique_ptr<Method> make_method(std::string_view name, const MethodOptions& options,
                                    const render::Machine& machine) {
  return find_row(name).make(machine, options);
}

bool runs_on_device(std::string_view name, const MethodOptions& options, const Light& light,
                    const render::Machine& machine) {
  const TableRow& row = find_row(name);
  return row.on_device && (row.on_vectors == nullptr || !row.on_vectors(machine, options, light));
}

bool needs_device(std::string_view name, const MethodOptions& options) {
  const TableRow& row = find_row(name);
  const render::Machine without_gpu({.wanted = "cpu"});
  return row.on_device && (row.on_vectors == nullptr || !row.on_vectors(without_gpu, options, Light{}));
}

bool counts_light_samples(const MethodDescription& method) {
  // Two methods without masks add up, map by map, how many light samples are visible.
  constexpr std::array<std::string_view, 2> kShares = {"deep-penumbra", "layered-attenuation"};
  return method.output == visibility::Output::mask || std::ranges::find(kShares, method.name) != kShares.end();
}

bool can_do(const MethodDescription& method, const std::vector<Light>& lights) {
  return std::ranges::all_of(lights, [&](const Light& light) {
    return std::ranges::find(method.lights, light.kind) != method.lights.end() && (method.textures || !light.texture) &&
           (method.any_pattern || light.rows != 0) &&
           (light.filtered_by.empty() || method.output == visibility::Output::mask);
  });
}

const MethodDescription& default_method(const Light& light, const visibility::SceneFloats* scene) {
  const MethodDescription *rays = nullptr, *areas = nullptr;
  bool refused = false;  // is there one that does such lights where they are nearer?
  for (const MethodDescription* method : all_methods()) {
    if (!can_do(*method, {light})) continue;
    // A hard shadow of the light's centre is no answer where rays give one, nor is what takes longer than rays.
    if (method->output == visibility::Output::scalar || method->on_request) continue;
    const bool holds = scene == nullptr || visibility::can_span(method->span, light, *scene);
    if (method->family == Family::geometry && !refused) {
      if (holds) return *method;
      refused = true;
    }
    if (method->family != Family::reference || !holds) continue;
    (method->output == visibility::Output::mask ? rays : areas) = method;
  }
  if (rays != nullptr) return *rays;
  if (areas != nullptr) return *areas;
  throw InputError("light \"{}\" is a {}, which no method of this build can do; choose another with --light",
                   light.name, visibility::name_of(light.kind));
}

}  // namespace penumbra::app
