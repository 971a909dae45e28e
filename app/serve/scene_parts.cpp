// SPDX-License-Identifier: Apache-2.0
// Keeps a scene as replaceable things and joins them.

#include "app/serve/scene_parts.hpp"

#include "base/error.hpp"
#include "scenes/formats/checks.hpp"
#include "scenes/formats/gltf_reader.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace penumbra::app {
namespace {

/// Removes the thing's name from the name of one of its objects or lights, and returns it.
std::string take_thing(std::string& name) {
  const std::size_t end = name.find(SceneParts::kThingEnds);
  if (end == std::string::npos) return "";
  std::string thing = name.substr(0, end);
  name.erase(0, name.rfind(SceneParts::kThingEnds) + SceneParts::kThingEnds.size());
  return thing;
}

/// Extends a thing's range by one. Throws if the range has already ended.
void add(const std::string& thing, std::uint32_t number, std::uint32_t& first, std::uint32_t& count) {
  if (count == 0) first = number;
  if (first + count != number)
    throw InputError("the nodes of the thing \"{}\" are not contiguous in their file", thing);
  ++count;
}

}  // namespace

void SceneParts::put(std::span<const std::byte> glb, const Put& what) {
  auto file = std::make_shared<scenes::Scene>(
      scenes::read_glb(glb, "the scene", {.needs_light = false, .needs_surface = false, .lenient = true}, what.folder));
  std::vector<std::string> order;
  std::map<std::string, Thing> things;
  const auto part_of = [&](const std::string& thing) {
    const auto [place, is_new] = things.try_emplace(thing);
    if (is_new) order.push_back(thing);
    place->second.file = file;
    place->second.part.scene = file.get();
    place->second.part.casts_shadows = !what.shadeless.contains(thing);
    return place;
  };
  for (std::uint32_t i = 0; i < file->objects.size(); ++i) {
    const auto thing = part_of(take_thing(file->objects[i].name));
    add(thing->first, i, thing->second.part.first_object, thing->second.part.objects);
  }
  for (std::uint32_t i = 0; i < file->lights.size(); ++i) {
    const auto thing = part_of(take_thing(file->lights[i].name));
    add(thing->first, i, thing->second.part.first_light, thing->second.part.lights);
  }
  for (const std::string& thing : what.things) static_cast<void>(part_of(thing));
  for (const std::string& name : order) {
    Thing& thing = things.at(name);
    note_change_of(thing);
    const auto [before, is_new] = things_.try_emplace(name);
    if (is_new)
      order_.push_back(name);
    else
      note_change_of(before->second);
    before->second = std::move(thing);
  }
}

void SceneParts::remove(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const auto thing = things_.find(name);
    if (thing == things_.end()) continue;
    note_change_of(thing->second);
    things_.erase(thing);
    std::erase(order_, name);
  }
}

void SceneParts::put_in_order(const std::vector<std::string>& names) {
  std::vector<std::string> order;
  std::set<std::string> taken;
  for (const std::string& name : names) {
    if (!things_.contains(name)) throw InputError("there is no thing \"{}\"", name);
    if (!taken.insert(name).second) throw InputError("the thing \"{}\" is named twice", name);
    order.push_back(name);
  }
  for (const std::string& name : order_) {
    if (!taken.contains(name)) order.push_back(name);
  }
  if (order == order_) return;
  order_ = std::move(order);
  meshes_changed_ = true;
}

LiveScene SceneParts::scene(const scenes::Camera& camera) const {
  std::vector<scenes::ScenePart> parts;
  for (const std::string& name : order_) parts.push_back(things_.at(name).part);
  LiveScene made{scenes::joined(parts, meshes_changed_), !meshes_changed_};
  made.scene.name = "the scene";
  made.scene.cameras = {camera};
  if (made.scene.lights.empty()) throw InputError("there is no light in the scene");
  if (meshes_changed_) scenes::check_scene(made.scene, made.scene.name);
  return made;
}

}  // namespace penumbra::app
