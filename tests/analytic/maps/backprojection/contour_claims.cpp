// SPDX-License-Identifier: Apache-2.0
// Tests statements of papers about contours, hierarchies, packets and sub-lights, on scenes of the class that they
// concern: signs and rough sizes. docs/contour.md and docs/packet.md have the measured numbers.

#include "tests/analytic/maps/backprojection/contour_scenes.hpp"

namespace penumbra::tests {
namespace {

class MapsContourClaims : public ContourTest {
 protected:
  static FloorErrors errors(const Stage& stage, const Masks& truth, const visibility::MethodOptions& options,
                            const Factory& factory = maps::make_packet) {
    return floor_errors(stage, run(factory, stage, options), truth);
  }
  static void record(const std::string& name, double value) { fmt::print("{}: {:.4g}\n", name, value); }
};

// Atty et al. 2006, 5.2: an edge is off by no more than a texel's projection. Each of the square's four edges is off by
// half a texel, which the light sees f / z times as large: t f of the light's width, and twice that where two edges
// cross the light.
TEST_F(MapsContourClaims, AParallelSquareIsOffByATexelOnTheLightAtMost) {
  const Stage stage(parallel_square(), 40, 40, light_samples(1));
  const ParallelSquare square(stage);
  // The window is ±4 at 5 and the light's reach beside it, 1 (1/3 − 1/5); f = 3 · 5 / (5 − 3); the light is 2 wide.
  double previous = 1;
  for (const std::uint32_t size : {32U, 128U, 512U}) {
    const Masks found = run(maps::make_contour, stage, {{"size", std::to_string(size)}});
    const double texel = 2 * (0.8 + 1.0 / 3 - 0.2) / (size - 2);
    double largest = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (square.on_floor(i)) largest = std::max(largest, std::abs(found.visibility[i] - square.area(i)));
    }
    record(fmt::format("E2 largest error at {}", size), largest);
    EXPECT_LT(largest, 2 * texel * 7.5 / 2) << size;
    EXPECT_LT(largest, previous);
    previous = largest;
  }
}

// Schwarz and Stamminger 2007: joined surfaces have no gaps.
TEST_F(MapsContourClaims, NoLightLeaksThroughJoinedSurfaces) {
  scenes::Scene tilted = contour_floor(0.6);
  add_quad(tilted, {0, 2.5, 0}, {1, -1.2, 0}, {0, 0, 1});
  for (const auto& [name, scene] : {std::pair("plate over plate", plate_over_plate()), std::pair("tilted", tilted),
                                    std::pair("ball", ball_over_floor(1))}) {
    const Stage stage(scene, 40, 40, light_samples(1));
    const FloorErrors found = errors(stage, exact(stage), {{"size", "128"}});
    record(fmt::format("C1 leak, {}", name), found.leak);
    EXPECT_LE(found.leak, 0.02) << name;
  }
}

// Contours of parts that do not touch in the map are added, even where they overlap as seen from the receiver.
TEST_F(MapsContourClaims, PartsAreAddedAsIfTheyNeverOverlapped) {
  scenes::Scene both = contour_floor(1), left = contour_floor(1), right = contour_floor(1);
  const auto add_left = [](scenes::Scene& scene) { add_quad(scene, {-0.55, 3, 0}, {0.4, 0, 0}, {0, 0, 2}); };
  const auto add_right = [](scenes::Scene& scene) { add_quad(scene, {0.275, 1, 0}, {0.075, 0, 0}, {0, 0, 2}); };
  add_left(both);
  add_right(both);
  add_left(left);
  add_right(right);
  for (scenes::Scene* scene : {&left, &right}) {  // slivers keep the window and the origin the same
    for (const double z : {-2.0, 2.0}) {
      add_quad(*scene, {-0.55, 3, z}, {0.4, 0, 0}, {0, 0, 1e-6});
      add_quad(*scene, {0.275, 1, z}, {0.075, 0, 0}, {0, 0, 1e-6});
    }
  }
  const Stage stage(both, 48, 48, light_samples(1));
  const auto hidden = [&](const scenes::Scene& scene) {
    const Stage one(scene, 48, 48, light_samples(1));
    return run(maps::make_contour, one, {{"size", "256"}, {"traversal", "hierarchy"}});
  };
  const Masks whole = hidden(both), a = hidden(left), b = hidden(right), truth = exact(stage);
  std::size_t overlap = 0, added = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (!on_object(stage, i, 0)) continue;
    const double sum = std::max(0.0, static_cast<double>(a.visibility[i]) + static_cast<double>(b.visibility[i]) - 1);
    if (truth.visibility[i] < sum + 0.05) continue;  // they do not overlap here
    ++overlap;
    // The slivers keep the window the same up to 1e-6: one map may have a row or column of texels more than the other.
    // In a window 2 wide that is 1/127 · 20 / 2 of the light for the lower plate, which f = 20 enlarges.
    added += std::abs(static_cast<double>(whole.visibility[i]) - sum) < 0.08 ? 1 : 0;
  }
  record("C2 pixels with overlap", static_cast<double>(overlap));
  EXPECT_GT(overlap, 8U);
  EXPECT_EQ(added, overlap);
}

// A method that reads one map cannot know about a gap that is not in it.
TEST_F(MapsContourClaims, AGapThatTheCentreDoesNotSeeIsNotThere) {
  const Stage whole(plates_alike(false), 40, 40, light_samples(1)), gap(plates_alike(true), 40, 40, light_samples(1));
  const visibility::MethodOptions options{{"size", "128"}};
  const Masks a = run(maps::make_contour, whole, options), b = run(maps::make_contour, gap, options);
  const Masks exact_a = exact(whole), exact_b = exact(gap);
  std::size_t differing = 0;
  for (std::size_t i = 0; i < whole.samples.size(); ++i) {
    if (!on_object(whole, i, 0) || !on_object(gap, i, 0)) continue;
    EXPECT_EQ(a.visibility[i], b.visibility[i]);
    differing += exact_a.visibility[i] != exact_b.visibility[i] ? 1 : 0;
  }
  EXPECT_GT(differing, 20U);
  record("I14 error without the gap", floor_errors(whole, a, exact_a).shadow);
  record("I14 error with the gap", floor_errors(gap, b, exact_b).shadow);
}

// Facets between points of a convex body lie inside it; contours reach half a texel beyond it. For a body whose outline
// is w wide at depth z_s, half a texel on each side is t z_s f / (z_s · the light's width).
TEST_F(MapsContourClaims, AConvexBodyHidesTooLittleButForHalfATexel) {
  const Stage stage(ball_over_floor(1), 40, 40, light_samples(1));
  const Masks truth = exact(stage);
  for (const std::uint32_t size : {64U, 256U}) {
    const FloorErrors found = errors(stage, truth, {{"size", std::to_string(size)}});
    // The window is the floor's ±0.8 and the light's reach beside it, 1 (1/2 − 1/5): 2.2 wide; f at depth 3 is 7.5, the
    // light is 2 wide; both sides of the ball may cross the light.
    record(fmt::format("I7 lowest V − exact at {}", size), found.lowest);
    EXPECT_GT(found.lowest, -2.2 / (size - 2) * 7.5 / 2);
    EXPECT_GT(found.bias, 0);
  }
}

// Atty 2006 and all single-map methods: above some map size the error comes from the single view, and only more views
// lower it (Yang 2009, section 5; peeling cannot).
TEST_F(MapsContourClaims, SubLightsBreakTheFloorOfOneView) {
  const Stage stage(ball_over_floor(1), 40, 40, light_samples(1));
  const Masks truth = exact(stage);
  const FloorErrors coarse = errors(stage, truth, {{"size", "128"}}), fine = errors(stage, truth, {{"size", "256"}}),
                    two = errors(stage, truth, {{"size", "128"}, {"sublights", "2"}}),
                    four = errors(stage, truth, {{"size", "128"}, {"sublights", "4"}});
  record("E1 S0 error(256) / error(128)", fine.shadow / coarse.shadow);
  record("M1 RMSE S=1", coarse.rmse);
  record("M1 RMSE S=2", two.rmse);
  record("M1 RMSE S=4", four.rmse);
  EXPECT_GT(fine.shadow, 0.8 * coarse.shadow);
  EXPECT_LT(two.rmse, 0.6 * coarse.rmse);
  EXPECT_LT(four.rmse, 0.7 * two.rmse);
  const FloorErrors peel = errors(stage, truth, {{"size", "128"}, {"layers", "4"}}, maps::make_backproject_peel);
  record("M3 RMSE of four peeled layers", peel.rmse);
  EXPECT_LT(two.rmse, peel.rmse);
}

// Yang 2009, figures 7 and 8: a hierarchy of contours skips empty and full nodes, Dmitriev and Uralsky's only empty
// ones, and a kernel alone none. There are far fewer edges than texels that shade.
TEST_F(MapsContourClaims, HierarchiesLookAtFewerCells) {
  const Stage stage(ball_over_floor(2), 40, 40, light_samples(1));
  const auto cells = [&](const char* traversal) {
    return counted(maps::make_contour, stage, {{"size", "128"}, {"search", "mssm"}, {"traversal", traversal}});
  };
  const Counted flat = cells("flat"), minmax = cells("minmax"), hierarchy = cells("hierarchy");
  const double looked_flat = flat.count("cells"), looked_minmax = minmax.count("cells") + minmax.count("nodes"),
               looked = hierarchy.count("cells") + hierarchy.count("nodes");
  record("C6 cells, flat", looked_flat);
  record("C6 cells and nodes, minmax", looked_minmax);
  record("C6 cells and nodes, hierarchy", looked);
  record("C4 edges", flat.count("edges"));
  EXPECT_EQ(flat.count("edges"), minmax.count("edges"));
  // Our hierarchy also skips nodes beside the light.
  EXPECT_LT(hierarchy.count("edges"), flat.count("edges"));
  EXPECT_LT(looked, 0.8 * looked_minmax);
  EXPECT_LT(looked_minmax, 0.8 * looked_flat);
  EXPECT_LT(flat.count("edges"), 0.1 * looked_flat);
}

// Yang 2009, section 6: under larger lights more of the nontrivial packets are coherent (overall, though not at every
// step: 0.58, 0.56, 0.69), and packets read less.
TEST_F(MapsContourClaims, PacketsAreMoreCoherentUnderLargerLights) {
  std::vector<double> coherent;
  for (const double half : {0.25, 0.5, 1.0}) {
    const Stage stage(ball_over_floor(half), 64, 64, light_samples(1));
    const Counted packets = counted(maps::make_packet, stage, {{"size", "128"}}),
                  alone = counted(maps::make_packet, stage, {{"size", "128"}, {"packet", "1x1"}});
    const double together = packets.count("packetsShared"),
                 all = together + packets.count("packetsParted") + packets.count("packetsDiverged");
    coherent.push_back(together / all);
    record(fmt::format("C7 coherent share, light {}", half), coherent.back());
    record(fmt::format("C7 cells and nodes, packets of 1 over 9, light {}", half),
           (alone.count("cells") + alone.count("nodes")) / (packets.count("cells") + packets.count("nodes")));
    EXPECT_LT(packets.count("cells"), alone.count("cells"));
  }
  EXPECT_GT(coherent.back(), coherent.front() + 0.05);
}

// Yang 2009, equations 7 to 9: sub-lights look at as many texels together as one light does, except for a texel of
// padding on every side.
TEST_F(MapsContourClaims, SubLightsLookAtAsManyTexels) {
  const Stage stage(ball_over_floor(1), 40, 40, light_samples(1));
  const Counted one = counted(maps::make_packet, stage, {{"size", "128"}});
  for (const double parts : {2.0, 4.0}) {
    const Counted some =
        counted(maps::make_packet, stage, {{"size", "128"}, {"sublights", fmt::format("{:.0f}", parts)}});
    const double ratio = some.count("kernelCells") / one.count("kernelCells");
    record(fmt::format("C8 kernel cells, S = {:.0f} over 1", parts), ratio);
    // A kernel of this scene is at least 8 cells wide, so that the ratio is at most (8 + 2 S)² / (8 + 2)².
    EXPECT_LT(ratio, (8 + 2 * parts) * (8 + 2 * parts) / 100);
  }
}

}  // namespace
}  // namespace penumbra::tests
