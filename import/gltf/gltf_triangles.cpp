// SPDX-License-Identifier: Apache-2.0
// Places the triangles of a primitive in the world, with only the vertices that they use. Corners are swapped where the
// transform mirrors (glTF 2.0, 3.7.4).

#include "import/gltf/gltf_triangles.hpp"

#include "base/error.hpp"
#include "mesh/import.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace penumbra::import {
namespace {

/// Adds the appearance of the vertex that was added last.
void add_look(scenes::Scene& scene, const PrimitiveVertices& vertices, std::uint32_t index) {
  const Look& look = vertices.look;
  const std::size_t count = scene.soup.positions.size();
  const auto put = [count](auto& list, const auto& value, const auto& otherwise) {
    list.resize(count - 1, otherwise);
    list.push_back(value);
  };
  if (!look.normals.empty()) {
    put(scene.looks.normals, scenes::world_normal(vertices.to_world(index), look.normals[index]), glm::vec3(0));
  }
  if (!look.colors.empty()) put(scene.looks.colors, look.colors[index], glm::vec4(1));
  if (!look.places.empty()) put(scene.looks.places, look.places[index], glm::dvec2(0));
  if (vertices.lightmap != nullptr && !look.lightmap.empty())
    put(*vertices.lightmap, look.lightmap[index], mesh::kNoPlace);
}

const glm::dvec3& finite_position(const PrimitiveVertices& vertices, std::uint32_t index) {
  const glm::dvec3& local = vertices.local[index];
  if (!std::isfinite(local.x) || !std::isfinite(local.y) || !std::isfinite(local.z)) {
    throw InputError("{}/attributes/POSITION: vertex {} is not finite: ({}, {}, {})", vertices.place, index, local.x,
                     local.y, local.z);
  }
  return local;
}

}  // namespace

SoupEnd append_triangles(scenes::Scene& scene, const PrimitiveVertices& vertices,
                         std::vector<mesh::Triangle> triangles) {
  auto& soup = scene.soup;
  const auto number = static_cast<std::uint32_t>(scene.objects.size());
  const SoupEnd before{soup.positions.size(), soup.triangles.size()};
  // A mirroring node flips the front of its triangles (glTF 2.0, 3.7.4); swapping corners turns it outward again.
  constexpr auto kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> renumbered(vertices.local.size(), kUnused);
  if (soup.positions.empty()) soup.positions.reserve(vertices.local.size());
  for (mesh::Triangle& triangle : triangles) {
    const bool mirrored = glm::determinant(glm::dmat3(vertices.to_world(triangle[0]))) < 0;
    for (std::uint32_t& index : triangle) {
      std::uint32_t& target = renumbered[index];
      if (target == kUnused) {
        if (soup.positions.size() >= kUnused) throw InputError("{}: more than 4,294,967,294 vertices", vertices.place);
        target = static_cast<std::uint32_t>(soup.positions.size());
        const glm::dvec3& local = finite_position(vertices, index);
        const glm::dvec3 p(vertices.to_world(index) * glm::dvec4(local, 1));
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
          throw InputError("{}: vertex {} is not finite after the transform of /nodes/{}", vertices.place, index,
                           vertices.placed.number);
        }
        soup.positions.push_back(p);
        add_look(scene, vertices, index);
      }
      index = target;
    }
    if (mirrored) std::swap(triangle[1], triangle[2]);
  }
  soup.object.insert(soup.object.end(), triangles.size(), number);
  soup.source_face.resize(soup.object.size());
  std::iota(soup.source_face.begin() + static_cast<std::ptrdiff_t>(before.triangle), soup.source_face.end(), 0U);
  if (soup.triangles.empty())
    soup.triangles = std::move(triangles);
  else
    soup.triangles.insert(soup.triangles.end(), triangles.begin(), triangles.end());
  return before;
}

scenes::SharedMesh shared_mesh(const PrimitiveVertices& vertices, std::vector<mesh::Triangle> triangles) {
  constexpr auto kUnused = std::numeric_limits<std::uint32_t>::max();
  const Look& look = vertices.look;
  scenes::SharedMesh shared;
  std::vector<std::uint32_t> renumbered(vertices.local.size(), kUnused);
  for (mesh::Triangle& triangle : triangles) {
    for (std::uint32_t& index : triangle) {
      std::uint32_t& target = renumbered[index];
      if (target == kUnused) {
        target = static_cast<std::uint32_t>(shared.soup.positions.size());
        shared.soup.positions.push_back(finite_position(vertices, index));
        if (!look.normals.empty()) shared.normals.push_back(look.normals[index]);
        if (!look.colors.empty()) shared.colors.push_back(look.colors[index]);
        if (!look.places.empty()) shared.places.push_back(look.places[index]);
      }
      index = target;
    }
  }
  shared.soup.object.assign(triangles.size(), 0);
  shared.soup.source_face.resize(triangles.size());
  std::iota(shared.soup.source_face.begin(), shared.soup.source_face.end(), 0U);
  shared.soup.triangles = std::move(triangles);
  return shared;
}

void shorten(scenes::Scene& scene, const SoupEnd& end) {
  mesh::TriangleSoup& soup = scene.soup;
  soup.positions.resize(end.position);
  soup.triangles.resize(end.triangle);
  soup.source_face.resize(end.triangle);
  soup.object.resize(end.triangle);
  const auto cut = [&end](auto& list) { list.resize(std::min(list.size(), end.position)); };
  cut(scene.looks.normals), cut(scene.looks.colors), cut(scene.looks.places);
}

void complete_looks(scenes::Scene& scene) {
  const std::size_t count = scene.soup.positions.size();
  if (!scene.looks.normals.empty()) scene.looks.normals.resize(count, glm::vec3(0));
  if (!scene.looks.colors.empty()) scene.looks.colors.resize(count, glm::vec4(1));
  if (!scene.looks.places.empty()) scene.looks.places.resize(count, glm::dvec2(0));
}

}  // namespace penumbra::import
