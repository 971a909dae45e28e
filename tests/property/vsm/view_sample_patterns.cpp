// SPDX-License-Identifier: Apache-2.0
// Every kind of planar light, sample pattern and count: a random soup over a tilted floor, where each pair (at some of
// the pixels if there are many) is compared with the exact decision.

#include "tests/agreement/support.hpp"
#include "tests/unit/visibility/soups.hpp"

namespace penumbra::vsm {
namespace {

using tests::PairCounts;
using visibility::SamplePattern;
using visibility::SampleRequest;

enum class Shape { rectangle, tilted, disk, ellipse, polygon };

scenes::Scene soup_under(Shape shape, std::uint32_t seed) {
  std::mt19937 random(seed);
  scenes::Scene scene = tests::soup_over_tilted_floor(random, 24);
  const glm::dvec3 center(0.3, 2.2, -0.2);
  scene.lights.push_back(tests::rectangle_light(center, {0.6, 0, 0}, {0, 0, 0.7}));
  if (shape == Shape::tilted) scene.lights[0] = tests::rectangle_light(center, {0.6, 0.37, 0.03}, {-0.11, 0.21, 0.7});
  if (shape == Shape::disk) scene.lights[0].shape = scenes::Disk{center, glm::normalize(glm::dvec3(0.1, -1, 0.2)), 0.7};
  if (shape == Shape::ellipse) scene.lights[0].shape = scenes::Ellipse{center, {0.6, 0.1, 0.03}, {-0.11, 0.21, 0.3}};
  if (shape == Shape::polygon) {
    scene.lights[0].shape = scenes::Polygon{{{-0.5, 2.2, -0.5}, {0.7, 2.2, -0.4}, {0.9, 2.2, 0.3}, {0.1, 2.2, 0.8}}};
  }
  scene.lights[0].two_sided = seed % 2 == 1;
  return scene;
}

class Patterns : public tests::DeviceTest, public testing::WithParamInterface<const char*> {
 protected:
  void check(Shape shape, const SampleRequest& request) {
    const tests::Stage stage(soup_under(shape, ++seed_), 24, 18, request);
    if (!method_) method_ = make_view_sample(device(), {{"engine", GetParam()}});
    const tests::Masks masks = tests::run(*method_, stage.floats, stage.light, stage.samples);
    const std::size_t step = 1 + 2 * (stage.light.sample_count() / 64);
    PairCounts counts;
    EXPECT_TRUE(equals_truth(stage.floats, stage.light, stage.samples, masks, &counts, step))
        << "shape " << static_cast<int>(shape) << " pattern " << name_of(request.pattern) << " count " << request.count
        << " " << request.rows << "x" << request.columns << " seed " << seed_;
    total_ += counts;
  }

  void TearDown() override {
    EXPECT_GT(total_.visible, total_.pairs / 10);
    EXPECT_GT(total_.blocked, total_.pairs / 100);
    DeviceTest::TearDown();
  }

  PairCounts total_;
  std::uint32_t seed_ = 0;
  std::unique_ptr<visibility::Method> method_;
};

TEST_P(Patterns, CountsOfEveryPattern) {
  for (const SamplePattern pattern :
       {SamplePattern::rows, SamplePattern::grid, SamplePattern::sobol, SamplePattern::jittered, SamplePattern::rgss}) {
    for (const std::uint32_t count : {1U, 2U, 5U, 31U, 32U, 33U, 256U, 1000U, 4096U}) {
      check(count % 2 == 0 ? Shape::rectangle : Shape::tilted, {count, 0, 0, pattern, count});
    }
  }
}

TEST_P(Patterns, RowsByColumns) {
  using Layout = std::pair<std::uint32_t, std::uint32_t>;
  for (const auto& [rows, columns] : {Layout(1, 7), Layout(7, 1), Layout(3, 40), Layout(40, 3), Layout(64, 64),
                                      Layout(1, 4096), Layout(4096, 1), Layout(2, 33), Layout(5, 32), Layout(16, 31)}) {
    for (const SamplePattern pattern : {SamplePattern::rows, SamplePattern::grid}) {
      check(Shape::tilted, {rows * columns, rows, columns, pattern, 0});
    }
  }
}

TEST_P(Patterns, DisksEllipsesAndPolygons) {
  for (const Shape shape : {Shape::disk, Shape::ellipse, Shape::polygon}) {
    for (const SamplePattern pattern : {SamplePattern::rows, SamplePattern::grid, SamplePattern::sobol,
                                        SamplePattern::jittered, SamplePattern::rgss}) {
      for (const std::uint32_t count : {1U, 33U, 256U, 1000U}) check(shape, {count, 0, 0, pattern, 7});
    }
  }
}

TEST_P(Patterns, SeedsOfRectangles) {
  for (int i = 0; i < 30; ++i) {
    check(i % 2 == 0 ? Shape::rectangle : Shape::tilted,
          {64, 0, 0, i % 3 == 0 ? SamplePattern::rows : SamplePattern::sobol, 3});
  }
}

INSTANTIATE_TEST_SUITE_P(On, Patterns, testing::Values("vulkan", "native"));

}  // namespace
}  // namespace penumbra::vsm
