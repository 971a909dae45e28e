// SPDX-License-Identifier: Apache-2.0
// Tests bitmask with one map: each bit against the occluders one by one, and relations between occluders, levels,
// layers and sums that hold on every scene or on every scene of a class.

#include "maps/backprojection/level_maps.hpp"
#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/parallel_square.hpp"
#include "reference/methods.hpp"
#include "tests/analytic/maps/backprojection/patch_twin.hpp"

#include <random>
#include <set>

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

class MapsBitmask : public MapsTest {
 protected:
  static Masks bits(const Stage& stage, const MethodOptions& options, const char* size = "48") {
    MethodOptions all{{"size", size}};
    for (const auto& [key, value] : options) all[key] = value;
    return run(maps::make_bitmask, stage, all);
  }
  static bool receives(const Stage& stage, std::size_t i) {
    return visibility::is_receiver(stage.floats, stage.light, stage.samples, i);
  }
  /// Whether everything that `less` hides is hidden in `more` too.
  static testing::AssertionResult hides_no_less(const Masks& more, const Masks& less) {
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < more.words.size(); ++i) wrong += (more.words[i] & ~less.words[i]) != 0 ? 1 : 0;
    if (wrong == 0) return testing::AssertionSuccess();
    return testing::AssertionFailure() << wrong << " words";
  }

  /// Expects every bit to agree with the polygons, except for samples within `margin` of a polygon's border.
  static void expect_bits(const scenes::Scene& scene, const visibility::SampleRequest& request, Occluder kind,
                          const char* name, bool by_hand = true) {
    constexpr double kMargin = 2e-5;
    const Stage stage = by_hand ? on_floor(scene, 12, request) : Stage(scene, 14, 14, request);
    const PatchTwin twin(device(), stage, 32);
    const Masks found = bits(stage, {{"occluder", name}, {"search", "none"}}, "32");
    std::size_t wrong = 0, hidden = 0, pairs = 0, near = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!receives(stage, i)) continue;
      const auto polygons = twin.occluders(i, kind);
      for (std::uint32_t j = 0; j < stage.light.sample_count(); ++j) {
        double most = -1e30;
        for (const PatchTwin::Polygon& polygon : polygons) {
          most = std::max(most, PatchTwin::inside(polygon, twin.light_sample(j)));
        }
        ++pairs;
        near += std::abs(most) <= kMargin ? 1 : 0;
        hidden += most > 0 ? 1 : 0;
        if (std::abs(most) > kMargin && found.visible(i, j) != (most < 0)) ++wrong;
      }
    }
    EXPECT_EQ(wrong, 0U) << name << " of " << pairs;
    EXPECT_GT(hidden, pairs / 20);
    EXPECT_LT(hidden, pairs * 19 / 20);
    EXPECT_LT(near, pairs / 100) << "the margin hides what it should show";
  }
};

TEST_F(MapsBitmask, EachBitIsWhatTheOccludersSay) {
  scenes::Scene disk = oblique_quad(0.3);
  disk.lights.front().shape = scenes::Disk{{0, 5, 0}, {0, -1, 0}, 0.7};
  visibility::SampleRequest sobol = light_samples(77);
  sobol.pattern = visibility::SamplePattern::sobol;
  for (const auto& [kind, name] : {std::pair(Occluder::patch, "patch"), std::pair(Occluder::quad, "quad"),
                                   std::pair(Occluder::triangle, "triangle")}) {
    expect_bits(sphere_over_floor(1, 8), light_samples(64), kind, name);
    expect_bits(oblique_quad(0.4), sobol, kind, name);
    expect_bits(disk, light_samples(100), kind, name);
  }
}

// Quads and triangles are facets between points of the surface. Here they are tested in every face of a hemicube.
TEST_F(MapsBitmask, QuadsInAHemicube) {
  scenes::Scene scene = bare_floor(0.5, 1.5);
  add_quad(scene, {-1.5, 2.5, 0}, {0, 0, 1.5}, {0, 2.5, 0}).casts_shadow = false;  // a wall up to the light's plane
  add_quad(scene, {-0.8, 3.6, 0.2}, {0.3, 0.05, 0.1}, {0.05, 0.2, -0.3}).receives_shadow = false;
  add_quad(scene, {0.5, 2.6, 0.2}, {0.3, 0.1, 0.1}, {0.1, 0.1, -0.3}).receives_shadow = false;
  scene.cameras.front() = camera({1.5, 3, 1}, {-1, 1.5, 0}, 70);
  expect_bits(scene, light_samples(64), Occluder::triangle, "triangle", false);
}

TEST_F(MapsBitmask, TrianglesHideAllThatQuadsDoAndLayersAllThatFewerDo) {
  for (const scenes::Scene& scene : {sphere_over_floor(), square_above_plate(), oblique_quad(0.5)}) {
    const Stage stage = on_floor(scene, 9, light_samples(64));
    EXPECT_TRUE(hides_no_less(bits(stage, {{"occluder", "triangle"}}), bits(stage, {{"occluder", "quad"}})));
    for (const char* occluder : {"patch", "quad", "triangle"}) {
      Masks before = bits(stage, {{"occluder", occluder}, {"layers", "1"}});
      for (const char* layers : {"2", "3"}) {
        Masks more = bits(stage, {{"occluder", occluder}, {"layers", layers}});
        EXPECT_TRUE(hides_no_less(more, before)) << occluder << ", " << layers << " layers";
        before = std::move(more);
      }
    }
  }
}

// Facets between points of a convex body lie inside it: what they hide is hidden. The rasteriser may move the body's
// corners by up to 1/256 texel, here 2.1 · 3 / 48 / 256 = 5e-4 at the body's depth: bits are compared with a body that
// is 1/500 larger.
TEST_F(MapsBitmask, NothingVisibleIsHiddenByQuadsAndTrianglesOfAConvexBody) {
  for (const double light : {0.3, 1.0}) {
    const Stage stage = on_floor(sphere_over_floor(light), 16, light_samples(64)),
                larger = on_floor(sphere_over_floor(light, 16, 1.002), 16, light_samples(64));
    ASSERT_EQ(stage.floats.origin, larger.floats.origin);
    for (const char* occluder : {"quad", "triangle"}) {
      for (const char* layers : {"1", "3"}) {
        const Masks found = bits(stage, {{"occluder", occluder}, {"layers", layers}});
        std::size_t wrongly_dark = 0, wrongly_lit = 0, pairs = 0;
        for (std::size_t i = 0; i < stage.samples.size(); ++i) {
          if (!receives(stage, i)) continue;
          for (std::uint32_t j = 0; j < 64; ++j) {
            const bool visible = visibility::decide_pair(stage.floats, stage.samples, i, stage.light, j).outcome ==
                                 visibility::PairOutcome::visible;
            const bool past_larger =
                visible && visibility::decide_pair(larger.floats, stage.samples, i, stage.light, j).outcome ==
                               visibility::PairOutcome::visible;
            ++pairs;
            wrongly_dark += past_larger && !found.visible(i, j) ? 1 : 0;
            wrongly_lit += !visible && found.visible(i, j) ? 1 : 0;
          }
        }
        fmt::print("{} of {} layers, light {}: of {} pairs {} wrongly dark, {} wrongly lit\n", occluder, layers, light,
                   pairs, wrongly_dark, wrongly_lit);
        EXPECT_EQ(wrongly_dark, 0U);
        EXPECT_GT(wrongly_lit, 0U) << "a sphere's silhouette is not all seen from the centre";
      }
    }
  }
}

// The union of patches is no more than their sum. With 16 × 16 samples each edge of a patch may gain a whole row or
// column, 1/16; patches of one surface share their edges, and its outline has two edges along each axis.
TEST_F(MapsBitmask, AUnionOfPatchesIsNoMoreThanTheirSum) {
  for (const scenes::Scene& scene :
       {sphere_over_floor(), square_above_plate(), oblique_quad(0.4), box_over_floor(0.5)}) {
    const Stage stage = on_floor(scene, 9, light_samples(256));
    for (const char* fill : {"none", "edges", "diagonal"}) {
      const Masks joined = bits(stage, {{"occluder", "patch"}, {"fill", fill}});
      const Masks sum = run(maps::make_backproject, stage, {{"size", "48"}, {"fill", fill}, {"search", "mssm"}});
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        EXPECT_GE(joined.visibility[i], sum.visibility[i] - 2.0F / 16) << fill << ", pixel " << i;
      }
    }
  }
}

TEST_F(MapsBitmask, ASearchChangesNoBit) {
  for (const scenes::Scene& scene : {sphere_over_floor(), square_above_plate(), oblique_quad(0.2)}) {
    const Stage stage = on_floor(scene, 9, light_samples(64));
    for (const char* occluder : {"quad", "triangle", "patch"}) {
      const Masks plain = bits(stage, {{"occluder", occluder}, {"search", "none"}});
      for (const char* search : {"hsm", "mssm", "ysm"}) {
        const Masks found = bits(stage, {{"occluder", occluder}, {"search", search}});
        for (std::size_t i = 0; i < stage.samples.size(); ++i) {
          const bool same = found.visibility[i] == plain.visibility[i];
          EXPECT_TRUE(same || (occluder == std::string("patch") && found.visibility[i] == 0))
              << occluder << ", " << search << ", pixel " << i;
        }
      }
    }
  }
}

// Two scenes with the same map have the same image: the light's centre cannot tell them apart.
TEST_F(MapsBitmask, OneMapOneImage) {
  const Stage gap = on_floor(plates_with_gap(true), 16, light_samples(64)),
              whole = on_floor(plates_with_gap(false), 16, light_samples(64));
  ASSERT_EQ(gap.floats.origin, whole.floats.origin);
  for (const char* occluder : {"patch", "quad", "triangle", "rect"}) {
    EXPECT_EQ(bits(gap, {{"occluder", occluder}}).words, bits(whole, {{"occluder", occluder}}).words);
  }
  for (const char* fill : {"none", "edges", "diagonal"}) {
    const MethodOptions options{{"size", "48"}, {"fill", fill}};
    EXPECT_EQ(run(maps::make_backproject, gap, options).visibility,
              run(maps::make_backproject, whole, options).visibility);
  }
  EXPECT_NE(run(maps::make_accumulate, gap).words, run(maps::make_accumulate, whole).words);
}

TEST_F(MapsBitmask, UmbraAndFullLightAreExactAndLevelsFinite) {
  scenes::Scene scene = parallel_square();
  scene.objects[0].casts_shadow = false;
  const Stage stage(scene, 32, 32, light_samples(64));
  const ParallelSquare exact(stage);
  for (const char* occluder : {"patch", "quad", "triangle", "rect"}) {
    const Masks found = bits(stage, {{"occluder", occluder}}, "96");
    std::set<float> levels;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      levels.insert(found.visibility[i]);
      EXPECT_EQ(found.visibility[i] * 64, std::round(found.visibility[i] * 64));
      if (!exact.on_floor(i)) continue;
      // A texel is 0.087 wide on the floor; quads lose half a texel of the square on each side, which is 2.5 times as
      // wide on the floor.
      const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
      const double off = std::max(std::abs(p.x), std::abs(p.z));
      if (off < 1 - 0.25) {
        EXPECT_EQ(found.visibility[i], 0) << occluder;
      } else if (off > 7.0 / 3 + 0.25) {
        EXPECT_EQ(found.visibility[i], 1) << occluder;
      }
    }
    EXPECT_GT(levels.size(), 8U);
    EXPECT_LE(levels.size(), 65U);
  }
}

/// Mean of V − the exact V of the pairs.
double bias_of(const Stage& stage, const Masks& found) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (!visibility::is_receiver(stage.floats, stage.light, stage.samples, i)) continue;
    for (std::uint32_t j = 0; j < stage.light.sample_count(); ++j) {
      sum += (found.visible(i, j) ? 1 : 0) -
             (visibility::decide_pair(stage.floats, stage.samples, i, stage.light, j).outcome ==
                      visibility::PairOutcome::visible
                  ? 1
                  : 0);
    }
    count += stage.light.sample_count();
  }
  return sum / static_cast<double>(count);
}

// A bar that is less than a texel wide has no four centres next to each other: quads and triangles lose it. Patches are
// a texel wide, which is right on average. The window holds ±1.2 / 5 in 46 texels: 0.0104 each, 0.0261 at the bars'
// depth.
TEST_F(MapsBitmask, BarsThinnerThanATexelAreLostToQuadsAndNotToPatches) {
  const Stage thin = on_floor(bars(0.02), 16, light_samples(64)), wide = on_floor(bars(0.12), 16, light_samples(64));
  const Masks quads = bits(thin, {{"occluder", "quad"}}), triangles = bits(thin, {{"occluder", "triangle"}});
  for (std::size_t i = 0; i < thin.samples.size(); ++i) {
    EXPECT_EQ(quads.visibility[i], 1);
    EXPECT_EQ(triangles.visibility[i], 1);
  }
  const double lost = bias_of(thin, quads), kept = bias_of(thin, bits(thin, {{"occluder", "patch"}}));
  const double wide_lost = bias_of(wide, bits(wide, {{"occluder", "quad"}}));
  fmt::print("bars of 0.77 texels: bias of quads {:+.3f}, patches {:+.3f}; of 4.6 texels, quads {:+.3f}\n", lost, kept,
             wide_lost);
  EXPECT_GT(lost, 0.05);
  EXPECT_LT(std::abs(kept), lost / 2);
}

// Each texel of a level has the nearest depth of its block: patches grow, quads shrink, and boxes are never larger than
// blocks.
TEST_F(MapsBitmask, LevelsFattenPatchesAndBoxesLess) {
  for (const bool thin : {true, false}) {
    const scenes::Scene scene = thin ? bars(0.06) : square_above_plate();
    const Stage stage = on_floor(scene, 12, light_samples(64));
    EXPECT_EQ(bits(stage, {{"occluder", "rect"}}).words, bits(stage, {{"occluder", "patch"}}).words);
    double before = 1;
    for (const char* level : {"0", "1", "2", "3"}) {
      const Masks patch = bits(stage, {{"occluder", "patch"}, {"level", level}}, "64"),
                  box = bits(stage, {{"occluder", "rect"}, {"level", level}}, "64");
      EXPECT_TRUE(hides_no_less(patch, box)) << level;
      const double patch_bias = bias_of(stage, patch), box_bias = bias_of(stage, box),
                   quad_bias = bias_of(stage, bits(stage, {{"occluder", "quad"}, {"level", level}}, "64"));
      fmt::print("level {}: bias of patches {:+.3f}, boxes {:+.3f}, quads {:+.3f}\n", level, patch_bias, box_bias,
                 quad_bias);
      // A block at the border of two surfaces takes the nearer depth and loses the other surface's texels: so these
      // relations hold for bars only.
      if (thin) {
        EXPECT_LE(patch_bias, before);
        EXPECT_LE(std::abs(box_bias), std::abs(patch_bias));
      }
      before = patch_bias;
    }
  }
}

TEST_F(MapsBitmask, ALevelHasTheNearestOfEachBlockAndTheBoxAroundIt) {
  std::mt19937 random(7);
  const visibility::Light light{};
  const maps::LightBasis basis{};
  const visibility::SceneFloats scene{};
  const render::Buffer views(device(), "views", sizeof(maps::gpu::LightView));
  for (const auto& [size, level, faces] : {std::tuple(16U, 1U, 1U), std::tuple(37U, 3U, 2U), std::tuple(9U, 2U, 5U)}) {
    std::vector<float> depths(std::size_t{size} * size * faces);
    for (float& depth : depths) depth = random() % 4 != 0 ? 1.0F : static_cast<float>(random() % 1000) / 1000;
    const render::Buffer maps = render::make_buffer<float>(device(), "depths", depths);
    maps::LevelMaps product(device(), level, level);
    render::Commands commands(device());
    product.record(commands, {views, maps, faces, size, light, basis, scene});
    commands.submit();
    const std::uint32_t side = maps::gpu::level_size(size, level), width = 1U << level;
    std::vector<std::uint32_t> words(std::size_t{2} * faces * side * side);
    product.buffer().read<std::uint32_t>(words);
    for (std::uint32_t i = 0; i < faces * side * side; ++i) {
      const std::uint32_t face = i / (side * side), x0 = i % side * width, y0 = i / side % side * width;
      float nearest = 1;
      std::array<std::uint32_t, 4> box{255, 0, 255, 0};
      for (std::uint32_t y = y0; y < std::min(y0 + width, size); ++y) {
        for (std::uint32_t x = x0; x < std::min(x0 + width, size); ++x) {
          const float depth = depths[(std::size_t{face} * size + y) * size + x];
          if (depth == 1) continue;
          nearest = std::min(nearest, depth);
          box = {std::min(box[0], x - x0), std::max(box[1], x - x0), std::min(box[2], y - y0),
                 std::max(box[3], y - y0)};
        }
      }
      EXPECT_EQ(std::bit_cast<float>(words[std::size_t{2} * i]), nearest);
      EXPECT_EQ(words[2 * i + 1], box[0] | box[1] << 8 | box[2] << 16 | box[3] << 24);
    }
  }
}

TEST_F(MapsBitmask, ALightWithoutExtentGivesTheShadowMap) {
  scenes::Scene scene = sphere_over_floor();
  scene.lights.front() = ceiling_light(5, 1e-6);
  const Stage stage = on_floor(scene, 40, light_samples(4));
  const Masks hard = run(maps::make_shadow_map, stage, {{"size", "48"}});
  EXPECT_EQ(bits(stage, {{"occluder", "patch"}}).visibility, hard.visibility);
}

// Row B11 of docs/predicates.md (Schwarz and Stamminger 2008): under a budget neighbouring pixels may use different
// levels, and V has a step there. When samples are shared out between two levels, the step vanishes.
TEST_F(MapsBitmask, BlendedLevelsHaveSmallerSteps) {
  // The places are so close together that the errors of neighbours hardly differ.
  std::vector<double> places;
  for (int i = 0; i < 250; ++i) places.push_back(-2.5 + i / 50.0);
  const Stage stage = along_floor(sphere_over_floor(1, 16), places, light_samples(256));
  const Masks truth = tests::run(*reference::make_exact({}), stage);
  const auto with = [&](MethodOptions options) {
    options["occluder"] = "patch";  // the search makes its kernels as wide as each receiver needs
    return bits(stage, options, "96");
  };
  std::vector<Masks> levels;
  for (const char* level : {"0", "1", "2", "3"}) levels.push_back(with({{"level", level}}));
  const auto is_level = [&](const Masks& found, std::size_t pixel, const Masks& level) {
    const auto words = static_cast<std::ptrdiff_t>(found.words_per_pixel),
               at = static_cast<std::ptrdiff_t>(pixel) * words;
    return std::equal(found.words.begin() + at, found.words.begin() + at + words, level.words.begin() + at);
  };
  const auto error = [&](const Masks& found, std::size_t i) {
    return static_cast<double>(found.visibility[i]) - static_cast<double>(truth.visibility[i]);
  };
  double step = 0, blend = 0;
  std::size_t changes = 0;
  for (const char* budget : {"90", "150", "250", "400", "700"}) {
    const Masks blended = with({{"budget", budget}}), stepped = with({{"budget", budget}, {"blend", "off"}});
    for (std::size_t i = 0; i + 1 < stage.samples.size(); ++i) {
      bool one = false, same = false;
      for (const Masks& level : levels) {
        one |= is_level(stepped, i, level);
        same |= is_level(stepped, i, level) && is_level(stepped, i + 1, level);
      }
      EXPECT_TRUE(one) << "each pixel looks at one level";
      if (same) continue;
      ++changes;
      step = std::max(step, std::abs(error(stepped, i + 1) - error(stepped, i)));
      blend = std::max(blend, std::abs(error(blended, i + 1) - error(blended, i)));
    }
  }
  fmt::print("B11: {} changes of level, largest step {:.4f}, blended {:.4f}\n", changes, step, blend);
  RecordProperty("step", fmt::format("{:.4f}", step));
  RecordProperty("blended", fmt::format("{:.4f}", blend));
  EXPECT_GE(changes, 2U);
  EXPECT_LE(blend, 0.5 * step);
  // A large enough budget changes nothing.
  EXPECT_EQ(with({{"budget", "1000000"}}).words, levels.front().words);
}

// A kernel of w texels a side under a budget of b gets level log2(w / sqrt(b)), rounded up.
TEST_F(MapsBitmask, TheBudgetSaysWhichLevel) {
  scenes::Scene scene = bare_floor(1, 3);
  add_quad(scene, {0.013, 2, 0.007}, {0.231, 0, 0}, {0, 0, -0.157}).receives_shadow = false;
  const Stage stage = on_floor(scene, 1, light_samples(1024));  // the floor's middle
  const auto with = [&](MethodOptions options) {
    options["occluder"] = "patch";
    options["search"] = "none";
    options["blend"] = "off";
    return bits(stage, options, "200").words;
  };
  // The window holds the floor, +-3/5, and nothing beside it, in 198 texels; the plate is at depth 3.
  const double across = 2 * (1.0 / 3 - 1.0 / 5) / (1.2 / 198);
  const auto budget = [&](double texels) { return with({{"budget", fmt::format("{:.0f}", texels)}}); };
  std::vector<std::vector<std::uint32_t>> levels;
  for (const char* level : {"0", "1", "2", "3"}) levels.push_back(with({{"level", level}}));
  EXPECT_NE(levels[0], levels[1]);
  EXPECT_NE(levels[1], levels[2]);
  // The kernel is up to two texels wider than the plate's part that it holds; with a budget of just that many texels
  // the finest level is used.
  double too_few = std::floor(0.98 * across * across), enough = std::ceil(1.02 * (across + 2) * (across + 2));
  EXPECT_EQ(budget(too_few), levels[1]);
  EXPECT_EQ(budget(enough), levels[0]);
  while (enough - too_few > 1) {
    const double middle = std::floor((too_few + enough) / 2);
    (budget(middle) == levels[0] ? enough : too_few) = middle;
  }
  for (const std::size_t level : {std::size_t{1}, std::size_t{2}}) {
    const double texels = std::exp2(-2.0 * static_cast<double>(level)) * enough;
    EXPECT_EQ(budget(std::ceil(1.005 * texels)), levels[level]) << level;
    EXPECT_EQ(budget(std::floor(0.995 * texels)), levels[level + 1]) << level;
  }
}

}  // namespace
}  // namespace penumbra::tests
