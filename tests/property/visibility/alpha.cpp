// SPDX-License-Identifier: Apache-2.0
// Tests the effect of surfaces that let light through on pairs: against docs/definitions.md evaluated literally, with
// crossing points, texture coordinates and texels in GMP's rationals, on lattices where coincidences are the rule; and
// against closed forms.
#include "visibility/alpha/alpha_filter.hpp"

#include "tests/property/literal_truth.hpp"
#include "tests/unit/visibility/scenes.hpp"
#include "visibility/masks/visible_share.hpp"
#include "visibility/pair_truth.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <random>

namespace penumbra::visibility {
namespace {

using namespace tests::rational;
using scenes::Alpha;
using scenes::PictureUse;

/// Far too small to change a lattice point's sign or texel.
const Rational kTiny(1, mpz_class("1000000000000000000000000000000"));

mpz_class floor_of(const Rational& x) {
  mpz_class result;
  mpz_fdiv_q(result.get_mpz_t(), x.get_num_mpz_t(), x.get_den_mpz_t());
  return result;
}

/// Returns the texel of a coordinate, by counting: repeat and mirror fold the integer, clamp stops at the ends. Returns
/// nullopt on a border between texels, where rounding may choose either.
std::optional<std::size_t> literal_texel(const Rational& place, std::uint32_t size, PictureUse::Wrap wrap) {
  const Rational at = place * size;
  if (floor_of(at) == at) return std::nullopt;
  long texel = floor_of(at).get_si();
  const auto count = static_cast<long>(size);
  if (wrap == PictureUse::Wrap::clamp)
    return static_cast<std::size_t>(texel < 0 ? 0 : texel >= count ? count - 1 : texel);
  const long period = wrap == PictureUse::Wrap::mirror ? 2 * count : count;
  texel = (texel % period + period) % period;
  if (texel >= count) texel = period - 1 - texel;
  return static_cast<std::size_t>(texel);
}

/// A scene of lattice triangles with a picture, with the truth of its pairs.
struct Leaves {
  scenes::Scene scene;
  std::mt19937 random;

  Leaves(std::uint32_t seed, bool under_a_sun) : random(seed) {
    scene.lights.push_back(tests::rectangle_light(point(), {1, 0, 0}, {0, 1, 1}));
    std::get<scenes::Rectangle>(scene.lights[0].shape).center.z += 1;
    scene.lights[0].two_sided = true;
    if (under_a_sun)
      scene.lights[0].shape =
          scenes::Sun{point() + glm::dvec3(0.25, 0.5, 0.125), static_cast<double>(number(0, 1) * 60)};
    scene.pictures.push_back({"leaf", 3, 2, {}});
    for (int i = 0; i < 6; ++i)
      scene.pictures[0].texels.push_back({0, 0, 0, static_cast<std::uint8_t>(number(0, 1) * 255)});
    std::vector<tests::Corners> soup, leaves(static_cast<std::size_t>(number(2, 8)));
    for (tests::Corners& corners : leaves) corners = {point(), point(), point()};
    for (int i = number(0, 2); i > 0; --i) soup.push_back({point(), point(), point()});
    soup.push_back({glm::dvec3(-2), glm::dvec3(2), glm::dvec3(2, 2, -2)});  // keeps the origin at 0
    tests::add_object(scene, "soup", soup);
    scenes::Object& leaf = tests::add_object(scene, "leaf", leaves);
    leaf.alpha = {Alpha::Mode::mask, 1, 0.5};
    leaf.picture =
        PictureUse{0, static_cast<PictureUse::Wrap>(number(0, 2)), static_cast<PictureUse::Wrap>(number(0, 2))};
    for (std::size_t i = 0; i < scene.soup.positions.size(); ++i)
      scene.looks.places.emplace_back(0.25 * number(-5, 9), 0.25 * number(-5, 9));
  }
  int number(int lowest, int highest) { return std::uniform_int_distribution<int>(lowest, highest)(random); }
  glm::dvec3 point() {
    const double x = number(-2, 2), y = number(-2, 2), z = number(-2, 2);
    return {x, y, z};
  }
};

/// Returns whether the texel is solid where the segment meets the triangle's plane; nullopt on a border.
std::optional<bool> literal_is_there(const scenes::Scene& scene, const SceneFloats& floats, std::uint32_t triangle,
                                     const Vector& p, const Vector& direction) {
  const auto corners = floats.corners(triangle);
  const tests::ExactTriangle exactly(corners);
  const Rational t = -exactly.height(p) / dot(exactly.normal, direction);
  const Vector q = p + t * direction;
  const Rational area = dot(exactly.normal, exactly.normal);
  const std::array shares{Rational(dot(cross(exactly.b - q, exactly.c - q), exactly.normal) / area),
                          Rational(dot(cross(exactly.c - q, exactly.a - q), exactly.normal) / area),
                          Rational(dot(cross(exactly.a - q, exactly.b - q), exactly.normal) / area)};
  Rational u(0), v(0);
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec2& place = scene.looks.places[floats.triangles[triangle][i]];
    u += shares[i] * Rational(place.x);
    v += shares[i] * Rational(place.y);
  }
  const scenes::Picture& picture = scene.pictures[0];
  const PictureUse& use = *scene.objects[1].picture;
  const auto column = literal_texel(u, picture.width, use.wrap_s), row = literal_texel(v, picture.height, use.wrap_t);
  if (!column || !row) return std::nullopt;
  return picture.texels[*row * picture.width + *column][3] >= 128;
}

/// The seed, and whether the light is a sun. For a sun, a pair is a ray without end.
class AlphaOnLattice : public testing::TestWithParam<std::tuple<std::uint32_t, bool>> {};

TEST_P(AlphaOnLattice, TexelsDecide) {
  std::size_t by_mask = 0, stopped = 0, passed = 0;
  const auto [seed, under_a_sun] = GetParam();
  for (std::uint32_t round = 0; round < 60; ++round) {
    Leaves leaves(seed * 1000 + round, under_a_sun);
    const SceneFloats floats = make_scene_floats(leaves.scene);
    const Light light = make_light(leaves.scene, 0, glm::dvec3(0), {0, 3, 3, SamplePattern::grid, 0});
    EXPECT_EQ(light.filtered_by, "leaf");
    ViewSamples samples;
    for (std::uint32_t carrier = 0; carrier < floats.triangles.size(); ++carrier) {
      if (floats.plane[carrier] == SceneFloats::kNoPlane) continue;
      const auto [a, b, c] = floats.corners(carrier);
      samples.triangle.push_back(static_cast<std::int32_t>(carrier));
      samples.p.push_back(0.25f * a + 0.25f * b + 0.5f * c);
      samples.facing.push_back(leaves.number(0, 1) == 0 ? std::int8_t{-1} : std::int8_t{1});
    }
    samples.width = static_cast<std::uint32_t>(samples.size());
    samples.height = 1;
    // The answer of a method that ignores alpha: all triangles are solid.
    SceneFloats solids = floats;
    solids.alphas.casters.clear();
    std::vector<std::uint32_t> masks(samples.size());
    const auto is_visible = [&](const SceneFloats& scene, std::size_t pixel, std::uint32_t j) {
      return decide_pair(scene, samples, pixel, light, j).outcome == PairOutcome::visible;
    };
    for (std::size_t pixel = 0; pixel < samples.size(); ++pixel) {
      for (std::uint32_t j = 0; j < 9; ++j) masks[pixel] |= is_visible(solids, pixel, j) ? 1u << j : 0;
    }
    const std::vector<std::uint32_t> unfiltered = masks;
    by_mask += AlphaFilter(floats).filter(samples, light, 0, {masks, {}, {}}).mask_pairs;
    for (std::size_t pixel = 0; pixel < samples.size(); ++pixel) {
      const auto carrier = static_cast<std::uint32_t>(samples.triangle[pixel]);
      for (std::uint32_t j = 0; j < 9; ++j) {
        if ((unfiltered[pixel] >> j & 1u) == 0) continue;
        const Vector p = exact(samples.p[pixel]);
        const Vector direction = light.sun ? exact(light.points[j]) : Vector(exact(light.points[j]) - p);
        const Vector u = light.sun ? exact(light.sun->axis_u) : Vector(exact(light.center_u) - exact(light.center));
        const Vector v = light.sun ? exact(light.sun->axis_v) : Vector(exact(light.center_v) - exact(light.center));
        const Vector moved = direction + kTiny * u + kTiny * kTiny * v;
        bool visible = true, certain = true;
        for (const std::uint32_t leaf : floats.alphas.casters) {
          if (floats.plane[leaf] == floats.plane[carrier] ||
              !tests::meets({p, moved, direction, !light.sun}, floats.corners(leaf)))
            continue;
          const auto there = literal_is_there(leaves.scene, floats, leaf, p, direction);
          certain &= there.has_value();
          visible &= !there.value_or(false);
        }
        ASSERT_EQ((masks[pixel] >> j & 1u) != 0, is_visible(floats, pixel, j))
            << "both decisions are exact, also on borders of texels";
        if (!certain) continue;
        ASSERT_EQ((masks[pixel] >> j & 1u) != 0, visible)
            << "seed " << seed << " round " << round << " pixel " << pixel << " sample " << j;
        ++(visible ? passed : stopped);
      }
    }
  }
  EXPECT_GT(by_mask, 200u);
  EXPECT_GT(stopped, 100u);
  EXPECT_GT(passed, 100u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, AlphaOnLattice, testing::Combine(testing::Range(0u, 4u), testing::Bool()));

/// A floor under a square light, with surfaces in between.
struct UnderPanes {
  scenes::Scene scene;
  UnderPanes() {
    tests::add_quad(scene, {0, 0, 0}, {8, 0, 0}, {0, 0, -8});
    scene.lights.push_back(tests::ceiling_light(4, 0.5));
  }
  void add(double height, double alpha, const glm::dvec3& center = glm::dvec3(0), double half = 8) {
    scenes::Object& pane = tests::add_quad(scene, center + glm::dvec3(0, height, 0), {half, 0, 0}, {0, 0, -half});
    pane.alpha = {Alpha::Mode::blend, alpha, 0.5};
  }
  /// Returns V at the point below the light's middle, if no opaque surface is in between.
  [[nodiscard]] float share(const glm::vec3& p = glm::vec3(0)) const {
    const SceneFloats floats = make_scene_floats(scene);
    const Light light = make_light(scene, 0, floats.origin, {256, 0, 0, SamplePattern::rows, 0});
    ViewSamples samples;
    samples.triangle = {0};
    samples.p = {p - glm::vec3(floats.origin)};
    samples.facing = {1};
    std::vector<std::uint32_t> mask(light.words_per_mask(), 0xffffffffu);
    std::vector<float> transmittances(light.sample_count());
    std::vector<std::uint8_t> dimmed(1);
    const AlphaFilter filter(floats);
    EXPECT_EQ(filter.dims(light), true);
    filter.filter(samples, light, 0, {mask, transmittances, dimmed});
    EXPECT_EQ(visible_share(light, mask), 1) << "translucent surfaces must not change bits";
    return dimmed[0] != 0 ? dimmed_share(light, mask, transmittances, glm::vec3(0, 1, 0)) : 1;
  }
};

TEST(AlphaFilters, PanesMultiply) {
  UnderPanes one;
  one.add(1, 0.3);
  EXPECT_FLOAT_EQ(one.share(), 0.7f);
  one.add(2, 0.5);
  EXPECT_FLOAT_EQ(one.share(), 0.35f);
  one.add(3, 1);
  EXPECT_EQ(one.share(), 0) << "a pane with an alpha of 1 blocks all light, though bits ignore it";
}

/// A pane at half the light's height that ends below the light's middle covers, as seen from below, half of the light.
TEST(AlphaFilters, APaneMayHideAPart) {
  UnderPanes half;
  half.add(2, 0.6, {4, 0, 0}, 4);
  EXPECT_NEAR(half.share(), 1 - 0.6 / 2, 0.6 / 32 + 1e-6) << "at most half of one of 16 columns is wrong";
}

TEST(AlphaFilters, VerticesAndFactorsMultiply) {
  UnderPanes panes;
  panes.add(2, 0.5);
  for (std::size_t i = 0; i < panes.scene.soup.positions.size(); ++i)
    panes.scene.looks.colors.emplace_back(1, 1, 1, 0.5f);
  EXPECT_FLOAT_EQ(panes.share(), 0.75f);
}

/// Casters are searched in the pyramid from p to the light samples that it sees. None of thousands of specks is missed,
/// not even those on the pyramid's sides.
TEST(AlphaFilters, FindEverySpeck) {
  for (const bool under_a_sun : {false, true}) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> real(-1, 1);
    const auto point = [&](double size) { return size * glm::dvec3(real(random), real(random), real(random)); };
    scenes::Scene scene;
    tests::add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 0, -1});
    scene.lights.push_back(tests::ceiling_light(4, 1));
    if (under_a_sun) scene.lights[0].shape = scenes::Sun{{0, -1, 0}, 30};
    std::vector<tests::Corners> specks;
    for (int i = 0; i < 4000; ++i) {
      const glm::dvec3 at = glm::dvec3(0, 2, 0) + glm::dvec3(2, 1.9, 2) * point(1);
      specks.push_back({at + point(0.1), at + point(0.1), at + point(0.1)});
    }
    tests::add_object(scene, "specks", specks).alpha = {Alpha::Mode::mask, 1, 0.5};
    const SceneFloats floats = make_scene_floats(scene);
    const Light light = make_light(scene, 0, floats.origin, {64, 8, 8, SamplePattern::grid, 0});
    ViewSamples samples;
    const auto [a, b, c] = floats.corners(0);
    const bool up = glm::cross(b - a, c - a).y > 0;
    for (int row = 0; row < 8; ++row) {
      for (int column = 0; column < 8; ++column) {
        const float s = 0.125f * static_cast<float>(column), t = s * 0.125f * static_cast<float>(row);
        samples.triangle.push_back(0);
        samples.p.push_back(a + s * (b - a) + t * (c - b));
        samples.facing.push_back(up ? std::int8_t{1} : std::int8_t{-1});
      }
    }
    samples.width = samples.height = 8;
    std::vector<std::uint32_t> masks(2 * samples.size(), 0xffffffffu);
    AlphaFilter(floats).filter(samples, light, 0, {masks, {}, {}});
    int stopped = 0;
    for (std::size_t pixel = 0; pixel < samples.size(); ++pixel) {
      for (std::uint32_t j = 0; j < 64; ++j) {
        const bool visible = (masks[2 * pixel + j / 32] >> j % 32 & 1u) != 0;
        ASSERT_EQ(visible, decide_pair(floats, samples, pixel, light, j).outcome == PairOutcome::visible)
            << (under_a_sun ? "sun, " : "rectangle, ") << pixel << " " << j;
        stopped += visible ? 0 : 1;
      }
    }
    EXPECT_GT(stopped, 1000);
    EXPECT_LT(stopped, 3000);
  }
}

/// p is rounded, so that its own surface may be between p and the light. Neither that surface nor others in its plane
/// may hide anything.
TEST(AlphaFilters, ASurfaceDoesNotHideItself) {
  scenes::Scene scene;
  for (const double x : {-1.0, 1.0}) {
    tests::add_quad(scene, glm::dvec3(x, 0.375 * x, 0), {1, 0.375, 0}, {0.1, 0.0375, -1}).alpha = {Alpha::Mode::mask, 1,
                                                                                                   0.5};
  }
  scene.lights.push_back(tests::ceiling_light(4, 1));
  const SceneFloats floats = make_scene_floats(scene);
  const Light light = make_light(scene, 0, floats.origin, {16, 4, 4, SamplePattern::grid, 0});
  std::mt19937 random(11);
  std::uniform_real_distribution<float> real(0, 0.5F);
  ViewSamples samples;
  for (std::int32_t i = 0; i < 400; ++i) {
    const auto [a, b, c] = floats.corners(static_cast<std::uint32_t>(i % 4));
    samples.triangle.push_back(i % 4);
    samples.p.push_back(a + real(random) * (b - a) + real(random) * (c - a));
    samples.facing.push_back(glm::cross(b - a, c - a).y > 0 ? std::int8_t{1} : std::int8_t{-1});
  }
  samples.width = 400;
  samples.height = 1;
  std::vector<std::uint32_t> masks(samples.size(), 0xffffU);
  AlphaFilter(floats).filter(samples, light, 0, {masks, {}, {}});
  EXPECT_EQ(masks, std::vector<std::uint32_t>(samples.size(), 0xffffU));
}

/// If all corners of a triangle have the same value, it has that value everywhere, to the last digit, though other
/// vertices differ.
TEST(AlphaFilters, WhatCornersShareHasNoNoise) {
  for (const float vertex : {1.0F, 0.75F}) {
    scenes::Scene scene;
    scenes::Object& solid = tests::add_quad(scene, {0, 0, 0}, {1, 0.3, 0}, {0, 0.2, 1});
    solid.alpha = {Alpha::Mode::mask, 1, double{vertex}};
    solid.picture = PictureUse{0};
    scene.pictures.push_back({"checks", 2, 1, {{0, 0, 0, 255}, {}}});
    scene.lights.push_back(tests::ceiling_light(4, 0.5));
    for (std::size_t i = 0; i < 4; ++i) {
      scene.looks.places.emplace_back(
          1, 0.5);  // between two texels, of which the first one is solid because of repetition
      scene.looks.colors.emplace_back(1, 1, 1, vertex);
    }
    tests::add_quad(scene, {9, 0, 0}, {1, 0, 0}, {0, 0, 1});
    scene.looks.places.resize(8);
    scene.looks.colors.resize(8, glm::vec4(1, 1, 1, 0.5F));
    const SceneFloats floats = make_scene_floats(scene);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> real(0, 1);
    for (int i = 0; i < 2000; ++i) {
      const glm::dvec3 aim = glm::dvec3(real(random), 0, real(random)), direction(real(random), -1, real(random));
      const glm::dvec3 shares = shares_on_line(aim - direction, direction, floats.corners(0));
      EXPECT_EQ(alpha_at(floats, 0, shares), double{vertex});
      EXPECT_EQ(transmittance_at(floats, 0, shares), 0);
    }
  }
}

TEST(AlphaFilters, AnObjectsFlagsHold) {
  UnderPanes panes;
  panes.add(2, 0.5);
  panes.scene.objects[1].casts_shadow = false;
  SceneFloats floats = make_scene_floats(panes.scene);
  EXPECT_TRUE(floats.alphas.casters.empty());
  EXPECT_EQ(make_light(panes.scene, 0, floats.origin, {}).filtered_by, "");
  panes.scene.objects[1].casts_shadow = true;
  panes.scene.lights[0].unshaded_by = {1};
  floats = make_scene_floats(panes.scene);
  EXPECT_EQ(floats.alphas.casters.size(), 2u);
  const Light light = make_light(panes.scene, 0, floats.origin, {});
  EXPECT_TRUE(cast_for(floats, light).alphas.casters.empty());
  EXPECT_EQ(light.filtered_by, "");
}

}  // namespace
}  // namespace penumbra::visibility
