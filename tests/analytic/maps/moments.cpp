// SPDX-License-Identifier: Apache-2.0
// Tests vssm against its twin in double, and against closed forms of Chebyshev's bound.

#include "maps/filters/methods.hpp"

#include "tests/analytic/maps/vssm_stage.hpp"

#include <array>

namespace penumbra::tests {
namespace {

TEST_F(Vssm, IsItsTwin) {
  const std::vector<decltype(scenes::AreaLight::shape)> shapes{
      scenes::Rectangle{{0, 4, 0}, {0.6, 0, 0}, {0, 0, 0.3}}, scenes::Disk{{0.2, 4, 0}, {0, -1, 0}, 0.5},
      scenes::Polygon{{{-0.5, 4, -0.5}, {0.6, 4, -0.4}, {0.1, 4, 0.6}}},
      scenes::Rectangle{
          {0, 4, 0}, {2.5, 0, 0}, {0, 0, 3}}};  // the near plane is the light's radius away, not at the nearest caster
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
      if (k == 3 && settings.moments != "vsm") continue;  // this light's windows are the whole map: slow twins
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
        // Where a mean depth of the search equals the receiver's, rounding decides whether anything blocks: V may then
        // be anything between the filter's result and 1. A series' functions have 12 digits.
        off += std::abs(v - is) > 2e-4 ? 1 : 0;
      }
      fmt::print("{} {} of light {}: {} receivers, {} in penumbra, {} off, mean {:.2e}\n", settings.moments,
                 settings.subdivision, k, receivers, soft, off, sum / static_cast<double>(receivers));
      EXPECT_GT(soft, receivers / 20) << settings.moments;
      EXPECT_LE(off, receivers / 100) << settings.moments << " of light " << k;
    }
  }
}

// Receivers in the air at all heights, so that every layer is used.
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

// Where most of a window is farther than the receiver, the mean of exponentials is inaccurate, and texels are compared
// with the receiver one by one: in a window wider than 16 only every few texels, and only those inside the map.
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

// Eisemann et al. 2009, section 4.2.1: one flat blocker and one flat receiver, both parallel to the light, give two
// depths, for which the bound is the exact share.
TEST_F(Vssm, OfTwoDepthsTheBoundIsTheShare) {
  const Stage stage = floor_stage({{2, -4, 0.1}});
  const VssmSettings settings{.moments = "vsm", .bias = 0};
  const Masks found = run(maps::make_vssm, stage, options_of(settings, 512));
  const CentreMaps maps(device(), stage, 512, beside(stage));
  const VssmTwin twin(maps, stage, settings);
  std::size_t soft = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    // The search's window equals the filter's, because the near plane is at the blocker: the share is that of the
    // texels in it.
    const VssmTwin::Answer answer = twin(i);
    const double share = answer.no_blockers ? 1 : answer.pcf;
    // A lit share f gives (f (1 − f) Δ² + ε) / ((1 − f) Δ² + ε), with Δ half of the range of heights and ε the least
    // variance, 2⁻²²: off by less than 2⁻²⁰ / (1 − f).
    EXPECT_NEAR(found.visibility[i], share, share < 1 ? 0x1p-20 / (1 - share) + 1e-5 : 1e-6) << i;
    soft += share > 0 && share < 1 ? 1 : 0;
  }
  EXPECT_GT(soft, 300U);
}

// Eisemann et al. 2009, section 4.2.1: "the correct shadow could be darker, but never brighter".
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

// Eisemann et al. 2009, figure 4.5 as a closed form. A sheet at z1 is over one at z2 that covers everything, seen from
// z3; Δ = z2 − z1 and D = z3 − z2. Where the upper sheet fills q of the window the bound is q (1 − q) Δ² / (q (1 − q)
// Δ² + (D + q Δ)²). Its maximum, at q = D / (Δ + 2 D), is 1 / (1 + 2 D / Δ)².
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
      // Everything is umbra. With 48 columns over a window's width the best q is met within 1/20, and V is flat there:
      // by V'' ≈ −2 worst (1 + 2 D / Δ)², 1/20 off the best q costs less than 2 % of the maximum.
      if (repaired) {
        EXPECT_EQ(most, 0) << upper << " over " << lower;
      } else {
        EXPECT_LE(most, worst + 1e-4) << upper << " over " << lower;
        EXPECT_GT(most, 0.98 * worst) << upper << " over " << lower;
      }
    }
  }
}

}  // namespace
}  // namespace penumbra::tests
