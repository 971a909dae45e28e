// SPDX-License-Identifier: Apache-2.0
// Exact areas of soups on a lattice: changes that must not matter, and agreement with point samples.

#include "tests/unit/exact_area_soups.hpp"
#include "visibility/pair_truth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace penumbra::areas {
namespace {

using tests::AreaStage;
using tests::Corners;
using tests::Lamp;
using tests::lattice_soup;
using tests::soup_receiver;
using tests::soup_scene;

constexpr Lamp kLamps[] = {Lamp::flat, Lamp::tilted, Lamp::polygon, Lamp::disk, Lamp::ellipse, Lamp::sphere};

// docs/exact.md: a vertex that is off by an ulp moves the area by an ulp times the lengths of its edges; there are a
// few hundred vertices.
constexpr double kAreaRounding = 1e-12;

class ExactAreaSoups : public testing::TestWithParam<std::uint32_t> {};

TEST_P(ExactAreaSoups, OrderAndWindingChangeNoBitAndDuplicatesNoArea) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  const std::vector<Corners> soup = lattice_soup(random, 24);
  std::vector<Corners> shuffled = soup;
  std::ranges::shuffle(shuffled, random);
  for (Corners& corners : shuffled) {
    if (random() % 2 == 0) std::swap(corners[0], corners[2]);
  }
  std::vector<Corners> doubled = shuffled;
  doubled.insert(doubled.end(), soup.begin(), soup.begin() + 9);
  for (const Lamp lamp : kLamps) {
    const AreaStage one(soup_scene(soup, lamp)), other(soup_scene(shuffled, lamp)), more(soup_scene(doubled, lamp));
    for (int i = 0; i < 12; ++i) {
      const glm::vec3 p = soup_receiver(random);
      EXPECT_EQ(one.visibility(p), other.visibility(p));
      EXPECT_NEAR(one.visibility(p), more.visibility(p),
                  kAreaRounding);  // duplicates bring back edges that cancelled partly
    }
  }
}

TEST_P(ExactAreaSoups, SplitFacesCoverTheSame) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  const std::vector<Corners> soup = lattice_soup(random, 16);
  std::vector<Corners> split;
  for (const auto& [a, b, c] : soup) {
    const glm::dvec3 middle = 0.5 * (a + b);  // exact: it makes a T-junction with triangles that share the edge
    if (random() % 2 == 0) {
      split.push_back({a, b, c});
    } else {
      split.push_back({a, middle, c});
      split.push_back({middle, b, c});
    }
  }
  for (const Lamp lamp : kLamps) {
    const AreaStage one(soup_scene(soup, lamp)), other(soup_scene(split, lamp));
    for (int i = 0; i < 12; ++i) {
      const glm::vec3 p = soup_receiver(random);
      EXPECT_NEAR(one.visibility(p), other.visibility(p), kAreaRounding);
    }
  }
}

TEST_P(ExactAreaSoups, RationalSweepsAgree) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  const std::vector<Corners> soup = lattice_soup(random, 12);
  for (const Lamp lamp : kLamps) {
    const AreaStage stage(soup_scene(soup, lamp));
    for (int i = 0; i < 4; ++i) {
      const glm::vec3 p = soup_receiver(random);
      EXPECT_NEAR(stage.visibility(p), stage.visibility(p, SweepArithmetic::rational), kAreaRounding);
    }
  }
}

TEST_P(ExactAreaSoups, PointSamplesAverageToTheArea) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  // Jittered light samples, new ones for every view sample: each is uniform in its own stratum and the strata share the
  // light, so the expected number of visible ones is N V. All K = N · (number of view samples) outcomes are independent
  // and in {0, 1}: by Hoeffding the probability that their mean is off by more than ε is below 2 exp(−2 K ε²), here
  // 1e-12.
  std::mt19937 random(GetParam());
  double difference = 0;
  std::size_t count = 0, part = 0;
  constexpr std::uint32_t kSamples = 64;
  for (const Lamp lamp : kLamps) {
    const scenes::Scene scene = soup_scene(lattice_soup(random, 16), lamp);
    for (std::uint32_t i = 0; i < 24; ++i) {
      const AreaStage stage(scene, kSamples, static_cast<std::uint32_t>(random()));
      const Receiver receiver = tests::receiver_at(stage.floats, soup_receiver(random));
      visibility::ViewSamples samples;
      samples.width = samples.height = 1;
      samples.triangle = {0};
      samples.p = {receiver.p};
      samples.facing = {receiver.facing};
      std::uint32_t visible = 0;
      for (std::uint32_t j = 0; j < stage.light.sample_count(); ++j) {
        const auto truth = visibility::decide_pair(stage.floats, samples, 0, stage.light, j);
        visible += truth.outcome == visibility::PairOutcome::visible ? 1 : 0;
      }
      const double area = stage.area.visibility(receiver);
      difference += visible - stage.light.sample_count() * area;
      count += stage.light.sample_count();
      part += area > 0 && area < 1 ? 1 : 0;
      const double alone = std::sqrt(std::log(2e12) / (2.0 * stage.light.sample_count()));
      EXPECT_LT(std::abs(visible / static_cast<double>(stage.light.sample_count()) - area), alone);
    }
  }
  EXPECT_GT(part, 20u);
  EXPECT_LT(std::abs(difference) / static_cast<double>(count),
            std::sqrt(std::log(2e12) / (2.0 * static_cast<double>(count))));
}

INSTANTIATE_TEST_SUITE_P(Seeds, ExactAreaSoups, testing::Range(0u, 8u));

TEST(ExactArea, WhatIsNotBetweenHidesNothing) {
  // Triangles beyond the light, in its plane, behind p, in p's plane, edge-on to p, and without area hide nothing; of a
  // triangle that crosses a plane, only the part between p and the light hides.
  const auto alone = [](const Corners& corners, const glm::vec3& p = {0, -1, 0}) {
    return AreaStage(soup_scene({corners}, Lamp::flat)).visibility(p);
  };
  EXPECT_EQ(alone({{{-9, 3.5, -9}, {9, 3.5, -9}, {0, 3.5, 9}}}), 1);
  EXPECT_EQ(alone({{{-9, 3, -9}, {9, 3, -9}, {0, 3, 9}}}), 1);
  EXPECT_EQ(alone({{{-9, -2, -9}, {9, -2, -9}, {0, -2, 9}}}), 1);
  EXPECT_EQ(alone({{{-9, -1, -9}, {9, -1, -9}, {0, -1, 9}}}, {1, -1, 1}), 1);
  EXPECT_EQ(alone({{{0, -1, -9}, {0, 5, 0}, {0, -1, 9}}}), 1);
  EXPECT_EQ(alone({{{-1, 1, 0}, {0, 1, 0}, {1, 1, 0}}}), 1);
  // Upright at x = ¼, from far below to far above both planes: seen from x = 0, its points a quarter of the way up
  // appear at x = 1; higher points cover x from 1 down to ¼.
  EXPECT_NEAR(alone({{{0.25, -60, 0}, {0.25, 60, -60}, {0.25, 60, 60}}}, {0, -1, 0}), 1 - 0.75 / 2, kAreaRounding);
  // A triangle that crosses the light's plane at x = 0, rising to the right: its lower part, x < 0, hides light.
  EXPECT_NEAR(alone({{{-16, -13, -29}, {-16, -13, 29}, {16, 19, 0}}}, {0.5, -1, 0}), 0.5, kAreaRounding);
}

}  // namespace
}  // namespace penumbra::areas
