// SPDX-License-Identifier: Apache-2.0
// Writes a scene as penumbra-scene/1, with numbers in the shortest digits that read back as the same double.

#include "scenes/formats/lights/light_formats.hpp"
#include "scenes/formats/writers.hpp"
#include "scenes/picture_size.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace penumbra::scenes {
namespace {

std::string quoted(const std::string& text) {
  using nlohmann::json;
  return json(text).dump(-1, ' ', false, json::error_handler_t::replace);
}

void write_camera(const Camera& camera, TextStream& text) {
  text.print(R"({{"name": {}, "eye": )", quoted(camera.name)).array(camera.eye);
  text.print(R"(, "target": )").array(camera.target);
  text.print(R"(, "up": )").array(camera.up);
  if (camera.shift != glm::dvec2(0)) {
    text.print(R"(, "shift": [)").number(camera.shift.x).print(", ");
    text.number(camera.shift.y).print("]");
  }
  if (camera.lens) {
    text.print(R"(, "aperture": )").number(camera.lens->radius);
    text.print(R"(, "focusDistance": )").number(camera.lens->focus_distance);
  }
  if (camera.height)
    text.print(R"(, "orthographicHeight": )").number(*camera.height).print("}}");
  else
    text.print(R"(, "verticalFov": )").number(camera.vertical_fov).print("}}");
}

/// Writes "key": ["name", …], each name once.
void write_names(const char* key, const std::set<std::string>& names, TextStream& text) {
  text.print(R"("{}": [)", key);
  bool first = true;
  for (const std::string& name : names) text.print("{}{}", std::exchange(first, false) ? "" : ", ", quoted(name));
  text.print("]");
}

void write_light(const Scene& scene, const AreaLight& light, const std::string& texture_file, TextStream& text) {
  text.print(R"({{"name": {}, )", quoted(light.name));
  if (const auto* dome = std::get_if<Dome>(&light.shape); dome != nullptr && light.texture) {
    Dome named = *dome;
    named.image = texture_file;
    write_light_shape(named, text);
  } else {
    write_light_shape(light.shape, text);
  }
  const auto* sun = std::get_if<Sun>(&light.shape);
  text.print(R"(, "{}": )", sun != nullptr && sun->angle == 0 ? "irradiance" : "radiance").array(light.radiance);
  text.print(R"(, "twoSided": {})", light.two_sided);
  if (light.visible) text.print(R"(, "visible": true)");
  if (light.texture && std::holds_alternative<Rectangle>(light.shape))
    text.print(R"(, "texture": {})", quoted(texture_file));
  if (!light.unshaded_by.empty()) {
    std::set<std::string> names;
    for (const std::uint32_t object : light.unshaded_by) names.insert(scene.objects[object].name);
    text.print(R"(, "casters": {{)");
    write_names("exclude", names, text);
    text.print("}}");
  }
  text.print("}}");
}

/// A mesh of the file.
struct Entry {
  const mesh::TriangleSoup* soup = nullptr;
  ObjectRange range = {};
  std::vector<const Instance*> instances = {};  // empty: the triangles are in the world
};

/// Returns the file's meshes: instances of one mesh, with the same surface, are in one entry, in the place of the
/// first.
std::vector<Entry> entries_of(const Scene& scene, const Instances& instances) {
  std::vector<Entry> entries;
  std::multimap<std::uint32_t, std::size_t> entries_of_mesh;
  for_each_mesh(
      scene, instances,
      [&](const ObjectRange& range) {
        entries.push_back({&scene.soup, range});
      },
      [&](const Instance& instance) {
        const auto [begin, end] = entries_of_mesh.equal_range(instance.mesh);
        const auto same = std::find_if(begin, end, [&](const auto& entry) {
          return same_surface(scene.objects[entries[entry.second].range.object], scene.objects[instance.object]);
        });
        if (same != end) {
          entries[same->second].instances.push_back(&instance);
          return;
        }
        entries_of_mesh.emplace(instance.mesh, entries.size());
        const mesh::TriangleSoup& soup = instances.meshes[instance.mesh]->soup;
        entries.push_back({&soup, {instance.object, 0, soup.triangles.size()}, {&instance}});
      });
  return entries;
}

/// Adds notes if objects or the numbers of triangles have changed.
void note_entries(const Scene& scene, std::span<const Entry> entries, Notes& notes) {
  std::size_t ranges = 0, merged = 0;
  bool in_order = true, precise = true;
  const Instance* last = nullptr;
  for (const Entry& entry : entries) {
    if (entry.instances.empty()) ++ranges;
    std::set<std::uint32_t> objects;
    for (const Instance* instance : entry.instances) {
      objects.insert(instance->object);
      in_order &= last == nullptr || last < instance;
      precise &= instance->placement.offset_last;
      last = instance;
    }
    if (objects.size() > 1) merged += objects.size();
  }
  if (ranges > scene.objects.size())
    notes.push_back(fmt::format("{} objects became {} meshes, because their triangles are not contiguous",
                                scene.objects.size(), ranges));
  if (merged > 0)
    notes.push_back(fmt::format("{} objects that share meshes became instances, which have no names of their own{}",
                                merged, in_order ? "" : "; their triangles are numbered in another order"));
  if (!precise)
    notes.push_back("positions of instances are summed in another order, and may differ in the last bit of a double");
}

/// Writes the matrix by rows.
void write_matrix(const glm::dmat4& matrix, TextStream& text) {
  text.print("[");
  for (glm::length_t row = 0; row < 3; ++row) {
    for (glm::length_t column = 0; column < 4; ++column) text.number(matrix[column][row]).print(",");
  }
  text.print("0,0,0,1]");
}

void write_mesh(const Scene& scene, const Entry& entry, TextStream& text) {
  const Object& object = scene.objects[entry.range.object];
  text.print(R"({{"name": {}, "color": )", quoted(object.name)).array(object.color);
  if (!object.casts_shadow) text.print(R"(, "castsShadow": false)");
  if (!object.receives_shadow) text.print(R"(, "receivesShadow": false)");
  if (object.lit_by) {
    std::set<std::string> names;
    for (const std::uint32_t light : *object.lit_by) names.insert(scene.lights[light].name);
    text.print(", ");
    write_names("lights", names, text);
  }
  if (object.emits) text.print(R"(, "emits": {})", quoted(scene.lights[*object.emits].name));
  text.print(R"(, "triangles": [)");
  for (std::size_t i = 0; i < entry.range.count; ++i) {
    const auto& [a, b, c] = entry.soup->triangles[entry.range.first + i];
    text.print("{}\n      [", i > 0 ? "," : "").numbers(entry.soup->positions[a], ",");
    text.print(", ").numbers(entry.soup->positions[b], ",");
    text.print(", ").numbers(entry.soup->positions[c], ",").print("]");
  }
  text.print("]");
  for (std::size_t i = 0; i < entry.instances.size(); ++i) {
    if (i == 0)
      text.print(R"(, "instances": [)");
    else
      text.print(",\n      ");
    write_matrix(entry.instances[i]->placement.to_world, text);
  }
  if (!entry.instances.empty()) text.print("]");
  text.print("}}");
}

}  // namespace

void write_json(const Scene& scene, const Instances& instances, AtomicFile& file, Losses&, Notes& notes) {
  TextStream text(file);
  const auto size = picture_size(scene, scene.cameras.front());
  for (const Camera& camera : scene.cameras) {
    const auto own = picture_size(scene, camera);
    if (own != size) {
      notes.push_back(fmt::format("camera \"{}\": a scene has one size, that of its first camera; {}x{} is left out",
                                  camera.name, own.first, own.second));
    }
  }
  text.print("{{\n  \"format\": \"penumbra-scene/1\",\n  \"size\": [{}, {}],\n", size.first, size.second);
  if (scene.cameras.size() == 1) {
    text.print("  \"camera\": ");
    write_camera(scene.cameras[0], text);
  } else {
    text.print("  \"cameras\": [");
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
      text.print("{}\n    ", i > 0 ? "," : "");
      write_camera(scene.cameras[i], text);
    }
    text.print("\n  ]");
  }
  text.print(",\n  \"meshes\": [");
  const std::vector<Entry> entries = entries_of(scene, instances);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    text.print("{}\n    ", i > 0 ? "," : "");
    write_mesh(scene, entries[i], text);
  }
  text.print("\n  ],\n  \"lights\": [");
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    text.print("{}\n    ", i > 0 ? "," : "");
    write_light(scene, scene.lights[i], texture_file(file.path(), i).filename().string(), text);
  }
  text.print("\n  ]\n}}\n");
  text.flush();
  note_entries(scene, entries, notes);
}

}  // namespace penumbra::scenes
