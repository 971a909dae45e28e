// SPDX-License-Identifier: Apache-2.0
// Builds and validates the wedges of a light for a request.

#include "session/wedges/built_wedges.hpp"

#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "volumes/wedges/wedge_faults.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

namespace penumbra::session {
namespace {

struct ChosenConstruction {
  volumes::Construction construction = volumes::Construction::original;
  std::optional<volumes::Fault> fault;
};

ChosenConstruction parse_construction(const std::string& text) {
  if (text == "original") return {};
  if (text == "tight") return {volumes::Construction::tight, {}};
  constexpr std::string_view kBroken = "broken:";
  if (text.size() == kBroken.size() + 1 && text.starts_with(kBroken) && text.back() >= '1' && text.back() <= '6') {
    return {volumes::Construction::original, static_cast<volumes::Fault>(text.back() - '0')};
  }
  throw UsageError("--construction {}: expected original, tight, or broken:1 … broken:6", text);
}

volumes::SilhouettesFrom parse_from(const std::string& text) {
  if (text == "centre") return volumes::SilhouettesFrom::center;
  if (text == "anywhere") return volumes::SilhouettesFrom::anywhere;
  throw UsageError("--from {}: expected centre or anywhere", text);
}

/// Returns the index of the light with this name; 0 for an empty name.
std::uint32_t find_light(const scenes::Scene& scene, const std::string& name) {
  if (name.empty()) return 0;
  const auto found = std::ranges::find(scene.lights, name, &scenes::AreaLight::name);
  if (found != scene.lights.end()) return static_cast<std::uint32_t>(found - scene.lights.begin());
  std::vector<std::string> names;
  for (const scenes::AreaLight& light : scene.lights) names.push_back(light.name);
  throw UsageError("--light {}: {} has no such name; it has: {}{}", name, scene.name, fmt::join(names, ", "),
                   did_you_mean(name, names));
}

/// Returns points of the light itself, if its hull is larger: points of a disk's or ellipse's rim. A sphere's outline
/// depends on the viewpoint; its hull is used instead.
std::vector<glm::dvec3> shape_of(const visibility::Light& light, const volumes::LightHull& hull) {
  if (is_body(light.kind) || !is_round(light.kind)) return hull.corners;
  constexpr int kRim = 256;
  const auto [center, u, v] = visibility::light_frame(light);
  std::vector<glm::dvec3> rim;
  for (int i = 0; i < kRim; ++i) {
    const double angle = 2 * std::numbers::pi * i / kRim;
    rim.push_back(center + std::cos(angle) * u + std::sin(angle) * v);
  }
  return rim;
}

}  // namespace

void require_wedges(const visibility::Light& light) {
  if (!light.sun) return;
  throw InputError("light \"{}\" is a {}; only lights at a finite distance have wedges: choose another (--light)",
                   light.name, visibility::name_of(light.kind));
}

LightWedges wedges_of(const volumes::Casters& casters, const visibility::Light& light, const WedgeRequest& request) {
  const ChosenConstruction chosen = parse_construction(request.construction);
  const volumes::SilhouettesFrom from = parse_from(request.from);
  const bool crop = chosen.construction == volumes::Construction::tight && from == volumes::SilhouettesFrom::anywhere;
  LightWedges made;
  made.hull = volumes::light_hull(light);
  made.casting = volumes::casting_edges(casters, made.hull, from, crop);
  const std::vector<volumes::WedgeEdge>& edges = made.casting.wedges;
  made.wedges = chosen.fault ? volumes::build_faulty_wedges(edges, made.hull, *chosen.fault)
                             : volumes::build_wedges(edges, made.hull, chosen.construction);
  return made;
}

BuiltWedges::BuiltWedges(const scenes::Scene& scene, const WedgeRequest& asked) : request(asked) {
  const bool tight = parse_construction(request.construction).construction == volumes::Construction::tight;
  static_cast<void>(parse_from(request.from));
  const auto step = [&](double done) {
    if (request.step != nullptr) (*request.step)(done);
  };
  step(0);
  floats = visibility::make_scene_floats(scene);
  light = visibility::make_light(scene, find_light(scene, request.light), floats.origin, {});
  if (!light.unshaded_by.empty()) floats = cast_for(floats, light);
  if (!light.filtered_by.empty())
    warnings.push_back(fmt::format(
        "\"{}\" lets light through (alphaMode MASK or BLEND): wedges exist only for casters that block all light",
        light.filtered_by));
  require_wedges(light);
  step(0.1);
  casters = volumes::casters_of(floats, light);
  step(0.2);
  LightWedges made = wedges_of(casters, light, request);
  hull = std::move(made.hull);
  casting = std::move(made.casting);
  wedges = std::move(made.wedges);
  if (!request.validate) return;
  step(0.4);
  report = volumes::validate({casters, casting, hull, wedges, tight});
  step(0.7);
  tightness = volumes::tightness_of(wedges, hull, shape_of(light, hull));
  step(0.8);
  coverage = check_scene_coverage(scene, floats, light, casters, *report);
}

WedgesResult BuiltWedges::result() const {
  WedgesResult result{light, hull, floats.origin, request.construction, request.from, wedges};
  if (report) result.validation = &*report;
  if (tightness) result.tightness = &*tightness;
  if (coverage) result.coverage = &*coverage;
  return result;
}

}  // namespace penumbra::session
