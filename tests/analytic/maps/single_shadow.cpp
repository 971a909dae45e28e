// SPDX-License-Identifier: Apache-2.0
// Tests penumbrae made from one hard shadow: under the edge of a half-plane each paper's formula has a closed form, and
// so has its error.

#include "maps/products/light_shape.hpp"
#include "maps/single_shadow/flood.hpp"
#include "reference/methods.hpp"
#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/centre_maps.hpp"
#include "tests/analytic/maps/map_variants.hpp"

namespace penumbra::tests {
namespace {

using selftest::CentreMaps;

/// A half plane x > 0 at this height over a floor that casts nothing, under a square light at height 5.
scenes::Scene half_plane(double height, double light_half) {
  scenes::Scene scene = bare_floor(light_half);
  add_quad(scene, {6, height, 0}, {6, 0, 0}, {0, 0, -6}).receives_shadow = false;
  return scene;
}

double cubic(double t) {
  const double s = std::clamp(t, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

/// V near the edge of a half-plane; x > 0 is in the hard shadow.
struct UnderAnEdge {
  double light_half, height;
  double radius = 2 * light_half / std::sqrt(std::numbers::pi);  // of a disk of the light's area
  double z_v = 5 - height;
  double half_width = radius * (1 / z_v - 1.0 / 5);  // of the penumbra, as the light's centre sees it

  [[nodiscard]] double exact(double x) const {  // for the square light V is linear
    return std::clamp(0.5 - x / 5 / (2 * light_half * (1 / z_v - 1.0 / 5)), 0.0, 1.0);
  }
  [[nodiscard]] double both_sides(double x) const { return std::clamp(0.5 - x / 5 / (2 * half_width), 0.0, 1.0); }
  [[nodiscard]] double outside(double x) const { return x > 0 ? 0 : std::min(-x / 5 / half_width, 1.0); }
  [[nodiscard]] double inside(double x) const { return std::clamp(1 - x / 5 / half_width, 0.0, 1.0); }
  /// Wyman and Hansen: from the depths of the silhouette, the cone's surface and the floor.
  [[nodiscard]] double penumbra_map(double x) const {
    if (x > 0) return 0;
    const double cone = 1 / z_v + x / 5 / radius;
    return cone * 5 <= 1 ? 1 : cubic((1 / cone - z_v) / (5 - z_v));
  }
};

class MapsSingleShadow : public MapsTest {
 protected:
  static constexpr std::uint32_t kPlaces = 181;
  static std::vector<double> places() {
    std::vector<double> all;
    for (std::uint32_t i = 0; i < kPlaces; ++i) all.push_back(-0.9 + 0.01 * i + 0.0013);
    return all;
  }
  static Masks line(const std::string& words, const scenes::Scene& scene, const std::vector<double>& at = places()) {
    const Stage stage = along_floor(scene, at, light_samples(1));
    const MapVariant variant = MapVariant(words).with({{"size", "512"}});
    return run(*variant.make(device()), stage);
  }
  /// Seen from the light's centre texels are 1.6e-3 wide, or 5e-3 if the window holds casters beside the floor. The
  /// tolerance is half a texel at either end over the penumbra's width, times the steepest slope.
  static void expect_line(const std::string& words, double light_half, double height,
                          const std::function<double(double)>& v, double tolerance) {
    const Masks found = line(words, half_plane(height, light_half));
    double worst = 0;
    for (std::uint32_t i = 0; i < kPlaces; ++i) {
      worst = std::max(worst, std::abs(static_cast<double>(found.visibility[i]) - v(places()[i])));
    }
    fmt::print("{}, light {}, height {}: off by {:.4f}\n", words, light_half, height, worst);
    EXPECT_LT(worst, tolerance) << words;
  }
  /// Share of the floor darker than this.
  static double dark_share(const Masks& found, float than) {
    return static_cast<double>(std::ranges::count_if(found.visibility, [&](float v) { return v < than; })) /
           static_cast<double>(found.visibility.size());
  }
};

TEST_F(MapsSingleShadow, UnderAnEdgeEachPapersFormulaIsAClosedForm) {
  for (const auto& [light, height] : {std::pair(0.5, 2.0), std::pair(0.3, 3.0)}) {
    const UnderAnEdge edge{light, height};
    const double step = 0.0024 / edge.half_width;
    expect_line(
        "brabec-seidel", light, height, [&](double x) { return edge.both_sides(x); }, step);
    expect_line(
        "kirsch-doellner:radius=140", light, height, [&](double x) { return edge.inside(x); }, 2 * step);
    expect_line(
        "parker:radius=140", light, height, [&](double x) { return cubic(edge.outside(x)); }, 2 * step);
    expect_line(
        "penumbra-map:filter=nearest", light, height, [&](double x) { return edge.penumbra_map(x); }, 3 * step);
    // All silhouettes are at their mean height here, so that smoothies' one width is Parker's.
    expect_line(
        "smoothies:filter=nearest", light, height, [&](double x) { return cubic(edge.outside(x)); }, 2 * step);
    // A pixel of the flood is 0.002 wide, as the light's centre sees it.
    expect_line(
        "arvo", light, height, [&](double x) { return cubic(edge.both_sides(x)); },
        1.5 * step + 0.0015 / edge.half_width);
  }
}

// V is linear while a rectangle light's side moves past an edge parallel to it. So a penumbra on both sides of the
// border is the truth if the light's half-width replaces the radius of its disk.
TEST_F(MapsSingleShadow, BothSidesOfAnEdgeAreTheTruthButForTheRadius) {
  const UnderAnEdge edge{0.5, 2};
  for (double x = -1; x < 1; x += 0.01) {
    EXPECT_NEAR(edge.both_sides(x * edge.radius / 0.5), edge.exact(x), 1e-12);
  }
  const Stage stage = along_floor(half_plane(2, 0.5), places(), light_samples(1));
  const Masks truth = tests::run(*reference::make_exact({}), stage);
  for (std::uint32_t i = 0; i < kPlaces; ++i) {
    EXPECT_NEAR(truth.visibility[i], edge.exact(places()[i]), 1e-5);
  }
}

// The other falloffs are Parker's polynomial and sine.
TEST_F(MapsSingleShadow, FalloffsAreParkersPolynomialAndSine) {
  const UnderAnEdge edge{0.5, 2};
  const double step = 0.0024 / edge.half_width;
  expect_line(
      "parker:radius=140:falloff=linear", 0.5, 2, [&](double x) { return edge.outside(x); }, step);
  expect_line(
      "parker:radius=140:falloff=sine", 0.5, 2,
      [&](double x) { return (1 + std::sin(std::numbers::pi * (edge.outside(x) - 0.5))) / 2; }, 2 * step);
  expect_line(
      "brabec-seidel:falloff=cubic", 0.5, 2, [&](double x) { return cubic(edge.both_sides(x)); }, 2 * step);
}

// Atty et al. 2006, section 1, Eisemann et al. 2009, section 5.3.1: with outer penumbrae only, the umbra is the whole
// hard shadow. Under a plate that a large light sees past, the true umbra is small, and methods with penumbrae on both
// sides find no larger one (docs/predicates.md, E12).
TEST_F(MapsSingleShadow, OuterPenumbraeOverestimateTheUmbraAndInnerOnesLoseIt) {
  scenes::Scene scene = bare_floor(0.6);
  add_quad(scene, {0, 2, 0}, {0.55, 0, 0}, {0, 0, -0.55}).receives_shadow = false;
  const Stage stage = on_floor(scene, 32, light_samples(16));
  const Masks truth = tests::run(*reference::make_exact({}), stage);
  const double umbra = dark_share(truth, 0.05F), shadow = dark_share(truth, 0.95F);
  const auto shares = [&](const char* words) {
    const Masks found = run(*MapVariant(words).with({{"size", "128"}}).make(device()), stage);
    const double dark = dark_share(found, 0.05F), shaded = dark_share(found, 0.95F);
    fmt::print("{}: umbra {:.2f} times, shadow {:.2f} times the true one\n", words, dark / umbra, shaded / shadow);
    return std::pair(dark / umbra, shaded / shadow);
  };
  for (const char* words : {"penumbra-map", "smoothies", "parker"}) EXPECT_GT(shares(words).first, 2.0) << words;
  const auto [inner_umbra, inner_shadow] = shares("kirsch-doellner");
  EXPECT_LT(inner_shadow, 0.7);
  for (const char* words : {"brabec-seidel", "arvo", "soft-shadow-map"}) {
    const auto [dark, shaded] = shares(words);
    EXPECT_LT(dark, 1.8) << words;
    EXPECT_NEAR(shaded, 1, 0.25) << words;
  }
  EXPECT_LT(inner_umbra, 1.8);
}

// One width for all silhouettes is right at one height only (Chan and Durand choose it by hand).
TEST_F(MapsSingleShadow, SmoothiesAreRightAtOneHeight) {
  const UnderAnEdge near{0.5, 1}, far{0.5, 3};
  const std::string width = fmt::format("smoothies:filter=nearest:width={}", near.radius / near.z_v);
  expect_line(
      width, 0.5, 1, [&](double x) { return cubic(near.outside(x)); }, 0.0048 / near.half_width);
  // Nearer to the light the strip keeps its width, although it should be 4 / 2 times as wide.
  expect_line(
      width, 0.5, 3, [&](double x) { return cubic(2 * far.outside(x)); }, 0.0096 / far.half_width);
}

// Eisemann et al. 2009, section 5.2.1: the search's radius is bounded, and so is the penumbra's width.
TEST_F(MapsSingleShadow, AShortSearchEndsPenumbrae) {
  const scenes::Scene scene = half_plane(2, 0.5);
  const Stage stage = along_floor(scene, places(), light_samples(1));
  const maps::LightBasis basis = maps::light_basis(stage.light);
  const CentreMaps maps(device(), stage, 512, maps::half_extent(stage.light, basis) / maps::half_width(stage.light));
  const auto& side = maps.fitted.views.front().side[0];
  const double texel = static_cast<double>(side.upper.x - side.lower.x) / 512;
  const Masks all = line("brabec-seidel:radius=140", scene), few = line("brabec-seidel:radius=8", scene);
  std::size_t cut = 0;
  for (std::uint32_t i = 0; i < kPlaces; ++i) {
    const double away = std::abs(places()[i]) / 5 / texel;
    if (away < 7) {
      EXPECT_EQ(few.visibility[i], all.visibility[i]);
    }
    if (away < 9) continue;
    EXPECT_EQ(few.visibility[i], places()[i] > 0 ? 0.0F : 1.0F) << places()[i];
    cut += all.visibility[i] > 0 && all.visibility[i] < 1 ? 1 : 0;
  }
  EXPECT_GT(cut, 30U);
}

// Eisemann et al. 2009, section 5.2.1: the flood starts from borders in the picture. The same places without the border
// in the picture have no penumbra.
TEST_F(MapsSingleShadow, AFloodKnowsNoBorderOutsideOfThePicture) {
  std::vector<double> beside;
  for (const double x : places()) {
    if (x > 0.05) beside.push_back(x);
  }
  const Masks whole = line("arvo", half_plane(2, 0.5)), part = line("arvo", half_plane(2, 0.5), beside);
  const std::size_t first = kPlaces - beside.size();
  std::size_t lost = 0;
  for (std::size_t i = 0; i < beside.size(); ++i) {
    EXPECT_EQ(part.visibility[i], 0.0F);
    lost += whole.visibility[first + i] > 0 ? 1 : 0;
  }
  EXPECT_GT(lost, 30U);
}

// Object ids need no bias, and ignore an object's shadow on itself (Hourcade and Nicolas 1985; Eisemann et al. 2009,
// section 4.1.2).
TEST_F(MapsSingleShadow, ObjectIdsNeedNoBiasAndLoseSelfShadows) {
  scenes::Scene scene = bare_floor(0.3);
  const auto lower = quad({0, 1.5, 0}, {0.5, 0.2, 0}, {0, 0, -0.5}),
             upper = quad({0.2, 3, 0}, {0.3, 0, 0}, {0, 0, -0.3});
  add_object(scene, "steps", lower);
  const Stage plain(scene, 40, 40, light_samples(1));
  const std::size_t steps = scene.objects.size() - 1;
  const auto lit_on_steps = [&](const Stage& stage, const char* words) {
    const Masks found = run(*MapVariant(words).with({{"size", "128"}}).make(device()), stage);
    std::size_t lit = 0, all = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const std::int32_t triangle = stage.samples.triangle[i];
      if (triangle < 0 || stage.floats.object[static_cast<std::size_t>(triangle)] != steps) continue;
      const glm::dvec3 to_light = glm::dvec3(stage.light.center) - glm::dvec3(stage.samples.p[i]);
      if (glm::dot(glm::dvec3(stage.samples.n[i]), to_light) <= 0) continue;
      ++all;
      lit += found.visibility[i] == 1 ? 1 : 0;
    }
    EXPECT_GT(all, 40U);
    return static_cast<double>(lit) / static_cast<double>(all);
  };
  EXPECT_EQ(lit_on_steps(plain, "brabec-seidel:bias=0:receiverPlane=off"), 1.0);
  EXPECT_LT(lit_on_steps(plain, "brabec-seidel:bias=0:receiverPlane=off:ids=off"), 0.9);
  // A second part of the same object, above the first.
  scenes::Scene stacked = bare_floor(0.3);
  auto both = lower;
  both.insert(both.end(), upper.begin(), upper.end());
  add_object(stacked, "steps", both);
  const Stage shaded(stacked, 40, 40, light_samples(1));
  EXPECT_EQ(lit_on_steps(shaded, "brabec-seidel"), 1.0);
  EXPECT_LT(lit_on_steps(shaded, "brabec-seidel:ids=off"), 0.8);
}

// A line of pixels with the border between two of them: shares are linear in the distance to its middle.
TEST(MapsFlood, ALineIsFilledAsFarAsThePenumbraReaches) {
  constexpr double kLight = 1, kHeight = 5, kBlocker = 2.5, kStep = 0.01;
  constexpr double kReach = kLight * (1 / kBlocker - 1 / kHeight);
  std::vector<maps::FloodPixel> pixels(100);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    using State = maps::FloodPixel::State;
    pixels[i] = {i < 60 ? State::lit : State::shaded, {kStep * static_cast<double>(i), 0}, kHeight, kBlocker};
  }
  pixels[70].state = maps::FloodPixel::State::nothing;  // one background pixel stops the flood
  const maps::FloodResult found = maps::flood(pixels, 100, kLight);
  EXPECT_EQ(found.passes, 20U);  // for 0.2 less half a pixel on the lit side, and a last pass that finds no more
  for (std::size_t i = 0; i < 70; ++i) {
    const double away = (59.5 - static_cast<double>(i)) * kStep / kReach;
    EXPECT_NEAR(found.share[i], std::clamp(0.5 + 0.5 * away, 0.0, 1.0), 1e-12) << i;
  }
  for (std::size_t i = 71; i < 100; ++i) EXPECT_EQ(found.share[i], 0) << i;
  EXPECT_TRUE(maps::flood({}, 0, 1).share.empty());
}

// The outer penumbra under the half-plane at height 2 is 0.4 wide on the floor, about 15 texels (of 10 / 510 and more).
// A search that is too short for that ends early, and counters and the warning say so; one of sixty does not.
TEST_F(MapsSingleShadow, CutSearchesAreCounted) {
  const Stage stage = along_floor(half_plane(2, 0.3), places(), light_samples(1));
  for (const auto make : {maps::make_parker, maps::make_brabec_seidel}) {
    const auto cut_of = [&](const char* radius) {
      const auto method = make(device(), {{"size", "512"}, {"radius", radius}});
      static_cast<void>(run(*method, stage));
      const auto counters = method->counters();
      const auto warning = method->description().warning({{"radius", radius}}, counters);
      EXPECT_EQ(warning.has_value(), counters.at("cutSearches") > 0);
      const std::string said = warning.value_or("radius=" + std::string(radius));
      EXPECT_NE(said.find(std::string("radius=") + radius), std::string::npos) << said;
      return counters.at("cutSearches");
    };
    EXPECT_EQ(cut_of("60"), 0U);
    EXPECT_GT(cut_of("4"), 2U);
    EXPECT_LE(cut_of("4"), stage.samples.size());
  }
}

}  // namespace
}  // namespace penumbra::tests
