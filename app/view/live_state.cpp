// SPDX-License-Identifier: Apache-2.0
// Applies messages of the page to the state.

#include "app/view/live_state.hpp"

#include "app/view/light_json.hpp"
#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "scenes/picture_size.hpp"
#include "session/methods.hpp"
#include "session/options.hpp"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

namespace penumbra::app {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::array kChannels = {"beauty", "v", "error", "ids", "normals", "depth"};
constexpr std::uint32_t kLargestSide = 4096;

scenes::AreaLight& light_named(LiveState& state, const std::string& name) {
  const auto found = std::ranges::find(state.scene.lights, name, &scenes::AreaLight::name);
  if (found == state.scene.lights.end()) throw InputError("the scene has no light \"{}\"", name);
  return *found;
}

bool has_body(const scenes::Scene& scene, const scenes::AreaLight& light) {
  const auto number = static_cast<std::uint32_t>(&light - scene.lights.data());
  return std::ranges::any_of(scene.objects, [&](const scenes::Object& object) { return object.emits == number; });
}

LiveChange change_light(LiveState& state, const json& message) {
  scenes::AreaLight& light = light_named(state, message.at("name").get<std::string>());
  scenes::AreaLight made = changed_light(light, message.at("light"));
  json before = light_json(light), after = light_json(made);
  for (json* one : {&before, &after}) {
    for (const char* key : {"radiance", "irradiance", "twoSided"}) one->erase(key);
  }
  if (before != after && has_body(state.scene, light))
    throw InputError(
        "light \"{}\" has a body in the scene, which would not change with it: its shape must stay that of the file",
        light.name);
  light = std::move(made);
  return LiveChange::picture;
}

LiveChange change_lights_on(LiveState& state, const json& message) {
  std::set<std::string> off;
  for (const json& name : message.at("off")) off.insert(light_named(state, name.get<std::string>()).name);
  const auto solo = message.at("solo").get<std::string>();
  if (!solo.empty()) light_named(state, solo);
  state.off = std::move(off);
  state.solo = solo;
  return LiveChange::picture;
}

LiveChange change_camera(LiveState& state, const json& message) {
  scenes::Camera camera = state.camera;
  if (const auto name = message.find("name"); name != message.end()) {
    const auto found = std::ranges::find(state.scene.cameras, name->get<std::string>(), &scenes::Camera::name);
    if (found == state.scene.cameras.end())
      throw InputError("the scene has no camera \"{}\"", name->get<std::string>());
    camera = *found;
  }
  if (const auto change = message.find("camera"); change != message.end()) camera = changed_camera(camera, *change);
  state.camera = std::move(camera);
  return LiveChange::picture;
}

LiveChange change_method(LiveState& state, const json& message) {
  const auto entry = message.at("entry").get<std::string>();
  const bool is_other = message.at("slot").get<std::string>() == "b";
  if (const session::NamedMethod method = session::parse_method(entry); !method.name.empty())
    static_cast<void>(session::describe_method(method.name, method.options));
  if (!is_other)
    state.method = entry;
  else if (message.value("none", false))
    state.other.reset();
  else
    state.other = entry;
  return LiveChange::picture;
}

LiveChange change_size(LiveState& state, const json& message) {
  const auto width = message.at("width").get<std::uint32_t>(), height = message.at("height").get<std::uint32_t>();
  if ((width == 0) != (height == 0) || width > kLargestSide || height > kLargestSide)
    throw InputError("size {}x{}: expected at most {} a side, or 0x0 for the scene's", width, height, kLargestSide);
  state.width = width;
  state.height = height;
  return LiveChange::picture;
}

LiveChange change_samples(LiveState& state, const json& message) {
  const auto count = message.at("count").get<std::uint32_t>();
  session::RunOptions run;
  if (count != 0) run.light_samples = fmt::format("{}", count);
  static_cast<void>(session::parse_light_samples(run));
  state.light_samples = count;
  return LiveChange::picture;
}

LiveChange change_display(LiveState& state, const json& message) {
  LiveDisplay display = state.display;
  if (const auto channel = message.find("channel"); channel != message.end()) {
    const auto found = std::ranges::find(kChannels, channel->get<std::string>());
    if (found == kChannels.end())
      throw InputError("channel {}: expected one of {}", channel->dump(), fmt::join(kChannels, ", "));
    display.channel = static_cast<LiveChannel>(found - kChannels.begin());
  }
  if (const auto light = message.find("light"); light != message.end())
    display.light = light_named(state, light->get<std::string>()).name;
  const auto number = [&](const char* key, double least, double most, auto& into) {
    const auto value = message.find(key);
    if (value == message.end()) return;
    into.reset();
    if (value->is_null()) return;
    const auto given = value->get<double>();
    if (!(given >= least && given <= most)) throw InputError("{} {}: expected {} to {}", key, given, least, most);
    into = static_cast<typename std::remove_reference_t<decltype(into)>::value_type>(given);
  };
  number("stops", -40, 40, display.stops);
  number("limit", 1e-6, 1, display.limit);
  state.display = std::move(display);
  return LiveChange::display;
}

LiveChange change_masks(LiveState& state, const json& message) {
  state.masks = message.at("wanted").get<bool>();
  return LiveChange::display;
}

LiveChange stop_moving(LiveState& state, const json&) {
  state.moving = false;
  return LiveChange::display;
}

using Apply = LiveChange (*)(LiveState&, const json&);
const std::map<std::string_view, Apply>& changes() {
  static const std::map<std::string_view, Apply> all = {
      {"camera", change_camera},   {"light", change_light}, {"lights", change_lights_on},
      {"method", change_method},   {"size", change_size},   {"samples", change_samples},
      {"display", change_display}, {"masks", change_masks}, {"still", stop_moving},
  };
  return all;
}

}  // namespace

LiveState live_state(scenes::Scene scene, const std::string& camera) {
  LiveState state;
  state.camera = scene.cameras.front();
  if (!camera.empty()) {
    const auto found = std::ranges::find(scene.cameras, camera, &scenes::Camera::name);
    std::vector<std::string> names;
    for (const scenes::Camera& one : scene.cameras) names.push_back(one.name);
    if (found == scene.cameras.end())
      throw UsageError("--camera {}: {} has no such name; it has: {}{}", camera, scene.name, fmt::join(names, ", "),
                       did_you_mean(camera, names));
    state.camera = *found;
  }
  state.display.light = scene.lights.front().name;
  state.scene = std::move(scene);
  return state;
}

LiveChange apply(LiveState& state, const json& message) {
  if (!message.is_object() || !message.contains("type") || !message["type"].is_string())
    throw InputError("a message is an object with a \"type\"");
  const auto type = message["type"].get<std::string>();
  const auto change = changes().find(type);
  if (change == changes().end()) throw InputError("no message has the type \"{}\"", type);
  try {
    const LiveChange what = change->second(state, message);
    if (what == LiveChange::picture) state.moving = message.value("moving", false);
    return what;
  } catch (const json::exception& error) {
    throw InputError("message \"{}\": {}", type, error.what());
  }
}

ordered_json to_json(const LiveState& state) {
  auto lights = ordered_json::array(), cameras = ordered_json::array();
  const std::vector<std::string> on = lights_on(state);
  for (const scenes::AreaLight& light : state.scene.lights) {
    ordered_json row = light_json(light);
    row["fixed"] = has_body(state.scene, light);
    row["textured"] = light.texture.has_value();
    lights.push_back(std::move(row));
  }
  for (const scenes::Camera& camera : state.scene.cameras) cameras.push_back(camera_json(camera));
  scenes::Scene sized;
  sized.width = state.scene.width;
  sized.height = state.scene.height;
  const auto [width, height] = scenes::picture_size(sized, state.camera);
  ordered_json camera = camera_json(state.camera);
  camera["shift"] = {state.camera.shift.x, state.camera.shift.y};
  return {{"type", "state"},
          {"scene", state.scene.name},
          {"size", {state.width != 0 ? state.width : width, state.height != 0 ? state.height : height}},
          {"ownSize", {width, height}},
          {"camera", std::move(camera)},
          {"cameras", std::move(cameras)},
          {"lights", std::move(lights)},
          {"off", state.off},
          {"solo", state.solo},
          {"method", state.method},
          {"other", state.other ? ordered_json(*state.other) : ordered_json(nullptr)},
          {"lightSamples", state.light_samples},
          {"display",
           {{"channel", kChannels.at(static_cast<std::size_t>(state.display.channel))},
            {"light", state.display.light},
            {"stops", state.display.stops ? ordered_json(*state.display.stops) : ordered_json(nullptr)},
            {"limit", state.display.limit ? ordered_json(*state.display.limit) : ordered_json(nullptr)}}}};
}

std::vector<std::string> lights_on(const LiveState& state) {
  std::vector<std::string> on;
  for (const scenes::AreaLight& light : state.scene.lights) {
    const bool shines = state.solo.empty() ? !state.off.contains(light.name) : light.name == state.solo;
    if (shines) on.push_back(light.name);
  }
  return on;
}

LiveState reloaded(const LiveState& state, const scenes::Scene& before, scenes::Scene now) {
  LiveState made = state;
  const auto named = [](const auto& list, const std::string& name) {
    const auto found = std::ranges::find_if(list, [&](const auto& one) { return one.name == name; });
    return found == list.end() ? nullptr : &*found;
  };
  for (scenes::AreaLight& light : now.lights) {
    const scenes::AreaLight* const old = named(before.lights, light.name);
    const scenes::AreaLight* const edited = named(state.scene.lights, light.name);
    if (old == nullptr || edited == nullptr || light_json(*old) != light_json(light)) continue;
    light.shape = edited->shape;
    light.radiance = edited->radiance;
    light.two_sided = edited->two_sided;
  }
  const scenes::Camera* const camera = named(now.cameras, state.camera.name);
  const scenes::Camera* const old = named(before.cameras, state.camera.name);
  if (camera == nullptr)
    made.camera = now.cameras.front();
  else if (old == nullptr || camera_json(*camera) != camera_json(*old) || camera->aspect != old->aspect)
    made.camera = *camera;
  std::erase_if(made.off, [&](const std::string& name) { return named(now.lights, name) == nullptr; });
  if (named(now.lights, made.solo) == nullptr) made.solo.clear();
  if (named(now.lights, made.display.light) == nullptr) made.display.light = now.lights.front().name;
  made.scene = std::move(now);
  return made;
}

bool same_meshes(const scenes::Scene& a, const scenes::Scene& b) {
  const auto soup = [](const scenes::Scene& scene) {
    return std::tie(scene.soup.triangles, scene.soup.object, scene.soup.source_face, scene.soup.positions);
  };
  const auto looks = [](const scenes::Scene& scene) {
    return std::tie(scene.looks.normals, scene.looks.colors, scene.looks.places, scene.pictures, scene.origin);
  };
  const auto object = [](const scenes::Object& one) {
    return std::tie(one.name, one.color, one.casts_shadow, one.receives_shadow, one.emits, one.lit_by, one.material,
                    one.picture, one.alpha);
  };
  return std::ranges::equal(a.objects, b.objects, {}, object, object) && soup(a) == soup(b) && looks(a) == looks(b);
}

scenes::Scene with_meshes(scenes::Scene scene, const scenes::Scene& meshes) {
  scene.soup = meshes.soup;
  scene.looks = meshes.looks;
  scene.pictures = meshes.pictures;
  return scene;
}

}  // namespace penumbra::app
