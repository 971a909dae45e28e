// SPDX-License-Identifier: Apache-2.0
// Tests relations that hold on every scene between a light and its parts or corners (docs/predicates.md: I4, I19, I20).

#include "maps/backprojection/contours/methods.hpp"
#include "tests/analytic/maps/adaptive_light.hpp"
#include "tests/analytic/maps/places.hpp"
#include "visibility/lights/light_parts.hpp"

namespace penumbra::tests {
namespace {

class LightIdentities : public AdaptiveLight {
 protected:
  static constexpr const char* kSize = "20";

  static bool is_plain_rectangle(const visibility::Light& light) {
    return light.kind == visibility::LightKind::rectangle && !light.texture;
  }

  /// I4 (Yang et al. 2009, section 5): `packet` with sub-lights is the mean of `contour` under each sub-light. Returns
  /// false if their maps differ: all points of one light have either windows or hemicubes.
  static bool expect_mean_of_parts(const Place& place) {
    const Stage& stage = place.stage;
    const auto packet = maps::make_packet(device(), {{"size", kSize}, {"sublights", "2"}});
    const Masks whole = run(*packet, stage);
    std::vector<double> mean(whole.visibility.size(), 0.0);
    std::uint64_t faces = 0;
    for (const visibility::LightPart& part : visibility::light_parts(stage.light, 2)) {
      Stage alone = stage;
      alone.light = part.light;
      const auto contour = maps::make_contour(device(), {{"size", kSize}});
      const Masks found = run(*contour, alone);
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += part.weight * static_cast<double>(found.visibility[i]);
      faces += contour->counters().at("mapFaces");
    }
    if (faces != packet->counters().at("mapFaces")) return false;
    // Areas are added in units of 2^-22 of the light, one edge at a time. The rounding of a light that is not along the
    // scene's axes differs from that of its parts, so that tangents differ by about eight roundings of 2^-24 of the
    // window. On the light that is f / l times as large, with f = z z' / (z - z'). The bias keeps occluders at least
    // half a texel away from a pixel at height z over the light: 1 - z' / z > 1/2 of 1/kSize of the window. The total
    // is 8 kSize 2^-24 z / l.
    const maps::LightBasis basis = maps::light_basis(stage.light);
    const maps::LightBounds bounds = maps::light_bounds(stage.light, basis);
    const double least = 0.5 * std::min(bounds.upper.x, bounds.upper.y);  // of a part's half-sides
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const double off = std::abs(mean[i] - static_cast<double>(whole.visibility[i]));
      const double z = std::abs(basis.local(stage.samples.p[i]).z);
      EXPECT_LE(off, 1e-6 + 8 * std::stod(kSize) * 0x1p-24 * z / least) << place.name << ", I4, pixel " << i;
    }
    return true;
  }

  /// I19 (Schwaerzler, equations 2, 5, 6): without tolerance adaptive-light is `accumulate` over the corners of all
  /// cells. I20: larger epsilon and gamma give fewer maps, never fewer than 4 and never more than all corners.
  static void expect_adaptive(const Place& place) {
    Stage stage = place.stage;
    const MethodOptions without{{"size", kSize}, {"levels", "2"}, {"epsilon", "0"}, {"pcf", "off"}};
    const Run all = adaptive(stage, without);
    const auto maps_with = [&](const char* epsilon, const char* gamma) {
      MethodOptions options = without;
      options["epsilon"] = epsilon;
      options["gamma"] = gamma;
      options["shareOf"] = "pixels";
      return adaptive(stage, options).maps;
    };
    const std::uint64_t some = maps_with("0.02", "0.02"), fewer = maps_with("0.2", "0.02"),
                        flatter = maps_with("0.02", "0.2");
    EXPECT_LE(some, 25U) << place.name << ", I20";
    EXPECT_LE(fewer, some) << place.name << ", I20, epsilon";
    EXPECT_LE(flatter, some) << place.name << ", I20, gamma";
    EXPECT_GE(std::min(fewer, flatter), 4U) << place.name << ", I20";
    EXPECT_EQ(all.maps, 25U) << place.name;
    stage.light = with_points(stage.light, corner_grid(stage.light, 5));
    EXPECT_EQ(all.picture.visibility, run(maps::make_accumulate, stage, {{"size", kSize}}).visibility)
        << place.name << ", I19";
  }
};

TEST_F(LightIdentities, HoldOnOneSceneOfEachKind) {
  std::size_t compared = 0;
  for (const Place& place : few_places()) {
    if (!is_plain_rectangle(place.stage.light)) continue;
    compared += expect_mean_of_parts(place) ? 1 : 0;
    expect_adaptive(place);
  }
  EXPECT_GE(compared, 2U);
}

TEST_F(LightIdentities, HoldOnManyScenesFull) {
  std::size_t places = 0, compared = 0;
  each_place([&](const Place& place) {
    if (!is_plain_rectangle(place.stage.light)) return;
    ++places;
    compared += expect_mean_of_parts(place) ? 1 : 0;
    expect_adaptive(place);
  });
  fmt::print("I19, I20 on {} scenes, I4 on {}\n", places, compared);
  EXPECT_GE(compared, places * 3 / 4);
}

}  // namespace
}  // namespace penumbra::tests
