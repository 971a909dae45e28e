// SPDX-License-Identifier: Apache-2.0
// Compares the mask methods with the ray caster on every shipped scene.

#include "tests/agreement/differences.hpp"

#include "mesh/shapes/shapes.hpp"
#include "scenes/formats/reader.hpp"

#include <glm/geometric.hpp>

#include <filesystem>
#include <random>

namespace penumbra {
namespace {

class AgreementBase : public tests::DeviceTest {
 protected:
  void check(const scenes::Scene& scene, std::uint32_t size, const tests::MaskMethod& method) {
    const tests::Differences found = tests::BothMethods(device(), method).on(scene, size);
    tests::print(fmt::format("{} {} {}x{}", method.name, scene.name, size, size), found);
    EXPECT_GT(found.pairs, 0U);
    EXPECT_LE(static_cast<double>(found.differing), 2e-5 * static_cast<double>(found.pairs_all));
    EXPECT_LE(static_cast<double>(found.differing), 2e-4 * static_cast<double>(found.pairs));
    EXPECT_EQ(found.mapped_right, found.judged) << found.first_wrong;
  }
};

class AgreementTest : public AgreementBase,
                      public testing::WithParamInterface<std::tuple<std::string, tests::MaskMethod>> {
 protected:
  void check(std::uint32_t size) {
    const auto& [name, method] = GetParam();
    AgreementBase::check(scenes::read_scene(std::string(PENUMBRA_SCENES "/") + name), size, method);
  }
};

// A rectangle light whose sides are not quite perpendicular, because decimals are rounded, or far from it.
using AgreementOn = AgreementBase;
TEST_F(AgreementOn, ParallelogramLights) {
  for (const double skew : {1e-4, 0.3, -0.9}) {
    scenes::Scene scene = scenes::read_scene(PENUMBRA_SCENES "/fusion.json");
    auto& light = std::get<scenes::Rectangle>(scene.lights[0].shape);
    light.half_v += skew * light.half_u;
    for (const tests::MaskMethod& method : tests::kMaskMethods) check(scene, 96, method);
  }
}

// A lamp's panel in the plane of a tilted light, over all of the light or a part of it: light samples are in front of
// the panel or behind it by a unit in the last place. Rays end before that distance; the exact decision decides.
TEST_F(AgreementOn, PanelsInTheLightsPlane) {
  const glm::dvec3 center(-2.6, 4.2, 2.4), u(0.5208, 0, 0.6076), v(-0.4416, -0.5498, 0.3784);
  for (const auto& [shift, size] : {std::pair(0.0, 2.0), std::pair(-0.7, 0.6)}) {
    mesh::SphereShape ball;
    ball.center = {0.3, 0.8, 0.2};
    ball.radius = 0.5;
    scenes::Scene scene = tests::with_a_floor(mesh::make_sphere(ball));
    tests::add_object(scene, "panel", tests::quad(center + shift * u, size * u, 1.5 * v));
    scene.lights[0] = tests::rectangle_light(center, u, v);
    for (const tests::MaskMethod& method : tests::kMaskMethods) {
      const tests::Differences found = tests::BothMethods(device(), method).on(scene, 48);
      tests::print(fmt::format("{} panel {}", method.name, size), found);
      EXPECT_GT(found.judged, 100U);
      EXPECT_EQ(found.mapped_right, found.judged) << found.first_wrong;
    }
  }
}

// Lights whose corners are not exact in float, with small panels in their planes: over a corner, across a side, next to
// the light.
TEST_F(AgreementOn, PanelsOfRandomLights) {
  for (const tests::MaskMethod& method : tests::kMaskMethods) {
    tests::BothMethods both(device(), method);
    tests::Differences found;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> real(-1, 1);
    const auto point = [&] { return glm::dvec3(real(random), real(random), real(random)); };
    for (int i = 0; i < (method.make == tests::kEdgeScatter.make ? 24 : 4); ++i) {
      const glm::dvec3 center = glm::dvec3(0, 2.5, 0) + 0.3 * point(), u = glm::normalize(point());
      const glm::dvec3 v = 0.7 * glm::normalize(glm::cross(u, point()));
      const glm::dvec2 at = glm::dvec2(real(random), real(random)) * 1.3;
      scenes::Scene scene = tests::with_a_floor({});
      scene.lights[0] = tests::rectangle_light(center, u, v);
      scene.lights[0].two_sided = true;
      tests::add_object(scene, "panel", tests::quad(center + at.x * u + at.y * v, 0.5 * u, 0.4 * v));
      found += both.on(scene, 24, {.count = i % 3 == 0 ? 9U : 64U}, 400);
    }
    tests::print(fmt::format("{} panels", method.name), found);
    EXPECT_GT(found.judged, 100U);
    EXPECT_EQ(found.mapped_right, found.judged) << found.first_wrong;
  }
}

// One method gets one light after another: with a body and without, with planes that cut the scene and planes that do
// not. Nothing of one light may remain for the next.
TEST_F(AgreementOn, LightsOneAfterTheOther) {
  mesh::SphereShape ball;
  ball.center = {0.3, 0.8, 0.2};
  ball.radius = 0.5;
  scenes::Scene scene = tests::with_a_floor(mesh::make_sphere(ball));
  const glm::dvec3 u(0.5208, 0, 0.6076), v(-0.4416, -0.5498, 0.3784);
  tests::add_object(scene, "lamp", tests::quad({-2.6, 4.2, 2.4}, u, v)).emits = 1;
  scene.lights.push_back(tests::rectangle_light({-2.6, 4.2, 2.4}, u, v));
  scene.lights.push_back(tests::rectangle_light({0.3, 0.9, 0.2}, u, v));  // in the middle of the ball
  scene.lights.back().two_sided = true;
  const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
  render::VisibilityBuffer view(device(), floats);
  const visibility::ViewSamples samples = view.render(visibility::make_camera(scene.cameras[0], floats.origin, 40, 40));
  const auto kept = tests::kNativeEdgeScatter.make(device(), {});
  kept->prepare_mesh(floats);
  for (const std::uint32_t index : {0U, 1U, 2U, 1U, 0U, 2U, 2U}) {
    const visibility::Light light = visibility::make_light(scene, index, floats.origin, {.count = 64});
    const auto fresh = tests::kNativeEdgeScatter.make(device(), {});
    const tests::Masks expected = tests::run(*fresh, floats, light, samples);
    kept->prepare_light(light);
    kept->prepare_view(samples);
    kept->evaluate({0, samples.height});
    std::vector<std::uint32_t> words(expected.words.size());
    kept->read_masks(words);
    EXPECT_EQ(words, expected.words) << "light " << index;
    EXPECT_TRUE(tests::equals_truth(floats, light, samples, expected)) << "light " << index;
  }
}

// Spheres and suns, wide and thin, above closed meshes and open ones.
TEST_F(AgreementOn, SpheresAndSuns) {
  mesh::SphereShape ball;
  ball.center = {0.3, 0.8, 0.2};
  ball.radius = 0.5;
  scenes::Scene round = tests::with_a_floor(mesh::make_sphere(ball));
  round.name = "ball";
  for (scenes::Scene scene : {round, scenes::read_scene(PENUMBRA_SCENES "/fusion.json"),
                              scenes::read_scene(PENUMBRA_SCENES "/self-shadow.json")}) {
    const glm::dvec3 center = std::get<scenes::Rectangle>(scene.lights[0].shape).center;
    for (const scenes::LightShape& shape :
         {scenes::LightShape(scenes::Sphere{center, 0.4}), scenes::LightShape(scenes::Sphere{center, 0.01}),
          scenes::LightShape(scenes::Sun{-center, 12}), scenes::LightShape(scenes::Sun{-center, 2})}) {
      scene.lights[0].shape = shape;
      for (const tests::MaskMethod& method : tests::kConeMethods) {
        const tests::Differences found = tests::BothMethods(device(), method).on(scene, 64);
        tests::print(fmt::format("{} {} {}", method.name, scene.name, shape.index()), found);
        EXPECT_GT(found.pairs, 0U);
        EXPECT_LE(static_cast<double>(found.differing), 2e-4 * static_cast<double>(found.pairs_all));
        EXPECT_EQ(found.mapped_right, found.judged) << found.first_wrong;
      }
    }
  }
}

// Triangles smaller than pixels: smaller blocks of pixels get separate lists.
TEST_F(AgreementOn, MeshesFinerThanPixels) {
  mesh::KnotShape knot;
  knot.segments = 1000;
  knot.sides = 100;
  tests::BothMethods both(device(), tests::kNativeEdgeScatter);
  const tests::Differences found = both.on(tests::with_a_floor(tests::fitted(mesh::make_knot(knot))), 64);
  EXPECT_GT(found.pairs, 0U);
  EXPECT_EQ(found.mapped_right, found.judged) << found.first_wrong;
  EXPECT_GT(both.mapped().counters().at("denseRegions"), 0U);
}

// Triangles far smaller than pixels: each view sample searches for edges alone, in rows also for edges between two
// rows. Rows and tiles of light samples, on the mesh and on the floor below.
TEST_F(AgreementOn, MeshesFarFinerThanPixels) {
  mesh::KnotShape knot;
  knot.segments = 2000;
  knot.sides = 150;
  const scenes::Scene scene = tests::with_a_floor(tests::fitted(mesh::make_knot(knot)));
  for (const auto pattern : {visibility::SamplePattern::rows, visibility::SamplePattern::sobol}) {
    visibility::SampleRequest request;
    request.pattern = pattern;
    tests::BothMethods both(device(), tests::kNativeEdgeScatter);
    const tests::Differences found = both.on(scene, 40, request);
    tests::print(fmt::format("{}", visibility::name_of(pattern)), found);
    EXPECT_GT(found.pairs, 0U);
    EXPECT_LE(static_cast<double>(found.differing), 2e-4 * static_cast<double>(found.pairs));
    EXPECT_EQ(found.mapped_right, found.judged) << found.first_wrong;
    EXPECT_GT(both.mapped().counters().at("samplesAlone"), 0U);
  }
}

std::vector<std::string> shipped_scenes(bool with_large_ones) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(PENUMBRA_SCENES)) {
    const std::string name = entry.path().filename().string();
    const bool scene = entry.path().extension() == ".json" && name.find(".schema") == std::string::npos;
    if (scene && (with_large_ones || name != "terrain-1m.json")) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string name_of_case(const testing::TestParamInfo<std::tuple<std::string, tests::MaskMethod>>& info) {
  const auto& [scene, method] = info.param;
  std::string name = fmt::format("{}_{}", std::filesystem::path(scene).stem().string(), method.name);
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

using Agreement = AgreementTest;
TEST_P(Agreement, WithTheRayCaster) {
  check(128);
}
INSTANTIATE_TEST_SUITE_P(Scenes, Agreement,
                         testing::Combine(testing::ValuesIn(shipped_scenes(false)),
                                          testing::ValuesIn(tests::kMaskMethods)),
                         name_of_case);

class AgreementFull : public AgreementTest {};
TEST_P(AgreementFull, WithTheRayCaster) {
  check(512);
}
INSTANTIATE_TEST_SUITE_P(Scenes, AgreementFull,
                         testing::Combine(testing::ValuesIn(shipped_scenes(true)),
                                          testing::ValuesIn(tests::kMaskMethods)),
                         name_of_case);

}  // namespace
}  // namespace penumbra
