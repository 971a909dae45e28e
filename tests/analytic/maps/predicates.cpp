// SPDX-License-Identifier: Apache-2.0
// Tests statements of papers and of algebra about the image-based family, for every scene or for every scene of a
// class, as far as no other file of this folder does. docs/predicates.md lists all of them, with their names (I15, E6
// ...) and measurements.

#include "maps/filters/methods.hpp"
#include "tests/analytic/maps/predicates.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <random>

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

/// A ball, and four specks at the corners of the receivers' window, so that the ball's map from the light's centre has
/// that window.
scenes::Scene ball_and_specks() {
  scenes::Scene scene = bare_floor(0.5, 4);
  add_object(scene, "ball", sphere({0, 2, 0}, 1, 16)).receives_shadow = false;
  for (const double x : {-1, 1}) {
    for (const double z : {-1, 1}) {
      add_quad(scene, {1.9 * x, 2.5, 1.9 * z}, {0.1, 0, 0}, {0, 0, 0.1}).receives_shadow = false;
    }
  }
  return scene;
}

// I15: behind a convex body the second layer is the farthest surface, and two ways to sum its patches agree: the second
// pass of soft-shadow-map, at a texel of its receivers' map, and the deepest layer of backproject-peel.
TEST_F(MapsPredicates, BehindAConvexBodyPeelingIsTheSecondPass) {
  const Stage stage(ball_and_specks(), 20, 20, light_samples(1),
                    [](const visibility::SceneFloats& floats, const visibility::PinholeCamera& /*camera*/) {
                      visibility::ViewSamples samples;
                      samples.width = samples.height = 20;
                      for (std::uint32_t i = 0; i < 400; ++i) {
                        // Centres of texels 4, 7, ... of the 66 over the floor, one of which is spare on either side.
                        const glm::dvec2 at = glm::dvec2(4 + 3 * (i % 20), 4 + 3 * (i / 20)) + 0.5 - 33.0;
                        samples.triangle.push_back(0);
                        samples.p.emplace_back(glm::dvec3(8 * at.x / 64, 0, 8 * at.y / 64) - floats.origin);
                        samples.n.emplace_back(0, 1, 0);
                        samples.depth.push_back(1);
                        samples.facing.push_back(1);
                      }
                      return samples;
                    });
  const MethodOptions map{{"size", "64"}, {"receiverSize", "66"}, {"filter", "nearest"}};
  MethodOptions both = map;
  both["passes"] = "2";
  const Masks one = soft(stage, map), two = soft(stage, both);
  const auto peeled = [&](const char* select) {
    return run(
        maps::make_backproject_peel, stage,
        {{"size", "64"}, {"layers", "2"}, {"samples", "0"}, {"depth", "first"}, {"bias", "0"}, {"select", select}});
  };
  const Masks deepest = peeled("deepest"), contribution = peeled("contribution");
  double off = 0, darker = 0;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    EXPECT_LE(contribution.visibility[i], deepest.visibility[i]);
    if (!(two.visibility[i] < one.visibility[i])) continue;  // the second pass's V is not the smaller one here
    ++compared;
    off = std::max(off, static_cast<double>(std::abs(two.visibility[i] - deepest.visibility[i])));
    darker = std::max(darker, static_cast<double>(two.visibility[i] - contribution.visibility[i]));
  }
  record("I15 select=deepest off by", off);
  record("I15 select=contribution darker by up to", darker);
  EXPECT_GT(compared, 40U);
  // Borders on the light are rounded to 2^-20 of its sides in one method and to 2^-30 of its area in the other; 16
  // patches a side have borders: V is off by at most 16 of these roundings, and by as much again for tangents in float.
  EXPECT_LT(off, 1e-4);
  EXPECT_GT(darker, 0.01) << "a nearer patch counts where the farther one misses the light";
}

/// A box over a floor in one pass and in two, against the truth, by Atty's measure.
class ABoxOverAFloor : public MapsPredicates {
 protected:
  struct Measured {
    double one, two;            ///< errors
    double bias_one, bias_two;  ///< mean errors over the pixels in shadow
  };
  static Measured measured(double aside, double light_half = 0.5, const char* size = "128") {
    const Stage stage = on_floor(box_over_floor(aside, light_half), 32, light_samples(1));
    const Masks truth = exact(stage);
    const MethodOptions few{{"size", size}, {"receiverSize", "128"}},
        twice{{"size", size}, {"receiverSize", "128"}, {"passes", "2"}};
    const Masks one = soft(stage, few), two = soft(stage, twice);
    const double in_shadow =
        static_cast<double>(std::ranges::count_if(truth.visibility, [](float v) { return v < 1; })) /
        static_cast<double>(truth.visibility.size());
    const Measured found{shadow_error(one, truth), shadow_error(two, truth), bias(one, truth) / in_shadow,
                         bias(two, truth) / in_shadow};
    const auto name = [&](const char* what) { return fmt::format("light {}, {} aside: {}", light_half, aside, what); };
    record(name("E6 error in one pass"), found.one);
    record(name("E6 error in two"), found.two);
    record(name("A15 bias in one pass"), found.bias_one);
    record(name("A15 bias in two"), found.bias_two);
    return found;
  }
};

// E6 (Atty et al. 2006, figure 19), for this box: under the light the result is nearer to the truth than half a width
// aside.
TEST_F(ABoxOverAFloor, UnderTheLightIsNearerToTheTruthThanAside) {
  EXPECT_LT(measured(0).one, measured(0.4).one);
}

TEST_F(ABoxOverAFloor, FartherAsideTooFull) {
  const double under = measured(0).one;
  for (const double aside : {0.8, 1.5}) EXPECT_LT(under, measured(aside).one);
}

// A15: the map has only the box's top, and no gaps to blame. Points of a light within the box's own half-size see
// nothing of its sides, and next to nothing is missing; points of a light of half-size 1 do see them. The light that
// the box hides and its top does not, integrated by hand, is 0.033 of the pixels in shadow.
TEST_F(ABoxOverAFloor, SidesThatTheCentreDoesNotSeeHideALargeLight) {
  const Measured small = measured(0), large = measured(0, 1, "64");
  EXPECT_GT(small.bias_one, 0);
  EXPECT_LT(small.bias_one, 0.01);
  EXPECT_NEAR(large.bias_one, 0.033, 0.01);
  EXPECT_LT(large.bias_two, large.bias_one);
}

// E9 (Atty et al. 2006, section 5.1.2): over a tilted plane gaps and overlaps of summed patches partly cancel; a union
// of the same patches has only the gaps.
TEST_F(MapsPredicates, OverATiltedPlaneSumsAreLessBiasedThanUnions) {
  const Stage stage = on_floor(oblique_quad(), 32, light_samples(1024));
  const Masks truth = exact(stage);
  for (const char* size : {"64", "128"}) {
    const double sum =
        bias(run(maps::make_backproject, stage, {{"size", size}, {"fill", "none"}, {"search", "none"}}), truth);
    const double united =
        bias(run(maps::make_bitmask, stage, {{"size", size}, {"occluder", "patch"}, {"search", "none"}}), truth);
    record(fmt::format("E9 bias of the sum, size {}", size), sum);
    record(fmt::format("E9 bias of the union, size {}", size), united);
    EXPECT_LT(std::abs(sum), std::abs(united));
    EXPECT_GT(united, 0);
  }
}

// S1' (Eisemann et al. 2009, figure 1.8): for nested shells one layer holds the outermost shell; each further layer
// adds to the shadow.
TEST_F(MapsPredicates, LayersOfNestedShellsBringTheShadowBack) {
  scenes::Scene scene = bare_floor(1, 3);
  // Caps that the light's centre sees one behind the other; the lowest casts the widest shadow on the floor.
  for (int shell = 0; shell < 4; ++shell) {
    add_quad(scene, {0, 3.6 - 0.8 * shell, 0}, {0.35, 0, 0}, {0, 0, -0.35}).receives_shadow = false;
  }
  const Stage stage = on_floor(scene, 20, light_samples(256));
  const Masks truth = exact(stage);
  double last = 1;
  for (const char* layers : {"1", "2", "3", "4"}) {
    const Masks found = run(maps::make_bitmask, stage, {{"size", "64"}, {"layers", layers}});
    const double off = bias(found, truth);
    record(fmt::format("S1' bias of {} layers", layers), off);
    EXPECT_GT(off, -0.005);
    EXPECT_LT(off, last);
    last = off;
  }
}

/// Places along a line outward across a shadow's edge where V leaves 0, passes 1/2 and reaches 1.
struct Edge {
  double inner = 0, middle = 0, outer = 0;
};
Edge edge_of(const std::vector<double>& places, const std::vector<float>& visibility) {
  Edge edge{places.back(), places.back(), places.back()};
  for (std::size_t i = places.size(); i-- > 0;) {
    if (visibility[i] > 0.002F) edge.inner = places[i];
    if (visibility[i] >= 0.5F) edge.middle = places[i];
    if (visibility[i] < 0.998F) {
      edge.outer = std::max(places[i], edge.outer == places.back() ? places[i] : edge.outer);
    }
  }
  return edge;
}

// E11 (Atty et al. 2006, section 5.2.2): both the inner and the outer penumbra exist and are as wide as the true ones;
// and the middle of the shadow's edge is at its true place.
TEST_F(MapsPredicates, PenumbraeReachInwardAndOutwardAsFarAsTheyDo) {
  for (const double height : {0.25, 1.0, 2.0}) {
    scenes::Scene scene = bare_floor(0.5, 4);
    add_quad(scene, {0, height, 0}, {1, 0, 0}, {0, 0, -1}).receives_shadow = false;
    std::vector<double> places;
    for (int i = 0; i < 600; ++i) places.push_back(0.5 + 2.5 * i / 600);
    const Stage stage = along_floor(scene, places, light_samples(1));
    // A texel of the occluders' map, 2 / 126 wide on the plate, is 5 / (5 - height) times that on the floor; a
    // receivers' texel is 8 / 510.
    const double texel = 2.0 / 126 * 5 / (5 - height) + 8.0 / 510;
    const Edge true_edge = edge_of(places, exact(stage).visibility);
    const Edge found = edge_of(places, soft(stage, {{"receiverSize", "512"}}).visibility);
    const double hard = 5 / (5 - height);  // the hard shadow's edge
    record(fmt::format("E11 plate at {}: inner edge off by", height), found.inner - true_edge.inner);
    record(fmt::format("E11 plate at {}: middle off by", height), found.middle - true_edge.middle);
    record(fmt::format("E11 plate at {}: outer edge off by", height), found.outer - true_edge.outer);
    record(fmt::format("E11 plate at {}: texel", height), texel);
    EXPECT_LT(found.inner, hard);
    EXPECT_GT(found.outer, hard);
    EXPECT_NEAR(found.inner, true_edge.inner, texel);
    EXPECT_NEAR(found.middle, true_edge.middle, texel);
    EXPECT_NEAR(found.outer, true_edge.outer, texel);
  }
}

// C3 (Eisemann et al. 2009, figure 5.8c), for this scene: as plates move, V from outlines jumps where the depth at an
// outline jumps; V from quads, which have no outlines, jumps less.
TEST_F(MapsPredicates, OutlinesJumpWhereDepthsAtThemDo) {
  visibility::SampleRequest request = light_samples(1024);
  request.pattern = visibility::SamplePattern::sobol;
  Masks last_contour, last_quad, last_truth;
  double contour_jump = 0, quad_jump = 0;
  for (int step = 0; step <= 12; ++step) {
    scenes::Scene scene = bare_floor(0.6, 3.5);
    // Seen from the light's centre, the small plate's edge passes over the large plate's, at x/z = 0.457.
    add_quad(scene, {0.31 + 0.012 * step, 3.5, 0}, {0.3, 0, 0}, {0, 0, -0.3}).receives_shadow = false;
    add_quad(scene, {0, 1.5, 0}, {1.6, 0, 0}, {0, 0, -1.6}).receives_shadow = false;
    const Stage stage = on_floor(scene, 18, request);
    const Masks truth = exact(stage), contour = run(maps::make_contour, stage, {{"size", "64"}}),
                quad = run(maps::make_bitmask, stage, {{"size", "64"}});
    for (std::size_t i = 0; step > 0 && i < truth.visibility.size(); ++i) {
      const float moved = truth.visibility[i] - last_truth.visibility[i];
      contour_jump = std::max(
          contour_jump, static_cast<double>(std::abs(contour.visibility[i] - last_contour.visibility[i] - moved)));
      quad_jump =
          std::max(quad_jump, static_cast<double>(std::abs(quad.visibility[i] - last_quad.visibility[i] - moved)));
    }
    last_contour = contour;
    last_quad = quad;
    last_truth = truth;
  }
  record("C3 largest jump of contour", contour_jump);
  record("C3 largest jump of quads", quad_jump);
  EXPECT_GT(contour_jump, quad_jump);
}

// M4 (Yang et al. 2009, section 5): sub-lights make wide penumbrae smooth; narrow ones stay as coarse as the map.
TEST_F(MapsPredicates, NarrowPenumbraeStayAliasedUnderSubLights) {
  for (const char* sub_lights : {"1", "2", "4"}) {
    std::array<double, 2> in_penumbra{}, in_picture{};
    std::size_t at = 0;
    for (const double height : {0.05, 2.0}) {
      scenes::Scene scene = bare_floor(0.5, 2);
      add_quad(scene, {0.013, height, 0.007}, {0.7, 0, 0}, {0, 0, -0.7}).receives_shadow = false;
      const Stage stage = on_floor(scene, 160, light_samples(1));
      const Masks truth = exact(stage),
                  found = run(maps::make_packet, stage, {{"size", "128"}, {"sublights", sub_lights}});
      // On the floor a penumbra is height / (5 - height) wide, and a texel at most 5 (4 / 5 + 2 beside) / 126.
      double penumbra = 0, picture = 0, pixels = 0;
      for (std::size_t i = 0; i < truth.visibility.size(); ++i) {
        const double square = std::pow(static_cast<double>(found.visibility[i] - truth.visibility[i]), 2);
        picture += square;
        if (truth.visibility[i] <= 0 || truth.visibility[i] >= 1) continue;
        penumbra += square;
        pixels += 1;
      }
      EXPECT_GT(pixels, 50);
      in_penumbra.at(at) = std::sqrt(penumbra / pixels);
      in_picture.at(at) = std::sqrt(picture / static_cast<double>(truth.visibility.size()));
      record(fmt::format("M4 S={}, plate at {}: RMSE in the penumbra", sub_lights, height), in_penumbra.at(at));
      record(fmt::format("M4 S={}, plate at {}: RMSE of the picture", sub_lights, height), in_picture.at(at++));
    }
    EXPECT_GT(in_penumbra[0], 2 * in_penumbra[1]) << sub_lights;
  }
}

}  // namespace
}  // namespace penumbra::tests
