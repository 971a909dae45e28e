// SPDX-License-Identifier: Apache-2.0
// Scene floats: world space in double minus the origin, rounded once to float32; triangles with sorted vertices.

#include "visibility/scene_floats.hpp"

#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/pages.hpp"
#include "base/parallel.hpp"
#include "visibility/floats_memory.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/plane_ids.hpp"

#include <glm/common.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace penumbra::visibility {
namespace {

bool lexicographically_less(const glm::vec3& a, const glm::vec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// The order of vertices at the same place is arbitrary: no value computed from places depends on it.
Triangle sorted(Triangle t, const std::vector<glm::vec3>& positions) {
  const auto put_in_order = [&](std::uint32_t& a, std::uint32_t& b) {
    if (lexicographically_less(positions[b], positions[a])) std::swap(a, b);
  };
  put_in_order(t[0], t[1]);
  put_in_order(t[1], t[2]);
  put_in_order(t[0], t[1]);
  return t;
}

constexpr auto kOpaque = scenes::Alpha::Mode::opaque;

/// Bounds of points, computed in parallel; without points the corners keep their initial values.
template <typename Point>
struct Around {
  Point lower{std::numeric_limits<typename Point::value_type>::infinity()}, upper = -lower;

  Around with(const Around& other) const { return {glm::min(lower, other.lower), glm::max(upper, other.upper)}; }
};
template <typename Point, typename PointAt>
Around<Point> box_around(std::size_t count, const PointAt& point_at) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, 4096), Around<Point>(),
      [&](const tbb::blocked_range<std::size_t>& range, Around<Point> around) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const Point point = point_at(i);
          around = {glm::min(around.lower, point), glm::max(around.upper, point)};
        }
        return around;
      },
      [](const Around<Point>& a, const Around<Point>& b) { return a.with(b); });
}

glm::dvec3 center_of_bounds(const std::vector<glm::dvec3>& positions) {
  if (positions.empty()) return glm::dvec3(0);
  const auto [lower, upper] = box_around<glm::dvec3>(positions.size(), [&](std::size_t i) { return positions[i]; });
  return 0.5 * lower + 0.5 * upper;
}

bool is_finite(const glm::vec3& x) {
  return std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z);
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

/// Smallest size of a scene: below it, products of coordinates with other numbers of a picture are subnormal on
/// devices, which may flush them to 0.
constexpr float kSmallestScene = 0x1p-120F;

void refuse_subnormal(const SceneFloats& floats) {
  float size = 0;
  for (int axis = 0; axis < 3; ++axis) {
    size = std::max({size, std::abs(floats.lower[axis]), std::abs(floats.upper[axis])});
  }
  if (size == 0 || size >= kSmallestScene) return;
  throw InputError(
      "the scene reaches only {} from its middle; float32 has full precision only above 1e-36: scale the scene up",
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
  // Sides of triangles have 32-bit indices (mesh/sorted_sides.hpp), and triangles 31-bit ones in the picture.
  constexpr std::uint64_t kMostTriangles = (std::uint64_t{1} << 32U) / 3;
  const std::uint64_t count_of_triangles = scene.soup.triangles.size();
  if (count_of_triangles > kMostTriangles) {
    throw ResourceError("the scene has {} triangles; at most {} are possible here: make its meshes smaller",
                        count_of_triangles, kMostTriangles);
  }
  require_memory(count_of_triangles * kFloatsOfTriangle + scene.soup.positions.size() * sizeof(glm::vec3),
                 fmt::format("a scene of {} triangles", count_of_triangles), "make its meshes smaller");
  SceneFloats floats;
  floats.origin = scene.origin ? *scene.origin : center_of_bounds(scene.soup.positions);
  resize_on_all_cores(floats.positions, scene.soup.positions.size());
  std::atomic<bool> finite = true;
  const auto [lower, upper] = box_around<glm::vec3>(floats.positions.size(), [&](std::size_t i) {
    floats.positions[i] = glm::vec3(scene.soup.positions[i] - floats.origin) + 0.0f;  // + 0 turns −0 into +0
    if (!is_finite(floats.positions[i])) finite.store(false, std::memory_order_relaxed);
    return floats.positions[i];
  });
  if (!finite) {
    const auto first = std::ranges::find_if_not(floats.positions, is_finite);
    refuse_position(scene, static_cast<std::size_t>(first - floats.positions.begin()), floats.origin);
  }
  if (!floats.positions.empty()) {
    floats.lower = lower;
    floats.upper = upper;
    refuse_subnormal(floats);
  }

  const std::size_t count = scene.soup.triangles.size();
  resize_on_all_cores(floats.triangles, count);
  resize_on_all_cores(floats.object, count);
  for_each_index(count, [&](std::size_t i) {
    floats.triangles[i] = sorted(scene.soup.triangles[i], floats.positions);
    floats.object[i] = scene.soup.object[i];
  });
  floats.alphas = make_surface_alphas(scene);
  floats.plane = plane_ids(floats);

  floats.casts_shadow.resize(count);
  floats.receives_shadow.resize(count);
  floats.emits.resize(count);
  for_each_index(count, [&](std::size_t i) {
    const scenes::Object& object = scene.objects.at(floats.object[i]);
    floats.casts_shadow[i] =
        object.casts_shadow && floats.plane[i] != SceneFloats::kNoPlane && object.alpha.mode == kOpaque;
    floats.receives_shadow[i] = object.receives_shadow;
    floats.emits[i] = object.emits ? static_cast<std::int32_t>(*object.emits) : -1;
  });
  const auto opaque = [](const scenes::Object& object) { return object.alpha.mode == kOpaque; };
  if (std::ranges::all_of(scene.objects, opaque)) return floats;
  for (std::size_t i = 0; i < count; ++i) {
    const scenes::Object& object = scene.objects.at(floats.object[i]);
    if (object.casts_shadow && floats.plane[i] != SceneFloats::kNoPlane && !opaque(object))
      floats.alphas.casters.push_back(static_cast<std::uint32_t>(i));
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
