// World space in double minus the origin, rounded once to float32; triangles in an order of vertices of their own.

#include "visibility/scene_floats.hpp"

#include "base/error.hpp"
#include "base/memory.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/plane_ids.hpp"

#include <glm/common.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace penumbra::visibility {
namespace {

bool lexicographically_less(const glm::vec3& a, const glm::vec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

glm::dvec3 center_of_bounds(const std::vector<glm::dvec3>& positions) {
  if (positions.empty()) return glm::dvec3(0);
  glm::dvec3 lower = positions.front(), upper = lower;
  for (const glm::dvec3& position : positions) {
    lower = glm::min(lower, position);
    upper = glm::max(upper, position);
  }
  return 0.5 * lower + 0.5 * upper;
}

[[noreturn]] void refuse_position(const scenes::Scene& scene, std::size_t position, const glm::dvec3& origin) {
  const auto& triangles = scene.soup.triangles;
  const auto user = std::find_if(triangles.begin(), triangles.end(), [&](const Triangle& t) {
    return t[0] == position || t[1] == position || t[2] == position;
  });
  std::string owner = "no triangle";
  if (user != triangles.end()) {
    owner = fmt::format(
        "mesh \"{}\"", scene.objects.at(scene.soup.object.at(static_cast<std::size_t>(user - triangles.begin()))).name);
  }
  const glm::dvec3& at = scene.soup.positions[position];
  throw InputError("vertex {} ({}, {}, {}) of {} is not finite in float32 relative to the scene's origin ({}, {}, {})",
                   position, at.x, at.y, at.z, owner, origin.x, origin.y, origin.z);
}

/// Below this, products of coordinates with a picture's other numbers are subnormal on devices, which may take them for
/// 0.
constexpr float kSmallestScene = 0x1p-120F;

void refuse_subnormal(const SceneFloats& floats) {
  float size = 0;
  for (int axis = 0; axis < 3; ++axis) {
    size = std::max({size, std::abs(floats.lower[axis]), std::abs(floats.upper[axis])});
  }
  if (size == 0 || size >= kSmallestScene) return;
  throw InputError("the scene reaches only {} from its middle; float32 has full precision from 1e-36 on: scale it up",
                   size);
}

struct Ranked {
  std::array<float, 9> vertices;  // the triangle's sorted vertices: the key
  std::uint32_t triangle;
  bool operator<(const Ranked& other) const { return vertices < other.vertices; }
};

}  // namespace

bool SceneFloats::comes_before(std::uint32_t triangle, std::uint32_t other) const {
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec3 &mine = positions[triangles[triangle][i]], &theirs = positions[triangles[other][i]];
    if (mine != theirs) return lexicographically_less(mine, theirs);
  }
  return false;
}

std::vector<std::uint32_t> ranks(const SceneFloats& scene) {
  std::vector<Ranked> order(scene.triangles.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, order.size()),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        const auto [a, b, c] = scene.corners(static_cast<std::uint32_t>(i));
                        order[i] = {{a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z}, static_cast<std::uint32_t>(i)};
                      }
                    });
  tbb::parallel_sort(order.begin(), order.end());
  std::vector<std::uint32_t> rank(order.size());
  std::uint32_t current = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && order[i - 1] < order[i]) ++current;
    rank[order[i].triangle] = current;
  }
  return rank;
}

SceneFloats make_scene_floats(const scenes::Scene& scene) {
  constexpr std::uint64_t kTriangle = sizeof(Triangle) + 3 * sizeof(std::uint32_t) + 2;  // see SceneFloats
  constexpr std::uint64_t kSorting = 3 * sizeof(std::uint32_t);
  const std::uint64_t count_of_triangles = scene.soup.triangles.size();
  require_memory(count_of_triangles * (kTriangle + kSorting) + scene.soup.positions.size() * sizeof(glm::vec3),
                 fmt::format("a scene of {} triangles", count_of_triangles), "make its meshes smaller");
  SceneFloats floats;
  floats.origin = scene.origin ? *scene.origin : center_of_bounds(scene.soup.positions);
  floats.positions.reserve(scene.soup.positions.size());
  for (const glm::dvec3& world : scene.soup.positions) {
    const glm::vec3 position = glm::vec3(world - floats.origin) + 0.0f;  // + 0 turns −0 into +0
    if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z)) {
      refuse_position(scene, floats.positions.size(), floats.origin);
    }
    floats.positions.push_back(position);
  }
  if (!floats.positions.empty()) {
    floats.lower = floats.upper = floats.positions.front();
    for (const glm::vec3& position : floats.positions) {
      floats.lower = glm::min(floats.lower, position);
      floats.upper = glm::max(floats.upper, position);
    }
    refuse_subnormal(floats);
  }

  floats.triangles = scene.soup.triangles;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, floats.triangles.size(), 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      // Vertices at the same place are told apart by nothing that is computed from places, so their order is free.
      std::sort(floats.triangles[i].begin(), floats.triangles[i].end(), [&](std::uint32_t a, std::uint32_t b) {
        return lexicographically_less(floats.positions[a], floats.positions[b]);
      });
    }
  });
  floats.object = scene.soup.object;
  floats.alphas = make_surface_alphas(scene);
  floats.plane = plane_ids(floats);

  const std::size_t count = floats.triangles.size();
  floats.casts_shadow.resize(count);
  floats.receives_shadow.resize(count);
  floats.emits.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const scenes::Object& object = scene.objects.at(floats.object[i]);
    const bool casts = object.casts_shadow && floats.plane[i] != SceneFloats::kNoPlane;
    const bool lets_through = object.alpha.mode != scenes::Alpha::Mode::opaque;
    floats.casts_shadow[i] = casts && !lets_through;
    if (casts && lets_through) floats.alphas.casters.push_back(static_cast<std::uint32_t>(i));
    floats.receives_shadow[i] = object.receives_shadow;
    floats.emits[i] = object.emits ? static_cast<std::int32_t>(*object.emits) : -1;
  }
  return floats;
}

SceneFloats cast_for(const SceneFloats& scene, const Light& light) {
  SceneFloats linked = scene;
  if (light.unshaded_by.empty()) return linked;
  for (std::size_t i = 0; i < linked.triangles.size(); ++i) {
    if (light.unshaded_by[linked.object[i]] != 0) linked.casts_shadow[i] = 0;
  }
  std::erase_if(linked.alphas.casters, [&](std::uint32_t i) { return light.unshaded_by[linked.object[i]] != 0; });
  return linked;
}

}  // namespace penumbra::visibility
