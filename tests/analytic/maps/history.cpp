// shadow-map:history: frames whose texels lie elsewhere, against the recurrence that mixes them and the hard shadow.

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

/// A board whose edge runs along the texels, over a floor that has 62 of them across 4, and one more on either side.
/// Frame k sees the edge where the first of its texels' centres beyond it says.
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
      // In which axis of the map x runs, and which way, is the light's: here u, along x.
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

/// A turned board: the more frames, the fewer pixels are on the wrong side; whatever the tiles.
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

}  // namespace
}  // namespace penumbra::tests
