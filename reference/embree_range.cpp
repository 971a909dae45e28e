// SPDX-License-Identifier: Apache-2.0
// Scaling of scenes and rays to the range in which Embree's float32 arithmetic neither overflows nor underflows.

#include "reference/embree_range.hpp"

#include "base/error.hpp"

#include <glm/common.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::reference {
namespace {

constexpr int kMeshExponent = 14;      // exponent of the first power of two above all coordinates of the mesh
constexpr double kFarthest = 0x1p60;   // largest distance of light points
constexpr double kSmallest = 0x1p-50;  // lower bound of a triangle's largest edge component
constexpr double kLeastTerm = 0x1p-95;

double largest_component(const glm::dvec3& x) {
  return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)});
}

}  // namespace

EmbreeRange::EmbreeRange(const visibility::SceneFloats& scene, std::span<const std::uint32_t> casting) {
  const double size = std::max(largest_component(scene.lower), largest_component(scene.upper));
  if (size > 0) scale_ = std::ldexp(1.0, kMeshExponent - 1 - std::ilogb(size));

  const auto edges_of = [&](std::uint32_t triangle) {
    const auto [a, b, c] = scene.corners(triangle);
    return std::max(largest_component(glm::dvec3(b) - glm::dvec3(a)), largest_component(glm::dvec3(c) - glm::dvec3(a)));
  };
  const double smallest = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, casting.size(), 4096), std::numeric_limits<double>::infinity(),
      [&](const tbb::blocked_range<std::size_t>& range, double least) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
          least = std::min(least, edges_of(casting[i]) * scale_);
        return least;
      },
      [](double x, double y) { return std::min(x, y); });
  if (smallest < kSmallest) {
    const auto first =
        std::ranges::find_if(casting, [&](std::uint32_t triangle) { return edges_of(triangle) * scale_ < kSmallest; });
    throw InputError(
        "rays: triangle {} measures {} in a scene of {}: Embree's float32 cannot hold both; exact and view-sample can "
        "(compare: --reference exact)",
        *first, edges_of(*first), size);
  }
  shortest_ray_ = static_cast<float>(kLeastTerm / (smallest * smallest));
}

glm::vec3 EmbreeRange::direction(const glm::vec3& d) {
  const int exponent = kMeshExponent - 1 - std::ilogb(largest_component(d));
  return glm::vec3(glm::dvec3(d) * std::ldexp(1.0, exponent));
}

void EmbreeRange::require_light(const visibility::Light& light, const visibility::Bounds& bounds) const {
  const double farthest = std::max(largest_component(bounds.lower), largest_component(bounds.upper));
  if (farthest * scale_ <= kFarthest) return;
  throw InputError(
      "light \"{}\" is {} away from a scene of {}: Embree's float32 cannot hold both; bring the light nearer (compare: "
      "--reference exact)",
      light.name, farthest, std::ldexp(1.0, kMeshExponent) / scale_);
}

}  // namespace penumbra::reference
