// SPDX-License-Identifier: Apache-2.0
#pragma once
// Scenes for contours; each function says what its scene is for. Lights are 5 above a floor at height 0.

#include "reference/methods.hpp"
#include "tests/analytic/maps/parallel_square.hpp"

namespace penumbra::tests {

inline scenes::Scene contour_floor(double light_half, double floor_half = 4) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {floor_half, 0, 0}, {0, 0, -floor_half});
  scene.lights.push_back(ceiling_light(5, light_half));
  scene.cameras.push_back(camera({0.3, 1.2, 7}, {0, 0.2, 0}, 55));
  return scene;
}

/// A solid body: the outline that the light's centre sees is not the one that other light points see.
inline scenes::Scene ball_over_floor(double light_half, double height = 2) {
  scenes::Scene scene = contour_floor(light_half);
  add_object(scene, "ball", sphere({0, height, 0}, 1, 24));
  return scene;
}

/// A plate over a larger plate, apart from it: the part of the larger one that the smaller one hides is missing in the
/// map.
inline scenes::Scene plate_over_plate(double light_half = 0.6) {
  scenes::Scene scene = contour_floor(light_half);
  add_quad(scene, {0, 3.5, 0}, {0.3, 0, 0}, {0, 0, 0.3});
  add_quad(scene, {0, 1.5, 0}, {1.6, 0, 0}, {0, 0, 1.6});
  return scene;
}

/// Two plates that look the same in the map whether or not there is a gap between them.
inline scenes::Scene plates_alike(bool gap) {
  scenes::Scene scene = contour_floor(0.6);
  add_quad(scene, {-1, 3.5, 0}, {1, 0, 0}, {0, 0, 2});
  const double from = gap ? 0 : -2;
  add_quad(scene, {(from + 2) / 2, 1.5, 0}, {(2 - from) / 2, 0, 0}, {0, 0, 2});
  return scene;
}

/// The parallel square under a disk (1), a polygon (2), a skew rectangle (3) or an ellipse (4). The light's first axis
/// stays along x, as the occluder's sides do.
inline scenes::Scene under_shape(int shape) {
  scenes::Scene scene = parallel_square();
  if (shape == 1) scene.lights.front().shape = scenes::Disk{{0, 5, 0}, {0, -1, 0}, 0.9};
  if (shape == 2) scene.lights.front().shape = scenes::Polygon{{{-1, 5, -1}, {1, 5, -1}, {0.7, 5, 0.9}, {-0.4, 5, 1}}};
  if (shape == 3) scene.lights.front() = rectangle_light({0.1, 5, 0}, {0.9, 0, 0}, {0.3, 0, 0.8});
  if (shape == 4) scene.lights.front().shape = scenes::Ellipse{{0.1, 5, 0}, {0.9, 0, 0}, {0.3, 0, 0.5}};
  return scene;
}

inline bool on_object(const Stage& stage, std::size_t pixel, std::uint32_t object) {
  const std::int32_t triangle = stage.samples.triangle[pixel];
  return triangle >= 0 && stage.floats.object[static_cast<std::size_t>(triangle)] == object;
}

/// Errors of V against exact areas, over the floor (object 0).
struct FloorErrors {
  double rmse = 0, bias = 0;
  double leak = 0;    ///< the share of pixels in the umbra that are brighter than 0.05
  double dark = 0;    ///< share of lit pixels that are darker than 0.95
  double shadow = 0;  ///< Σ|V − exact| over the pixels that are not lit
  double lowest = 0;  ///< lowest V − exact
  std::size_t pixels = 0;
};
inline FloorErrors floor_errors(const Stage& stage, const Masks& found, const Masks& exact) {
  FloorErrors errors;
  double umbra = 0, lit = 0, shaded = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (!on_object(stage, i, 0)) continue;
    const double v = found.visibility[i], truth = exact.visibility[i], difference = v - truth;
    ++errors.pixels;
    errors.rmse += difference * difference;
    errors.bias += difference;
    errors.lowest = std::min(errors.lowest, difference);
    if (truth == 0) {
      umbra += 1;
      errors.leak += v > 0.05 ? 1 : 0;
    }
    if (truth == 1) {
      lit += 1;
      errors.dark += v < 0.95 ? 1 : 0;
    } else {
      shaded += 1;
      errors.shadow += std::abs(difference);
    }
  }
  EXPECT_GT(errors.pixels, 100U);
  errors.rmse = std::sqrt(errors.rmse / static_cast<double>(errors.pixels));
  errors.bias /= static_cast<double>(errors.pixels);
  errors.leak /= std::max(umbra, 1.0);
  errors.dark /= std::max(lit, 1.0);
  errors.shadow /= std::max(shaded, 1.0);
  return errors;
}

/// A method's V and its counters.
struct Counted {
  Masks masks;
  std::map<std::string, std::uint64_t> counters;
  [[nodiscard]] double count(const std::string& name) const { return static_cast<double>(counters.at(name)); }
};

class ContourTest : public MapsTest {
 protected:
  static Counted counted(const Factory& factory, const Stage& stage, const visibility::MethodOptions& options) {
    const auto method = factory(device(), options);
    Counted result{tests::run(*method, stage), {}};
    result.counters = method->counters();
    return result;
  }
  static Masks exact(const Stage& stage) { return tests::run(*reference::make_exact({}), stage); }
};

}  // namespace penumbra::tests
