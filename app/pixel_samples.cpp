#include "app/pixel_samples.hpp"

#include "base/assert.hpp"

#include <tbb/parallel_for.h>

#include <limits>
#include <utility>
#include <vector>

namespace penumbra::app {
namespace {

using visibility::SceneFloats;
using visibility::ViewSamples;

/// The view sample (docs/definitions.md): least t, then least rank.
std::int32_t carrier_of(const SceneFloats& scene, const visibility::PinholeCamera& camera, std::uint32_t pixel) {
  const glm::dvec3 direction = camera.direction(pixel % camera.width, pixel / camera.width);
  std::int32_t carrier = ViewSamples::kBackground;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.plane[i] == SceneFloats::kNoPlane) continue;
    const std::optional<double> t = visibility::cover(camera, direction, scene.corners(i));
    if (!t || *t > nearest) continue;
    if (*t == nearest && scene.rank[i] >= scene.rank[static_cast<std::size_t>(carrier)]) continue;
    nearest = *t;
    carrier = static_cast<std::int32_t>(i);
  }
  return carrier;
}

}  // namespace

ViewSamples samples_at(const SceneFloats& scene, const visibility::PinholeCamera& camera,
                       std::span<const std::uint32_t> pixels) {
  std::vector<std::int32_t> carriers(std::size_t{camera.width} * camera.height, ViewSamples::kBackground);
  tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
    PENUMBRA_ASSERT(pixels[i] < carriers.size(), "pixel {} of {}", pixels[i], carriers.size());
    carriers[pixels[i]] = carrier_of(scene, camera, pixels[i]);
  });
  return visibility::complete_view_samples(scene, camera, std::move(carriers));
}

}  // namespace penumbra::app
