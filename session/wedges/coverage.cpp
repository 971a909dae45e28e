// SPDX-License-Identifier: Apache-2.0
// Checks sums over silhouettes against triangles and exact unions at pixels of a scene.

#include "session/wedges/coverage.hpp"

#include "areas/exact_area.hpp"
#include "session/pixel_samples.hpp"

#include <tbb/parallel_for.h>

namespace penumbra::session {
namespace {

using volumes::LitPoint;

constexpr std::uint32_t kGrid = 32;
constexpr std::size_t kMost = 64;

std::vector<std::uint32_t> grid_of_pixels(std::uint32_t width, std::uint32_t height) {
  const std::uint64_t columns = std::min(kGrid, width), rows = std::min(kGrid, height);
  std::vector<std::uint32_t> pixels;
  for (std::uint64_t row = 0; row < rows; ++row) {
    for (std::uint64_t column = 0; column < columns; ++column) {
      const std::uint64_t x = (2 * column + 1) * width / (2 * columns), y = (2 * row + 1) * height / (2 * rows);
      pixels.push_back(static_cast<std::uint32_t>(y * width + x));
    }
  }
  return pixels;
}

std::vector<LitPoint> judged_samples(const scenes::Scene& scene, const visibility::SceneFloats& floats,
                                     const visibility::Light& light) {
  const visibility::PinholeCamera camera =
      visibility::make_camera(scene.cameras.front(), floats.origin, scene.width, scene.height);
  const std::vector<std::uint32_t> pixels = grid_of_pixels(scene.width, scene.height);
  const visibility::ViewSamples samples = samples_at(floats, camera, pixels);
  const std::vector<visibility::PixelClass> classes = visibility::classify_pixels(floats, samples, light);
  std::vector<LitPoint> judged;
  for (const std::uint32_t pixel : pixels) {
    if (classes[pixel] != visibility::PixelClass::judged) continue;
    judged.push_back({samples.p[pixel], static_cast<std::uint32_t>(samples.triangle[pixel]), samples.facing[pixel]});
  }
  return judged;
}

/// Returns the samples that see a silhouette on the light, thinned out evenly.
std::vector<LitPoint> where_edges_appear(const volumes::SoftVisibility& soft, const std::vector<LitPoint>& samples) {
  std::vector<std::uint8_t> sees(samples.size());
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    sees[i] = soft.at(samples[i], volumes::Viewer::center).edges.empty() ? 0 : 1;
  });
  std::vector<LitPoint> seeing, chosen;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (sees[i] != 0) seeing.push_back(samples[i]);
  }
  if (seeing.size() <= kMost) return seeing;
  for (std::size_t i = 0; i < kMost; ++i) chosen.push_back(seeing[i * seeing.size() / kMost]);
  return chosen;
}

}  // namespace

CoverageOutcome check_scene_coverage(const scenes::Scene& scene, const visibility::SceneFloats& floats,
                                     const visibility::Light& light, const volumes::Casters& casters,
                                     volumes::ValidationReport& report) {
  CoverageOutcome outcome;
  outcome.textured = light.texture.has_value();
  const volumes::SoftVisibility soft(floats, light, casters);
  const std::vector<LitPoint> samples = where_edges_appear(soft, judged_samples(scene, floats, light));
  outcome.points = volumes::check_coverage(soft, light, samples, report);
  areas::ExactArea area(floats);
  area.set_light(light);
  outcome.hidden.resize(samples.size());
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    outcome.hidden[i] = 1 - area.visibility({samples[i].p, samples[i].carrier, samples[i].facing});
  });
  // Exact unions use a polygon of equal area for a disk; its parts differ from the disk's by 7.6e-8 at most
  // (docs/exact.md).
  const double error = is_round(light.kind) ? 1e-7 : 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    volumes::check_union(outcome.points[i], outcome.hidden[i], error, report);
  }
  return outcome;
}

}  // namespace penumbra::session
