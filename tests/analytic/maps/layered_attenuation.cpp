// SPDX-License-Identifier: Apache-2.0
// Tests layered-attenuation's layers per texel, which are joined from the maps of many light samples, against those
// maps.

#include "maps/products/lists/layered_depth.hpp"
#include "maps/products/lists/layered_depth.shared.h"
#include "tests/analytic/maps/lists.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

class LayeredAttenuation : public MapLists {
 protected:
  static constexpr std::uint32_t kBoardSize = 40, kBoardSamples = 36;
  struct Layered {
    std::vector<maps::gpu::LayerEntry> entries;  // the same number for each texel
    std::size_t layers = 0;
    std::vector<glm::dvec3> directions;  // directions of the texels' rays, of length 1 along the light's normal
  };
  /// A board over a floor, 3 below a light at height 5; it is tilted about its middle and rises by `tilt` toward x.
  static Layered board_over_floor(double tilt) {
    scenes::Scene scene;
    add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, -3});
    add_quad(scene, {0, 2, 0}, {0.8, tilt, 0}, {0, 0, 0.8});
    scene.lights.push_back(ceiling_light(5, 0.5));
    scene.cameras.push_back(camera({0, 4, 7}, {0, 1, 0}, 60));
    const Stage stage(scene, 4, 4, light_samples(kBoardSamples));
    Made made(device(), stage, kBoardSize);
    maps::LayeredDepth product(device(), 0.01);
    product.make(*made.source);
    Layered found{entries_of(product, std::size_t{kBoardSize} * kBoardSize), product.layers(), {}};
    const auto face = maps::face_of(made.centre.views.front(), made.basis, 0);
    for (std::uint32_t y = 0; y < kBoardSize; ++y) {
      for (std::uint32_t x = 0; x < kBoardSize; ++x) found.directions.push_back(face.direction(x, y, kBoardSize));
    }
    return found;
  }
  /// Returns the unsorted words of a layered depth image as entries.
  static std::vector<maps::gpu::LayerEntry> entries_of(const maps::LayeredDepth& product, std::size_t texels) {
    std::vector<maps::gpu::LayerEntry> entries(texels * product.layers());
    product.buffer().read<maps::gpu::LayerEntry>(entries);
    return entries;
  }
};

// With one sample, at the centre, every texel holds its own depth once, and nothing else.
TEST_F(LayeredAttenuation, OneMapFromTheCentreIsItself) {
  constexpr std::uint32_t kSize = 32;
  for (const bool wall : {false, true}) {
    const Stage stage(crowded(wall, false), 4, 4, light_samples(1));
    Made made(device(), stage, kSize);
    maps::LayeredDepth product(device(), 0.001);
    product.make(*made.source);
    maps::SampleMaps samples(device());
    samples.make(*made.source);
    const std::vector<float> depths = selftest::depths_of(samples, kSize);
    const auto entries = entries_of(product, depths.size());
    const float far = made.centre.views.front().far;
    std::size_t own = 0, all = 0;
    for (std::size_t texel = 0; texel < depths.size(); ++texel) {
      for (std::size_t e = 0; e < product.layers(); ++e) {
        const auto& entry = entries[texel * product.layers() + e];
        if (entry.weight == 0) continue;
        ++all;
        EXPECT_EQ(entry.weight, 1U);
        own += std::abs(entry.t - depths[texel] * far) <= 1e-6F * far ? 1 : 0;
      }
    }
    const auto filled = static_cast<std::size_t>(std::ranges::count_if(depths, [](float depth) { return depth < 1; }));
    EXPECT_EQ(own, filled);
    // In hemicubes, a texel beside an edge of the cube reaches onto the next face.
    EXPECT_LE(all, wall ? filled + filled / 4 : filled);
  }
}

TEST_F(LayeredAttenuation, EveryMapCountsOnceAndTheFloorIsCoveredWithoutGaps) {
  const Layered found = board_over_floor(0);
  std::size_t lit_floor = 0, uncovered = 0;
  for (std::size_t texel = 0; texel < found.directions.size(); ++texel) {
    std::uint32_t board = 0, floor = 0;
    for (std::size_t e = 0; e < found.layers; ++e) {
      const auto& entry = found.entries[texel * found.layers + e];
      EXPECT_LE(entry.weight, kBoardSamples);
      if (entry.weight == 0) continue;
      const bool is_floor = std::abs(entry.t - 5) < 0.05F, is_board = std::abs(entry.t - 3) < 0.03F;
      EXPECT_TRUE(is_floor || is_board) << entry.t;
      (is_floor ? floor : board) += entry.weight;
    }
    // The board hides the floor from no sample where the centre's ray is far from the board: |x| > 0.8 5/3 + 0.5 2/3 on
    // the floor.
    const glm::dvec3 at = 5.0 * found.directions[texel];
    const double out = std::max(std::abs(at.x), std::abs(at.z));
    const double texel_width = 6.0 / (kBoardSize - 2);
    if (out < 0.8 * 5 / 3 - 0.5 * 2 / 3 - texel_width) {
      EXPECT_EQ(floor, 0U) << "umbra";
    }
    if (out < 0.8 * 5 / 3 + 0.5 * 2 / 3 + texel_width || out > 3 - texel_width) continue;
    ++lit_floor;
    uncovered += floor != kBoardSamples ? 1 : 0;
  }
  EXPECT_GT(lit_floor, found.directions.size() / 4);
  EXPECT_EQ(uncovered, 0U);
}

// On a tilted board the images of a map's texels begin at all fractions of the centre's texels: if there were gaps of a
// fiftieth, rays would often meet the middle of one.
TEST_F(LayeredAttenuation, ATiltedBoardIsCoveredWithoutGaps) {
  const Layered found = board_over_floor(0.08);
  const double texel_width = 6.0 / (kBoardSize - 2) * 3 / 5;
  std::size_t inside = 0;
  for (std::size_t texel = 0; texel < found.directions.size(); ++texel) {
    const glm::dvec3& direction = found.directions[texel];
    // The board is at height 2 + x / 10, that is at depth 3 - x / 10.
    const glm::dvec3 at = 3 / (1 + 0.1 * direction.x) * direction;
    if (std::max(std::abs(at.x), std::abs(at.z)) > 0.8 - 2 * texel_width) continue;
    std::uint32_t board = 0;
    for (std::size_t e = 0; e < found.layers; ++e) {
      const auto& entry = found.entries[texel * found.layers + e];
      if (entry.weight > 0 && entry.t < 4) board += entry.weight;
    }
    EXPECT_EQ(board, kBoardSamples) << texel;
    ++inside;
  }
  EXPECT_GT(inside, 50U);
}

// A sample's texel covers those of the centre's texels whose centres lie in its image. Its image ends where its
// neighbour's begins: on one plane, where the plane crosses their border. So each of the centre's texels holds one
// depth, and that is where its own ray meets the board, even if the board is steep compared with the tolerance.
TEST_F(LayeredAttenuation, ATexelEndsWhereTheSurfaceCrossesItsBorder) {
  constexpr std::uint32_t kSize = 120;
  constexpr double kAside = 0.9;  // distance of the only sample from the light's centre
  std::size_t compared = 0, on_borders = 0;
  const auto expect_depths = [&](double slope, double epsilon) {
    scenes::Scene scene;
    add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, -3});
    add_quad(scene, {0, 2, 0}, {0.5, 0.5 * slope, 0}, {0, 0, 0.6});
    scene.lights.push_back(ceiling_light(5, 1));
    scene.cameras.push_back(camera({0, 4, 7}, {0, 1, 0}, 60));
    Stage stage(scene, 4, 4, light_samples(1));
    stage.light.points.front() += glm::vec3(kAside, 0, 0);
    Made made(device(), stage, kSize);
    maps::LayeredDepth product(device(), epsilon);
    product.make(*made.source);
    const auto entries = entries_of(product, std::size_t{kSize} * kSize);
    const auto views =
        maps::fit_views(stage.floats, stage.light, made.basis, stage.light.points, {.size = kSize}).views;
    const auto from = maps::face_of(views.front(), made.basis, 0),
               to = maps::face_of(made.centre.views.front(), made.basis, 0);
    const double texel = (from.upper.x - from.lower.x) / kSize;
    for (std::uint32_t i = 0; i < kSize * kSize; ++i) {
      // The board is at depth 3 - slope x below the light.
      const glm::dvec3 direction = to.direction(i % kSize, i / kSize, kSize),
                       at = 3 / (1 + slope * direction.x) * direction;
      if (std::abs(at.x) > 0.45 || std::abs(at.z) > 0.55) continue;
      const glm::dvec3 seen = at - glm::dvec3(kAside, 0, 0);
      const glm::dvec2 across = glm::dvec2(glm::dot(seen, from.a), glm::dot(seen, from.b)) / glm::dot(seen, from.w);
      const glm::dvec2 place = (across - from.lower) / (from.upper - from.lower) * static_cast<double>(kSize);
      const auto x = static_cast<std::uint32_t>(place.x), y = static_cast<std::uint32_t>(place.y);
      const double middle = from.direction(x, y, kSize).x;
      // Seen from the sample, the surface's depth in the direction a is (3 - slope aside) / (1 + slope a).
      const auto depth = [&](double a) { return (3 - kAside * slope) / (1 + slope * a); };
      const glm::dvec2 beside = glm::abs(place - glm::round(place));
      if (std::min(beside.x, beside.y) < 0.01) {
        ++on_borders;
        continue;
      }
      std::vector<float> found;
      for (std::size_t e = 0; e < product.layers(); ++e) {
        const auto& entry = entries[std::size_t{i} * product.layers() + e];
        if (entry.weight > 0 && entry.t < 4) found.push_back(entry.t);
      }
      ++compared;
      ASSERT_EQ(found.size(), 1U) << "texel " << i << ", epsilon " << epsilon;
      // The depth of the sample's texel is off by up to half of its difference to the next one, the rasteriser's by
      // 1/256 of that. At borders the mean of two depths is used: for 1/(1 + slope a) its relative error is below
      // (slope texel)²/4.
      EXPECT_NEAR(found.front(), std::abs(at.y), 0.02 * std::abs(depth(middle) - depth(middle - texel)))
          << "texel " << i << ", epsilon " << epsilon;
    }
  };
  expect_depths(0.1, 0.01);
  // A slope of 45 degrees, on which neighbouring depths differ by 0.0125 to 0.0165 of their value.
  for (int i = 0; i < 14; ++i) expect_depths(1, 0.0131 + 0.00023 * i);
  EXPECT_GT(compared, 5000U);
  EXPECT_LT(10 * on_borders, compared);
}

// A slope on which the depths of neighbouring texels differ by more than the tolerance, but by less than twice that.
// Seen from off the centre, their images overlap where the slope falls away from the sample, and both may be near one
// layer. The samples' weights are 1, 4, 16 and 64, so that one that counts twice sets an odd bit.
TEST_F(LayeredAttenuation, OnASteepSurfaceAMapCountsOnce) {
  constexpr std::uint32_t kSize = 40;
  std::size_t all = 0;
  for (const double aside : {0.0, 0.01, 0.02, 0.03, 0.04, 0.05}) {  // a texel is 0.1 wide there
    scenes::Scene scene;
    add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, -3});
    add_quad(scene, {aside - 0.5, 2, 0}, {0.4, 0.36, 0}, {0, 0, 1});
    add_quad(scene, {aside + 0.5, 2, 0}, {0.4, -0.36, 0}, {0, 0, 1});
    scene.lights.push_back(ceiling_light(5, 1));
    scene.cameras.push_back(camera({0, 4, 7}, {0, 1, 0}, 60));
    Stage stage(scene, 4, 4, {4, 1, 4, visibility::SamplePattern::rows, 0});
    for (int i = 0; i < 4; ++i) stage.light.weights.push_back(std::ldexp(1.0, 2 * i - 24));
    Made made(device(), stage, kSize);
    maps::LayeredDepth product(device(), 0.025);
    product.make(*made.source);
    for (const auto& entry : entries_of(product, std::size_t{kSize} * kSize)) {
      EXPECT_EQ(entry.weight & ~0x55U, 0U) << entry.weight << " at depth " << entry.t;
      all += entry.weight == 0x55U && entry.t < 4 ? 1 : 0;
    }
  }
  EXPECT_GT(all, 100U);
}

TEST_F(LayeredAttenuation, VCountsSamplesAndTendsToAccumulate) {
  const Stage stage(parallel_square(), 48, 48, light_samples(64));
  const Masks truth = run(maps::make_accumulate, stage, {{"size", "1024"}});
  double last = 1;
  for (const char* size : {"32", "96", "288"}) {
    const Masks found = run(maps::make_layered_attenuation, stage, {{"size", size}});
    for (const float v : found.visibility) EXPECT_EQ(v * 64, std::round(v * 64));
    const double error = distance(stage, found, truth);
    fmt::print("layered-attenuation, size {}: RMSE {:.5f} to accumulate\n", size, error);
    EXPECT_LT(error, 0.8 * last);
    last = error;
  }
  EXPECT_LT(last, 0.015);
}

// A tolerance that is too small splits a curved surface into layers, each seen by only some of the samples. One that is
// too large takes what lies just below an occluder for the occluder. (All maps of one plane hold the same places: their
// windows end where the receivers end.)
TEST_F(LayeredAttenuation, EpsilonTradesSpeckleOnCurvedSurfacesForLeaksAtContact) {
  scenes::Scene round, contact;
  add_quad(round, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
  add_object(round, "sphere", sphere({0, 1.2, 0}, 1, 24));
  round.cameras.push_back(camera({0, 5.5, 2}, {0, 1, 0}, 35));
  add_quad(contact, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
  add_quad(contact, {-2, 0.2, 0}, {2, 0, 0}, {0, 0, 2.5}).receives_shadow = false;  // over one half of the floor
  contact.cameras.push_back(camera({0, 0.1, 3}, {0, 0, 0}, 60));                    // looks from below the board
  struct Shares {
    double dark, leak;
  };
  const auto shares = [&](scenes::Scene scene, const char* epsilon) {
    scene.lights.push_back(ceiling_light(5, 0.4));
    const Stage stage(scene, 48, 48, light_samples(36));
    const Masks truth = run(maps::make_accumulate, stage, {{"size", "1024"}}),
                found =
                    run(maps::make_layered_attenuation, stage, {{"size", "128"}, {"bias", "0"}, {"epsilon", epsilon}});
    double lit = 0, dark = 0, umbra = 0, leak = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (stage.samples.triangle[i] < 0) continue;
      lit += truth.visibility[i] == 1 ? 1 : 0;
      dark += truth.visibility[i] == 1 && found.visibility[i] < 0.95F ? 1 : 0;
      umbra += truth.visibility[i] == 0 ? 1 : 0;
      leak += truth.visibility[i] == 0 && found.visibility[i] > 0.05F ? 1 : 0;
    }
    const Shares result{dark / std::max(lit, 1.0), leak / std::max(umbra, 1.0)};
    fmt::print("epsilon {}: dark {:.3f} of {}, leak {:.3f} of {}\n", epsilon, result.dark, lit, result.leak, umbra);
    return result;
  };
  const double small = shares(round, "0.0003").dark, middle = shares(round, "0.01").dark,
               large = shares(round, "0.04").dark;
  EXPECT_GT(small, 0.1);
  EXPECT_LT(middle, 0.5 * small);
  EXPECT_LT(middle, 0.08);  // 0.14 where a texel keeps the depth of its own centre
  EXPECT_LT(large, middle);
  EXPECT_LT(shares(contact, "0.01").leak, 0.05);
  EXPECT_GT(shares(contact, "0.06").leak, 0.5);
}

// Depths of a surface parallel to the light are equal except for rounding, which even epsilon=0 must allow.
TEST_F(LayeredAttenuation, WithoutEpsilonOrBiasAParallelFloorIsFound) {
  const Stage stage(parallel_square(), 32, 32, light_samples(16));
  const auto visibility = [&](const char* epsilon) {
    return run(maps::make_layered_attenuation, stage, {{"size", "64"}, {"bias", "0"}, {"epsilon", epsilon}}).visibility;
  };
  const std::vector<float> none = visibility("0");
  EXPECT_EQ(none, visibility("0.0001"));
  EXPECT_GT(std::ranges::count(none, 1.0F), std::ssize(none) / 2);
}

}  // namespace
}  // namespace penumbra::tests
