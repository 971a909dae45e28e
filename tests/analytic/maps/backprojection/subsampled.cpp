// SPDX-License-Identifier: Apache-2.0
// Tests V that is computed for few pixels only: which pixels are computed, which are filled in, and how large the error
// is.

#include "maps/backprojection/penumbra_width.hpp"
#include "maps/backprojection/subsampled.hpp"
#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/backprojection/contour_scenes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>

namespace penumbra::tests {
namespace {

using maps::KnownPixel;
using visibility::MethodOptions;

class MapsSubsampled : public ContourTest {};

/// A ball over a floor, and a board so small that a grid of pixels may miss it.
scenes::Scene ball_and_speck() {
  scenes::Scene scene = ball_over_floor(1);
  add_quad(scene, {1.6, 0.3, 1.5}, {0.09, 0, 0}, {0, 0.06, 0});
  return scene;
}

MethodOptions with(MethodOptions options, std::uint32_t step, const char* by = "grid") {
  options["subsample"] = std::to_string(step);
  options["subsampleBy"] = by;
  return options;
}

TEST_F(MapsSubsampled, ComputedPixelsAreTheMethodsAndOthersLieBetweenThem) {
  const Stage stage(ball_and_speck(), 61, 53, light_samples(1));
  const std::vector<std::pair<Factory, MethodOptions>> variants{
      {maps::make_contour, {{"size", "64"}}},
      {maps::make_packet, {{"size", "64"}, {"sublights", "2"}}},
      {maps::make_backproject, {{"size", "64"}}},
      {maps::make_backproject_peel, {{"size", "64"}}},
      {maps::make_bitmask, {{"size", "64"}}}};
  for (const auto& [factory, options] : variants) {
    const Masks whole = run(factory, stage, options);
    EXPECT_EQ(run(factory, stage, with(options, 1)).visibility, whole.visibility);
    for (const std::uint32_t step : {2U, 5U}) {
      const auto method = factory(device(), with(options, step));
      const Masks few = run(*method, stage);
      EXPECT_EQ(run(*method, stage, 7).visibility, few.visibility) << "tiles change nothing";
      std::size_t speck = 0;
      for (std::size_t i = 0; i < few.visibility.size(); ++i) {
        EXPECT_TRUE(few.visibility[i] >= 0 && few.visibility[i] <= 1);
        const bool on_grid = i % 61 % step == 0 && i / 61 % step == 0;
        if (on_grid || !visibility::is_receiver(stage.floats, stage.light, stage.samples, i)) {
          EXPECT_EQ(few.visibility[i], whole.visibility[i]) << i;
        }
        if (on_object(stage, i, 2)) ++speck;
      }
      EXPECT_GT(speck, 0U);
      EXPECT_LT(method->counters().at("pixelsComputed"), 61U * 53U / (step * step) * 3 / 2 + speck);
    }
  }
}

TEST_F(MapsSubsampled, TheErrorGrowsWithTheStep) {
  const Stage stage(ball_over_floor(1), 96, 80, light_samples(1));
  const Masks whole = run(maps::make_packet, stage, {{"size", "128"}});
  double last = 0;
  for (const std::uint32_t step : {2U, 4U, 8U, 16U}) {
    const Masks few = run(maps::make_packet, stage, with({{"size", "128"}}, step));
    const double off = rmse(
        stage, [&](std::size_t i) { return visibility::is_receiver(stage.floats, stage.light, stage.samples, i); },
        [&](std::size_t i) { return static_cast<double>(few.visibility[i] - whole.visibility[i]); });
    fmt::print("subsample={}: RMSE {:.4f} of the whole picture\n", step, off);
    RecordProperty(fmt::format("subsample {}", step), fmt::format("{:.4f}", off));
    EXPECT_GT(off, last);
    if (step == 2) {
      EXPECT_LT(off, 0.05);
    }
    last = off;
  }
}

// Two plates over a floor. Where the lower one hides a part of the light, its penumbra is the narrow one; the width is
// the light's, scaled by the plate's distances to floor and light. With nothing in the kernel the width is infinite.
TEST_F(MapsSubsampled, TheNarrowestPenumbraIsThatOfTheFarthestCaster) {
  const auto scene_of = [](bool high, bool low) {
    scenes::Scene scene = bare_floor(1, 3);
    scene.lights.front() = rectangle_light({0, 5, 0}, {1, 0, 0}, {0, 0, 0.7});  // the narrower side counts
    if (high) add_quad(scene, {-0.5, 2.5, 0}, {0.8, 0, 0}, {0, 0, -0.8}).receives_shadow = false;
    if (low) add_quad(scene, {1, 1, 0.3}, {0.3, 0, 0}, {0, 0, -0.3}).receives_shadow = false;
    return scene;
  };
  const Stage stage = on_floor(scene_of(true, true), 24, light_samples(1));
  const Masks truth = exact(stage), under_low = exact(on_floor(scene_of(false, true), 24, light_samples(1)));
  const auto widths = run(*maps::make_penumbra_widths(device(), {{"size", "128"}, {"sublights", "2"}}), stage);
  const float wide = 1.4F * 2.5F / 2.5F, narrow = 1.4F * 1.0F / 4.0F;
  std::size_t none = 0, wides = 0, narrows = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    const float width = widths.visibility[i];
    if (std::isinf(width)) {
      ++none;
      EXPECT_EQ(truth.visibility[i], 1) << i;
    } else if (width > 1) {
      ++wides;
      EXPECT_NEAR(width, wide, 1e-5) << i;
      EXPECT_EQ(under_low.visibility[i], 1) << i;
    } else {
      ++narrows;
      EXPECT_NEAR(width, narrow, 1e-5) << i;
    }
  }
  EXPECT_GT(none, 50U);
  EXPECT_GT(wides, 50U);
  EXPECT_GT(narrows, 10U);
}

// Few pixels are computed where penumbrae are wide on the screen, and all where they are narrow: the picture is nearer
// to the full one than with a grid.
TEST_F(MapsSubsampled, PixelsAreLeftOutWherePenumbraeAreWide) {
  std::vector<double> shares;
  for (const double half : {0.3, 1.5}) {
    scenes::Scene scene = ball_over_floor(half);
    add_quad(scene, {1.6, 0.3, 1.5}, {0.4, 0, 0}, {0, 0.3, 0});
    const Stage stage(scene, 200, 160, light_samples(1));
    const MethodOptions options{{"size", "128"}};
    const Masks whole = run(maps::make_packet, stage, options),
                widths = run(*maps::make_penumbra_widths(device(), options), stage);
    const auto receives = [&](std::size_t i) {
      return visibility::is_receiver(stage.floats, stage.light, stage.samples, i);
    };
    const auto error = [&](const Masks& few) {
      return rmse(stage, receives,
                  [&](std::size_t i) { return static_cast<double>(few.visibility[i] - whole.visibility[i]); });
    };
    const auto method = maps::make_packet(device(), with(options, 16, "penumbra"));
    const Masks found = run(*method, stage);
    EXPECT_EQ(run(*method, stage, 7).visibility, found.visibility) << "tiles change nothing";
    const std::uint64_t computed = method->counters().at("pixelsComputed");
    std::uint64_t lit = 0, shaded = 0, same = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!receives(i)) continue;
      (std::isinf(widths.visibility[i]) ? lit : shaded) += 1;
      same += found.visibility[i] == whole.visibility[i] ? 1 : 0;
    }
    EXPECT_GE(same, computed);
    shares.push_back(static_cast<double>(computed - lit) / static_cast<double>(shaded));
    const double off = error(found), by_grid = error(run(maps::make_packet, stage, with(options, 2)));
    fmt::print("light of half {}: {:.2f} of {} pixels in shadow computed, RMSE {:.4f}; by a grid of 2 {:.4f}\n", half,
               shares.back(), shaded, off, by_grid);
    RecordProperty(fmt::format("half {}", half), fmt::format("{:.2f}, {:.4f}, {:.4f}", shares.back(), off, by_grid));
    EXPECT_LT(off, by_grid);
  }
  EXPECT_LT(shares[1], shares[0]);
}

// Each pixel gets the largest step, a power of two, that leaves four computed pixels across its narrowest penumbra as
// seen in the picture.
TEST_F(MapsSubsampled, PixelsAreChosenByThePenumbrasWidthOnThePicture) {
  constexpr std::uint32_t kMost = 16;
  scenes::Scene scene = bare_floor(0.6, 6);
  add_quad(scene, {0, 2, 0}, {2, 0, 0}, {0, 0, -5}).receives_shadow = false;
  scene.cameras.front() = camera({0, 1.4, 8}, {0, 0, 1}, 60);
  const Stage stage(scene, 160, 120, light_samples(1));
  const MethodOptions options{{"size", "128"}};
  const Masks widths = run(*maps::make_penumbra_widths(device(), options), stage);
  const auto method = maps::make_packet(device(), with(options, kMost, "penumbra"));
  run(*method, stage);
  std::uint64_t expected = 0, between = 0;
  for (std::uint32_t i = 0; i < stage.samples.size(); ++i) {
    if (!visibility::is_receiver(stage.floats, stage.light, stage.samples, i)) continue;
    const glm::dvec3 direction(stage.samples.eye - stage.samples.p[i]);
    const double slant = std::abs(glm::dot(glm::dvec3(stage.samples.n[i]), direction)) / glm::length(direction),
                 pixel = 2 * std::tan(std::numbers::pi / 6) / 120 * static_cast<double>(stage.samples.depth[i]);
    std::uint32_t step = 1;
    while (!std::isinf(widths.visibility[i]) && 2 * step <= kMost &&
           2 * step * 4 <= static_cast<double>(widths.visibility[i]) * slant / pixel) {
      step *= 2;
    }
    between += step > 1 && step < kMost ? 1 : 0;
    expected += i % 160 % step == 0 && i / 160 % step == 0 ? 1 : 0;
  }
  EXPECT_GT(between, 1000U);
  EXPECT_EQ(method->counters().at("pixelsComputed"), expected);
}

// Pull-push: constants are kept, and nothing crosses from object to object.
TEST(MapsFillIn, KeepsConstantsAndObjectsApart) {
  constexpr std::uint32_t kWidth = 37, kHeight = 29;
  std::vector<KnownPixel> pixels(std::size_t{kWidth} * kHeight);
  for (std::uint32_t i = 0; i < pixels.size(); ++i) {
    const std::uint32_t x = i % kWidth, y = i / kWidth;
    pixels[i].object = x + y < 30 ? 0 : 7;
    pixels[i].known = x % 4 == 0 && y % 4 == 0;
    pixels[i].v = pixels[i].known ? (pixels[i].object == 0 ? 0.25F : 0.75F) : -1;
    if (x == 36) pixels[i].object = KnownPixel::kNothing;
  }
  maps::fill_in(pixels, kWidth);
  for (const KnownPixel& pixel : pixels) {
    if (pixel.object == KnownPixel::kNothing) continue;
    EXPECT_EQ(pixel.v, pixel.object == 0 ? 0.25F : 0.75F);
  }
}

// Pixels are known at every second, fourth or eighth place: between four known pixels V is bilinear, so that a ramp is
// restored exactly.
TEST(MapsFillIn, BetweenFourPixelsIsBilinear) {
  constexpr std::uint32_t kWidth = 65;
  std::mt19937 random(3);
  for (const std::uint32_t step : {2U, 4U, 8U}) {
    std::vector<KnownPixel> pixels(std::size_t{kWidth} * kWidth), ramp(pixels.size());
    for (std::uint32_t i = 0; i < pixels.size(); ++i) {
      const std::uint32_t x = i % kWidth, y = i / kWidth;
      pixels[i].object = ramp[i].object = 2;
      pixels[i].known = ramp[i].known = x % step == 0 && y % step == 0;
      pixels[i].v = static_cast<float>(random() % 100) / 100;
      ramp[i].v = ramp[i].known ? 0.1F + 0.005F * static_cast<float>(x) + 0.006F * static_cast<float>(y) : 0;
    }
    const std::vector<KnownPixel> before = pixels;
    maps::fill_in(pixels, kWidth);
    maps::fill_in(ramp, kWidth);
    const auto known = [&](std::uint32_t x, std::uint32_t y) { return static_cast<double>(before[y * kWidth + x].v); };
    for (std::uint32_t y = 0; y < kWidth; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        EXPECT_NEAR(ramp[y * kWidth + x].v, 0.1 + 0.005 * x + 0.006 * y, 1e-6) << step << " " << x << " " << y;
        if (step > 2 || x % 2 == 0 || y % 2 == 0) continue;
        const double mean = (known(x - 1, y - 1) + known(x + 1, y - 1) + known(x - 1, y + 1) + known(x + 1, y + 1)) / 4;
        EXPECT_NEAR(pixels[y * kWidth + x].v, mean, 1e-6);
      }
    }
  }
}

// In a row of pixels 0 to 3 all but pixel 1 are known. In the coarser level pixel 0 keeps its place, and pixels 2 and 3
// lie at 2.5: these are 1 and 1.5 away from pixel 1, and tents 2 wide weight them by 1 / 2 and 1 / 4.
TEST(MapsFillIn, TentsAreTwoPixelsOfTheirLevelWide) {
  std::vector<KnownPixel> row(4, KnownPixel{0, true, 1});
  row[0].v = 0;
  row[1].known = false;
  maps::fill_in(row, 4);
  EXPECT_NEAR(row[1].v, 1.0 / 3, 1e-7);
}

}  // namespace
}  // namespace penumbra::tests
