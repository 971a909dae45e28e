// SPDX-License-Identifier: Apache-2.0
// Descriptions and repairs common to the methods of this room.

#include "maps/single_shadow/descriptions.hpp"

#include "maps/host/error_repairs.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/single_shadow/options.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace penumbra::maps {

namespace {

MapRepairs one_edge() {
  return {.ends_at_points = true,
          .layers = "it reads only the nearest surfaces; no form of the method reads more",
          .fusion = "only the nearest edge decides: nothing is added or joined",
          .gaps = "no texel is projected: there are no gaps between them",
          .falloff = "the fall of light across the penumbra of that edge is the method itself: it has no other form"};
}

}  // namespace

visibility::MethodDescription single_shadow_description(SingleShadow method) {
  return {.name = std::move(method.name),
          .family = visibility::Family::image,
          .paper = std::move(method.paper),
          .output = visibility::Output::scalar,
          .exact_for = std::move(method.exact_for),
          .lights = visibility::kPlanarLights,
          .textures = false,
          .on_request = true,
          .options = std::move(method.options),
          .verdict_on = method.verdict_on,
          .repairs = method.repairs};
}

visibility::MeshVerdict outer_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("the hard shadow of the light's centre, with penumbrae outside of it only", mesh);
}

visibility::ErrorRepairs single_shadow_repairs(const visibility::MethodDescription& method,
                                               const visibility::MethodOptions& given) {
  return map_repairs(method, given, one_edge());
}

visibility::ErrorRepairs searched_shadow_repairs(const visibility::MethodDescription& method,
                                                 const visibility::MethodOptions& given) {
  MapRepairs repairs = one_edge();
  // The search radius is given in texels: doubling it keeps the search's extent.
  repairs.doubled = {"size", "radius"};
  return map_repairs(method, given, repairs);
}

std::optional<std::string> cut_search_warning(const visibility::MethodOptions& options,
                                              const std::map<std::string, std::uint64_t>& counters) {
  const auto found = counters.find("cutSearches");
  if (found == counters.end() || found->second == 0) return std::nullopt;
  const auto radius = options.find(kSearchRadius.key);
  return fmt::format(
      "penumbrae may extend beyond radius={} texels, where the search ended, at {} view samples, and are cut there; "
      "take a larger radius (at most {}) or a smaller size",
      radius == options.end() ? std::to_string(kSearchRadius.otherwise) : radius->second, found->second,
      kSearchRadius.most);
}

}  // namespace penumbra::maps
