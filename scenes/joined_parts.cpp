// SPDX-License-Identifier: Apache-2.0
// Joins parts of scenes into one scene.

#include "scenes/joined_parts.hpp"

#include "base/error.hpp"
#include "scenes/unique_names.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <vector>

namespace penumbra::scenes {
namespace {

struct Stretch {
  std::size_t first = 0, end = 0;
};

/// Returns the range of triangles of a part's objects.
Stretch triangles_of(const ScenePart& part) {
  const std::vector<std::uint32_t>& object = part.scene->soup.object;
  const auto first = std::ranges::lower_bound(object, part.first_object);
  const auto end = std::ranges::lower_bound(object, part.first_object + part.objects);
  return {static_cast<std::size_t>(first - object.begin()), static_cast<std::size_t>(end - object.begin())};
}

/// Returns the range of vertices of some triangles.
Stretch vertices_of(const mesh::TriangleSoup& soup, const Stretch& triangles) {
  if (triangles.first == triangles.end) return {};
  Stretch range{std::numeric_limits<std::size_t>::max(), 0};
  for (std::size_t i = triangles.first; i < triangles.end; ++i) {
    for (const std::uint32_t corner : soup.triangles[i]) {
      range.first = std::min<std::size_t>(range.first, corner);
      range.end = std::max<std::size_t>(range.end, corner + std::size_t{1});
    }
  }
  return range;
}

template <typename T>
void append_range(std::vector<T>& all, const std::vector<T>& from, const Stretch& range) {
  all.insert(all.end(), from.begin() + static_cast<std::ptrdiff_t>(range.first),
             from.begin() + static_cast<std::ptrdiff_t>(range.end));
}

/// Appends attributes of vertices; earlier vertices without attributes get `otherwise`.
template <typename T>
void append_looks(std::vector<T>& all, std::size_t before, const std::vector<T>& from, const Stretch& range,
                  const T& otherwise) {
  if (from.empty()) return;
  all.resize(before, otherwise);
  append_range(all, from, range);
}

constexpr glm::vec3 kNoNormal(0);
constexpr glm::vec4 kNoColor(1);
constexpr glm::dvec2 kNowhere(0);

void append_mesh(Scene& whole, const ScenePart& part) {
  const mesh::TriangleSoup& from = part.scene->soup;
  const VertexLooks& looks = part.scene->looks;
  mesh::TriangleSoup& soup = whole.soup;
  const std::size_t before = soup.positions.size();
  const Stretch triangles = triangles_of(part), vertices = vertices_of(from, triangles);
  if (before + (vertices.end - vertices.first) >= std::numeric_limits<std::uint32_t>::max())
    throw InputError("the scene has more than 4,294,967,294 vertices");
  const auto moved = static_cast<std::uint32_t>(before - vertices.first);  // modulo 2³²: adding it to an index wraps
                                                                           // around
  const auto renumbered = static_cast<std::uint32_t>(whole.objects.size()) - part.first_object;
  append_range(soup.positions, from.positions, vertices);
  append_range(soup.source_face, from.source_face, triangles);
  for (std::size_t i = triangles.first; i < triangles.end; ++i) {
    const mesh::Triangle& triangle = from.triangles[i];
    soup.triangles.push_back({triangle[0] + moved, triangle[1] + moved, triangle[2] + moved});
    soup.object.push_back(from.object[i] + renumbered);
  }
  append_looks(whole.looks.normals, before, looks.normals, vertices, kNoNormal);
  append_looks(whole.looks.colors, before, looks.colors, vertices, kNoColor);
  append_looks(whole.looks.places, before, looks.places, vertices, kNowhere);
}

void complete(VertexLooks& looks, std::size_t count) {
  if (!looks.normals.empty()) looks.normals.resize(count, kNoNormal);
  if (!looks.colors.empty()) looks.colors.resize(count, kNoColor);
  if (!looks.places.empty()) looks.places.resize(count, kNowhere);
}

}  // namespace

Scene joined(std::span<const ScenePart> parts, bool with_meshes) {
  Scene whole;
  UniqueNames object_names, light_names;
  std::vector<std::size_t> shadeless;
  std::set<const Scene*> warned;
  // Number of the first picture of each scene with a part that has objects. Lights store their pictures themselves, so
  // parts with only lights do not change these numbers: they also hold for the pictures of an earlier result with the
  // same objects.
  std::map<const Scene*, std::uint32_t> first_picture;
  std::uint32_t pictures = 0;
  for (const ScenePart& part : parts) {
    const Scene& scene = *part.scene;
    const auto first_light = static_cast<std::uint32_t>(whole.lights.size());
    if (part.objects > 0 && first_picture.try_emplace(&scene, pictures).second) {
      pictures += static_cast<std::uint32_t>(scene.pictures.size());
      if (with_meshes) whole.pictures.insert(whole.pictures.end(), scene.pictures.begin(), scene.pictures.end());
    }
    if (warned.insert(&scene).second) {
      for (const std::string& warning : scene.warnings) {
        if (std::ranges::find(whole.warnings, warning) == whole.warnings.end()) whole.warnings.push_back(warning);
      }
    }
    if (with_meshes) append_mesh(whole, part);
    for (Object object : std::span(scene.objects).subspan(part.first_object, part.objects)) {
      object.name = object_names.take(object.name);
      if (object.emits) object.emits = *object.emits - part.first_light + first_light;
      if (object.picture) object.picture->picture += first_picture.at(&scene);
      whole.objects.push_back(std::move(object));
    }
    for (AreaLight light : std::span(scene.lights).subspan(part.first_light, part.lights)) {
      light.name = light_names.take(light.name);
      light.unshaded_by.clear();
      if (!part.casts_shadows) shadeless.push_back(whole.lights.size());
      whole.lights.push_back(std::move(light));
    }
  }
  complete(whole.looks, whole.soup.positions.size());
  for (const std::size_t light : shadeless) {
    whole.lights[light].unshaded_by.resize(whole.objects.size());
    std::iota(whole.lights[light].unshaded_by.begin(), whole.lights[light].unshaded_by.end(), 0U);
  }
  return whole;
}

}  // namespace penumbra::scenes
