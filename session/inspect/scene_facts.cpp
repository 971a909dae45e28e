// SPDX-License-Identifier: Apache-2.0
// Lists lights, cameras, materials and animations of a scene.

#include "session/inspect/scene_facts.hpp"

#include "compare/scene_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace penumbra::session {
namespace {

using scenes::Alpha;

std::string alpha_text(const Alpha& alpha) {
  switch (alpha.mode) {
    case Alpha::Mode::mask:
      return fmt::format("holes where alpha is below {:.3g}", alpha.cutoff);
    case Alpha::Mode::blend:
      return "translucent";
    case Alpha::Mode::opaque:
      break;
  }
  return "";
}

/// Returns whether the object shades any light other than the one whose body it is. For a mesh without lights: true.
bool dims_light(const scenes::Scene& scene, const scenes::Object& object) {
  const auto number = static_cast<std::uint32_t>(&object - scene.objects.data());
  const auto shades = [&](const scenes::AreaLight& light) {
    const auto index = static_cast<std::uint32_t>(&light - scene.lights.data());
    return object.emits != index && std::ranges::find(light.unshaded_by, number) == light.unshaded_by.end();
  };
  return object.casts_shadow && (scene.lights.empty() || std::ranges::any_of(scene.lights, shades));
}

const char* alpha_name(const Alpha& alpha) {
  return alpha.mode == Alpha::Mode::mask ? "mask" : alpha.mode == Alpha::Mode::blend ? "blend" : "opaque";
}

}  // namespace

SceneFacts facts_of(const scenes::Scene& scene) {
  SceneFacts facts;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const scenes::AreaLight& light = scene.lights[i];
    const auto body =
        std::ranges::find_if(scene.objects, [&](const scenes::Object& object) { return object.emits == i; });
    const std::string of = body == scene.objects.end() ? "" : fmt::format("; its body is \"{}\"", body->name);
    facts.lights.push_back({light.name, compare::words_of(light) + of});
  }
  for (const scenes::Camera& camera : scene.cameras) facts.cameras.push_back({camera.name, compare::words_of(camera)});
  for (const scenes::Object& object : scene.objects) {
    if (object.alpha.mode != Alpha::Mode::opaque && dims_light(scene, object)) {
      if (facts.filter.empty()) facts.filter = object.name;
      if (facts.dimmer.empty() && object.alpha.mode == Alpha::Mode::blend) facts.dimmer = object.name;
    }
    if (object.material.empty()) continue;
    auto same = std::ranges::find(facts.materials, object.material, &SceneFacts::Material::name);
    if (same == facts.materials.end()) {
      const std::string picture = object.picture ? scene.pictures[object.picture->picture].file : "";
      same = facts.materials.insert(same, {object.material, object.alpha, picture, {}});
    }
    same->objects.push_back(object.name);
  }
  facts.motion = scene.motion;
  return facts;
}

std::string facts_table(const SceneFacts& facts) {
  std::string text;
  const auto row = [&](const char* what, const std::string& name, const std::string& words) {
    text += fmt::format("  {:<9} \"{}\"{}{}\n", what, name, words.empty() ? "" : ": ", words);
  };
  for (const SceneFacts::Named& light : facts.lights) row("light", light.name, light.text);
  for (const SceneFacts::Named& camera : facts.cameras) row("camera", camera.name, camera.text);
  for (const SceneFacts::Material& material : facts.materials) {
    std::vector<std::string> words;
    if (!material.picture.empty()) words.push_back(fmt::format("picture {}", material.picture));
    if (const std::string alpha = alpha_text(material.alpha); !alpha.empty()) words.push_back(alpha);
    words.push_back(material.objects.size() == 1 ? fmt::format("of \"{}\"", material.objects.front())
                                                 : fmt::format("of {} objects", material.objects.size()));
    row("material", material.name, fmt::format("{}", fmt::join(words, ", ")));
  }
  if (facts.motion)
    text += fmt::format("  animation from {:.4g} s to {:.4g} s\n", facts.motion->first, facts.motion->last);
  return text;
}

nlohmann::ordered_json facts_json(const SceneFacts& facts) {
  using nlohmann::ordered_json;
  const auto named = [](const std::vector<SceneFacts::Named>& all) {
    auto list = ordered_json::array();
    for (const SceneFacts::Named& one : all) list.push_back({{"name", one.name}, {"text", one.text}});
    return list;
  };
  auto materials = ordered_json::array();
  for (const SceneFacts::Material& material : facts.materials) {
    materials.push_back(
        {{"name", material.name}, {"alpha", alpha_name(material.alpha)}, {"objects", material.objects}});
    materials.back()["picture"] = material.picture.empty() ? ordered_json(nullptr) : ordered_json(material.picture);
  }
  ordered_json json = {{"lights", named(facts.lights)}, {"cameras", named(facts.cameras)}, {"materials", materials}};
  json["animation"] = nullptr;
  if (facts.motion) json["animation"] = {{"first", facts.motion->first}, {"last", facts.motion->last}};
  return json;
}

}  // namespace penumbra::session
