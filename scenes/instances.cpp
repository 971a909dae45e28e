// SPDX-License-Identifier: Apache-2.0
// Instances of meshes that a scene has several times: conversion to triangles.

#include "scenes/instances.hpp"

#include "base/error.hpp"
#include "base/memory.hpp"
#include "mesh/soup_memory.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace penumbra::scenes {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

}  // namespace

std::uint64_t triangle_count(const Scene& scene, const Instances& instances) {
  std::uint64_t count = scene.soup.triangles.size();
  for (const Instance& instance : instances.all) count += instances.triangles_of(instance);
  return count;
}

SoupBuilder::SoupBuilder(Scene& to, const Scene& from, const Instances& instances)
    : to_(to), from_(from), instances_(instances) {
  const auto any = [&](auto list) {
    return std::ranges::any_of(instances.meshes, [&](const auto& mesh) { return !((*mesh).*list).empty(); });
  };
  normals_ = !from.looks.normals.empty() || any(&SharedMesh::normals);
  colors_ = !from.looks.colors.empty() || any(&SharedMesh::colors);
  places_ = !from.looks.places.empty() || any(&SharedMesh::places);
  own_.assign(from.soup.positions.size(), kNone);
}

template <typename PositionOf>
void SoupBuilder::add_corners(mesh::Triangle corners, const PositionOf& position_of) {
  for (std::uint32_t& corner : corners) corner = position_of(corner);
  to_.soup.triangles.push_back(corners);
}

void SoupBuilder::add_own_position(std::uint32_t position) {
  const auto look = [&](const auto& list, const auto& none) { return list.empty() ? none : list[position]; };
  to_.soup.positions.push_back(from_.soup.positions[position]);
  if (normals_) to_.looks.normals.push_back(look(from_.looks.normals, glm::vec3(0)));
  if (colors_) to_.looks.colors.push_back(look(from_.looks.colors, glm::vec4(1)));
  if (places_) to_.looks.places.push_back(look(from_.looks.places, glm::dvec2(0)));
}

void SoupBuilder::add_own(std::uint32_t triangle) {
  add_corners(from_.soup.triangles[triangle], [&](std::uint32_t position) {
    std::uint32_t& number = own_[position];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(to_.soup.positions.size());
      add_own_position(position);
    }
    return number;
  });
  to_.soup.object.push_back(from_.soup.object[triangle]);
  to_.soup.source_face.push_back(from_.soup.source_face[triangle]);
}

void SoupBuilder::add_position(std::uint32_t position) {
  const SharedMesh& mesh = *instances_.meshes[at_hand_->mesh];
  to_.soup.positions.push_back(at_hand_->placement(mesh.soup.positions[position]));
  if (normals_) {
    to_.looks.normals.push_back(
        mesh.normals.empty() ? glm::vec3(0) : world_normal(at_hand_->placement.to_world, mesh.normals[position]));
  }
  if (colors_) to_.looks.colors.push_back(mesh.colors.empty() ? glm::vec4(1) : mesh.colors[position]);
  if (places_) to_.looks.places.push_back(mesh.places.empty() ? glm::dvec2(0) : mesh.places[position]);
}

void SoupBuilder::begin(const Instance& instance) {
  for (const std::uint32_t position : numbered_) number_[position] = kNone;
  numbered_.clear();
  number_.resize(std::max(number_.size(), instances_.meshes[instance.mesh]->soup.positions.size()), kNone);
  at_hand_ = &instance;
  mirrors_ = instance.placement.mirrors();
}

void SoupBuilder::add(const Instance& instance, std::uint32_t triangle) {
  if (at_hand_ != &instance) begin(instance);
  const mesh::TriangleSoup& soup = instances_.meshes[instance.mesh]->soup;
  add_corners(soup.triangles[triangle], [&](std::uint32_t position) {
    std::uint32_t& number = number_[position];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(to_.soup.positions.size());
      numbered_.push_back(position);
      add_position(position);
    }
    return number;
  });
  if (mirrors_) std::swap(to_.soup.triangles.back()[1], to_.soup.triangles.back()[2]);
  to_.soup.object.push_back(instance.object);
  to_.soup.source_face.push_back(soup.source_face[triangle]);
}

std::uint32_t object_of(const Scene& scene, const Instances& instances, std::uint64_t triangle) {
  std::uint64_t before = 0;  // triangles of the instances before
  for (const Instance& instance : instances.all) {
    const std::uint64_t first = instance.soup_before + before, count = instances.triangles_of(instance);
    if (triangle < first) break;
    if (triangle < first + count) return instance.object;
    before += count;
  }
  return scene.soup.object[triangle - before];
}

Scene copied(Scene scene, const Instances& instances, std::uint64_t more_bytes) {
  if (instances.empty()) return scene;
  const std::uint64_t triangles = triangle_count(scene, instances);
  std::uint64_t positions = scene.soup.positions.size();
  for (const Instance& instance : instances.all) positions += instances.meshes[instance.mesh]->soup.positions.size();
  const auto what = fmt::format("a scene of {} triangles, {} instances of meshes among them, each as a copy", triangles,
                                instances.all.size());
  constexpr std::string_view kRemedy =
      "make its meshes smaller or its instances fewer, or use `render`, which keeps instances shared with a method "
      "that "
      "supports it (under a dome: with --light-samples, or a dome that is \"sampled\")";
  if (positions >= kNone) throw ResourceError("{}: {} vertices are more than 2^32; {}", what, positions, kRemedy);
  require_memory(mesh::soup_bytes(triangles, positions) + triangles * more_bytes, what, kRemedy);
  Scene from;
  from.soup = std::exchange(scene.soup, {});
  from.looks = std::exchange(scene.looks, {});
  scene.soup.positions.reserve(positions);
  scene.soup.triangles.reserve(triangles);
  scene.soup.object.reserve(triangles);
  scene.soup.source_face.reserve(triangles);
  SoupBuilder builder(scene, from, instances);
  std::uint32_t own = 0;
  for (const Instance& instance : instances.all) {
    for (; own < instance.soup_before; ++own) builder.add_own(own);
    for (std::uint32_t i = 0; i < instances.triangles_of(instance); ++i) builder.add(instance, i);
  }
  for (; own < from.soup.triangles.size(); ++own) builder.add_own(own);
  return scene;
}

}  // namespace penumbra::scenes
