// SPDX-License-Identifier: Apache-2.0
#pragma once

// Compares every pair of lattice soups with the exact decision, without tolerance.

#include "tests/agreement/lattice.hpp"
#include "tests/agreement/support.hpp"
#include "visibility/method.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace penumbra::tests {

/// Returns the view samples of all cameras, and also points on triangles that are exactly on them, without a camera's
/// rounding.
inline visibility::ViewSamples all_samples(const scenes::Scene& scene, const visibility::SceneFloats& floats,
                                           std::mt19937& random) {
  visibility::ViewSamples samples = samples_on_triangles(floats, 8, 8, random);
  for (const scenes::Camera& camera : scene.cameras) {
    append(samples, visibility::brute_force_view_samples(floats, visibility::make_camera(camera, floats.origin, 8, 6)));
  }
  return samples;
}

/// Soups number `first` to `first + count` with corners in −range … range. Without `any_light`, light samples are in
/// rows only.
struct LatticeRun {
  int range = 1;
  std::uint32_t count = 1;
  bool any_light = true;
  std::uint32_t first = 0;
  std::uint64_t* open =
      nullptr;  ///< if given, increased by the number of pairs that the method left to exact predicates
};

/// Keeps a method for each layout of light samples, as a method that gets another layout compiles its kernels again.
class MethodsByLayout {
 public:
  using Make = std::function<std::unique_ptr<visibility::Method>()>;
  explicit MethodsByLayout(Make make) : make_(std::move(make)) {}

  visibility::Method& of(const visibility::Light& light) {
    std::unique_ptr<visibility::Method>& method = methods_[{light.rows, light.columns, light.sample_count()}];
    if (!method) method = make_();
    return *method;
  }

 private:
  Make make_;
  std::map<std::array<std::uint32_t, 3>, std::unique_ptr<visibility::Method>> methods_;
};

/// Checks the soups, and returns the numbers of pairs by outcome.
inline PairCounts expect_lattice_truth(MethodsByLayout& methods, const LatticeRun& run_of) {
  PairCounts counts;
  for (std::uint32_t i = run_of.first; i < run_of.first + run_of.count; ++i) {
    const std::uint32_t seed = i + 1000 * static_cast<std::uint32_t>(run_of.range);
    LatticeSoup soup(seed, run_of.range);
    visibility::SampleRequest request;
    const scenes::Scene scene = lattice_scene(soup, request);
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    const visibility::Light rows = visibility::make_light(scene, 0, floats.origin, request);
    const visibility::ViewSamples samples = all_samples(scene, floats, soup.random());
    const visibility::Light light = i % 3 == 0 || !run_of.any_light ? rows : scattered(rows, i % 3 == 2);
    visibility::Method& method = methods.of(light);
    const Masks masks = run(method, floats, light, samples);
    EXPECT_TRUE(equals_truth(floats, light, samples, masks, &counts)) << "seed " << seed << " range " << run_of.range;
    if (run_of.open != nullptr) *run_of.open += method.counters()["openPairs"];
  }
  return counts;
}

/// Checks a thousand soups at a time, prints the result of each thousand, and stops at the first that fails.
inline PairCounts expect_lattice_truth_by_thousands(MethodsByLayout& methods, const LatticeRun& run_of,
                                                    const std::string& name) {
  PairCounts counts;
  LatticeRun part = run_of;
  for (std::uint32_t done = 0; done < run_of.count && !testing::Test::HasFailure(); done += part.count) {
    part.first = run_of.first + done;
    part.count = std::min(1000U, run_of.count - done);
    counts += expect_lattice_truth(methods, part);
    fmt::print("{} of range {}: {} soups, {} pairs, {} of them by a zero\n", name, run_of.range, done + part.count,
               counts.pairs, counts.zero);
    std::fflush(stdout);
  }
  return counts;
}

inline void expect_all_kinds(const PairCounts& counts) {
  EXPECT_GT(counts.visible, counts.pairs / 20);
  EXPECT_GT(counts.blocked, counts.pairs / 20);
  EXPECT_GT(counts.horizon, counts.pairs / 20);
  EXPECT_GT(counts.zero, counts.pairs / 100);
}

}  // namespace penumbra::tests
