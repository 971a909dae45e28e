// SPDX-License-Identifier: Apache-2.0
// Measures shadows of objects in front of a light that stands on the floor: where V times the unshadowed integral is
// wrong, by how much, and how far point samples and cells are from `exact`. Prints the table of docs/radiance.md.

#include "compare/beauty.hpp"
#include "reference/methods.hpp"
#include "tests/agreement/panel.hpp"
#include "tests/unit/ray_traced_masks.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace penumbra::compare {
namespace {

using tests::Stage;
using tests::trace;
using visibility::SamplePattern;

struct Pictures {
  explicit Pictures(const visibility::SampleRequest& request)
      : stage(tests::things_before_a_panel(), 96, 72, request) {}

  [[nodiscard]] std::vector<glm::vec3> shade(const LightVisibility& seen) const {
    return integrate_beauty({stage.floats, stage.samples, colors, std::span(&stage.light, 1)}, {&seen, 1});
  }
  /// Equation 1.3 literally: area / N · Σ over visible samples.
  [[nodiscard]] std::vector<double> point_samples(const tests::Masks& masks) const {
    std::vector<double> sums(stage.samples.size());
    const glm::dvec3 m(0, 0, 1);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      for (std::uint32_t j = 0; j < stage.light.sample_count(); ++j) {
        if (!masks.visible(i, j)) continue;
        const glm::dvec3 d = glm::dvec3(stage.light.points[j]) - glm::dvec3(stage.samples.p[i]);
        const double squared = glm::dot(d, d);
        sums[i] += std::max(0.0, glm::dot(glm::dvec3(stage.samples.n[i]), d)) * -glm::dot(m, d) / (squared * squared);
      }
      sums[i] *= stage.light.area / stage.light.sample_count() / std::numbers::pi;
    }
    return sums;
  }

  Stage stage;
  std::vector<glm::dvec3> colors = std::vector<glm::dvec3>(4, glm::dvec3(1));
};

struct Exact {
  std::vector<float> visibility;
  std::vector<glm::dvec3> form_factors;
};

Exact exact_of(const Stage& stage) {
  const auto method = reference::make_exact({});
  method->prepare_mesh(stage.floats);
  method->prepare_light(stage.light);
  method->prepare_view(stage.samples);
  method->evaluate({0, stage.samples.height});
  Exact exact{std::vector<float>(stage.samples.size()), std::vector<glm::dvec3>(stage.samples.size())};
  method->read_visibility(exact.visibility);
  method->read_form_factors(exact.form_factors);
  return exact;
}

/// Returns √(mean e²) / mean over the pixels that see only a part of the light.
class Error {
 public:
  explicit Error(const Exact& exact) : exact_(exact) {}
  template <typename ValueAt>
  double operator()(ValueAt&& value_at) const {
    double squares = 0, sum = 0, count = 0;
    for (std::size_t i = 0; i < exact_.visibility.size(); ++i) {
      if (!(exact_.visibility[i] > 0 && exact_.visibility[i] < 1)) continue;
      const double truth = exact_.form_factors[i].x, e = static_cast<double>(value_at(i)) - truth;
      squares += e * e;
      sum += truth;
      count += 1;
    }
    return std::sqrt(squares / count) / (sum / count);
  }

 private:
  const Exact& exact_;
};

TEST(RadianceNearLight, CellsBeatSamplesAndBothBeatV) {
  const Pictures first({16});
  const Exact exact = exact_of(first.stage);
  const Error error(exact);
  const auto scaled = first.shade({.visibility = exact.visibility});
  const double of_v = error([&](std::size_t i) { return scaled[i].x; });
  fmt::print("V × unshadowed, V exact: {:.4f}\n", of_v);
  EXPECT_GT(of_v, 0.1) << "the picture must show the error that this test measures";

  double cells_before = of_v;
  for (const std::uint32_t count : {16u, 64u, 256u, 1024u}) {
    const Pictures rows({count}), jittered({count, 0, 0, SamplePattern::jittered, 1});
    const tests::Masks masks = trace(rows.stage), jittered_masks = trace(jittered.stage);
    const auto by_cells = rows.shade({.masks = masks.words}), by_v = rows.shade({.visibility = masks.visibility});
    const auto by_samples = jittered.shade({.masks = jittered_masks.words});
    const auto points = rows.point_samples(masks), jittered_points = jittered.point_samples(jittered_masks);
    const double cells = error([&](std::size_t i) { return by_cells[i].x; });
    const double plain = error([&](std::size_t i) { return points[i]; });
    const double sampled = error([&](std::size_t i) { return by_samples[i].x; });
    const double plain_sampled = error([&](std::size_t i) { return jittered_points[i]; });
    const double v = error([&](std::size_t i) { return by_v[i].x; });
    fmt::print("{:4}: V {:.4f}, rows: points {:.4f} cells {:.4f}, jittered: points {:.4f} scaled {:.4f}\n", count, v,
               plain, cells, plain_sampled, sampled);
    EXPECT_LT(cells, plain);
    EXPECT_LT(sampled, plain_sampled);
    EXPECT_LT(cells, cells_before / 1.6) << "four times the samples";
    if (count >= 64) {
      EXPECT_LT(cells, of_v / 4);
      EXPECT_GT(v, of_v / 2) << "more samples do not help V";
    }
    cells_before = cells;
  }
}

TEST(RadianceNearLight, WhatNothingHidesIsTheSameToTheLastBit) {
  for (const SamplePattern pattern : {SamplePattern::rows, SamplePattern::sobol}) {
    const Pictures pictures({64, 0, 0, pattern, 1});
    const tests::Masks masks = trace(pictures.stage);
    const Exact exact = exact_of(pictures.stage);
    const auto by_mask = pictures.shade({.masks = masks.words}),
               by_v = pictures.shade({.visibility = exact.visibility});
    const auto by_exact = pictures.shade({.form_factors = exact.form_factors});
    int compared = 0;
    for (std::size_t i = 0; i < by_mask.size(); ++i) {
      if (pictures.stage.samples.triangle[i] < 0 || exact.visibility[i] != 1 || masks.visibility[i] != 1) continue;
      ASSERT_EQ(by_mask[i], by_exact[i]) << i;
      ASSERT_EQ(by_v[i], by_exact[i]) << i;
      ++compared;
    }
    EXPECT_GT(compared, 200);
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const auto again = pictures.shade({.masks = masks.words});
    EXPECT_EQ(std::memcmp(again.data(), by_mask.data(), again.size() * sizeof again[0]), 0);
  }
}

}  // namespace
}  // namespace penumbra::compare
