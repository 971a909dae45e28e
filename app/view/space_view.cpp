// SPDX-License-Identifier: Apache-2.0
// Answers of the live view's 3D page: the scene's triangles, its defects, the wedges and shadow volumes of a light, and
// the wedges that contain the surface at a chosen pixel. Floats of the scene and casters are kept until the scene
// changes.

#include "app/view/space_view.hpp"

#include "app/view/space_meshes.hpp"
#include "app/view/space_message.hpp"
#include "base/error.hpp"
#include "network/requests.hpp"
#include "session/parse.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace penumbra::app {
namespace {

std::optional<double> number_in(std::string_view target, std::string_view name) {
  const std::optional<std::string> text = network::parameter_of(target, name);
  if (!text) return std::nullopt;
  const std::optional<double> number = session::parse_number(*text);
  if (!number) throw UsageError("{}={}: expected a number", name, *text);
  return number;
}

std::optional<std::uint32_t> index_in(std::string_view target, std::string_view name) {
  const std::optional<std::string> text = network::parameter_of(target, name);
  if (!text) return std::nullopt;
  const auto number = session::parse_integer<std::uint32_t>(*text);
  if (!number) throw UsageError("{}={}: expected a number from 0", name, *text);
  return number;
}

double place_in(std::string_view target, std::string_view name) {
  const double place = number_in(target, name).value_or(0);
  if (!(std::abs(place) <= 1)) throw UsageError("{}={}: expected -1 to 1", name, place);
  return place;
}

/// Returns the position of a pixel's view sample relative to `origin`; nullopt: the pixel shows no surface, or the
/// picture is of another size.
std::optional<glm::dvec3> point_at(const LivePicture& picture, std::uint32_t x, std::uint32_t y,
                                   const glm::dvec3& origin) {
  const visibility::ViewSamples& samples = picture.samples;
  if (samples.width != picture.full_width || x >= samples.width || y >= samples.height) return std::nullopt;
  const std::size_t i = std::size_t{y} * samples.width + x;
  if (samples.triangle[i] == visibility::ViewSamples::kBackground) return std::nullopt;
  return glm::dvec3(samples.p[i]) + (picture.origin - origin);
}

}  // namespace

SpaceShadows parse_space_shadows(std::string_view target) {
  SpaceShadows request;
  request.wedges.light = network::parameter_of(target, "light").value_or("");
  request.wedges.construction = network::parameter_of(target, "construction").value_or("original");
  request.wedges.from = network::parameter_of(target, "from").value_or("centre");
  request.place = {place_in(target, "s"), place_in(target, "t")};
  request.floor = number_in(target, "floor");
  request.wedge = index_in(target, "wedge");
  return request;
}

const visibility::SceneFloats& SpaceView::floats_of(const LiveScenery& scenery) {
  if (!scenery.whole->instances.empty())
    throw UsageError(
        "this scene has {} instances that share their meshes, which the 3D view cannot draw; use --instances copies",
        scenery.whole->instances.all.size());
  if (scene_ == scenery.whole) return floats_;
  scene_.reset();
  casters_of_.reset();
  floats_ = visibility::make_scene_floats(scenery.whole->scene);
  scene_ = scenery.whole;
  return floats_;
}

const volumes::Casters& SpaceView::casters_of(const LiveScenery& scenery, const visibility::Light& light) {
  const visibility::SceneFloats& floats = floats_of(scenery);
  const CastersOf wanted{light.index, light.unshaded_by};
  if (casters_of_ == wanted) return casters_;
  casters_of_.reset();
  casters_ = light.unshaded_by.empty() ? volumes::casters_of(floats, light)
                                       : volumes::casters_of(cast_for(floats, light), light);
  casters_of_ = wanted;
  return casters_;
}

std::string SpaceView::meshes() {
  const LiveScenery scenery = renderer_.scenery();
  const std::lock_guard lock(mutex_);
  return meshes_message(scenery.whole->scene, floats_of(scenery));
}

std::string SpaceView::defects() {
  const LiveScenery scenery = renderer_.scenery();
  const std::lock_guard lock(mutex_);
  return defects_message(scenery.whole->scene, floats_of(scenery).origin);
}

std::string SpaceView::shadows(std::string_view target) {
  SpaceShadows request = parse_space_shadows(target);
  const auto x = index_in(target, "x"), y = index_in(target, "y");
  const LiveScenery scenery = renderer_.scenery();
  const auto& lights = scenery.lights.lights;
  const std::string& name = request.wedges.light;
  const auto found = name.empty() ? lights.begin() : std::ranges::find(lights, name, &scenes::AreaLight::name);
  if (found == lights.end()) throw UsageError("light={}: the scene has no such light", name);
  const std::lock_guard lock(mutex_);
  const glm::dvec3 origin = floats_of(scenery).origin;
  if (x && y && scenery.picture) request.point = point_at(*scenery.picture, *x, *y, origin);
  visibility::Light light;
  try {
    light = visibility::make_light(scenery.lights, static_cast<std::uint32_t>(found - lights.begin()), origin, {});
    session::require_wedges(light);
  } catch (const InputError& error) {
    return SpaceMessage().finish({{"light", found->name}, {"refused", error.what()}});
  }
  return shadows_message(casters_of(scenery, light), light, origin, request);
}

}  // namespace penumbra::app
