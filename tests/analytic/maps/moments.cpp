// vssm: against its twin in double, against the closed forms of Chebyshev's bound, and what each kind of moments
// promises.

#include "maps/filters/methods.hpp"

#include "tests/analytic/maps/vssm_twin.hpp"

#include <fmt/format.h>

#include <array>

namespace penumbra::tests {
namespace {

constexpr std::uint32_t kMapSize = 128;

/// What the methods ask their map to hold beside the receivers.
glm::dvec2 beside(const Stage& stage) {
  return maps::half_extent(stage.light, maps::light_basis(stage.light)) / maps::half_width(stage.light);
}

visibility::MethodOptions options_of(const VssmSettings& settings, std::uint32_t size = kMapSize) {
  return {{"size", fmt::format("{}", size)},
          {"moments", settings.moments},
          {"layers", fmt::format("{}", settings.moments == "lvsm" ? settings.count : 4)},
          {"terms", fmt::format("{}", settings.moments == "csm" ? settings.count : 16)},
          {"exponent", fmt::format("{}", settings.exponent)},
          {"scale", fmt::format("{}", settings.scale)},
          {"leak", fmt::format("{}", settings.leak)},
          {"bias", fmt::format("{}", settings.bias)},
          {"offset", fmt::format("{}", settings.offset)},
          {"damping", fmt::format("{}", settings.damping)},
          {"subdivision", settings.subdivision},
          {"cuts", fmt::format("{}", settings.cuts)},
          {"window", fmt::format("{}", settings.window)},
          {"receiverPlane", settings.receiver_plane ? "on" : "off"},
          {"leakCut", settings.smooth_leak ? "smoothstep" : "linear"},
          {"fallback", settings.fallback ? "on" : "off"}};
}

/// A floor, a sphere and two boards above it, one of them tilted.
scenes::Scene scene_with(const decltype(scenes::AreaLight::shape)& shape) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
  add_object(scene, "sphere", sphere({0.5, 0.8, 0.3}, 0.5, 8));
  add_quad(scene, {-0.8, 1.5, 0}, {0.4, 0, 0}, {0, 0, 0.9});
  add_quad(scene, {-0.5, 0.5, -0.6}, {0.5, 0.2, 0}, {0, 0, 0.5});
  scene.lights.push_back(ceiling_light(4, 0.5));
  scene.lights.back().shape = shape;
  scene.cameras.push_back(camera({0, 5, 4}, {0, 0, 0}, 40));
  return scene;
}

class Vssm : public MapsTest {};

TEST_F(Vssm, IsItsTwin) {
  const std::vector<decltype(scenes::AreaLight::shape)> shapes{
      scenes::Rectangle{{0, 4, 0}, {0.6, 0, 0}, {0, 0, 0.3}}, scenes::Disk{{0.2, 4, 0}, {0, -1, 0}, 0.5},
      scenes::Polygon{{{-0.5, 4, -0.5}, {0.6, 4, -0.4}, {0.1, 4, 0.6}}},
      scenes::Rectangle{
          {0, 4, 0}, {2.5, 0, 0}, {0, 0, 3}}};  // the near plane is its radius away, not the nearest caster
  const std::vector<VssmSettings> all{
      {.moments = "vsm", .subdivision = "uniform"},
      {.moments = "vsm"},
      {.moments = "vsm", .leak = 0.2, .bias = 3, .subdivision = "adaptive", .cuts = 2, .smooth_leak = true},
      {.moments = "vsm", .subdivision = "uniform", .cuts = 2, .receiver_plane = false},
      {.moments = "vsm", .window = 6},
      {.moments = "lvsm", .count = 5, .subdivision = "uniform", .cuts = 1},
      {.moments = "evsm", .exponent = 40},
      {.moments = "evsm", .exponent = 40, .subdivision = "adaptive"},
      {.moments = "esm"},
      {.moments = "csm", .count = 3},
      {.moments = "csm", .count = 4, .scale = 2, .offset = 0.5, .damping = 0},
      {.moments = "csm", .count = 4, .scale = 2, .window = 5},
      {.moments = "esm", .exponent = 30, .fallback = false}};
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const Stage stage(scene_with(shapes[k]), 24, 24, light_samples(1));
    const CentreMaps maps(device(), stage, kMapSize, beside(stage));
    ASSERT_EQ(maps.fitted.faces, 1U);
    for (const VssmSettings& settings : all) {
      if (k == 3 && settings.moments != "vsm") continue;  // its windows are the whole map, and twins are slow
      const Masks found = run(maps::make_vssm, stage, options_of(settings));
      const VssmTwin twin(maps, stage, settings);
      std::size_t receivers = 0, off = 0, soft = 0;
      double sum = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        if (!visibility::is_receiver(stage.floats, stage.light, stage.samples, i)) continue;
        ++receivers;
        const double v = twin(i).v, is = found.visibility[i];
        soft += v > 0.02 && v < 0.98 ? 1 : 0;
        sum += std::abs(v - is);
        // Where a mean is at the receiver's own height within rounding, the search says blocked or not by a hair, and V
        // may be anything between the filter's answer and 1. A series' functions have 12 digits.
        off += std::abs(v - is) > 2e-4 ? 1 : 0;
      }
      fmt::print("{} {} of light {}: {} receivers, {} in penumbra, {} off, mean {:.2e}\n", settings.moments,
                 settings.subdivision, k, receivers, soft, off, sum / static_cast<double>(receivers));
      EXPECT_GT(soft, receivers / 20) << settings.moments;
      EXPECT_LE(off, receivers / 100) << settings.moments << " of light " << k;
    }
  }
}

// Receivers in the air, at all heights: whichever layer they are in.
TEST_F(Vssm, LayersAreTheirTwinsAtAnyHeight) {
  const Stage stage(scene_with(scenes::Rectangle{{0, 4, 0}, {0.6, 0, 0}, {0, 0, 0.3}}), 24, 24, light_samples(1),
                    grid_samples(24, {-0.2, 0.6, 0.1}, {0.7, 0, 0}, {0, 0.58, 0}, {0, 1, 0}));
  const CentreMaps maps(device(), stage, kMapSize, beside(stage));
  for (const std::uint32_t layers : {5U, 16U}) {
    const VssmSettings settings{.moments = "lvsm", .count = layers};
    const Masks found = run(maps::make_vssm, stage, options_of(settings));
    const VssmTwin twin(maps, stage, settings);
    std::size_t off = 0, soft = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const double v = twin(i).v;
      soft += v > 0.02 && v < 0.98 ? 1 : 0;
      off += std::abs(v - static_cast<double>(found.visibility[i])) > 2e-4 ? 1 : 0;
    }
    EXPECT_GT(soft, 50U);
    EXPECT_LE(off, stage.samples.size() / 100) << layers;
  }
}

// Where a window holds more that is farther than the receiver than what is nearer, exponentials are compared texel by
// texel: of windows wider than 16 texels some, and of those that reach beside the map what is in it.
TEST_F(Vssm, TexelByTexelItIsItsTwinAtAnyHeight) {
  const Stage stage(scene_with(scenes::Rectangle{{0, 4, 0}, {0.9, 0, 0}, {0, 0, 0.6}}), 24, 24, light_samples(1),
                    grid_samples(24, {0, 0.6, 0}, {1.9, 0, 0}, {0, 0.58, 0}, {0, 1, 0}));
  for (const double exponent : {3.0, 6.0, 10.0, 30.0, 80.0}) {
    const CentreMaps maps(device(), stage, kMapSize, beside(stage));
    const VssmSettings settings{.moments = "esm", .exponent = exponent};
    const Masks found = run(maps::make_vssm, stage, options_of(settings));
    const VssmTwin twin(maps, stage, settings);
    std::size_t off = 0, soft = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const double v = twin(i).v;
      soft += v > 0.02 && v < 0.98 ? 1 : 0;
      off += !(std::abs(v - static_cast<double>(found.visibility[i])) <= 2e-4) ? 1 : 0;
    }
    fmt::print("exponent {}: {} in penumbra, {} off\n", exponent, soft, off);
    EXPECT_GT(soft, 50U);
    EXPECT_LE(off, stage.samples.size() / 100) << exponent;
  }
}

/// A floor under half-planes parallel to it and to the light.
struct Strip {
  double height, x0, x1;
};
scenes::Scene under_boards(const std::vector<Strip>& boards, double light = 0.5) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, 2});
  for (const Strip& board : boards) {
    add_quad(scene, {(board.x0 + board.x1) / 2, board.height, 0}, {(board.x1 - board.x0) / 2, 0, 0}, {0, 0, 3})
        .receives_shadow = false;
  }
  scene.lights.push_back(ceiling_light(4, light));
  scene.cameras.push_back(camera({0, 1, 3}, {0, 0, 0}));
  return scene;
}

/// The floor's middle, 48 × 48.
Stage floor_stage(const std::vector<Strip>& boards, double light = 0.5) {
  return {under_boards(boards, light), 48, 48, light_samples(1),
          grid_samples(48, {0, 0, 0}, {1.2, 0, 0}, {0, 0, 1.2}, {0, 1, 0})};
}

// S4 4.2.1: one flat blocker and one flat receiver, both parallel to the light, are two depths, and of those the bound
// is the share itself.
TEST_F(Vssm, OfTwoDepthsTheBoundIsTheShare) {
  const Stage stage = floor_stage({{2, -4, 0.1}});
  const VssmSettings settings{.moments = "vsm", .bias = 0};
  const Masks found = run(maps::make_vssm, stage, options_of(settings, 512));
  const CentreMaps maps(device(), stage, 512, beside(stage));
  const VssmTwin twin(maps, stage, settings);
  std::size_t soft = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    // The search's window is the filter's, since the near plane is the blocker's: the share is of the texels under it.
    const VssmTwin::Answer answer = twin(i);
    const double share = answer.no_blockers ? 1 : answer.pcf;
    // A share f lit gives f (1 − f) Δ² + ε over (1 − f) Δ² + ε, Δ half of the range of heights and ε the least
    // variance, 2⁻²²: off by less than 2⁻²⁰ / (1 − f).
    EXPECT_NEAR(found.visibility[i], share, share < 1 ? 0x1p-20 / (1 - share) + 1e-5 : 1e-6) << i;
    soft += share > 0 && share < 1 ? 1 : 0;
  }
  EXPECT_GT(soft, 300U);
}

// S4 4.2.1: "the correct shadow could be darker, but never brighter".
TEST_F(Vssm, TheBoundIsNeverDarkerThanCountingTheSameTexels) {
  for (const char* moments : {"vsm", "lvsm", "evsm"}) {
    const Stage stage(scene_with(scenes::Rectangle{{0, 4, 0}, {0.6, 0, 0}, {0, 0, 0.4}}), 32, 32, light_samples(1));
    const VssmSettings settings{.moments = moments, .count = std::string(moments) == "lvsm" ? 4U : 1U, .exponent = 40};
    const Masks found = run(maps::make_vssm, stage, options_of(settings));
    const CentreMaps maps(device(), stage, kMapSize, beside(stage));
    const VssmTwin twin(maps, stage, settings);
    std::size_t brighter = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!visibility::is_receiver(stage.floats, stage.light, stage.samples, i)) continue;
      const VssmTwin::Answer answer = twin(i);
      if (answer.no_blockers || answer.v < answer.pcf) continue;  // the horizon may cut V
      const double is = found.visibility[i];
      EXPECT_GE(is, answer.pcf - 2e-3) << moments << " at pixel " << i;
      brighter += is > answer.pcf + 0.01 ? 1 : 0;
    }
    EXPECT_GT(brighter, 20U) << moments;
  }
}

// S4 figure 4.5 as a closed form. Of a sheet at z1 over one at z2 that covers all, seen from z3, with Δ = z2 − z1 and
// D = z3 − z2: the bound is q (1 − q) Δ² / (q (1 − q) Δ² + (D + q Δ)²) where the upper sheet fills q of the window,
// largest at q = D / (Δ + 2 D), where it is 1 / (1 + 2 D / Δ)².
TEST_F(Vssm, TheWorstLeakUnderTwoSheetsIsTheClosedForm) {
  for (const auto& [upper, lower] : {std::pair(2.5, 1.25), std::pair(2.5, 2.5 / 3), std::pair(2.0, 1.5)}) {
    const double delta = upper - lower, below = lower, worst = 1 / std::pow(1 + 2 * below / delta, 2);
    const Stage stage = floor_stage({{upper, -6, 0.02}, {lower, -6, 6}});
    for (const bool repaired : {false, true}) {
      const VssmSettings settings{.moments = "vsm", .leak = repaired ? worst + 1e-3 : 0, .bias = 0};
      const Masks found = run(maps::make_vssm, stage, options_of(settings, 256));
      const double most = *std::ranges::max_element(found.visibility);
      fmt::print("sheets at {} and {}: leak {:.5f}, closed form {:.5f}{}\n", upper, lower, most, worst,
                 repaired ? ", cut" : "");
      // Everything is umbra. 48 columns over a window's width: q is met within 1/20, and V is flat there: with
      // V'' ≈ −2 worst (1 + 2 D / Δ)² … below, 1/20 off the best q costs less than 2 % of it.
      if (repaired) {
        EXPECT_EQ(most, 0) << upper << " over " << lower;
      } else {
        EXPECT_LE(most, worst + 1e-4) << upper << " over " << lower;
        EXPECT_GT(most, 0.98 * worst) << upper << " over " << lower;
      }
    }
  }
}

// S4 4.2.3: shifted to its first maximum and damped, the series comes closer to counting the same texels with each
// term.
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

// The nearest caster's shadow on the deepest receiver: their heights are as far apart as heights are, and the series
// must not have jumped back there. It swings: beyond its first maximum a sum of sines is never further below a step of
// 1 than 1/2 - Si(2 pi) / pi = 0.0486 (Gibbs). Were heights to span all of half a period, 0.37 would be left.
TEST_F(Vssm, TheSeriesEndsBeforeItJumpsBack) {
  const Stage stage = floor_stage({{2, -4, 0.1}});
  for (const std::uint32_t terms : {1U, 2U, 4U, 16U}) {
    const VssmSettings settings{.moments = "csm", .count = terms, .offset = 0, .damping = 0};
    const Masks found = run(maps::make_vssm, stage, options_of(settings));
    std::size_t umbra = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      // The board is half way to the light, whose half is 0.5: the umbra ends at 2 * 0.1 - 0.5; a texel is 0.05 wide.
      if (stage.samples.p[i].x + stage.floats.origin.x > -0.4) continue;
      ++umbra;
      EXPECT_LT(found.visibility[i], 0.0486 + 0x1p-10) << terms << " terms";
    }
    EXPECT_GT(umbra, 500U);
  }
}

// S4 figure 4.8: at a plane's own height the series is exactly a half: of a filter of texels, which its scale makes 1,
// and of a light, whose search its scale or its offset tells that nothing blocks.
TEST_F(Vssm, ALitPlaneIsHalfDarkUntilTheSeriesIsScaledOrShifted) {
  const Stage stage = floor_stage({{2, -4, 0.1}});
  struct Way {
    double scale, offset, v;
    std::uint32_t window;
  };
  for (const Way& way : {Way{1, 0, 0.5, 0}, Way{2, 0, 1, 0}, Way{1, 1, 1, 0}, Way{1, 0, 0.5, 3}, Way{1.5, 0, 0.75, 3},
                         Way{2, 0, 1, 3}, Way{1, 1, 1, 3}}) {
    for (const std::uint32_t terms : {1U, 4U, 16U}) {
      if (terms == 1 && way.offset > 0) continue;  // its span is cut off
      const VssmSettings settings{.moments = "csm",
                                  .count = terms,
                                  .scale = way.scale,
                                  .bias = 0,
                                  .offset = way.offset,
                                  .damping = 0,
                                  .window = way.window};
      const Masks found = run(maps::make_vssm, stage, options_of(settings));
      std::size_t plane = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        // Lit whole, with nothing nearer than the floor in the search's window either.
        const double x = stage.samples.p[i].x + stage.floats.origin.x;
        if (x < 1.0) continue;
        ++plane;
        // 12 digits, and the sum of 2 / c_k over the terms: below 2.
        EXPECT_NEAR(found.visibility[i], way.v, way.scale * 0x1p-10) << terms << " terms, scale " << way.scale;
      }
      EXPECT_GT(plane, 100U);
    }
  }
}

// Where a board in the air looks past other boards down to the floor, the mean of its window lies behind it, and the
// bound is 1 whatever stands before. Cut into parts (Yang et al. 2010) it is nearly what counting the same texels says.
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
      // Each bar hides so much of the light: from p the light is 1.2 wide at 2 above it, the bars 0.6 of 2.
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

// Of two depths, one share f of them at the receiver's, the bound of the rising exponential is f, too, wherever their
// variance is not below the least one, L = (c b)^2, which the bias b stands for; elsewhere no more than L / (1 - f)^2
// above it. (A bias of the receiver's height would multiply the lit part by exp(c b).)
TEST_F(Vssm, OfTwoDepthsTheBoundOfExponentialsIsTheShare) {
  const Stage stage = floor_stage({{2, -4, 0.1}});
  const CentreMaps maps(device(), stage, 256, beside(stage));
  for (const double bias : {0.0, 0.5, 1.0}) {
    const VssmSettings settings{.moments = "evsm", .exponent = 80, .bias = bias};
    const Masks found = run(maps::make_vssm, stage, options_of(settings, 256));
    const VssmTwin twin(maps, stage, settings);
    // Heights run from 2 to 4: b is half of bias texels of depth 4 on a level floor; half a texel less of the window's
    // frame.
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

// Whether a level floor is drawn in the map or not, nothing there is nearer than it: V is the same. (Texels without a
// caster lay 1/1024 of the depth behind it, which exp(80 t) counted as 1.17 times lit.)
TEST_F(Vssm, AFloorThatCastsNothingIsNoBrighter) {
  const auto with = [&](bool casts, const VssmSettings& settings) {
    scenes::Scene scene = under_boards(std::vector<Strip>{{2, -0.7, 0.1}});
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
    // Heights are rounded to 2^-22 of their range, exponentials of them to 80 times that.
    for (std::size_t i = 0; i < drawn.size(); ++i)
      EXPECT_NEAR(drawn[i], empty[i], 1e-4) << settings.moments << " " << i;
    EXPECT_GT(std::ranges::count_if(drawn, [](float v) { return v > 0.1F && v < 0.9F; }), 300) << settings.moments;
  }
}

// S4 chapter 4: as filters of a fixed window the moments stand for pcf. Of two depths bounds and exponentials are the
// count, but for the least variance L: no more than L / (1 - f)^2 above it, 1 - f a 49th or more. Of vsm L is 2^-22, of
// four layers 16 times that, of evsm (40 b)^2 with b a twentieth of a texel's depth, 1.3e-4 of the range. The series
// swings.
TEST_F(Vssm, AFilterOfTexelsIsPcf) {
  const Stage stage = floor_stage({{2, -4, 0.1}});
  const Masks counted = run(maps::make_pcf, stage, {{"size", "128"}, {"window", "7"}});
  EXPECT_GT(std::ranges::count(counted.visibility, 0.0F), 100);
  struct Claim {
    const char *moments, *bias;
    double bound;
  };
  // A bias brings the receiver nearer to the mean, by which a bound grows: none where the bound is derived without one.
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

// Annen, Mertens et al. 2008, section 3.4: the conservative classifier compares all texels of windows that hold one
// behind the receiver, so V is never above what it is where the exponential's mean decides.
TEST_F(Vssm, TheConservativeClassifierFindsMoreThanTheMean) {
  const Stage stage(scene_with(scenes::Rectangle{{0, 4, 0}, {0.6, 0, 0}, {0, 0, 0.4}}), 32, 32, light_samples(1));
  const auto with = [&](const char* classifier) {
    return run(maps::make_vssm, stage, {{"size", "128"}, {"moments", "esm"}, {"classifier", classifier}}).visibility;
  };
  const std::vector<float> mean = with("mean"), farthest = with("farthest");
  std::size_t darker = 0, brighter = 0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    darker += farthest[i] < mean[i] - 0.01F ? 1 : 0;
    brighter += farthest[i] > mean[i] + 0.1F ? 1 : 0;  // by another mean blocker
  }
  EXPECT_GT(darker, 0U);
  EXPECT_EQ(brighter, 0U);
}

// Lauritzen 2007: on a plane that rises so much a texel the square of each texel has a quarter of the square more, so
// that the bound of a plane that shades itself is larger.
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
  // One texel: a receiver at the share x of the texel's height change behind its centre has V = 1/4 / (1/4 + x²), x up
  // to 1/2: no less than a half. Without slope V is 0 there, but for the least variance.
  const std::vector<float> with_slope = with("on"), without = with("off");
  std::size_t dark = 0, still_dark = 0;  // these at the plane's border
  for (std::size_t i = 0; i < without.size(); ++i) {
    if (!visibility::is_receiver(stage.floats, stage.light, stage.samples, i)) continue;
    dark += without[i] < 0.3F ? 1 : 0;
    still_dark += with_slope[i] < 0.49F ? 1 : 0;
  }
  EXPECT_GT(dark, 100U);
  EXPECT_LT(still_dark, dark / 20);
}

// S4 4.2.4: a texel behind the receiver makes the exponential more than 1. There are none over a level floor, and there
// are on a tilted one and where a caster's outline lets the floor behind it be seen.
TEST_F(Vssm, TheExponentialFailsWhereTexelsLieBehindTheReceiver) {
  const auto differing = [](const Stage& stage) {
    const VssmSettings with{.moments = "esm"}, without{.moments = "esm", .fallback = false};
    const Masks a = run(maps::make_vssm, stage, options_of(with)), b = run(maps::make_vssm, stage, options_of(without));
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.visibility.size(); ++i) {
      count += std::abs(a.visibility[i] - b.visibility[i]) > 1e-3F ? 1 : 0;
      EXPECT_LE(a.visibility[i], b.visibility[i] + 1e-3F);  // without it, V is 1 there
    }
    return static_cast<double>(count) / static_cast<double>(a.visibility.size());
  };
  EXPECT_EQ(differing(floor_stage({{2, -4, 0.1}})), 0);
  const double solid =
      differing(Stage(scene_with(scenes::Rectangle{{0, 4, 0}, {0.6, 0, 0}, {0, 0, 0.4}}), 48, 48, light_samples(1)));
  fmt::print("esm: {:.1f} % of pixels need the fallback around a sphere and boards\n", 100 * solid);
  EXPECT_GT(solid, 0.01);
}

// A light without size has windows of one texel, the receiver's own.
TEST_F(Vssm, APointLightIsTheShadowMap) {
  scenes::Scene scene = under_boards({{2, -0.7, 0.1}}, 1e-6);
  const Stage stage(scene, 64, 64, light_samples(1), grid_samples(64, {0, 0, 0}, {1.9, 0, 0}, {0, 0, 1.9}, {0, 1, 0}));
  const Masks hard = run(maps::make_shadow_map, stage, {{"size", "128"}});
  for (const char* moments : {"vsm", "lvsm", "evsm", "esm"}) {
    for (const char* filter : {"sat", "n-buffer"}) {
      const Masks found = run(maps::make_vssm, stage, {{"size", "128"}, {"moments", moments}, {"filter", filter}});
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        // The board is half of the range of heights away: the least variance, 2⁻²² of the warped range, leaves less
        // than 2⁻²⁰ of light in front of (16 layers' or 40 e-folds') Δ² ≥ 1/4.
        EXPECT_NEAR(found.visibility[i], hard.visibility[i], 1e-4) << moments << " " << filter << " at " << i;
      }
    }
  }
  const Masks taps = run(maps::make_pcss, stage, {{"size", "128"}});
  EXPECT_EQ(taps.visibility, hard.visibility);
}

// The other filters are approximations of the same means.
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
