// SPDX-License-Identifier: Apache-2.0
// Tests the properties of each kind of moments for a window, cut into parts or whole, and for a fixed window.

#include "maps/filters/methods.hpp"

#include "tests/analytic/maps/vssm_stage.hpp"

#include <array>

namespace penumbra::tests {
namespace {

// Eisemann et al. 2009, section 4.2.3: shifted to its first maximum and damped, the series comes closer to counting the
// same texels with each term.
TEST_F(Vssm, MoreTermsOfTheSeriesComeCloserToCounting) {
  constexpr std::uint32_t kTexels = 64;
  const Stage stage(scene_with(scenes::Rectangle{{0, 4, 0}, {0.6, 0, 0}, {0, 0, 0.4}}), 24, 24, light_samples(1));
  const CentreMaps maps(device(), stage, kTexels, beside(stage));
  double least = 1, last = 1;
  for (const std::uint32_t terms : {4U, 8U, 16U}) {
    const VssmSettings settings{.moments = "csm", .count = terms};
    const Masks found = run(maps::make_vssm, stage, options_of(settings, kTexels));
    const VssmTwin twin(maps, stage, settings);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!visibility::is_receiver(stage.floats, stage.light, stage.samples, i)) continue;
      const VssmTwin::Answer answer = twin(i);
      if (answer.no_blockers) continue;
      sum += std::pow(static_cast<double>(found.visibility[i]) - answer.pcf, 2);
      ++count;
    }
    ASSERT_GT(count, 50U);
    const double error = std::sqrt(sum / static_cast<double>(count));
    fmt::print("csm of {} terms: RMSE {:.4f} against counting\n", terms, error);
    last = error;
    if (terms < 16) least = std::min(least, error);
  }
  EXPECT_LT(last, 0.9 * least);
  EXPECT_LT(last, 0.07);
}

// The nearest caster's shadow on the deepest receiver: their heights are as far apart as possible, and the series must
// not have jumped back there. The series oscillates: beyond its first maximum a sum of sines is never farther below a
// step of 1 than 1/2 - Si(2 pi) / pi = 0.0486 (Gibbs). It would be 0.37 if heights spanned all of half a period.
TEST_F(Vssm, TheSeriesEndsBeforeItJumpsBack) {
  const Stage stage = floor_stage({{2, -4, 0.1}});
  for (const std::uint32_t terms : {1U, 2U, 4U, 16U}) {
    const VssmSettings settings{.moments = "csm", .count = terms, .offset = 0, .damping = 0};
    const Masks found = run(maps::make_vssm, stage, options_of(settings));
    std::size_t umbra = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      // The board is half way to the light, whose half-size is 0.5: the umbra ends at 2 * 0.1 - 0.5. A texel is 0.05
      // wide.
      if (stage.samples.p[i].x + stage.floats.origin.x > -0.4) continue;
      ++umbra;
      EXPECT_LT(found.visibility[i], 0.0486 + 0x1p-10) << terms << " terms";
    }
    EXPECT_GT(umbra, 500U);
  }
}

// At a plane's own height the series is exactly 1/2 (Eisemann et al. 2009, figure 4.8), unless its scale makes that 1
// in a filter of a fixed window, or its scale or offset makes the search find no blocker.
TEST_F(Vssm, ALitPlaneIsHalfDarkUntilTheSeriesIsScaledOrShifted) {
  const Stage stage = floor_stage({{2, -4, 0.1}});
  struct Series {
    double scale, offset, v;
    std::uint32_t window;
  };
  for (const Series& series : {Series{1, 0, 0.5, 0}, Series{2, 0, 1, 0}, Series{1, 1, 1, 0}, Series{1, 0, 0.5, 3},
                               Series{1.5, 0, 0.75, 3}, Series{2, 0, 1, 3}, Series{1, 1, 1, 3}}) {
    for (const std::uint32_t terms : {1U, 4U, 16U}) {
      if (terms == 1 && series.offset > 0) continue;  // one term cuts off its span
      const VssmSettings settings{.moments = "csm",
                                  .count = terms,
                                  .scale = series.scale,
                                  .bias = 0,
                                  .offset = series.offset,
                                  .damping = 0,
                                  .window = series.window};
      const Masks found = run(maps::make_vssm, stage, options_of(settings));
      std::size_t plane = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        // Fully lit, with nothing nearer than the floor in the search's window either.
        const double x = stage.samples.p[i].x + stage.floats.origin.x;
        if (x < 1.0) continue;
        ++plane;
        // The functions have 12 digits; the sum of 2 / c_k over the terms is below 2.
        EXPECT_NEAR(found.visibility[i], series.v, series.scale * 0x1p-10) << terms << " terms, scale " << series.scale;
      }
      EXPECT_GT(plane, 100U);
    }
  }
}

// A board in the air looks past other boards down to the floor: the mean depth of its window is behind it, so the bound
// is 1 whatever is in front. Cut into parts (Yang et al. 2010), the result is nearly that of counting the same texels.
TEST_F(Vssm, PartsSeeWhatBlocksBeforeADeepFloor) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
  add_quad(scene, {0, 2, 0}, {0.25, 0, 0}, {0, 0, 0.25}).casts_shadow = false;  // carries the samples
  for (const double x : {-0.3, 0.3}) add_quad(scene, {x, 2.6, 0}, {0.08, 0, 0}, {0, 0, 1});
  scene.lights.push_back(ceiling_light(4, 0.6));
  scene.cameras.push_back(camera({0, 6, 4}, {0, 2, 0}, 40));
  const Stage stage(scene, 24, 24, light_samples(1), grid_samples(24, {0, 2, 0}, {0.2, 0, 0}, {0, 0, 0.2}, {0, 1, 0}));
  const CentreMaps maps(device(), stage, 256, beside(stage));
  const auto error = [&](const char* subdivision) {
    const VssmSettings settings{.moments = "vsm", .subdivision = subdivision};
    const Masks found = run(maps::make_vssm, stage, options_of(settings, 256));
    const VssmTwin twin(maps, stage, settings);
    double sum = 0;
    std::size_t lit = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      // The light hidden by each bar: seen from p, the light is 1.2 wide at 2 above p, and the bars are at 0.6 of these
      // 2.
      const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
      double hidden = 0;
      for (const double x : {-0.3, 0.3}) {
        const double f = 2 / 0.6, from = p.x + (x - 0.08 - p.x) * f, to = p.x + (x + 0.08 - p.x) * f;
        hidden += std::max(std::min(to, 0.6) - std::max(from, -0.6), 0.0) / 1.2;
      }
      sum += std::pow(found.visibility[i] - (1 - hidden), 2);
      lit += found.visibility[i] == 1 && hidden > 0.2 ? 1 : 0;
    }
    fmt::print("{}: RMSE {:.4f} against the closed form, {} of {} lit\n", subdivision,
               std::sqrt(sum / static_cast<double>(stage.samples.size())), lit, stage.samples.size());
    return std::sqrt(sum / static_cast<double>(stage.samples.size()));
  };
  const double none = error("none"), uniform = error("uniform"), adaptive = error("adaptive");
  EXPECT_GT(none, 0.12);
  EXPECT_LT(uniform, 0.4 * none);
  EXPECT_LT(adaptive, 0.7 * none);
}

// For two depths, a share f of which is at the receiver's, the bound of the rising exponential is f, too, if their
// variance is not below the least variance L = (c b)^2, which stands for the bias b; otherwise it is at most L / (1 -
// f)^2 above f. (A bias of the receiver's height would multiply the lit part by exp(c b).)
TEST_F(Vssm, OfTwoDepthsTheBoundOfExponentialsIsTheShare) {
  const Stage stage = floor_stage({{2, -4, 0.1}});
  const CentreMaps maps(device(), stage, 256, beside(stage));
  for (const double bias : {0.0, 0.5, 1.0}) {
    const VssmSettings settings{.moments = "evsm", .exponent = 80, .bias = bias};
    const Masks found = run(maps::make_vssm, stage, options_of(settings, 256));
    const VssmTwin twin(maps, stage, settings);
    // Heights run from 2 to 4: on a level floor b is half of `bias` texels at depth 4 (half a texel less for the
    // window's frame).
    const auto view = maps.fitted.views.front().side[0];
    const double texel = static_cast<double>(view.upper.x - view.lower.x) / 256, b = bias * texel * 4 / 2;
    const double least = std::max(std::pow(40 * b, 2), 1600 * 0x1p-22) * 1.01;
    std::size_t soft = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const VssmTwin::Answer answer = twin(i);
      const double share = answer.no_blockers ? 1 : answer.pcf;
      if (share > 0.9) continue;
      EXPECT_GE(found.visibility[i], share - 1e-4) << i;
      EXPECT_LE(found.visibility[i], share + least / std::pow(1 - share, 2) + 1e-4) << i << ", bias " << bias;
      soft += share > 0 ? 1 : 0;
    }
    EXPECT_GT(soft, 200U);
  }
}

// V on a level floor does not depend on whether the floor is drawn in the map: nothing there is nearer. (Texels without
// a caster once lay 1/1024 of the depth behind the floor, which exp(80 t) counted as 1.17 times lit.)
TEST_F(Vssm, AFloorThatCastsNothingIsNoBrighter) {
  const auto with = [&](bool casts, const VssmSettings& settings) {
    scenes::Scene scene = under_strips(std::vector<Strip>{{2, -0.7, 0.1}});
    scene.objects[0].casts_shadow = casts;
    const Stage stage(scene, 48, 48, light_samples(1),
                      grid_samples(48, {0, 0, 0}, {1.2, 0, 0}, {0, 0, 1.2}, {0, 1, 0}));
    return run(maps::make_vssm, stage, options_of(settings, 256)).visibility;
  };
  for (const VssmSettings& settings : {VssmSettings{.moments = "esm"},
                                       {.moments = "esm", .fallback = false},
                                       {.moments = "evsm"},
                                       {.moments = "vsm"}}) {
    const std::vector<float> drawn = with(true, settings), empty = with(false, settings);
    // Heights are rounded to 2^-22 of their range, and their exponentials to 80 times that.
    for (std::size_t i = 0; i < drawn.size(); ++i)
      EXPECT_NEAR(drawn[i], empty[i], 1e-4) << settings.moments << " " << i;
    EXPECT_GT(std::ranges::count_if(drawn, [](float v) { return v > 0.1F && v < 0.9F; }), 300) << settings.moments;
  }
}

// With a fixed window, moments approximate pcf (Eisemann et al. 2009, chapter 4). For two depths bounds and
// exponentials equal the count, except for the least variance L: they are at most L / (1 - f)^2 above it, where 1 - f
// is at least a 49th. L is 2^-22 for vsm, 16 times that for four layers, and (40 b)^2 for evsm, with b a twentieth of a
// texel's depth, 1.3e-4 of the range. The series oscillates.
TEST_F(Vssm, AFilterOfTexelsIsPcf) {
  const Stage stage = floor_stage({{2, -4, 0.1}});
  const Masks counted = run(maps::make_pcf, stage, {{"size", "128"}, {"window", "7"}});
  EXPECT_GT(std::ranges::count(counted.visibility, 0.0F), 100);
  struct Claim {
    const char *moments, *bias;
    double bound;
  };
  // A bias moves the receiver toward the mean, which increases a bound: it is 0 where the tolerance is derived without
  // one.
  for (const auto& [moments, bias, bound] :
       {Claim{"vsm", "0", 1e-3}, Claim{"lvsm", "0", 1e-2}, Claim{"evsm", "0.1", 0.08}, Claim{"esm", "0.1", 1e-3},
        Claim{"csm", "0.1", 0.1}}) {
    const Masks found =
        run(maps::make_vssm, stage, {{"size", "128"}, {"window", "7"}, {"moments", moments}, {"bias", bias}});
    double worst = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      worst = std::max(worst, static_cast<double>(std::abs(found.visibility[i] - counted.visibility[i])));
    }
    EXPECT_LT(worst, bound) << moments;
  }
}

// Annen, Mertens et al. 2008, section 3.4: the conservative classifier compares all texels of windows that hold a texel
// behind the receiver, so that V is never above what the exponential's mean gives.
TEST_F(Vssm, TheConservativeClassifierFindsMoreThanTheMean) {
  const Stage stage(scene_with(scenes::Rectangle{{0, 4, 0}, {0.6, 0, 0}, {0, 0, 0.4}}), 32, 32, light_samples(1));
  const auto with = [&](const char* classifier) {
    return run(maps::make_vssm, stage, {{"size", "128"}, {"moments", "esm"}, {"classifier", classifier}}).visibility;
  };
  const std::vector<float> mean = with("mean"), farthest = with("farthest");
  std::size_t darker = 0, brighter = 0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    darker += farthest[i] < mean[i] - 0.01F ? 1 : 0;
    brighter += farthest[i] > mean[i] + 0.1F ? 1 : 0;  // due to another mean blocker
  }
  EXPECT_GT(darker, 0U);
  EXPECT_EQ(brighter, 0U);
}

// Lauritzen 2007: on a sloped plane a quarter of the square of the depth change per texel is added to each texel's
// squared depth, so that the bound of a plane that shades itself is larger.
TEST_F(Vssm, TheSlopeOfATexelWidensTheBound) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 1, 0}, {0, 0, -2});
  scene.lights.push_back(ceiling_light(4, 1e-6));
  scene.cameras.push_back(camera({0, 3, 3}, {0, 0, 0}));
  const Stage stage(scene, 32, 32, light_samples(1));
  const auto with = [&](const char* slope) {
    return run(maps::make_vssm, stage,
               {{"size", "64"},
                {"bias", "0"},
                {"receiverPlane", "off"},
                {"subdivision", "none"},
                {"window", "1"},
                {"slope", slope}})
        .visibility;
  };
  // A window of one texel: a receiver that is behind the texel's centre by a share x of the texel's depth change has V
  // = 1/4 / (1/4 + x²), at least 1/2 because x is at most 1/2. Without the slope V is 0 there, except for the least
  // variance.
  const std::vector<float> with_slope = with("on"), without = with("off");
  std::size_t dark = 0, still_dark = 0;  // still_dark: at the plane's border
  for (std::size_t i = 0; i < without.size(); ++i) {
    if (!visibility::is_receiver(stage.floats, stage.light, stage.samples, i)) continue;
    dark += without[i] < 0.3F ? 1 : 0;
    still_dark += with_slope[i] < 0.49F ? 1 : 0;
  }
  EXPECT_GT(dark, 100U);
  EXPECT_LT(still_dark, dark / 20);
}

// Eisemann et al. 2009, section 4.2.4: a texel behind the receiver makes the exponential more than 1. Over a level
// floor there are none; on a tilted one there are some, and also where the floor is visible past a caster's outline.
TEST_F(Vssm, TheExponentialFailsWhereTexelsLieBehindTheReceiver) {
  const auto differing = [](const Stage& stage) {
    const VssmSettings with{.moments = "esm"}, without{.moments = "esm", .fallback = false};
    const Masks a = run(maps::make_vssm, stage, options_of(with)), b = run(maps::make_vssm, stage, options_of(without));
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.visibility.size(); ++i) {
      count += std::abs(a.visibility[i] - b.visibility[i]) > 1e-3F ? 1 : 0;
      EXPECT_LE(a.visibility[i], b.visibility[i] + 1e-3F);  // without the fallback V is 1 there
    }
    return static_cast<double>(count) / static_cast<double>(a.visibility.size());
  };
  EXPECT_EQ(differing(floor_stage({{2, -4, 0.1}})), 0);
  const double solid =
      differing(Stage(scene_with(scenes::Rectangle{{0, 4, 0}, {0.6, 0, 0}, {0, 0, 0.4}}), 48, 48, light_samples(1)));
  fmt::print("esm: {:.1f} % of pixels need the fallback around a sphere and boards\n", 100 * solid);
  EXPECT_GT(solid, 0.01);
}

// For a light without size each window is one texel, the receiver's own.
TEST_F(Vssm, APointLightIsTheShadowMap) {
  scenes::Scene scene = under_strips({{2, -0.7, 0.1}}, 1e-6);
  const Stage stage(scene, 64, 64, light_samples(1), grid_samples(64, {0, 0, 0}, {1.9, 0, 0}, {0, 0, 1.9}, {0, 1, 0}));
  const Masks hard = run(maps::make_shadow_map, stage, {{"size", "128"}});
  for (const char* moments : {"vsm", "lvsm", "evsm", "esm"}) {
    for (const char* filter : {"sat", "n-buffer"}) {
      const Masks found = run(maps::make_vssm, stage, {{"size", "128"}, {"moments", moments}, {"filter", filter}});
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        // The board is half of the range of heights away: the least variance, 2⁻²² of the warped range, leaves less
        // than 2⁻²⁰ of the light, because Δ² ≥ 1/4 (with 16 layers or 40 e-folds).
        EXPECT_NEAR(found.visibility[i], hard.visibility[i], 1e-4) << moments << " " << filter << " at " << i;
      }
    }
  }
  const Masks taps = run(maps::make_pcss, stage, {{"size", "128"}});
  EXPECT_EQ(taps.visibility, hard.visibility);
}

// The other filters approximate the same means.
TEST_F(Vssm, PyramidsAndWindowsComeNearTheTables) {
  const Stage stage(scene_with(scenes::Rectangle{{0, 4, 0}, {0.6, 0, 0}, {0, 0, 0.3}}), 48, 48, light_samples(1));
  for (const char* moments : {"vsm", "lvsm", "evsm", "csm", "esm"}) {
    const auto with = [&](const char* filter) {
      return run(
          maps::make_vssm, stage,
          {{"size", "100"}, {"moments", moments}, {"filter", filter}, {"exponent", "30"}, {"subdivision", "none"}});
    };
    const Masks table = with("sat"), windows = with("n-buffer"), pyramid = with("mip");
    const auto receives = [&](std::size_t i) {
      return visibility::is_receiver(stage.floats, stage.light, stage.samples, i);
    };
    const double of_windows =
        rmse(stage, receives, [&](std::size_t i) { return windows.visibility[i] - table.visibility[i]; });
    const double of_pyramid =
        rmse(stage, receives, [&](std::size_t i) { return pyramid.visibility[i] - table.visibility[i]; });
    fmt::print("{}: RMSE against tables: n-buffer {:.4f}, mip {:.4f}\n", moments, of_windows, of_pyramid);
    EXPECT_LT(of_windows, 0.05) << moments;
    EXPECT_LT(of_pyramid, 0.12) << moments;
    EXPECT_GT(of_pyramid, of_windows) << moments;
  }
}

}  // namespace
}  // namespace penumbra::tests
