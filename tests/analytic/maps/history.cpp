// SPDX-License-Identifier: Apache-2.0
// Tests shadow-map:history: frames with shifted texels, against the recurrence that mixes them and against the hard
// shadow.

#include "maps/filters/history.hpp"
#include "tests/analytic/maps/backprojection_scenes.hpp"

#include <fmt/format.h>

#include <cmath>

namespace penumbra::tests {
namespace {

class History : public MapsTest {
 protected:
  static Masks of_frames(const Stage& stage, int frames, std::uint32_t rows = 0) {
    const auto method = maps::make_shadow_map(device(), {{"size", "64"}, {"history", fmt::format("{}", frames)}});
    return run(*method, stage, rows);
  }
};

TEST(HistoryJitter, IsHaltons) {
  EXPECT_EQ(maps::jitter_of(0), glm::dvec2(0));
  EXPECT_NEAR(glm::length(maps::jitter_of(1) - glm::dvec2(0, 1.0 / 3 - 0.5)), 0, 1e-12);
  EXPECT_NEAR(glm::length(maps::jitter_of(6) - glm::dvec2(3.0 / 8 - 0.5, 2.0 / 9 - 0.5)), 0, 1e-12);
}

/// A board whose edge runs along the texels, over a floor 4 wide with 62 texels and one more on either side. Frame k
/// sees the edge at the first texel centre beyond it.
TEST_F(History, MixesByConfidence) {
  scenes::Scene scene = bare_floor(0.3);
  const double texel = 4.0 / 62;
  add_quad(scene, {1.5 + 0.0123, 2, 0}, {1.5, 0, 0}, {0, 0, 1.8}).receives_shadow = false;
  const double edge = 0.0123 * 5 / 3;
  std::vector<double> places;
  for (int i = -40; i <= 40; ++i) places.push_back(edge + i / 20.0 * texel + 1e-6);
  const Stage stage = along_floor(scene, places, light_samples(1));
  constexpr int kFrames = 9;
  const Masks found = of_frames(stage, kFrames);
  std::size_t between = 0, off = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    double mixed = 0;
    for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
      // The light's frame decides along which map axis x runs, and in which direction: here along u.
      const glm::dvec2 jitter = maps::jitter_of(frame);
      const double x = (places[i] + 2) / texel + 1 - jitter.x, z = (0.013 + 2) / texel + 1 - jitter.y;
      const double centre = std::floor(x) + 0.5, lit = (centre - 1 + jitter.x) * texel - 2 < edge ? 1 : 0;
      const double share = 1 - 2 * std::max(std::abs(x - centre), std::abs(z - std::floor(z) - 0.5));
      mixed = frame == 0 ? lit : share * lit + (1 - share) * mixed;
    }
    off += std::abs(mixed - static_cast<double>(found.visibility[i])) > 1e-3 ? 1 : 0;
    between += mixed > 0.01 && mixed < 0.99 ? 1 : 0;
  }
  EXPECT_GT(between, 5U);
  EXPECT_LE(off, 2U) << "of " << places.size() << ": a texel's border within rounding";
}

/// A turned board: more frames leave fewer pixels on the wrong side; tiles change nothing.
TEST_F(History, ApproachesTheHardShadow) {
  scenes::Scene scene = bare_floor(0.3);
  const glm::dvec3 middle(0.11, 2, 0.07), u(0.62, 0, 0.23), v(-0.2, 0.0, 0.539130434782608);
  add_quad(scene, middle, u, v).receives_shadow = false;
  const Stage stage = on_floor(scene, 96, light_samples(1));
  const auto wrong = [&](const Masks& found) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin, light(0, 5, 0);
      const glm::dvec3 on = p + 2 / 5.0 * (light - p) - middle;
      const bool hidden =
          std::max(std::abs(glm::dot(on, u)) / glm::dot(u, u), std::abs(glm::dot(on, v)) / glm::dot(v, v)) < 1;
      count += (found.visibility[i] < 0.5F) != hidden ? 1 : 0;
    }
    return count;
  };
  const std::size_t one = wrong(of_frames(stage, 1)), eight = wrong(of_frames(stage, 8)),
                    many = wrong(of_frames(stage, 64));
  EXPECT_GT(one, 60U);
  EXPECT_LT(eight, one);
  EXPECT_LT(2 * many, one);
  EXPECT_EQ(of_frames(stage, 3, 7).visibility, of_frames(stage, 3).visibility);
  EXPECT_THROW(std::ignore = maps::make_shadow_map(device(), {{"history", "2"}, {"fit", "cascades"}}), UsageError);
}

/// A floor under a turned board, seen from a place beside it; the light's centre is at (0, 5, 0).
class Reprojection : public MapsTest {
 protected:
  static constexpr glm::dvec3 kMiddle{0.11, 2, 0.07}, kU{0.62, 0, 0.23}, kV{-0.2, 0.0, 0.539130434782608};

  static Stage seen_from(double x) {
    scenes::Scene scene = bare_floor(0.3);
    add_quad(scene, kMiddle, kU, kV).receives_shadow = false;
    scene.cameras[0] = camera({x, 4.5, 3}, {x / 3, 0, 0}, 40);
    return {scene, 128, 96, light_samples(1)};
  }
  /// Returns whether the board is between two points.
  static bool hides(const glm::dvec3& from, const glm::dvec3& to) {
    const double share = (kMiddle.y - from.y) / (to.y - from.y);
    const glm::dvec3 on = from + share * (to - from) - kMiddle;
    const double across = glm::dot(on, kU) / glm::dot(kU, kU), along = glm::dot(on, kV) / glm::dot(kV, kV);
    return share > 0 && share < 1 && std::max(std::abs(across), std::abs(along)) < 1;
  }
  static glm::dvec3 place(const Stage& stage, std::size_t pixel) {
    return glm::dvec3(stage.samples.p[pixel]) + stage.floats.origin;
  }
};

/// The test's picture stores a linear function of place as V. Reprojection must find this value at the same place;
/// places that the earlier picture does not show, because the board hides them or they are outside, have no value.
TEST_F(Reprojection, FindsTheSameSurface) {
  const Stage before = seen_from(0.9), now = seen_from(-0.4);
  visibility::KeptPicture kept{before.samples, {}};
  const auto value = [](const glm::dvec3& p) { return 0.5 + 0.1 * p.x + 0.07 * p.z; };
  for (std::size_t i = 0; i < before.samples.size(); ++i) {
    kept.visibility.push_back(static_cast<float>(value(place(before, i))));
  }
  std::size_t found = 0, hidden = 0;
  for (std::size_t i = 0; i < now.samples.size(); ++i) {
    const glm::dvec3 p = place(now, i);
    if (now.samples.triangle[i] < 0 || p.y > 1) continue;
    const float v = maps::reprojected(kept, now.samples, i);
    const glm::dvec3 eye = before.samples.camera.eye + before.floats.origin;
    // Well inside the board's image, so that no neighbouring pixel shows the floor either.
    const bool is_hidden = hides(eye, p) && hides(eye, p + glm::dvec3(0.15, 0, 0)) &&
                           hides(eye, p - glm::dvec3(0.15, 0, 0)) && hides(eye, p + glm::dvec3(0, 0, 0.15)) &&
                           hides(eye, p - glm::dvec3(0, 0, 0.15));
    hidden += is_hidden ? 1 : 0;
    if (is_hidden) {
      EXPECT_TRUE(std::isnan(v)) << i;
    } else if (!std::isnan(v)) {
      ++found;
      EXPECT_NEAR(static_cast<double>(v), value(p), 0.01) << i << ": a pixel's width, beside what is hidden";
    }
  }
  EXPECT_GT(found, 5000U);
  EXPECT_GT(hidden, 150U);
}

/// A camera that stands still, one map per frame: after many frames the result is that of shadow-map:history.
TEST_F(Reprojection, OfAStillCameraIsHistory) {
  const Stage stage = seen_from(0.5);
  visibility::FrameMemory memory;
  const auto method = maps::make_shadow_map(device(), {{"size", "64"}, {"reproject", "on"}});
  visibility::remember(*method, &memory);
  for (int frame = 0; frame < 4; ++frame) {
    memory.next_frame();
    const Masks found = run(*method, stage);
    EXPECT_EQ(run(*method, stage, 7).visibility, found.visibility) << "again, in tiles";
    const Masks right = run(maps::make_shadow_map, stage, {{"size", "64"}, {"history", fmt::format("{}", frame + 1)}});
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      EXPECT_NEAR(found.visibility[i], right.visibility[i], 1e-4) << frame << ", pixel " << i;
    }
  }
}

/// A camera that moves along the floor: after some frames fewer pixels are on the wrong side of the shadow's edge than
/// in a single picture.
TEST_F(Reprojection, OfAMovingCameraApproachesTheHardShadow) {
  visibility::FrameMemory memory;
  const auto method = maps::make_shadow_map(device(), {{"size", "64"}, {"reproject", "on"}});
  visibility::remember(*method, &memory);
  const auto wrong = [&](const Stage& stage, const Masks& found) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const glm::dvec3 p = place(stage, i);
      if (stage.samples.triangle[i] < 0 || p.y > 1) continue;
      count += (found.visibility[i] < 0.5F) != hides(p, {0, 5, 0}) ? 1 : 0;
    }
    return count;
  };
  constexpr int kFrames = 32;
  for (int frame = 0; frame < kFrames; ++frame) {
    memory.next_frame();
    const Stage stage = seen_from(-0.8 + 0.04 * frame);
    const Masks found = run(*method, stage);
    if (frame + 1 < kFrames) continue;
    const std::size_t one = wrong(stage, run(maps::make_shadow_map, stage, {{"size", "64"}})),
                      many = wrong(stage, found);
    fmt::print("wrong: {} by itself, {} in the sequence\n", one, many);
    EXPECT_GT(one, 60U);
    EXPECT_LT(3 * many, 2 * one);
    EXPECT_GT(method->counters().at("reprojectedPixels"), 5000U);
  }
}

}  // namespace
}  // namespace penumbra::tests
