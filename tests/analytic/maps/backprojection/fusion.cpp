// SPDX-License-Identifier: Apache-2.0
// Tests how parts of a shadow are combined (sums, unions, the deepest layer alone) on parts that are rectangles
// parallel to the light, known in closed form.

#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/backprojection/contour_scenes.hpp"

#include <array>
#include <random>

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

/// A plate `depth` below the light, which is 5 above the floor; its bounds are as the light's centre sees it, in x/z
/// and y/z.
struct Plate {
  double depth;
  glm::dvec2 lower, upper;
};

/// A rectangle in the light's plane.
struct OnLight {
  glm::dvec2 lower, upper;
  [[nodiscard]] bool has(const glm::dvec2& at) const {
    return glm::all(glm::greaterThan(at, lower)) && glm::all(glm::lessThan(at, upper));
  }
  /// Returns the rectangle's share of a light of this half-size.
  [[nodiscard]] double share(double half) const {
    const glm::dvec2 extent =
        glm::max(glm::min(upper, glm::dvec2(half)) - glm::max(lower, glm::dvec2(-half)), glm::dvec2(0));
    return extent.x * extent.y / (4 * half * half);
  }
};

class MapsFusion : public MapsTest {
 protected:
  static constexpr double kHeight = 5, kHalf = 1, kFloor = 2;
  static scenes::Scene under(const std::vector<Plate>& plates) {
    scenes::Scene scene = bare_floor(kHalf, kFloor);
    for (const Plate& plate : plates) {
      const glm::dvec2 middle = plate.depth * 0.5 * (plate.lower + plate.upper),
                       half = plate.depth * 0.5 * (plate.upper - plate.lower);
      add_quad(scene, {middle.x, kHeight - plate.depth, middle.y}, {half.x, 0, 0}, {0, 0, -half.y}).receives_shadow =
          false;
    }
    return scene;
  }
  static glm::dvec2 on_floor_at(const Stage& stage, std::size_t pixel) {
    const glm::dvec3 p = glm::dvec3(stage.samples.p[pixel]) + stage.floats.origin;
    return {p.x, p.z};
  }
  /// Returns the part of the light that a plate's texels hide from a point of the floor. The texels end up to half a
  /// texel, plus the snapping of corners, away from the plate's border. `out`: 1 for the largest, -1 for the smallest,
  /// 0 for the plate itself.
  static OnLight seen(const Plate& plate, const glm::dvec2& from, double texel, int out) {
    const double f = plate.depth * kHeight / (kHeight - plate.depth), beside = out * (0.5 + 1.0 / 256) * texel;
    return {(plate.lower - beside - from / kHeight) * f, (plate.upper + beside - from / kHeight) * f};
  }
  /// The window holds the floor only: all plates are seen in front of it.
  static double texel_of(std::uint32_t size) { return 2 * kFloor / kHeight / (size - 2); }
};

// Row I18 of docs/predicates.md (Eisemann et al. 2009, equation 1.5): if the parts of a caster hide exact shares B, the
// whole hides at least the largest share and at most their sum; and both bounds are nearly reached.
TEST_F(MapsFusion, WhatPartsHideBoundsWhatTheWholeHides) {
  double nearest_to_max = 1, nearest_to_sum = 1;
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    std::mt19937 random(seed);
    const auto number = [&](int low, int high) {
      return static_cast<double>(low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1))) / 2;
    };
    scenes::Scene scene = bare_floor(1, 2);
    for (int part = 0; part < 3; ++part) {
      std::vector<Corners> triangles(3);
      for (Corners& corners : triangles) {
        for (glm::dvec3& corner : corners) corner = {number(-3, 3), number(1, 7), number(-3, 3)};
      }
      add_object(scene, fmt::format("part {}", part), triangles).receives_shadow = false;
    }
    const auto hidden_by = [&](const std::function<bool(std::size_t)>& casts) {
      scenes::Scene some = scene;
      for (std::size_t object = 1; object < some.objects.size(); ++object) {
        some.objects[object].casts_shadow = casts(object);
      }
      return tests::run(*reference::make_exact({}), on_floor(some, 12, light_samples(1))).visibility;
    };
    const std::vector<float> whole = hidden_by([](std::size_t) { return true; });
    std::array<std::vector<float>, 3> parts;
    for (std::size_t part = 0; part < 3; ++part) {
      parts.at(part) = hidden_by([&](std::size_t object) { return object == part + 1; });
    }
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const double hidden = 1 - static_cast<double>(whole[i]);
      double most = 0, sum = 0;
      for (const std::vector<float>& part : parts) {
        most = std::max(most, 1 - static_cast<double>(part[i]));
        sum += 1 - static_cast<double>(part[i]);
      }
      constexpr double kRounding = 4 * 0x1p-25;  // V is a float: each is off by 2^-25
      EXPECT_GE(hidden, most - kRounding) << "seed " << seed << ", pixel " << i;
      EXPECT_LE(hidden, std::min(1.0, sum) + kRounding) << "seed " << seed << ", pixel " << i;
      if (most > 0.05 && most < 0.95 && sum - most > 0.05) {
        nearest_to_max = std::min(nearest_to_max, hidden - most);
        nearest_to_sum = std::min(nearest_to_sum, std::min(1.0, sum) - hidden);
      }
    }
  }
  fmt::print("least of whole - max {:.4f}, of sum - whole {:.4f}\n", nearest_to_max, nearest_to_sum);
  EXPECT_LT(nearest_to_max, 0.01);
  EXPECT_LT(nearest_to_sum, 0.01);
}

// Three plates are apart as seen from the light's centre and overlap as seen from the floor. Our methods add them
// (patches, outlines) or unite them (bits); each result is between those of the smallest and the largest texels.
TEST_F(MapsFusion, SumsAreSumsAndUnionsUnions) {
  constexpr std::uint32_t kSize = 128, kSamples = 256;
  const std::vector<Plate> plates{
      {1.5, {-0.35, -0.3}, {-0.12, 0.25}}, {2.5, {-0.07, -0.2}, {0.08, 0.3}}, {3.4, {0.13, -0.33}, {0.31, 0.17}}};
  const Stage stage = on_floor(under(plates), 10, light_samples(kSamples));
  const std::string size = fmt::format("{}", kSize);
  const double texel = texel_of(kSize);
  const Masks patches = run(maps::make_backproject, stage, {{"size", size}, {"fill", "none"}, {"search", "none"}}),
              shared = run(maps::make_backproject, stage, {{"size", size}, {"fill", "shared"}}),
              outlines = run(maps::make_contour, stage, {{"size", size}}),
              bits = run(maps::make_bitmask, stage, {{"size", size}, {"occluder", "patch"}});
  const glm::dvec3 centre = glm::dvec3(stage.light.center) + stage.floats.origin;
  double open = 0, doubled = 0, overlap = 0;
  std::size_t wrong_bits = 0, undecided = 0, count = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    const glm::dvec2 from = on_floor_at(stage, i);
    double least = 0, most = 0, corners = 0;
    for (const Plate& plate : plates) {
      least += seen(plate, from, texel, -1).share(kHalf);
      most += seen(plate, from, texel, 1).share(kHalf);
      const double side = texel * plate.depth * kHeight / (kHeight - plate.depth);
      corners += 0.5 * side * side / (4 * kHalf * kHalf);  // each of four corners is cut off by an eighth of a texel
    }
    // Shares are integers of 2^-30 (for outlines 2^-22), summed over the hundred texels or so of a border.
    const auto between = [&](const Masks& found, double low, double high, const char* what) {
      const double hidden = 1 - static_cast<double>(found.visibility[i]);
      EXPECT_GE(hidden, std::min(low, 1.0) - 5e-5) << what << ", pixel " << i;
      EXPECT_LE(hidden, std::min(high, 1.0) + 5e-5) << what << ", pixel " << i;
    };
    between(patches, least, most, "patches");
    between(shared, least, most, "patches with shared borders");
    between(outlines, least - corners, most, "outlines");
    if (most > 0.02 && least < 0.98) {
      open += most - least;
      doubled += 1;
    }
    for (std::uint32_t j = 0; j < kSamples; ++j) {
      const glm::dvec3 l = glm::dvec3(stage.light.points[j]) + stage.floats.origin - centre;
      std::size_t in_least = 0, in_most = 0;
      for (const Plate& plate : plates) {
        in_least += seen(plate, from, texel, -1).has({l.x, l.z}) ? 1 : 0;
        in_most += seen(plate, from, texel, 1).has({l.x, l.z}) ? 1 : 0;
      }
      overlap += in_least > 1 ? 1 : 0;
      ++count;
      undecided += in_least == 0 && in_most > 0 ? 1 : 0;
      wrong_bits += bits.visible(i, j) ? (in_least > 0 ? 1 : 0) : (in_most == 0 ? 1 : 0);
    }
  }
  fmt::print("V of sums known to ±{:.4f} in the mean; {} of {} bits undecided, {} twice hidden\n", open / doubled / 2,
             undecided, count, overlap);
  RecordProperty("known to", fmt::format("{:.4f}", open / doubled / 2));
  // Heights that are off by 2 % move borders by that share of their distance from the light's middle: in all by more
  // than 0.01 of the light's width.
  EXPECT_LT(open / doubled / 2, 0.02);
  EXPECT_EQ(wrong_bits, 0U);
  EXPECT_LT(undecided, count / 25);
  EXPECT_GT(overlap, static_cast<double>(count) / 100) << "they overlap nowhere";
}

// Bavoil et al. 2006, figure 5a: of a texel's surfaces only the deepest one that hides some of the light counts,
// although a nearer one hides another part. Two plates stand one behind the other as seen from the light's centre; at
// places beside them light leaks through. A union of the layers lets none through.
TEST_F(MapsFusion, ADeepPatchThatIsHalfOnTheLightHidesTheOneBeforeIt) {
  constexpr std::uint32_t kSize = 256;
  const Plate upper{2.5, {0.04, -0.3}, {0.09, 0.3}}, lower{3.5, {0.04, -0.3}, {0.09, 0.3}};
  const scenes::Scene scene = under({upper, lower});
  const std::vector<double> places{0.0, -0.05, 0.05, 0.1, 0.2};
  const Stage stage = along_floor(scene, places, light_samples(1024));
  const MethodOptions two{{"size", fmt::format("{}", kSize)}, {"layers", "2"}, {"depth", "first"}, {"samples", "0"}};
  const Masks peeled = run(maps::make_backproject_peel, stage, two),
              joined = run(maps::make_bitmask, stage,
                           {{"size", fmt::format("{}", kSize)}, {"layers", "2"}, {"occluder", "patch"}}),
              truth = tests::run(*reference::make_exact({}), stage);
  const double texel = texel_of(kSize);
  double leak = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec2 from = on_floor_at(stage, i);
    const double f = lower.depth * kHeight / (kHeight - lower.depth);
    // In columns and rows whose deeper patch is on the light, the nearer one does not count; this may be off by a
    // texel.
    double low = 1, high = 0;
    for (const double texels : {-1.0, 1.0}) {
      const glm::dvec2 reach(kHalf / f + texels * texel);
      Plate unseen = upper;
      unseen.lower = glm::max(upper.lower, from / kHeight - reach);
      unseen.upper = glm::min(upper.upper, from / kHeight + reach);
      for (const int out : {-1, 1}) {
        const double hidden = seen(lower, from, texel, out).share(kHalf) + seen(upper, from, texel, out).share(kHalf) -
                              seen(unseen, from, texel, out).share(kHalf);
        low = std::min(low, hidden);
        high = std::max(high, hidden);
      }
    }
    const double hidden = 1 - static_cast<double>(peeled.visibility[i]);
    EXPECT_GE(hidden, low - 5e-5) << places[i];
    EXPECT_LE(hidden, high + 5e-5) << places[i];
    EXPECT_LT(high - low, 0.06);
    // An edge passes one light sample in each row of 32.
    EXPECT_NEAR(joined.visibility[i], truth.visibility[i], 4.0 / 32 / 2 + (high - low)) << places[i];
    leak = std::max(leak, static_cast<double>(peeled.visibility[i] - truth.visibility[i]));
    fmt::print("at {}: peeled {:.4f}, exact {:.4f}\n", places[i], peeled.visibility[i], truth.visibility[i]);
  }
  EXPECT_GT(leak, 0.03);
}

}  // namespace
}  // namespace penumbra::tests
