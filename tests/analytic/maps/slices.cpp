// SPDX-License-Identifier: Apache-2.0
// Tests occlusion-textures and convolution: slices against their twin, and results for flat blockers parallel to the
// light, which are known.

#include "maps/filters/methods.hpp"
#include "maps/products/light_shape.hpp"
#include "maps/products/slices.hpp"
#include "selftest/crowd.hpp"
#include "selftest/map_checks.hpp"
#include "tests/analytic/maps/centre_maps.hpp"
#include "tests/unit/passed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace penumbra::tests {
namespace {

using SliceProducts = MapsTest;

TEST_F(SliceProducts, MarkEverySurfaceInItsSlice) {
  constexpr std::uint32_t kSize = 48, kSlices = 5;
  for (const auto& [hemicube, two_sided] : {std::pair(false, false), std::pair(true, false), std::pair(false, true)}) {
    const Stage stage(selftest::crowd(hemicube, two_sided), 4, 4, light_samples(1));
    for (const maps::Rasteriser rasteriser : {maps::Rasteriser::vulkan, maps::Rasteriser::opengl}) {
      expect_passed(selftest::check_slices(device(), stage, kSize, kSlices, rasteriser));
    }
    const CentreMaps maps(device(), stage, kSize);
    maps::Slices product(device(), {.count = kSlices});
    render::Commands commands(device());
    product.record(commands, maps.set(stage));
    commands.submit();
    std::vector<std::uint32_t> found(maps.texel_count());
    product.buffer().read<std::uint32_t>(found);
    EXPECT_GT(std::ranges::count_if(found, [](std::uint32_t word) { return std::popcount(word) > 1; }), 20);
  }
}

// A closed body has a top and a bottom; a sheet has one surface. Slices end at depths 2.25, 2.5, 2.75 and 3.
TEST_F(SliceProducts, TheNearestSurfaceIsInTheSliceWhereItsShadowBegins) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, 3}).casts_shadow = false;
  add_quad(scene, {-1, 2, 0}, {0.5, 0, 0}, {0, 0, 0.5});
  add_quad(scene, {-1, 1, 0}, {0.8, 0, 0}, {0, 0, 0.8});
  add_quad(scene, {1.5, 1.4, 0}, {0.5, 0, 0}, {0, 0, 0.5});
  scene.lights.push_back(ceiling_light(4, 0.5));
  scene.cameras.push_back(camera({0, 3, 8}, {0, 1, 0}));
  const Stage stage(scene, 4, 4, light_samples(1));
  constexpr std::uint32_t kSize = 64;
  const CentreMaps maps(device(), stage, kSize, {0, 0}, {.layers = 2});
  const auto& side = maps.fitted.views.front().side[0];
  // The body's middle appears at x/z = -1/2.5, the sheet's at 1.5/2.6.
  const auto words_of = [&](maps::DepthUse depth) {
    maps::Slices product(device(), {.count = 4, .depth = depth, .bias = 0.5});
    render::Commands commands(device());
    product.record(commands, maps.set(stage));
    commands.submit();
    std::vector<std::uint32_t> found(std::size_t{kSize} * kSize);
    product.buffer().read<std::uint32_t>(found);
    const auto at = [&](double tangent) {
      // The direction is along the basis' first axis, whatever its sign.
      const glm::dvec3 d = glm::dvec3(tangent, -1, 0);
      const glm::dvec2 place =
          (glm::dvec2(glm::dot(d, maps.basis.u), glm::dot(d, maps.basis.v)) - glm::dvec2(side.lower)) /
          glm::dvec2(side.upper - side.lower) * static_cast<double>(kSize);
      return found[static_cast<std::size_t>(place.y) * kSize + static_cast<std::size_t>(place.x)];
    };
    return std::pair(at(-0.45), at(1.5 / 2.6));
  };
  EXPECT_EQ(words_of(maps::DepthUse::first), std::pair(0b1001U, 0b100U));
  EXPECT_EQ(words_of(maps::DepthUse::second), std::pair(0b1000U, 0U));
  EXPECT_EQ(words_of(maps::DepthUse::midpoint), std::pair(0b1010U, 0b100U));
  EXPECT_EQ(words_of(maps::DepthUse::dual), std::pair(0b1001U, 0b100U));
}

// Compares texel by texel, in windows and hemicubes, with a bias of a slice's thickness and more: the nearest surface
// is removed from its slice, unless another surface is in that, too, and is added where its shadow begins.
TEST_F(SliceProducts, MovedSurfacesAreTheirTwin) {
  constexpr std::uint32_t kSize = 48, kSlices = 31;
  constexpr double kBias = 3;
  for (const bool hemicube : {false, true}) {
    const Stage stage(selftest::crowd(hemicube, false), 4, 4, light_samples(1));
    const CentreMaps maps(device(), stage, kSize, {0, 0}, {.layers = 2});
    ASSERT_EQ(maps.fitted.faces, hemicube ? 5U : 1U);
    const std::vector<float> layers = maps.read();
    const maps::gpu::LightView& view = maps.fitted.views.front();
    const maps::gpu::SlicePlanes planes = maps::slice_planes(maps.set(stage), maps::SliceRule::equal, kSlices);
    const auto words_of = [&](maps::DepthUse depth) {
      maps::Slices product(device(), {.count = kSlices, .depth = depth, .bias = kBias});
      render::Commands commands(device());
      product.record(commands, maps.set(stage));
      commands.submit();
      std::vector<std::uint32_t> words(maps.texel_count());
      product.buffer().read<std::uint32_t>(words);
      return words;
    };
    const auto slice_of = [&](double height) {
      for (std::uint32_t k = 0; k < kSlices; ++k) {
        if (height <= static_cast<double>(planes.limit[0][k])) return 1U << k;
      }
      return 0U;
    };
    // Returns whether the height is within rounding of a slice's end.
    const auto unsure = [&](double height) { return slice_of(height * (1 - 1e-6)) != slice_of(height * (1 + 1e-6)); };
    const std::vector<std::uint32_t> marked = words_of(maps::DepthUse::first);
    const glm::dvec2 extent = hemicube ? glm::dvec2(2) : glm::dvec2(view.side[0].upper - view.side[0].lower);
    const double forgiven = kBias * std::max(extent.x, extent.y) / kSize;
    for (const maps::DepthUse depth : {maps::DepthUse::second, maps::DepthUse::midpoint, maps::DepthUse::dual}) {
      const std::vector<std::uint32_t> found = words_of(depth);
      std::size_t moved = 0;
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (layers[i] == 1) continue;
        const std::size_t face = i / kSize / kSize, row = i / kSize % kSize;
        const double along = static_cast<double>(view.far) * (face > 0 ? (static_cast<double>(row) + 0.5) / kSize : 1),
                     nearest = along * static_cast<double>(layers[i]),
                     second = along * static_cast<double>(layers[found.size() + i]);
        const bool single = layers[found.size() + i] == 1;
        const double middle = 0.5 * (nearest + second) * (1 - forgiven);
        double begins = nearest;
        if (!single) {
          begins = depth == maps::DepthUse::second     ? second * (1 - forgiven)
                   : depth == maps::DepthUse::midpoint ? middle
                                                       : std::min(nearest, middle);
        }
        if (unsure(nearest) || unsure(second) || unsure(begins)) continue;
        std::uint32_t expected = marked[i];
        if (single || slice_of(second) != slice_of(nearest)) expected &= ~slice_of(nearest);
        if (depth != maps::DepthUse::second) expected |= slice_of(begins);
        EXPECT_EQ(found[i], expected) << "texel " << i;
        moved += expected != marked[i] ? 1 : 0;
      }
      if (depth != maps::DepthUse::dual) {
        EXPECT_GT(moved, 50U);
      }
    }
  }
}

TEST_F(SliceProducts, OnePlaneIsTheBlockersMeanHeightWithoutTheGround) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, 3});
  add_quad(scene, {-1, 2, 0}, {0.5, 0, 0}, {0, 0, 0.5});  // area 1 at distance 3
  add_quad(scene, {1, 1, 0}, {0.5, 0, 0}, {0, 0, 1.5});   // area 3 at distance 4
  scene.lights.push_back(ceiling_light(5, 0.5));
  scene.cameras.push_back(camera({0, 3, 8}, {0, 1, 0}));
  const Stage stage(scene, 4, 4, light_samples(1));
  const CentreMaps maps(device(), stage, 16);
  EXPECT_EQ(maps::ground_of(stage.floats, stage.light, maps.basis), 0U);
  EXPECT_NEAR(maps::slice_planes(maps.set(stage), maps::SliceRule::one_plane, 1).plane[0][0], 3.75, 1e-6);
  scene.objects[0].casts_shadow = false;
  const Stage lit(scene, 4, 4, light_samples(1));
  EXPECT_EQ(maps::ground_of(lit.floats, lit.light, maps.basis), maps::kNoObject);
  const CentreMaps its(device(), lit, 16);
  EXPECT_NEAR(maps::slice_planes(its.set(lit), maps::SliceRule::one_plane, 1).plane[0][0], 3.75, 1e-6);
}

/// A board parallel to the light.
struct Blocker {
  double height;
  glm::dvec2 lower, upper;  // in x and z
};
constexpr double kLight = 4, kHalf = 0.5, kFloor = 1;

/// The light's half size 0.5 at height 4 over a floor of half size 1 that casts no shadow.
scenes::Scene under_blockers(const std::vector<Blocker>& boards) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {kFloor, 0, 0}, {0, 0, kFloor}).casts_shadow = false;
  for (const Blocker& board : boards) {
    const glm::dvec2 middle = 0.5 * (board.lower + board.upper), half = 0.5 * (board.upper - board.lower);
    add_quad(scene, {middle.x, board.height, middle.y}, {half.x, 0, 0}, {0, 0, half.y}).receives_shadow = false;
  }
  scene.lights.push_back(ceiling_light(kLight, kHalf));
  scene.cameras.push_back(camera({0, 1, 3}, {0, 0, 0}));
  return scene;
}

Stage floor_stage(const std::vector<Blocker>& boards, std::uint32_t n = 32) {
  return {under_blockers(boards), n, n, light_samples(1),
          grid_samples(n, {0, 0, 0}, {0.97, 0, 0}, {0, 0, 0.97}, {0, 1, 0})};
}

/// The part of the light that `board` hides from p on the floor, as intervals on the light.
struct Shadow {
  glm::dvec2 lower, upper;  // on the light, −0.5 … 0.5
  [[nodiscard]] double share() const {
    const glm::dvec2 extent = glm::max(upper - lower, glm::dvec2(0));
    return extent.x * extent.y;
  }
};
Shadow shadow_of(const Blocker& board, const glm::dvec3& p) {
  const glm::dvec2 at(p.x, p.z);
  const double to_light = kLight / board.height;
  const auto on_light = [&](const glm::dvec2& corner) { return (at + (corner - at) * to_light) / (2 * kHalf); };
  return {glm::clamp(on_light(board.lower), -0.5, 0.5), glm::clamp(on_light(board.upper), -0.5, 0.5)};
}

/// Returns the largest error of a share if the board's four edges are known to half a texel and corners to 1/256: each
/// edge may move by this share of the window's width, which corresponds to the light's.
double half_texels(const CentreMaps& maps, double height) {
  const auto& side = maps.fitted.views.front().side[0];
  const glm::dvec2 texel = glm::dvec2(side.upper - side.lower) / static_cast<double>(maps.size);
  const double window = 2 * kHalf * (1 / (kLight - height) - 1 / kLight);
  return (2 * (0.5 + 1.0 / 256)) * (texel.x + texel.y) / window;
}

glm::dvec2 room_beside(const Stage& stage) {
  return maps::half_extent(stage.light, maps::light_basis(stage.light)) / maps::half_width(stage.light);
}

class SliceMethods : public MapsTest {
 protected:
  static constexpr std::uint32_t kSize = 1024;
  static glm::dvec3 world(const Stage& stage, std::size_t pixel) {
    return glm::dvec3(stage.samples.p[pixel]) + stage.floats.origin;
  }
};

// Eisemann and Décoret 2006, Soler and Sillion 1998: for one flat blocker parallel to the light the box filter gives
// the exact share of the light.
TEST_F(SliceMethods, OneFlatBlockerIsExactWithinHalfATexel) {
  const Blocker board{2, {-0.3, -0.2}, {0.25, 0.4}};
  const Stage stage = floor_stage({board});
  const CentreMaps maps(device(), stage, kSize, room_beside(stage));
  const double bound = half_texels(maps, board.height) + 1e-5;
  const Masks one = run(maps::make_occlusion_textures, stage, {{"slices", "1"}});
  const Masks blurred = run(maps::make_convolution, stage);
  const Masks taps = run(maps::make_pcss, stage, {{"blockerSamples", "1024"}, {"filterSamples", "1024"}});
  EXPECT_EQ(one.visibility, blurred.visibility);
  double worst = 0;
  std::size_t soft = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    const double exact = 1 - shadow_of(board, world(stage, i)).share(), off = std::abs(one.visibility[i] - exact);
    worst = std::max(worst, off);
    soft += exact > 0 && exact < 1 ? 1 : 0;
    EXPECT_LT(off, bound) << i;
    // 1024 taps of the R2 sequence are off by log₂ n / n of the light at each of four edges.
    EXPECT_NEAR(taps.visibility[i], exact, bound + 4 * 10.0 / 1024) << i;
  }
  RecordProperty("worst", std::to_string(worst));
  fmt::print("one flat blocker: off by {:.5f} at most, half texels allow {:.5f}\n", worst, bound);
  EXPECT_LT(bound, 0.012) << "2 % of the filter's width would move V by 0.01 and more";
  EXPECT_GT(soft, 500U);
}

// Eisemann et al. 2009, section 5.2.5: slices are multiplied, however their shadows overlap: disjoint, half over one
// another, or nested.
TEST_F(SliceMethods, TwoBlockersAreMultipliedInEveryLayout) {
  const Blocker upper{2, {-0.2, -0.5}, {0.1, 0.5}};
  for (const double shift : {0.45, 0.15, 0.0}) {
    // Seen from the floor's middle the boards are nested or side by side: `shift` moves the lower one's shadow on the
    // light.
    const Blocker lower{1, {-0.1 + shift, -0.4}, {0.05 + shift, 0.4}};
    // A speck far aside, above both boards, starts the slices, so that each board is at the far end of one: 2.25, 2, …,
    // 1.
    const Blocker speck{2.25, {-0.9, 0.9}, {-0.89, 0.91}};
    const Stage stage = floor_stage({upper, lower, speck});
    const CentreMaps maps(device(), stage, kSize, room_beside(stage));
    const double bound = half_texels(maps, upper.height) + half_texels(maps, lower.height) + 1e-5;
    const Masks found = run(maps::make_occlusion_textures, stage, {{"slices", "5"}});
    double fused = 0;
    std::size_t both = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const glm::dvec3 p = world(stage, i);
      if (p.x < -0.5 && p.z > 0.4) continue;  // here is the speck's shadow
      const Shadow a = shadow_of(upper, p), b = shadow_of(lower, p);
      const Shadow common{glm::max(a.lower, b.lower), glm::min(a.upper, b.upper)};
      EXPECT_NEAR(found.visibility[i], (1 - a.share()) * (1 - b.share()), bound) << i;
      const double exact = 1 - a.share() - b.share() + common.share();
      fused = std::max(fused, std::abs(found.visibility[i] - exact));
      both += a.share() > 0.05 && b.share() > 0.05 ? 1 : 0;
    }
    fmt::print("shift {}: product off the truth by up to {:.3f}\n", shift, fused);
    EXPECT_GT(both, 100U);
    EXPECT_GT(fused, 0.05) << "the product is not the truth";
  }
}

double error_of(const Stage& stage, const Masks& found, const Masks& truth) {
  const auto on_floor = [&](std::size_t i) { return stage.samples.triangle[i] == 0; };
  return rmse(stage, on_floor, [&](std::size_t i) { return found.visibility[i] - truth.visibility[i]; });
}

// Eisemann et al. 2009, section 5.2.5: convolution is exact for flat blockers only. The deeper a box reaches below its
// top, the larger the error.
TEST_F(SliceMethods, ConvolutionFailsWithTheBlockersExtentInDepth) {
  double before = 0;
  for (const double depth : {0.01, 0.6, 1.2}) {
    scenes::Scene scene = under_blockers({});
    std::vector<Corners> box = quad({0, 2, 0}, {0.3, 0, 0}, {0, 0, 0.3});
    for (const Corners& side : quad({0.3, 2 - depth / 2, 0}, {0, depth / 2, 0}, {0, 0, 0.3})) box.push_back(side);
    for (const Corners& side : quad({-0.3, 2 - depth / 2, 0}, {0, depth / 2, 0}, {0, 0, 0.3})) box.push_back(side);
    for (const Corners& side : quad({0, 2 - depth / 2, 0.3}, {0.3, 0, 0}, {0, depth / 2, 0})) box.push_back(side);
    for (const Corners& side : quad({0, 2 - depth / 2, -0.3}, {0.3, 0, 0}, {0, depth / 2, 0})) box.push_back(side);
    for (const Corners& side : quad({0, 2 - depth, 0}, {0.3, 0, 0}, {0, 0, 0.3})) box.push_back(side);
    add_object(scene, "box", box);
    const Stage stage(scene, 32, 32, light_samples(256),
                      grid_samples(32, {0, 0, 0}, {0.97, 0, 0}, {0, 0, 0.97}, {0, 1, 0}));
    const double error =
        error_of(stage, run(maps::make_convolution, stage), run(maps::make_accumulate, stage, {{"size", "256"}}));
    fmt::print("convolution of a box {} deep: RMSE {:.4f}\n", depth, error);
    EXPECT_GT(error, before);
    if (depth < 0.1) {
      EXPECT_LT(error, 0.02);
    }
    before = error;
  }
}

// Eisemann et al. 2009, section 5.2.5: there is no shadow within a slice. For a box on a floor that casts, too, the
// shadow near its foot is missing.
TEST_F(SliceMethods, WithinASliceOfTheFloorTheShadowIsMissing) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {kFloor, 0, 0}, {0, 0, kFloor});
  add_quad(scene, {0.2, 0.1, 0}, {0.3, 0, 0}, {0, 0, 0.3}).receives_shadow = false;  // within the last slice of 8
  add_quad(scene, {-0.8, 2, -0.8}, {0.1, 0, 0}, {0, 0, 0.1}).receives_shadow = false;
  scene.lights.push_back(ceiling_light(kLight, kHalf));
  scene.cameras.push_back(camera({0, 1, 3}, {0, 0, 0}));
  const Stage stage(scene, 32, 32, light_samples(1), grid_samples(32, {0, 0, 0}, {0.9, 0, 0}, {0, 0, 0.9}, {0, 1, 0}));
  const Masks found = run(maps::make_occlusion_textures, stage, {{"slices", "8"}}), taps = run(maps::make_pcss, stage);
  std::size_t missing = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    const glm::dvec3 p = world(stage, i);
    if (std::abs(p.x - 0.2) > 0.25 || std::abs(p.z) > 0.25) continue;
    EXPECT_EQ(found.visibility[i], 1.0F);
    EXPECT_EQ(taps.visibility[i], 0.0F);
    ++missing;
  }
  EXPECT_GT(missing, 50U);
}

}  // namespace
}  // namespace penumbra::tests
