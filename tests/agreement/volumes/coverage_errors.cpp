// SPDX-License-Identifier: Apache-2.0
// Predicts and measures the errors of soft shadow volumes, which use the silhouettes of the light's centre, and sums in
// place of unions. Also tests where they are right, in scenes of several solids that shadow themselves.

#include "mesh/shapes/shapes.hpp"
#include "tests/unit/coverage_stage.hpp"
#include "tests/unit/exact_area_soups.hpp"
#include "volumes/wedges/coverage_validation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace penumbra::volumes {
namespace {

using tests::CoverageStage;

/// Errors |V − exact| over a grid of floor points that see part of the light.
struct Errors {
  double center_mean = 0, center_max = 0;  ///< with the centre's silhouettes
  double receiver_max = 0;                 ///< with the receiver's own silhouettes
  int partly = 0;
};

Errors errors_on_the_floor(const CoverageStage& stage, double reach) {
  Errors errors;
  constexpr int kSteps = 32;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const glm::dvec2 at = reach * (2.0 * (glm::dvec2(i % kSteps, i / kSteps) + 0.5) / double{kSteps} - 1.0);
    const glm::vec3 p(at.x, 0, at.y);
    const double exact = stage.exact(p);
    const double center = std::abs(stage.center(p).visibility - exact);
    errors.receiver_max = std::max(errors.receiver_max, std::abs(stage.receiver(p).visibility - exact));
    if (exact == 0 || exact == 1) continue;
    ++errors.partly;
    errors.center_mean += center;
    errors.center_max = std::max(errors.center_max, center);
  }
  errors.center_mean /= std::max(1, errors.partly);
  return errors;
}

void record(const std::string& name, const Errors& errors) {
  testing::Test::RecordProperty(
      name, fmt::format("{} samples, mean {:.4f}, max {:.4f}; own silhouettes {:.1e}", errors.partly,
                        errors.center_mean, errors.center_max, errors.receiver_max));
  fmt::print("{}: {} samples, mean {:.4f}, max {:.4f}; own silhouettes {:.1e}\n", name, errors.partly,
             errors.center_mean, errors.center_max, errors.receiver_max);
}

TEST(CoverageErrors, OfASphereGrowWithTheLightAndVanishWithTheReceiversSilhouettes) {
  double last = 0;
  for (const double half : {0.25, 0.5, 1.0}) {
    scenes::Scene scene = tests::area_scene(tests::corners_of(mesh::make_sphere({{0, 1, 0}, 0.5, 64, 32})));
    scene.lights.push_back(tests::ceiling_light(4, half));
    const Errors errors = errors_on_the_floor(CoverageStage(scene), 0.75 + 0.5 * half);
    record(fmt::format("sphere, light of half-size {}", half), errors);
    EXPECT_LT(errors.receiver_max, 1e-9);  // a convex solid is a single layer
    EXPECT_GT(errors.partly, 200);
    EXPECT_GT(errors.center_max, last);
    last = errors.center_max;
  }
  EXPECT_LT(last, 0.08);
}

TEST(CoverageErrors, OfACubeAreLarge) {
  for (const double half : {0.25, 0.5, 1.0}) {
    for (const bool below : {true, false}) {
      const glm::dvec3 center = below ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 1, 0.5);
      scenes::Scene scene = tests::area_scene(tests::corners_of(mesh::make_box(center, {0.5, 0.5, 0.5})));
      scene.lights.push_back(tests::ceiling_light(4, half));
      const Errors errors = errors_on_the_floor(CoverageStage(scene), below ? 0.75 + 0.75 * half : 3);
      record(fmt::format("cube {}, light of half-size {}", below ? "below" : "beside", half), errors);
      EXPECT_LT(errors.receiver_max, 1e-9);
      EXPECT_GT(errors.partly, 30);
      // The centre's silhouette is the outline of the cube's top alone, the same as from every p, if the cube is
      // directly below the light and the light is no larger than the cube.
      const bool sees_top_alone = below && half <= 0.5;
      EXPECT_EQ(errors.center_max > 0.05, !sees_top_alone);
      EXPECT_LT(errors.center_max, sees_top_alone ? 1e-9 : 0.35);
    }
  }
}

TEST(CoverageErrors, OfConvexSheetsInOnePlaneAreNone) {
  // A quad and a hexagon that do not overlap, in a plane that misses the light: the centre's silhouettes give the right
  // result.
  std::mt19937 random(11);
  int partly = 0;
  for (int i = 0; i < 60; ++i) {
    const double slope = tests::random_dyadic(random, -0.25, 0.25), height = tests::random_dyadic(random, 0, 1.25);
    const auto at = [&](double x, double z) { return glm::dvec3(x, height + slope * x, z); };
    std::vector<tests::Corners> sheets = {{at(-0.75, -0.5), at(-0.125, -0.25), at(-0.25, 0.375)},
                                          {at(-0.75, -0.5), at(-0.25, 0.375), at(-0.625, 0.25)}};
    const std::array<glm::dvec2, 6> hexagon = {glm::dvec2(0, 0.125),    {0.25, -0.25}, {0.625, -0.375},
                                               glm::dvec2(0.75, 0.125), {0.5, 0.5},    {0.125, 0.5}};
    for (std::size_t k = 1; k + 1 < hexagon.size(); ++k) {
      sheets.push_back(
          {at(hexagon[0].x, hexagon[0].y), at(hexagon[k].x, hexagon[k].y), at(hexagon[k + 1].x, hexagon[k + 1].y)});
    }
    const auto lamp = static_cast<tests::Lamp>(i % 4);
    const CoverageStage stage(tests::soup_scene(sheets, lamp));
    for (int j = 0; j < 20; ++j) {
      const glm::vec3 p = tests::soup_receiver(random);
      const double exact = stage.exact(p);
      ASSERT_NEAR(stage.center(p).visibility, exact, lamp == tests::Lamp::disk ? 1e-7 : 1e-9);
      partly += exact > 0 && exact < 1 ? 1 : 0;
    }
  }
  EXPECT_GT(partly, 300);
}

/// Returns the share hidden by the triangles of which p and the light's centre see the same side, summed over
/// triangles: once for closed parts, twice for open ones (docs/coverage.md, Centre silhouettes).
double predicted_error(const CoverageStage& stage, const glm::vec3& p, int times) {
  std::vector<std::array<glm::vec3, 3>> same_side;
  for (const std::uint32_t triangle : stage.casters.triangle) {
    const auto corners = stage.floats.corners(triangle);
    const auto [a, b, c] = corners;
    if (stage.floats.object[triangle] != 2) continue;  // the floor hides nothing from itself
    if (mesh::side_of_plane(a, b, c, p) == mesh::side_of_plane(a, b, c, stage.light.center)) {
      same_side.push_back(corners);
    }
  }
  const auto layers = projected_layers(stage.light, p, same_side);
  return times * sum_of_layers(stage.soft.outline(), layers);
}

TEST(CoverageErrors, OfTheCentreAreWhatIsSeenFromOneSideByBoth) {
  const auto sphere = tests::corners_of(mesh::make_sphere({{0.25, 1, 0.125}, 0.5, 24, 12}));
  const auto box = tests::corners_of(mesh::make_box({1, 1, 0.25}, {0.5, 0.5, 0.5}));  // no face is edge-on
  const auto fin = tests::quad({0.25, 2, 0}, {0.0625, 1, 0}, {0, 0, 1});              // edge-on below the light
  int wrong = 0;
  for (const bool disk : {false, true}) {
    for (const auto& [occluder, times] : {std::pair{sphere, 1}, std::pair{box, 1}, std::pair{fin, 2}}) {
      scenes::Scene scene = tests::area_scene(occluder);
      scene.lights.push_back(tests::ceiling_light(4, 0.75));
      if (disk) scene.lights[0].shape = scenes::Disk{{0, 4, 0}, {0, -1, 0}, 0.75};
      const CoverageStage stage(scene);
      for (int i = 0; i < 400; ++i) {
        const int column = i % 20, row = i / 20;
        const glm::vec3 p(0.2F * static_cast<float>(column) - 1.9F, 0, 0.2F * static_cast<float>(row) - 1.9F);
        const double error = stage.receiver(p).blocked - stage.center(p).blocked;
        ASSERT_NEAR(error, predicted_error(stage, p, times), 1e-9);
        wrong += error > 0.001 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(wrong, 200);
}

TEST(CoverageErrors, OfOverlappingOccludersAreWhatTheyHaveInCommon) {
  // Boards at heights 1 and 2 under a light at 4: the sum removes A₁ + A₂, the union A₁ + A₂ − A₁₂. Tolerance: a few
  // ulps of 1.
  struct Board {
    double height, x0, x1, z0, z1;
  };
  const std::array<Board, 2> boards = {Board{1, -0.25, 0.125, -0.25, 0.25}, Board{2, -0.125, 0.5, -0.375, 0.125}};
  std::vector<tests::Corners> triangles;
  for (const Board& board : boards) {
    for (const tests::Corners& corners :
         tests::quad({(board.x0 + board.x1) / 2, board.height, (board.z0 + board.z1) / 2},
                     {(board.x1 - board.x0) / 2, 0, 0}, {0, 0, (board.z1 - board.z0) / 2})) {
      triangles.push_back(corners);
    }
  }
  scenes::Scene scene = tests::area_scene(triangles);
  scene.lights.push_back(tests::ceiling_light(4, 1));
  const CoverageStage stage(scene);
  double largest = 0;
  for (int i = -32; i <= 32; ++i) {
    const glm::vec3 p(static_cast<float>(i) / 32, 0, 0.0625F);
    std::array<std::array<double, 4>, 3> boxes{};  // s0, s1, t0, t1 of each board, and of their overlap
    for (std::size_t k = 0; k < 2; ++k) {
      const double scale = 4 / boards[k].height;
      const auto seen = [&](double x, double from) { return std::clamp(from + scale * (x - from), -1.0, 1.0); };
      boxes[k] = {seen(boards[k].x0, p.x), seen(boards[k].x1, p.x), seen(boards[k].z0, p.z), seen(boards[k].z1, p.z)};
    }
    boxes[2] = {std::max(boxes[0][0], boxes[1][0]), std::min(boxes[0][1], boxes[1][1]),
                std::max(boxes[0][2], boxes[1][2]), std::min(boxes[0][3], boxes[1][3])};
    std::array<double, 3> share{};
    for (std::size_t k = 0; k < 3; ++k) {
      share[k] = std::max(0.0, boxes[k][1] - boxes[k][0]) * std::max(0.0, boxes[k][3] - boxes[k][2]) / 4;
    }
    const double sum = std::max(0.0, 1 - share[0] - share[1]), united = 1 - share[0] - share[1] + share[2];
    EXPECT_NEAR(stage.center(p).visibility, sum, 1e-12);
    EXPECT_NEAR(stage.exact(p), united, 1e-12);
    EXPECT_NEAR(overlap_of_layers(stage.soft.outline(), stage.layers(p), 100), share[2], 1e-12);
    largest = std::max(largest, united - sum);
  }
  EXPECT_GT(largest, 0.1);
  fmt::print("two boards: {:.4f} too dark at most\n", largest);
}

/// Returns solids that shadow each other and themselves, and an open sheet.
scenes::Scene still_life() {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {3, 0, 0}, {0, 0, 3}));
  tests::add_object(scene, "ball", tests::corners_of(mesh::make_sphere({{0.75, 0.625, 0}, 0.5, 24, 12})));
  tests::add_object(scene, "box", tests::corners_of(mesh::make_box({-0.75, 0.5, 0}, {0.375, 0.5, 0.25})));
  tests::add_object(scene, "blob", tests::corners_of(mesh::make_blob({{0, 0.75, -1.25}, 0.5, 3})));
  tests::add_object(scene, "sheet", tests::quad({0, 1.5, 0.5}, {0.5, 0.125, 0}, {0, 0, 0.25}));
  scene.lights.push_back(tests::rectangle_light({0.5, 4, 0.5}, {0.75, 0, 0}, {0, 0.25, 0.75}));
  scene.cameras.push_back(tests::camera({2, 3, 4}, {0, 0.5, 0}));
  return scene;
}

/// Returns the judged pixels of a small picture.
std::vector<LitPoint> judged(const tests::Stage& stage) {
  const auto classes = visibility::classify_pixels(stage.floats, stage.samples, stage.light);
  std::vector<LitPoint> points;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (classes[i] != visibility::PixelClass::judged) continue;
    points.push_back(
        {stage.samples.p[i], static_cast<std::uint32_t>(stage.samples.triangle[i]), stage.samples.facing[i]});
  }
  return points;
}

struct Checked {
  std::vector<CoveragePoint> points;
  ValidationReport report;
};

Checked check(const tests::Stage& stage, const Casters& casters) {
  const SoftVisibility soft(stage.floats, stage.light, casters);
  areas::ExactArea area(stage.floats);
  area.set_light(stage.light);
  Checked checked;
  checked.points = check_coverage(soft, stage.light, judged(stage), checked.report);
  const double error = stage.light.kind == visibility::LightKind::disk ? 1e-7 : 0;
  for (const CoveragePoint& point : checked.points) {
    const double hidden = 1 - area.visibility({point.sample.p, point.sample.carrier, point.sample.facing});
    check_union(point, hidden, error, checked.report);
  }
  return checked;
}

TEST(CoverageErrors, SolidsThatShadowThemselvesAddUpToTheirLayers) {
  scenes::Scene scene = still_life();
  for (const bool disk : {false, true}) {
    if (disk) scene.lights[0].shape = scenes::Disk{{0.5, 4, 0.5}, {0.125, -1, 0}, 0.75};
    const tests::Stage stage(scene, 64, 48);
    const Checked checked = check(stage, casters_of(stage.floats, stage.light));
    EXPECT_TRUE(checked.report.violations.empty()) << checked.report.violations.front().what;
    std::size_t single = 0;
    double worst = 0;
    for (const CoveragePoint& point : checked.points) {
      const bool partly = point.layers > 0.01 && point.layers < 0.99;
      single += point.is_single_layer() && partly ? 1 : 0;
      worst = std::max(worst, std::abs(point.receiver - point.layers));
    }
    EXPECT_GT(single, 100U);
    EXPECT_LT(worst, 1e-9);
    fmt::print("{} samples, {} with a single layer and partly lit, {:.1e} off at most\n", checked.points.size(), single,
               worst);
  }
}

TEST(CoverageErrors, WhatCrossesTheLightIsSetApart) {
  // A board that crosses the light's plane: if it crosses inside the light, nothing is judged; if it crosses outside
  // the light, everything is.
  for (const double at : {0.25, 1.5}) {
    scenes::Scene scene = still_life();
    tests::add_object(scene, "board", tests::quad({0.5 + at, 4, 0.5}, {0, 0.5, 0}, {0.125, 0, 0.25}));
    const tests::Stage stage(scene, 32, 24);
    const Checked checked = check(stage, casters_of(stage.floats, stage.light));
    EXPECT_TRUE(checked.report.violations.empty()) << checked.report.violations.front().what;
    EXPECT_EQ(std::ranges::any_of(checked.points, &CoveragePoint::touches_light), at < 1);
  }
}

TEST(CoverageErrors, AWrongEdgeIsFound) {
  const tests::Stage stage(still_life(), 32, 24);
  const Casters casters = casters_of(stage.floats, stage.light);
  // Reverses each of the sheet's four open edges, one at a time.
  for (std::uint32_t edge = 0; edge < casters.graph.edges.size(); ++edge) {
    const auto around = casters.graph.around(edge);
    if (around.size() != 1 || stage.floats.object[casters.triangle[around[0].triangle]] != 4) continue;
    Casters wrong = casters;
    std::swap(wrong.graph.edges[edge].a, wrong.graph.edges[edge].b);
    EXPECT_FALSE(check(stage, wrong).report.violations.empty()) << edge;
  }
}

TEST(CoverageErrors, AMissingTriangleIsFound) {
  const tests::Stage stage(still_life(), 32, 24);
  visibility::SceneFloats without = stage.floats;
  const auto sheet = std::ranges::find(without.object, 4U) - without.object.begin();
  without.casts_shadow[static_cast<std::size_t>(sheet)] = 0;
  // Edges and triangles agree without the removed triangle; only the union shows the error.
  const Checked checked = check(stage, casters_of(without, stage.light));
  EXPECT_FALSE(checked.report.violations.empty());
}

}  // namespace
}  // namespace penumbra::volumes
