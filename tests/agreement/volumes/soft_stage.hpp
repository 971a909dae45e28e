// SPDX-License-Identifier: Apache-2.0
#pragma once

// A scene for tests of soft shadow volumes, with V by a C++ implementation of the same method and by exact areas.

#include "mesh/shapes/shapes.hpp"
#include "areas/exact_area.hpp"
#include "render/visibility_buffer.hpp"
#include "tests/agreement/support.hpp"
#include "tests/unit/shipped_scene.hpp"
#include "volumes/wedges/soft_visibility.hpp"
#include "volumes/wedges/wedge_casters.hpp"

#include <glm/common.hpp>

namespace penumbra::tests {

struct SoftStage : Stage {
  SoftStage(const scenes::Scene& scene, const render::Device& device, std::uint32_t width, std::uint32_t height)
      : Stage(scene, width, height, {64, 0, 0, visibility::SamplePattern::grid, 0},
              [&](const visibility::SceneFloats& scene_floats, const visibility::PinholeCamera& camera) {
                return render::VisibilityBuffer(device, scene_floats).render(camera);
              }),
        classes(visibility::classify_pixels(floats, samples, light)) {}
  SoftStage(const SoftStage&) = delete;
  SoftStage& operator=(const SoftStage&) = delete;

  [[nodiscard]] bool judged(std::size_t pixel) const { return classes[pixel] == visibility::PixelClass::judged; }
  [[nodiscard]] volumes::LitPoint lit(std::size_t pixel) const {
    return {samples.p[pixel], static_cast<std::uint32_t>(samples.triangle[pixel]), samples.facing[pixel]};
  }

  /// Returns V of the whole picture.
  [[nodiscard]] std::vector<float> run(visibility::Method& method, std::uint32_t rows = 0) const {
    return tests::run(method, *this, rows).visibility;
  }

  /// Returns `of(pixel)` for pixels of class `judged` (docs/definitions.md), NaN elsewhere.
  template <typename Of>
  [[nodiscard]] std::vector<double> at_judged(const Of& of) const {
    std::vector<double> result(samples.size(), std::numeric_limits<double>::quiet_NaN());
    tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
      if (judged(i)) result[i] = of(i);
    });
    return result;
  }
  [[nodiscard]] std::vector<double> twin(volumes::Viewer viewer) const {
    const volumes::Casters casters = volumes::casters_of(floats, light);
    const volumes::SoftVisibility soft(floats, light, casters);
    return at_judged([&](std::size_t i) { return soft.at(lit(i), viewer).visibility; });
  }
  [[nodiscard]] std::vector<double> exact() const {
    areas::ExactArea area(floats);
    area.set_light(light);
    return at_judged([&](std::size_t i) {
      const volumes::LitPoint point = lit(i);
      return area.visibility({point.p, point.carrier, point.facing});
    });
  }

  std::vector<visibility::PixelClass> classes;
};

/// Errors over the pixels where `truth` is a number.
struct Errors {
  std::size_t pixels = 0, penumbra = 0, largest_at = 0;
  double largest = 0, squares = 0;

  [[nodiscard]] double rmse() const {
    return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(pixels, 1)));
  }
};
template <typename Found>
Errors errors_of(const std::vector<Found>& found, const std::vector<double>& truth) {
  Errors errors;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (std::isnan(truth[i])) continue;
    ++errors.pixels;
    errors.penumbra += truth[i] > 0 && truth[i] < 1 ? 1 : 0;
    const double error = std::abs(static_cast<double>(found[i]) - truth[i]);
    errors.squares += error * error;
    if (!(error <= errors.largest)) {
      errors.largest = error;
      errors.largest_at = i;
    }
  }
  return errors;
}

inline std::vector<Corners> triangles_of(const mesh::TriangleSoup& soup) {
  std::vector<Corners> result;
  for (const mesh::Triangle& t : soup.triangles) {
    result.push_back({soup.positions[t[0]], soup.positions[t[1]], soup.positions[t[2]]});
  }
  return result;
}

/// Returns a floor under a square light of this half-size at height 5, and a camera above the floor.
inline scenes::Scene floor_and_light(double half) {
  scenes::Scene scene;
  add_object(scene, "floor", quad({0, 0, 0}, {5, 0, 0}, {0, 0, -5}));
  scene.lights.push_back(ceiling_light(5, half));
  scene.cameras.push_back(camera({2.5, 4, 3.5}, {0, 0, 0}));
  return scene;
}

}  // namespace penumbra::tests
