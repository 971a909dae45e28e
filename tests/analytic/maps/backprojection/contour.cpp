// SPDX-License-Identifier: Apache-2.0
// Tests contours against their closed form, with kernels and sub-lights.

#include "base/error.hpp"
#include "tests/agreement/differences.hpp"
#include "tests/analytic/maps/backprojection/contour_scenes.hpp"
#include "tests/analytic/maps/backprojection/octagon_twin.hpp"

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

class MapsContour : public ContourTest {};

// An occluder of n × m texels is n · m − ½ texels large: each of its four corners is cut off by an eighth. For each
// edge, areas are rounded to 2⁻²² of the light, and tangents to 2⁻²⁴ of the window's 1.6, which is 1e-6 of the light's
// width there. A disk's swept angle, for which drivers may be off by 4,096 units in the last place, is off by 2.4e-4 at
// worst. The error of this driver is measured where about half of the light is hidden, and must be no larger where an
// edge grazes the light: a disk of a wrong size shows there, and hardly where edges cross its middle.
TEST_F(MapsContour, IsTheOctagonOfTheTexelsThatShade) {
  for (const int shape : {0, 1, 2, 3, 4}) {
    for (const std::uint32_t size : {33U, 96U}) {
      const Stage stage(under_shape(shape), 40, 40, light_samples(1));
      const ParallelSquare square(stage);
      const OctagonTwin twin(stage, size);
      const Masks found = run(maps::make_contour, stage, {{"size", std::to_string(size)}});
      double halved = 0, others = 0;
      std::size_t partly = 0, grazed = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        if (!square.on_floor(i)) continue;
        const double expected = twin.visibility(i);
        const bool half = expected > 0.25 && expected < 0.75;
        partly += expected > 0.01 && expected < 0.99 ? 1 : 0;
        grazed += (expected > 1e-5 && expected < 0.01) || (expected > 0.99 && expected < 1 - 1e-5) ? 1 : 0;
        double& largest = half ? halved : others;
        largest = std::max(largest, std::abs(static_cast<double>(found.visibility[i]) - expected));
      }
      EXPECT_GT(partly, 100U);
      EXPECT_GT(grazed, 3U);
      EXPECT_LT(std::max(halved, others), shape == 1 || shape == 4 ? 5e-4 : 4e-5)
          << "shape " << shape << ", size " << size;
      EXPECT_LT(others, 2 * halved + 4e-5) << "shape " << shape << ", size " << size;
      RecordProperty(fmt::format("shape {} size {}", shape, size), fmt::format("{:.2g}, {:.2g}", halved, others));
    }
  }
}

// A coarse level is a map of blocks at their nearest depths (Guennebaud et al. 2007).
TEST_F(MapsContour, ALevelIsTheOctagonOfItsBlocks) {
  const Stage stage(parallel_square(), 32, 32, light_samples(1));
  const ParallelSquare square(stage);
  for (const std::uint32_t level : {1U, 2U}) {
    const OctagonTwin twin(stage, 101, level);
    const Masks found = run(maps::make_contour, stage, {{"size", "101"}, {"level", std::to_string(level)}});
    std::size_t partly = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!square.on_floor(i)) continue;
      const double expected = twin.visibility(i);
      partly += expected > 0.01 && expected < 0.99 ? 1 : 0;
      EXPECT_NEAR(found.visibility[i], expected, 4e-5) << "level " << level;
    }
    EXPECT_GT(partly, 100U);
  }
}

// Packets, searches and hierarchies find the same contours as a single pixel does, at one level and at the two levels
// that a budget chooses; V then lies between those of the two levels.
TEST_F(MapsContour, LevelsAreTheSameForPacketsAndSearches) {
  for (const auto& scene : {ball_over_floor(1), plate_over_plate()}) {
    const Stage stage(scene, 20, 20, light_samples(1));
    const auto differing = [](const std::vector<float>& a, const std::vector<float>& b) {
      std::size_t count = 0;
      for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i] ? 1 : 0;
      return count;
    };
    const auto with = [&](const Factory& factory, MethodOptions options) {
      options.emplace("size", "96");
      return run(factory, stage, options).visibility;
    };
    std::vector<std::vector<float>> levels;
    for (const char* level : {"0", "1", "2", "3", "4"}) {
      levels.push_back(with(maps::make_contour, {{"level", level}}));
      EXPECT_EQ(differing(with(maps::make_packet, {{"level", level}}), levels.back()), 0U) << level;
      EXPECT_EQ(differing(with(maps::make_contour, {{"level", level}, {"search", "none"}}), levels.back()), 0U)
          << level;
    }
    EXPECT_EQ(with(maps::make_contour, {{"budget", "100000"}}), levels[0]);
    std::size_t between = 0, coarse = 0;
    for (const char* budget : {"40", "150"}) {
      const std::vector<float> stepped = with(maps::make_contour, {{"budget", budget}, {"blend", "off"}}),
                               blended = with(maps::make_contour, {{"budget", budget}});
      EXPECT_EQ(differing(with(maps::make_packet, {{"budget", budget}}),
                          with(maps::make_packet, {{"budget", budget}, {"packet", "1x1"}})),
                0U)
          << budget;
      for (std::size_t i = 0; i < stepped.size(); ++i) {
        bool one = false, two = false;
        for (std::size_t l = 0; l < levels.size(); ++l) {
          one = one || stepped[i] == levels[l][i];
          coarse += l > 0 && stepped[i] == levels[l][i] && stepped[i] != levels[0][i] ? 1 : 0;
          if (l == 0) continue;
          const float low = std::min(levels[l - 1][i], levels[l][i]), high = std::max(levels[l - 1][i], levels[l][i]);
          two = two || (blended[i] >= low - 1e-6F && blended[i] <= high + 1e-6F);
          between += blended[i] > low + 1e-3F && blended[i] < high - 1e-3F ? 1 : 0;
        }
        EXPECT_TRUE(one) << budget << ", pixel " << i;
        EXPECT_TRUE(two) << budget << ", pixel " << i;
      }
    }
    EXPECT_GT(coarse, 50U);
    EXPECT_GT(between, 30U);
  }
}

// Packets of 64 pixels with kernels of thousands of cells need more loop iterations than a software driver grants a
// workgroup: the work is then submitted again with fewer rows, and neither V nor the counters of packets show that.
TEST_F(MapsContour, LoopsThatADriverCutsOffAreRunAgain) {
  const Stage stage(ball_over_floor(1), 16, 16, light_samples(1));
  const auto with = [&](const char* packet) {
    return counted(maps::make_packet, stage, {{"size", "512"}, {"packet", packet}, {"hierarchy", "off"}});
  };
  const auto many = with("8x8"), alone = with("1x1");
  EXPECT_EQ(many.masks.visibility, alone.masks.visibility);
  EXPECT_EQ(many.count("kernelCells"), alone.count("kernelCells"));
  EXPECT_GT(alone.count("kernelCells"), 1e6);
  EXPECT_LE(many.count("packetsShared") + many.count("packetsParted") + many.count("packetsTrivial"), 4);
}

TEST_F(MapsContour, TilesDoNotChangeIt) {
  const Stage stage(ball_over_floor(1), 31, 40, light_samples(1));
  for (const char* sub_lights : {"1", "2"}) {
    const auto method = maps::make_packet(device(), {{"size", "64"}, {"sublights", sub_lights}});
    EXPECT_EQ(run(*method, stage).visibility, run(*method, stage, 7).visibility);
  }
}

TEST_F(MapsContour, DepthsBehindTheNearestAreAskedInOneWay) {
  const Stage stage(ball_over_floor(1), 32, 32, light_samples(1));
  for (const char* depth : {"second", "midpoint", "dual"}) {
    const Masks flat = run(maps::make_contour, stage, {{"size", "64"}, {"depth", depth}});
    EXPECT_EQ(run(maps::make_packet, stage, {{"size", "64"}, {"depth", depth}}).visibility, flat.visibility) << depth;
  }
}

TEST_F(MapsContour, NothingInTheKernelIsLitAndAnUmbraIsDark) {
  // The light has half-size 1 at height 5, the occluder half-size 1 at 2, the floor is at 0: the umbra is |x|, |z| < 1.
  const Stage stage(parallel_square(), 48, 48, light_samples(1));
  const ParallelSquare square(stage);
  const OctagonTwin twin(stage, 128);
  for (const Factory& factory : {Factory(maps::make_contour), Factory(maps::make_packet)}) {
    const Masks found = run(factory, stage, {{"size", "128"}});
    std::size_t lit = 0, dark = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!square.on_floor(i)) continue;
      // V must be exactly 0 or 1 where the twin is farther inside the umbra or the lit part than the areas' rounding.
      const double expected = twin.visibility(i);
      if (expected == 1) {
        ++lit;
        EXPECT_EQ(found.visibility[i], 1.0F);
      } else if (expected < 1e-12) {
        ++dark;
        EXPECT_EQ(found.visibility[i], 0.0F);
      }
    }
    EXPECT_GT(lit, 100U);
    EXPECT_GT(dark, 10U);
  }
}

// Guennebaud 2006's trivial pixels: tighter depth ranges find more of them, and give smaller kernels.
TEST_F(MapsContour, TighterRangesFindSmallerKernels) {
  const Stage stage(plate_over_plate(), 40, 40, light_samples(1));
  std::array<Counted, 4> runs;
  std::size_t at = 0;
  for (const char* search : {"none", "hsm", "ysm", "mssm"}) {
    runs[at++] = counted(maps::make_contour, stage, {{"size", "128"}, {"search", search}, {"traversal", "flat"}});
  }
  for (std::size_t i = 1; i < runs.size(); ++i) {
    EXPECT_LE(runs[i].count("kernelCells"), runs[i - 1].count("kernelCells"));
    EXPECT_GE(runs[i].count("packetsTrivial"), runs[i - 1].count("packetsTrivial"));
  }
  EXPECT_LT(runs[3].count("kernelCells"), 0.8 * runs[1].count("kernelCells"));
}

// Sub-lights give the mean over the light's parts, each taken as a separate light (Yang 2009, section 5).
TEST_F(MapsContour, SubLightsAreTheMeanOfContoursOfTheParts) {
  const scenes::Scene scene = ball_over_floor(1);
  const Stage stage(scene, 32, 32, light_samples(1));
  const Masks found = run(maps::make_packet, stage, {{"size", "64"}, {"sublights", "2"}});
  const auto& whole = std::get<scenes::Rectangle>(scene.lights.front().shape);
  const glm::dvec3 half_u = 0.5 * whole.half_u, half_v = 0.5 * whole.half_v;
  std::vector<double> mean(found.visibility.size(), 0.0);
  for (const double x : {-0.5, 0.5}) {
    for (const double z : {-0.5, 0.5}) {
      scenes::Scene part = scene;
      part.lights.front() = rectangle_light({x, 5, z}, half_u, half_v);
      const Stage part_stage(part, 32, 32, light_samples(1));
      const Masks one = run(maps::make_contour, part_stage, {{"size", "64"}});
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += 0.25 * static_cast<double>(one.visibility[i]);
    }
  }
  double largest = 0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    largest = std::max(largest, std::abs(mean[i] - static_cast<double>(found.visibility[i])));
  }
  EXPECT_LT(largest, 1e-6);
}

// Disks, ellipses and polygons are cut into polygons that together make the light. Seen from the centroid of each, less
// is missed, as for rectangles (MapsContourClaims).
TEST_F(MapsContour, SubLightsOfAnyShape) {
  for (const int shape : {1, 2, 4}) {
    scenes::Scene scene = ball_over_floor(1);
    scene.lights.front().shape = under_shape(shape).lights.front().shape;
    const Stage stage(scene, 40, 40, light_samples(1));
    const Masks truth = exact(stage);
    std::vector<double> errors;
    for (const char* sub_lights : {"1", "2", "4"}) {
      const Masks found = run(maps::make_packet, stage, {{"size", "128"}, {"sublights", sub_lights}});
      errors.push_back(floor_errors(stage, found, truth).rmse);
      RecordProperty(fmt::format("shape {} S={}", shape, sub_lights), fmt::format("{:.4f}", errors.back()));
      fmt::print("shape {}, S={}: RMSE {:.4f}\n", shape, sub_lights, errors.back());
    }
    EXPECT_LT(errors[1], 0.6 * errors[0]) << shape;
    EXPECT_LT(errors[2], 0.7 * errors[1]) << shape;
  }
}

// A light whose left half is black equals its right half alone.
TEST_F(MapsContour, SubLightsWeighByTheTexture) {
  scenes::Scene scene = ball_over_floor(1);
  const Stage plain(scene, 24, 24, light_samples(4));
  visibility::Light textured = plain.light;
  textured.texture = visibility::LightTexture{
      .width = 2, .height = 1, .colors = {glm::vec3(0), glm::vec3(1)}, .luminance = {0, 1}, .mean_luminance = 0.5};
  const auto method = maps::make_packet(device(), {{"size", "64"}, {"sublights", "2"}});
  const Masks found = tests::run(*method, plain.floats, textured, plain.samples);
  const visibility::LightFrame frame = visibility::light_frame(plain.light);
  std::vector<double> mean(found.visibility.size(), 0.0);
  for (const double t : {-0.5, 0.5}) {
    visibility::Light part = plain.light;
    const glm::dvec3 center = frame.center + 0.5 * frame.u + t * frame.v, u = 0.5 * frame.u, v = 0.5 * frame.v;
    part.center = center;
    part.center_u = center + u;
    part.center_v = center + v;
    part.outline = {center - u - v, center + u - v, center + u + v, center - u + v};
    const auto contour = maps::make_contour(device(), {{"size", "64"}});
    const Masks one = tests::run(*contour, plain.floats, part, plain.samples);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += 0.5 * static_cast<double>(one.visibility[i]);
  }
  for (std::size_t i = 0; i < mean.size(); ++i) EXPECT_NEAR(found.visibility[i], mean[i], 1e-6);
}

TEST_F(MapsContour, WhatItCannotDoIsRefused) {
  scenes::Scene scene = ball_over_floor(1);
  scene.lights.front().shape = scenes::Sphere{{0, 5, 0}, 0.9};
  const Stage bulb(scene, 8, 8, light_samples(4));
  const auto packet = maps::make_packet(device(), {{"size", "16"}, {"sublights", "2"}});
  packet->prepare_mesh(bulb.floats);
  EXPECT_THROW(packet->prepare_light(bulb.light), InputError);
  for (const char* extent : {"0x3", "3x0", "9x8", "3", "x3", "3x", "3x3x", "3X3", "-1x2", " 2x2", "4294967297x1"}) {
    EXPECT_THROW(maps::make_packet(device(), {{"packet", extent}}), UsageError) << extent;
  }
  EXPECT_THROW(maps::make_contour(device(), {{"traversal", "deep"}}), UsageError);
}

}  // namespace
}  // namespace penumbra::tests
