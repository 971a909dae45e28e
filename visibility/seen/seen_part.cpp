// SPDX-License-Identifier: Apache-2.0
// Gathers the triangles that pixels see, and those that may lie between their view samples and the lights, as a
// separate scene whose view samples, V and masks are those of the whole scene (docs/instances.md).

#include "visibility/seen/seen_part.hpp"

#include "base/memory.hpp"
#include "mesh/soup_memory.hpp"
#include "visibility/seen/dome_rays.hpp"
#include "visibility/seen/light_shafts.hpp"
#include "visibility/seen/triangle_bits.hpp"
#include "visibility/seen/view_rays.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <vector>

namespace penumbra::visibility {
namespace {

constexpr std::uint32_t kBlock = 16;  // pixels on a side; the points of a block are sorted into clusters together

/// Finds the triangles between points and lights.
class Shafts {
 public:
  Shafts(const PlacedMeshes& meshes, std::span<const Light> lights, TriangleBits& seen) : meshes_(meshes), seen_(seen) {
    for (std::size_t first = 0; first < lights.size();) {
      std::size_t end = first + 1;
      while (end < lights.size() && lights[end].index == lights[first].index) ++end;
      lights_.push_back(hull_of(lights.subspan(first, end - first)));
      first = end;
    }
    reach_ = sum_of_sides(meshes.upper() - meshes.lower());
  }

  /// Adds the triangles between the points of one block and the lights.
  void add(std::span<const SeenPoint> points) const {
    std::vector<glm::vec3> places;
    for (const LightHull& light : lights_) {
      places.clear();
      for (const SeenPoint& point : points) {
        if (may_be_lit(point, light)) places.push_back(point.p);
      }
      divide(places, light);
    }
  }

 private:
  /// Returns whether some of the light may be above the surface.
  static bool may_be_lit(const SeenPoint& point, const LightHull& light) {
    const glm::dvec3 p = point.p, n = point.n;
    // The normal is float32 here, and its product with a direction is rounded: error at most 2⁻²⁰ of the factors'
    // product.
    const bool above = std::ranges::any_of(light.corners, [&](const glm::dvec3& corner) {
      const glm::dvec3 direction = light.directions ? corner : corner - p;
      return glm::dot(n, direction) >
             -2 * light.room - 0x1p-20 * (sum_of_sides(direction) + (light.directions ? 0 : sum_of_sides(p)));
    });
    if (!above || !light.front) return above;
    return glm::dot(light.front->normal, p - light.front->at) >
           -2 * light.room - 0x1p-20 * (sum_of_sides(p) + sum_of_sides(light.front->at));
  }

  void divide(std::span<glm::vec3> points, const LightHull& light) const {
    if (points.empty()) return;
    glm::vec3 lower = points.front(), upper = lower;
    for (const glm::vec3& point : points) lower = glm::min(lower, point), upper = glm::max(upper, point);
    const glm::vec3 extent = upper - lower;
    if (points.size() == 1 || sum_of_sides(extent) <= meshes_.grain()) {
      take(LightShaft(lower, upper, light, reach_));
      return;
    }
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::size_t half = points.size() / 2;
    std::ranges::nth_element(points, points.begin() + static_cast<std::ptrdiff_t>(half), {},
                             [axis](const glm::vec3& point) { return point[axis]; });
    divide(points.first(half), light);
    divide(points.subspan(half), light);
  }

  void take(const LightShaft& shaft) const {
    const auto touches = [&](const MiddleBox& box) { return shaft.touches(box); };
    meshes_.tree().walk(touches, [&](std::span<const std::uint32_t> parts) {
      for (const std::uint32_t number : parts) {
        const PlacedMeshes::Part& part = meshes_.parts()[number];
        ShaftOfPart(shaft, part).walk([&](std::uint32_t triangle) { seen_.set(part.first_bit + triangle); });
      }
    });
  }

  const PlacedMeshes& meshes_;
  TriangleBits& seen_;
  std::vector<LightHull> lights_;
  double reach_ = 0;
};

/// Copies everything of a scene except its triangles.
scenes::Scene rest_of(const scenes::Scene& scene) {
  scenes::Scene rest;
  rest.name = scene.name;
  rest.width = scene.width;
  rest.height = scene.height;
  rest.objects = scene.objects;
  rest.pictures = scene.pictures;
  rest.lights = scene.lights;
  rest.cameras = scene.cameras;
  rest.sources = scene.sources;
  rest.motion = scene.motion;
  rest.warnings = scene.warnings;
  return rest;
}

/// Calls take(part, triangle) for triangles whose bits are set, in the order of their numbers.
template <typename Take>
void for_each_seen(const PlacedMeshes& meshes, const TriangleBits& seen, const Take& take) {
  const std::span<const PlacedMeshes::Part> parts = meshes.parts();
  const std::size_t instances = meshes.instances().all.size(), first_instance = parts.size() - instances;
  std::uint32_t own = 0, number = 0;
  const auto take_own = [&](std::uint32_t end) {
    if (end <= own) return;
    seen.for_each(own, end, [&](std::uint64_t bit) {
      const auto triangle = static_cast<std::uint32_t>(bit);
      take(parts[0], triangle, number + (triangle - own));
    });
    number += end - own;
    own = end;
  };
  for (std::size_t i = 0; i < instances; ++i) {
    const PlacedMeshes::Part& part = parts[first_instance + i];
    take_own(static_cast<std::uint32_t>(part.instance->soup_before));
    const auto count = static_cast<std::uint32_t>(part.soup->triangles.size());
    seen.for_each(part.first_bit, part.first_bit + count, [&](std::uint64_t bit) {
      const auto triangle = static_cast<std::uint32_t>(bit - part.first_bit);
      take(part, triangle, number + triangle);
    });
    number += count;
  }
  take_own(static_cast<std::uint32_t>(meshes.scene().soup.triangles.size()));
}

SeenPart part_of(const PlacedMeshes& meshes, TriangleBits& seen) {
  SeenPart part;
  part.triangles = meshes.triangles();
  part.lower = glm::vec3(meshes.lower() - meshes.origin()) + 0.0f;
  part.upper = glm::vec3(meshes.upper() - meshes.origin()) + 0.0f;
  part.scene = rest_of(meshes.scene());
  part.scene.origin = meshes.origin();
  if (seen.count() == 0) seen.set(0);  // nothing is in sight, but a scene needs a triangle
  const std::uint64_t count = seen.count();
  require_memory(
      count * sizeof(std::uint32_t) + mesh::soup_bytes(count, 2 * count),
      fmt::format("the visible part of a scene of {} triangles, with the triangles that may shade it ({} triangles),",
                  meshes.triangles(), count),
      "choose a smaller --size, or a camera that sees less");
  part.numbers.reserve(count);
  part.scene.soup.triangles.reserve(count);
  part.scene.soup.object.reserve(count);
  part.scene.soup.source_face.reserve(count);
  scenes::SoupBuilder builder(part.scene, meshes.scene(), meshes.instances());
  for_each_seen(meshes, seen, [&](const PlacedMeshes::Part& from, std::uint32_t triangle, std::uint32_t number) {
    part.numbers.push_back(number);
    from.instance != nullptr ? builder.add(*from.instance, triangle) : builder.add_own(triangle);
  });
  return part;
}

}  // namespace

SeenPart seen_part(const PlacedMeshes& meshes, const PinholeCamera& camera, std::span<const Light> lights,
                   const Tile& rows, const PartOptions& options) {
  TriangleBits seen(meshes.triangles());
  std::vector<Light> others;  // lights other than domes
  std::vector<DomeRays> domes;
  const auto is_dome = [](const Light& light) { return light.dome.has_value(); };
  const bool any_dome = std::ranges::any_of(lights, is_dome), all = any_dome && !options.dome_samples;
  if (all) {
    for (std::uint64_t bit = 0; bit < meshes.triangles(); ++bit) seen.set(bit);
  } else if (any_dome) {
    std::ranges::remove_copy_if(lights, std::back_inserter(others), is_dome);
    for (const Light& light : lights) {
      if (light.dome) domes.emplace_back(meshes, light);
    }
  }
  if (!all || options.viewed != nullptr) {
    const ViewRays rays(meshes, camera);
    const Shafts shafts(meshes, any_dome ? others : lights, seen);
    const std::uint32_t end = rows.first_row + rows.row_count;
    const std::uint32_t across = (camera.width + kBlock - 1) / kBlock, down = (rows.row_count + kBlock - 1) / kBlock;
    std::mutex adding;
    tbb::parallel_for(std::uint32_t{0}, across * down, [&](std::uint32_t block) {
      std::vector<std::uint64_t> bits;
      std::vector<SeenPoint> points;
      const std::uint32_t left = block % across * kBlock, top = rows.first_row + block / across * kBlock;
      for (std::uint32_t y = top; y < std::min(top + kBlock, end); ++y) {
        for (std::uint32_t x = left; x < std::min(left + kBlock, camera.width); ++x) rays.look(x, y, bits, points);
      }
      for (const std::uint64_t bit : bits) seen.set(bit);
      if (options.viewed != nullptr) {
        const std::lock_guard lock(adding);
        options.viewed->insert(options.viewed->end(), bits.begin(), bits.end());
      }
      shafts.add(points);
      for (const DomeRays& dome : domes) dome.add(points, seen);
    });
  }
  return part_of(meshes, seen);
}

SeenPart viewed_part(const PlacedMeshes& meshes, std::span<const std::uint64_t> viewed) {
  TriangleBits seen(meshes.triangles());
  for (const std::uint64_t bit : viewed) seen.set(bit);
  return part_of(meshes, seen);
}

}  // namespace penumbra::visibility
