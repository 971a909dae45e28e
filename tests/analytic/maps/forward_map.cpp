// SPDX-License-Identifier: Apache-2.0
// Tests forward-map: splats against closed forms, against a twin that splats each texel's light onto all view samples,
// and how it differs from shadow-map.

#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/centre_maps.hpp"

#include <cmath>
#include <vector>

namespace penumbra::tests {
namespace {

class ForwardMap : public MapsTest {
 protected:
  static visibility::MethodOptions splat(const char* shape, const char* size = "64") {
    return {{"size", size}, {"splat", shape}};
  }
};

/// A B-spline of this degree, at a distance in texels from its middle.
double spline(int degree, double at) {
  at = std::abs(at);
  if (degree == 0) return at <= 0.5 ? 1 : 0;
  if (degree == 1) return std::max(0.0, 1 - at);
  return at <= 0.5 ? 0.75 - at * at : at < 1.5 ? 0.5 * (1.5 - at) * (1.5 - at) : 0;
}

/// At the edge of a board V is the sum of the splats of nearby texels: a step with boxes, a linear ramp one texel wide
/// with tents, and two parabolas over two texels with splines.
TEST_F(ForwardMap, AnEdgeFadesAsItsSplatsDo) {
  scenes::Scene scene = bare_floor(0.3);
  const double texel = 4.0 / 62;  // texels on the floor; the window has one more on either side
  add_quad(scene, {1.5, 2, 0}, {1.5, 0, 0}, {0, 0, 1.8}).receives_shadow = false;  // the edge, x = 0, is between texels
  std::vector<double> places;
  for (int i = -60; i <= 60; ++i) places.push_back(i / 30.0 * texel + 1e-7);
  const Stage stage = along_floor(scene, places, light_samples(1));
  for (const int degree : {0, 1, 2}) {
    const char* shapes[] = {"box", "tent", "spline"};
    const Masks found = run(*maps::make_forward_map(device(), splat(shapes[degree])), stage);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double s = -places[i] / texel;  // distance into the light
      double expected = s > 0 ? 1 : 0;
      if (degree == 1) expected = std::clamp(s + 0.5, 0.0, 1.0);
      if (degree == 2)
        expected = s <= -1 ? 0 : s <= 0 ? 0.5 * (1 + s) * (1 + s) : s < 1 ? 1 - 0.5 * (1 - s) * (1 - s) : 1;
      if (degree == 0 && std::abs(s) < 0.01) continue;
      // Splat positions are rounded to 1/64 of a texel.
      EXPECT_NEAR(found.visibility[i], expected, 1.0 / 128 + 1e-4) << shapes[degree] << " " << s;
    }
  }
}

/// A caster is lit where splats land on it, and splats end at its outline as seen from the light. A surface that casts
/// no shadow is lit by all light that would pass it, so with boxes it has the hard shadow.
TEST_F(ForwardMap, SurfacesFadeAtTheirOwnOutline) {
  scenes::Scene scene = bare_floor(0.3);
  const double texel = 4.0 / 62, at_plate = texel * 3 / 5;
  add_quad(scene, {0, 2, 0}, {0.475, 0, 0}, {0, 0, 0.475});
  const auto on_plate = [&](const visibility::SceneFloats& floats, const visibility::PinholeCamera& camera) {
    visibility::ViewSamples samples =
        grid_samples(101, {0, 2, 0}, {0.475, 0, 0}, {0, 0, 0.475}, {0, 1, 0})(floats, camera);
    for (std::int32_t& triangle : samples.triangle) triangle = 2;
    return samples;
  };
  const Stage plate(scene, 101, 101, light_samples(1), on_plate);
  for (const char* shape : {"box", "tent", "spline"}) {
    const Masks found = run(*maps::make_forward_map(device(), splat(shape)), plate);
    const Masks hard = run(*maps::make_shadow_map(device(), {{"size", "64"}}), plate);
    std::size_t faded = 0;
    for (std::size_t i = 0; i < plate.samples.size(); ++i) {
      EXPECT_EQ(hard.visibility[i], 1);
      const glm::dvec3 p = glm::dvec3(plate.samples.p[i]) + plate.floats.origin;
      const double inside = 0.475 - std::max(std::abs(p.x), std::abs(p.z));
      if (inside > 2 * at_plate) {
        EXPECT_EQ(found.visibility[i], 1) << shape;
      }
      faded += found.visibility[i] < 1 ? 1 : 0;
    }
    EXPECT_GT(faded, 100U) << shape;
  }
  const Stage floor = on_floor(scene, 160, light_samples(1));
  EXPECT_EQ(run(*maps::make_forward_map(device(), splat("box")), floor).visibility,
            run(*maps::make_shadow_map(device(), {{"size", "64"}}), floor).visibility);
}

/// The paper's own order of loops: each texel that shows something splats its light onto every view sample of the
/// picture.
std::vector<double> thrown(const CentreMaps& drawn, const Stage& stage, int degree, double bias) {
  const std::uint32_t size = drawn.size;
  std::vector<double> sums(stage.samples.size(), 0);
  const maps::gpu::LightView& view = drawn.fitted.views.front();
  const maps::Face face = maps::face_of(view, drawn.basis, 0);
  const std::vector<float> depths = drawn.read();
  const glm::dvec2 texel = (face.upper - face.lower) / static_cast<double>(size);
  for (std::uint32_t y = 0; y < size; ++y) {
    for (std::uint32_t x = 0; x < size; ++x) {
      const double depth = static_cast<double>(depths[y * size + x]) * static_cast<double>(view.far);
      const glm::dvec3 ray = face.direction(x, y, size);
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        if (stage.samples.triangle[i] < 0) continue;
        const glm::dvec3 d = glm::dvec3(stage.samples.p[i]) - glm::dvec3(view.point),
                         m = -glm::dvec3(stage.samples.n[i]);
        const double w = glm::dot(d, face.w), facing = glm::dot(m, ray);
        if (!(w > 0) || !(glm::dot(m, d) > 0) || !(facing > 0)) continue;
        const glm::dvec2 at = (glm::dvec2(glm::dot(d, face.a), glm::dot(d, face.b)) / w - face.lower) / texel;
        const double weight = spline(degree, at.x - x - 0.5) * spline(degree, at.y - y - 0.5);
        if (weight == 0) continue;
        const double slope = (std::abs(glm::dot(m, face.a)) + std::abs(glm::dot(m, face.b))) / facing;
        const double forgiven = bias * std::max(texel.x, texel.y) * w * (1 + slope);
        if (std::abs(glm::dot(m, d) / facing - depth) <= forgiven) sums[i] += weight;
      }
    }
  }
  return sums;
}

TEST_F(ForwardMap, GathersWhatTexelsThrow) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
  add_quad(scene, {0.1, 1.2, 0.05}, {0.6, 0.25, 0.1}, {-0.1, 0.0, 0.5});
  add_object(scene, "ball", sphere({-0.9, 0.5, 0.4}, 0.4, 12));
  scene.lights.push_back(ceiling_light(5, 0.3));
  scene.cameras.push_back(camera({0, 4, 4}, {0, 0, 0}));
  const Stage stage(scene, 64, 64, light_samples(1));
  const CentreMaps drawn(device(), stage, 96);
  ASSERT_EQ(drawn.fitted.faces, 1U);
  for (const int degree : {1, 2}) {
    const Masks found = run(*maps::make_forward_map(device(), splat(degree == 1 ? "tent" : "spline", "96")), stage);
    const std::vector<double> expected = thrown(drawn, stage, degree, 0.5);
    std::size_t judged = 0, off = 0, soft = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (stage.samples.triangle[i] < 0) continue;
      ++judged;
      soft += expected[i] > 0.02 && expected[i] < 0.98 ? 1 : 0;
      // Positions are rounded to 1/64 of a texel on either axis.
      off += std::abs(static_cast<double>(found.visibility[i]) - expected[i]) > 0.03 ? 1 : 0;
    }
    EXPECT_GT(soft, judged / 20);
    EXPECT_LE(off, judged / 200) << "of " << judged;  // surfaces a bias away, within rounding
  }
}

}  // namespace
}  // namespace penumbra::tests
