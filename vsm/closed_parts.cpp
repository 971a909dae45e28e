// SPDX-License-Identifier: Apache-2.0
// Finds the closed parts of a scene, and the triangles that view samples outside of a part need not test.

#include "vsm/closed_parts.hpp"

#include "base/parallel.hpp"
#include "base/size1.hpp"
#include "mesh/closed_components.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <span>

namespace penumbra::vsm {
namespace {

using visibility::Bounds;
using visibility::SceneFloats;

constexpr std::uint32_t kNone = 0xffffffffU;

/// The triangles that cast shadows and are not a light's body, as a mesh.
struct Casters {
  std::vector<glm::dvec3> positions;
  std::vector<mesh::Triangle> triangles;
  std::vector<std::uint32_t> in_scene;  ///< index in the scene of each triangle
};

Casters casters_of(const SceneFloats& scene) {
  Casters casters{mesh::widened(scene.positions), {}, {}};
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (scene.casts_shadow[t] == 0 || scene.emits[t] >= 0) continue;
    casters.triangles.push_back(scene.triangles[t]);
    casters.in_scene.push_back(t);
  }
  return casters;
}

ClosedPart bounds_of(const SceneFloats& scene, std::span<const std::uint32_t> triangles) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr Bounds kEmpty{glm::vec3(kInfinity), glm::vec3(-kInfinity)};
  const auto add = [](Bounds& box, const glm::vec3& at) { box = {glm::min(box.lower, at), glm::max(box.upper, at)}; };
  ClosedPart part{kEmpty, {kEmpty, kEmpty, kEmpty, kEmpty, kEmpty, kEmpty}};
  for (const std::uint32_t t : triangles) {
    for (const glm::vec3& corner : scene.corners(t)) add(part.box, corner);
  }
  for (const std::uint32_t t : triangles) {
    for (const glm::vec3& corner : scene.corners(t)) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto face = static_cast<std::size_t>(axis);
        if (corner[axis] == part.box.lower[axis]) add(part.touching[face], corner);
        if (corner[axis] == part.box.upper[axis]) add(part.touching[face + 3], corner);
      }
    }
  }
  return part;
}

/// Returns for each plane the only component that has triangles on it, or kNone.
std::vector<std::uint32_t> plane_owners(const SceneFloats& scene, const std::vector<std::uint32_t>& component) {
  constexpr std::uint32_t kUnseen = 0xfffffffeU;
  std::vector<std::uint32_t> owner(scene.triangles.size(), kUnseen);
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    if (scene.plane[t] == SceneFloats::kNoPlane) continue;
    std::uint32_t& of_plane = owner[scene.plane[t]];
    of_plane = of_plane == kUnseen || of_plane == component[t] ? component[t] : kNone;
  }
  return owner;
}

/// Returns ±1 if every light sample certainly sees the triangle from this side; 0 if it is not certain. All arithmetic
/// is in double on float32 numbers; the margin of 2⁻²⁰ of every length is a million times the rounding error, and
/// covers that light samples are stored in float32.
int side_shown(const std::array<glm::vec3, 3>& corners, const visibility::DeviceLight& frame, float scale) {
  const glm::dvec3 a(corners[0] * scale), e1 = glm::dvec3(corners[1] * scale) - a,
                                          e2 = glm::dvec3(corners[2] * scale) - a;
  const glm::dvec3 normal = glm::cross(e1, e2), center(frame.center), u(frame.u), v(frame.v);
  const double at_center = glm::dot(normal, center - a);
  const double span = glm::abs(glm::dot(normal, u)) + glm::abs(glm::dot(normal, v));
  const double lengths = size1(center) + size1(u) + size1(v) + size1(a);
  const double margin = (0x1p-20 * lengths + static_cast<double>(frame.deviation)) * size1(e1) * size1(e2);
  if (at_center > span + margin) return 1;
  return at_center < -(span + margin) ? -1 : 0;
}

bool apart_from_light(const Bounds& box, const visibility::DeviceLight& frame, float scale) {
  const glm::vec3 reach = glm::abs(frame.u) + glm::abs(frame.v);
  const glm::vec3 margin = 0x1p-20F * (glm::abs(frame.center) + reach) + frame.deviation;
  const glm::vec3 lower = frame.center - reach - margin, upper = frame.center + reach + margin;
  for (int axis = 0; axis < 3; ++axis) {
    if (box.upper[axis] * scale < lower[axis] || box.lower[axis] * scale > upper[axis]) return true;
  }
  return false;
}

}  // namespace

ClosedParts find_closed_parts(const SceneFloats& scene) {
  const Casters casters = casters_of(scene);
  const mesh::MeshView view{casters.positions, casters.triangles};
  const mesh::Components found = mesh::find_components(view, mesh::build_edge_graph(view));
  const std::vector<mesh::Component>& components = found.components;
  std::vector<std::uint32_t> component(scene.triangles.size(), kNone);  // for each triangle of the scene
  for (std::uint32_t i = 0; i < components.size(); ++i) {
    for (const std::uint32_t t : components[i].triangles) component[casters.in_scene[t]] = i;
  }
  const std::vector<std::uint32_t> owner = plane_owners(scene, component);
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 0; i < components.size(); ++i) {
    if (!components[i].closed || components[i].triangles.size() < ClosedParts::kFewestTriangles) continue;
    const auto owns_plane = [&](std::uint32_t t) { return owner[scene.plane[casters.in_scene[t]]] == i; };
    if (std::ranges::all_of(components[i].triangles, owns_plane)) chosen.push_back(i);
  }
  std::ranges::stable_sort(chosen, std::ranges::greater(),
                           [&](std::uint32_t i) { return components[i].triangles.size(); });
  if (chosen.size() > ClosedParts::kMost) chosen.resize(ClosedParts::kMost);

  ClosedParts closed;
  if (chosen.empty()) return closed;
  closed.part.resize(scene.triangles.size());
  closed.turn.resize(scene.triangles.size());
  for (const std::uint32_t i : chosen) {
    const bool outward = mesh::signed_volume(view, components[i], found.turn) > 0;
    std::vector<std::uint32_t> triangles;  // indices in the scene
    for (const std::uint32_t t : components[i].triangles) triangles.push_back(casters.in_scene[t]);
    closed.parts.push_back(bounds_of(scene, triangles));
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      const std::int8_t wound = found.turn[components[i].triangles[k]];
      closed.part[triangles[k]] = static_cast<std::uint8_t>(closed.parts.size());
      closed.turn[triangles[k]] = static_cast<std::int8_t>(outward ? -wound : wound);
    }
  }
  return closed;
}

std::uint32_t parts_apart_from(const ClosedParts& closed, const visibility::DeviceLight& frame, float scale) {
  std::uint32_t apart = 0;
  for (std::size_t i = 0; i < closed.parts.size(); ++i) {
    if (apart_from_light(closed.parts[i].box, frame, scale)) apart |= 1U << (i + 1);
  }
  return apart;
}

std::uint32_t parts_apart_from(const ClosedParts& closed, const visibility::Light& light) {
  const visibility::Bounds around = light.sun ? visibility::Bounds() : visibility::point_bounds(light);
  std::uint32_t apart = 0;
  for (std::size_t i = 0; i < closed.parts.size(); ++i) {
    const Bounds& box = closed.parts[i].box;
    bool is_apart = light.sun.has_value();
    for (int axis = 0; axis < 3; ++axis)
      is_apart = is_apart || box.upper[axis] < around.lower[axis] || box.lower[axis] > around.upper[axis];
    if (is_apart) apart |= 1U << (i + 1);
  }
  return apart;
}

std::vector<std::uint8_t> find_dispensable(const ClosedParts& closed, const SceneFloats& scene,
                                           const visibility::DeviceLight& frame, float scale) {
  std::vector<std::uint8_t> dispensable(scene.triangles.size());
  for_each_index(closed.part.size(), [&](std::size_t t) {
    if (closed.part[t] == 0) return;
    const int side = side_shown(scene.corners(static_cast<std::uint32_t>(t)), frame, scale);
    if (closed.turn[t] * side > 0) dispensable[t] = closed.part[t];
  });
  return dispensable;
}

}  // namespace penumbra::vsm
