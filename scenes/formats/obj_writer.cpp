// SPDX-License-Identifier: Apache-2.0
// Writes a scene's meshes as an OBJ file: world space, a group for each range of an object's triangles; no materials,
// lights or cameras.

#include "scenes/formats/writers.hpp"

namespace penumbra::scenes {

void write_obj(const Scene& scene, AtomicFile& file, Losses& losses, Notes& notes) {
  TextStream text(file);
  text.print("# {}: {} triangles, world space, Y up\n", scene.name, scene.soup.triangles.size());
  for (const glm::dvec3& position : scene.soup.positions) text.print("v ").numbers(position, " ").print("\n");
  for (const ObjectRange& range : object_ranges(scene.soup)) {
    text.print("o {}\n", scene.objects[range.object].name);
    for (std::size_t i = range.first; i < range.first + range.count; ++i) {
      const auto& [a, b, c] = scene.soup.triangles[i];
      text.print("f {} {} {}\n", a + 1ull, b + 1ull, c + 1ull);
    }
  }
  text.flush();
  for (const Object& object : scene.objects) {
    if (!object.casts_shadow || !object.receives_shadow || object.lit_by)
      losses.mention("has its own settings for shadows or lights, which OBJ cannot express", object.name);
  }
  notes.push_back(
      fmt::format("OBJ holds no lights and cameras; left out: {} and {}", scene.lights.size(), scene.cameras.size()));
}

}  // namespace penumbra::scenes
