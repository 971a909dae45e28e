// Surfaces that let light through, against docs/definitions.md evaluated literally: crossing points, texture
// coordinates and texels in GMP's rationals, on lattices where coincidences are the rule; and closed forms.
#include "visibility/alpha/alpha_filter.hpp"

#include "tests/property/literal_truth.hpp"
#include "tests/unit/visibility/scenes.hpp"
#include "visibility/alpha/panes.hpp"
#include "visibility/masks/visible_share.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/tree/view_walk.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <random>

namespace penumbra::visibility {
namespace {

using namespace tests::rational;
using scenes::Alpha;
using scenes::PictureUse;

/// Far below what moves a lattice point's sign or texel.
const Rational kTiny(1, mpz_class("1000000000000000000000000000000"));

mpz_class floor_of(const Rational& x) {
  mpz_class result;
  mpz_fdiv_q(result.get_mpz_t(), x.get_num_mpz_t(), x.get_den_mpz_t());
  return result;
}

/// The texel of a coordinate, by counting: repeat and mirror fold the whole number, clamp stops at the ends. Nothing
/// on a border between two, where rounding may say either.
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

/// A scene of a lattice's triangles under a picture, with the truth of its pairs.
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

/// Is there a texel where the way meets the triangle's plane? Nothing on a border.
std::optional<bool> literal_is_there(const scenes::Scene& scene, const SceneFloats& floats, std::uint32_t triangle,
                                     const Vector& p, const Vector& way) {
  const auto corners = floats.corners(triangle);
  const tests::ExactTriangle exactly(corners);
  const Rational t = -exactly.height(p) / dot(exactly.normal, way);
  const Vector q = p + t * way;
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

/// The seed, and whether the light is a sun: of those a pair is a ray without end.
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
    // What a method would say that knows nothing of leaves.
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
        const Vector way = light.sun ? exact(light.points[j]) : Vector(exact(light.points[j]) - p);
        const Vector u = light.sun ? exact(light.sun->axis_u) : Vector(exact(light.center_u) - exact(light.center));
        const Vector v = light.sun ? exact(light.sun->axis_v) : Vector(exact(light.center_v) - exact(light.center));
        const Vector moved = way + kTiny * u + kTiny * kTiny * v;
        bool visible = true, certain = true;
        for (const std::uint32_t leaf : floats.alphas.casters) {
          if (floats.plane[leaf] == floats.plane[carrier] ||
              !tests::meets({p, moved, way, !light.sun}, floats.corners(leaf)))
            continue;
          const auto there = literal_is_there(leaves.scene, floats, leaf, p, way);
          certain &= there.has_value();
          visible &= !there.value_or(false);
        }
        ASSERT_EQ((masks[pixel] >> j & 1u) != 0, is_visible(floats, pixel, j)) << "both exact, certain or not";
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
  /// V at the point below the light's middle, if nothing that stops all light is there.
  float share(const glm::vec3& p = glm::vec3(0)) {
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
    EXPECT_EQ(visible_share(light, mask), 1) << "bits ignore what is translucent";
    return dimmed[0] != 0 ? dimmed_share(light, mask, transmittances) : 1;
  }
};

TEST(AlphaFilters, PanesMultiply) {
  UnderPanes one;
  one.add(1, 0.3);
  EXPECT_FLOAT_EQ(one.share(), 0.7f);
  one.add(2, 0.5);
  EXPECT_FLOAT_EQ(one.share(), 0.35f);
  one.add(3, 1);
  EXPECT_EQ(one.share(), 0) << "an alpha of 1 lets nothing through, and is no bit's business all the same";
}

/// A pane that ends below the middle of the light at half its height hides, seen from below, half of it.
TEST(AlphaFilters, APaneMayHideAPart) {
  UnderPanes half;
  half.add(2, 0.6, {4, 0, 0}, 4);
  EXPECT_NEAR(half.share(), 1 - 0.6 / 2, 0.6 / 32 + 1e-6) << "one of 16 columns, cut in the middle of cells";
}

TEST(AlphaFilters, VerticesAndFactorsMultiply) {
  UnderPanes panes;
  panes.add(2, 0.5);
  for (std::size_t i = 0; i < panes.scene.soup.positions.size(); ++i)
    panes.scene.looks.colors.emplace_back(1, 1, 1, 0.5f);
  EXPECT_FLOAT_EQ(panes.share(), 0.75f);
}

/// One value at all corners is that value anywhere, to the last digit, though vertices elsewhere have others.
TEST(AlphaFilters, WhatCornersShareHasNoNoise) {
  for (const float vertex : {1.0F, 0.75F}) {
    scenes::Scene scene;
    scenes::Object& solid = tests::add_quad(scene, {0, 0, 0}, {1, 0.3, 0}, {0, 0.2, 1});
    solid.alpha = {Alpha::Mode::mask, 1, double{vertex}};
    solid.picture = PictureUse{0};
    scene.pictures.push_back({"checks", 2, 1, {{0, 0, 0, 255}, {}}});
    scene.lights.push_back(tests::ceiling_light(4, 0.5));
    for (std::size_t i = 0; i < 4; ++i) {
      scene.looks.places.emplace_back(1, 0.5);  // between two texels: the first, by repetition
      scene.looks.colors.emplace_back(1, 1, 1, vertex);
    }
    tests::add_quad(scene, {9, 0, 0}, {1, 0, 0}, {0, 0, 1});
    scene.looks.places.resize(8);
    scene.looks.colors.resize(8, glm::vec4(1, 1, 1, 0.5F));
    const SceneFloats floats = make_scene_floats(scene);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> real(0, 1);
    for (int i = 0; i < 2000; ++i) {
      const glm::dvec3 aim = glm::dvec3(real(random), 0, real(random)), way(real(random), -1, real(random));
      const glm::dvec3 shares = shares_on_line(aim - way, way, floats.corners(0));
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

/// A card of three by two texels, half of them holes, before a wall; and panes before both.
struct Card {
  scenes::Scene scene;
  Card() {
    tests::add_quad(scene, {0, 0, -3}, {5, 0, 0}, {0, 5, 0});
    scenes::Object& card = tests::add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    card.alpha = {Alpha::Mode::mask, 1, 0.5};
    card.picture = PictureUse{0};
    scene.pictures.push_back({"card", 3, 2, {{0, 0, 0, 255}, {}, {0, 0, 0, 128}, {0, 0, 0, 127}, {0, 0, 0, 200}, {}}});
    for (const glm::dvec3& position : scene.soup.positions) {
      scene.looks.places.emplace_back((position.x + 1) / 2, (1 - position.y) / 2);
    }
    scene.lights.push_back(tests::ceiling_light(4, 0.5));
  }
};

TEST(ViewsThroughHoles, AreOfWhatIsBehind) {
  Card card;
  scenes::Camera seen = tests::camera({0.2, 0.1, 4}, {0, 0, 0}, 40);
  for (const bool parallel : {false, true}) {
    if (parallel) seen.height = 2.5;
    const SceneFloats floats = make_scene_floats(card.scene);
    const PinholeCamera view = make_camera(seen, floats.origin, 37, 29);
    const ViewSamples truth = brute_force_view_samples(floats, view);
    const ViewSamples walked = walk_view_samples(floats, view);
    EXPECT_EQ(truth.triangle, walked.triangle);
    EXPECT_EQ(truth.p, walked.p);
    card.scene.objects[1].alpha = {};
    const SceneFloats filled = make_scene_floats(card.scene);
    card.scene.objects[1].alpha = {Alpha::Mode::mask, 1, 0.5};
    ViewSamples solid = brute_force_view_samples(filled, view);
    EXPECT_NE(solid.triangle, truth.triangle);
    EXPECT_EQ(look_through(floats, view, solid).triangle, truth.triangle);
    std::array<int, 4> seen_on{};
    for (std::size_t i = 0; i < truth.size(); ++i) {
      // The texel that the pixel's ray meets, of the card in the plane z = 0.
      const ViewRay ray = view.ray(static_cast<std::uint32_t>(i % 37), static_cast<std::uint32_t>(i / 37));
      const glm::dvec3 at =
          ray.start + floats.origin - (ray.start.z + floats.origin.z) / ray.direction.z * ray.direction;
      if (std::abs(at.x) >= 1 || std::abs(at.y) >= 1 || std::abs(at.y) < 1e-9) continue;  // or between two texels
      const int column = static_cast<int>((at.x + 1) / 2 * 3), row = static_cast<int>((1 - at.y) / 2 * 2);
      const bool is_there = (row == 0 && column != 1) || (row == 1 && column == 1);
      EXPECT_EQ(truth.triangle[i] >= 2, is_there) << at.x << " " << at.y;
      ++seen_on[is_there ? 1 : 0];
    }
    EXPECT_GT(seen_on[0], 50);
    EXPECT_GT(seen_on[1], 50);
  }
}

/// Only what may be behind a hole is looked at again: nothing that is may be forgotten, wherever in the picture, or
/// beside or behind the eye, a small card with holes and all others are.
TEST(ViewsThroughHoles, AreFoundWhereverTheyAre) {
  std::size_t looked_through = 0;
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1, 1);
    const auto point = [&](double size) { return size * glm::dvec3(real(random), real(random), real(random)); };
    scenes::Scene scene;
    std::vector<tests::Corners> soup;
    for (int i = 0; i < 60; ++i) {
      const glm::dvec3 middle = point(3);
      soup.push_back({middle + point(1), middle + point(1), middle + point(1)});
    }
    tests::add_object(scene, "soup", soup);
    scenes::Object& card = tests::add_quad(scene, point(1.5), point(0.4), point(0.4));
    card.alpha = {Alpha::Mode::mask, 1, 0.5};
    card.picture = PictureUse{0};
    scene.pictures.push_back({"card", 2, 1, {{0, 0, 0, 255}, {}}});
    for (std::size_t i = 0; i < scene.soup.positions.size(); ++i) scene.looks.places.emplace_back(real(random), 0.5);
    scene.lights.push_back(tests::ceiling_light(4, 0.5));
    scenes::Camera camera = tests::camera(point(1) + glm::dvec3(0, 0, 3), point(0.5), 50);
    if (seed % 3 == 0) camera.height = 4;
    const SceneFloats floats = make_scene_floats(scene);
    const std::uint32_t width = seed % 10 == 9 ? 1 : 31, height = seed % 10 == 8 ? 1 : 23;
    const PinholeCamera view = make_camera(camera, floats.origin, width, height);
    const ViewSamples truth = brute_force_view_samples(floats, view);
    scene.objects[1].alpha = {};
    const ViewSamples solid = brute_force_view_samples(make_scene_floats(scene), view);
    looked_through += solid.triangle != truth.triangle ? 1 : 0;
    EXPECT_EQ(look_through(floats, view, solid).triangle, truth.triangle) << "seed " << seed;
  }
  EXPECT_GT(looked_through, 30u);
}

/// The rays of an orthographic camera are parallel: p is where its pixel is, whatever the distance.
TEST(OrthographicViews, KeepDistancesAcross) {
  Card card;
  scenes::Camera seen = tests::camera({0, 0, 7}, {0, 0, 0});
  seen.height = 4;
  const SceneFloats floats = make_scene_floats(card.scene);
  const PinholeCamera view = make_camera(seen, floats.origin, 16, 8);
  const ViewSamples samples = walk_view_samples(floats, view);
  for (std::uint32_t y = 0; y < 8; ++y) {
    for (std::uint32_t x = 0; x < 16; ++x) {
      const std::size_t i = std::size_t{y} * 16 + x;
      const glm::dvec3 world = glm::dvec3(samples.p[i]) + floats.origin;
      EXPECT_NEAR(world.x, (x + 0.5) / 16 * 8 - 4, 1e-6);
      EXPECT_NEAR(world.y, 2 - (y + 0.5) / 8 * 4, 1e-6);
      EXPECT_NEAR(samples.depth[i], world.z < -1 ? 10 : 7, 1e-6);
      EXPECT_EQ(samples.n[i], glm::vec3(0, 0, 1));
    }
  }
}

TEST(PaneLayers, AreBeforeWhatIsSeenAndInOrder) {
  Card card;
  const auto add_pane = [&](double z, double alpha) {
    tests::add_quad(card.scene, {0, 0, z}, {3, 0, 0}, {0, 3, 0}).alpha = {Alpha::Mode::blend, alpha, 0.5};
    card.scene.looks.places.resize(card.scene.soup.positions.size());
  };
  add_pane(-4, 0.9);  // behind the wall
  add_pane(1, 0.25);
  add_pane(-1, 0.5);  // behind the card
  add_pane(2, 0);     // nothing
  const SceneFloats floats = make_scene_floats(card.scene);
  const PinholeCamera view = make_camera(tests::camera({0, 0, 6}, {0, 0, 0}, 30), floats.origin, 21, 21);
  const ViewSamples seen = brute_force_view_samples(floats, view);
  for (const std::int32_t triangle : seen.triangle) EXPECT_TRUE(triangle < 4) << "panes carry nothing";
  const Panes panes(floats, seen);
  ASSERT_EQ(panes.depth(), 2u);
  const std::array layers{panes.layer(0), panes.layer(1)};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(layers[0].alpha[i], 0.25f);
    EXPECT_NEAR(layers[0].samples.depth[i], 5, 1e-6);
    const bool card_before = seen.triangle[i] >= 2;
    EXPECT_EQ(layers[1].alpha[i], card_before ? 0.0f : 0.5f);
    EXPECT_EQ(layers[1].samples.triangle[i] == ViewSamples::kBackground, card_before);
  }
}

/// Rays through what triangles have in common meet one surface, whichever objects these are of; faces that coincide are
/// two surfaces.
TEST(PaneLayers, SeamsAreOneSurface) {
  const auto quads = [](std::initializer_list<glm::dvec3> centers) {
    scenes::Scene scene;
    tests::add_quad(scene, {0, 0, -3}, {5, 0, 0}, {0, 5, 0});
    for (const glm::dvec3& center : centers)
      tests::add_quad(scene, center, {1, 0, 0}, {0, 1, 0}).alpha = {Alpha::Mode::blend, 0.5, 0.5};
    scene.lights.push_back(tests::ceiling_light(4, 0.5));
    return scene;
  };
  const auto depths = [](const scenes::Scene& scene) {
    const SceneFloats floats = make_scene_floats(scene);
    // Odd: the middle's rays pass through the seam x = 0, the diagonals of quads, and the corner at (0, 0).
    const PinholeCamera view = make_camera(tests::camera({0, 0, 6}, {0, 0, 0}, 30), floats.origin, 21, 21);
    const ViewSamples seen = brute_force_view_samples(floats, view);
    const Panes panes(floats, seen);
    std::vector<int> counts(seen.size());
    for (std::size_t layer = 0; layer < panes.depth(); ++layer) {
      const std::vector<float> alpha = panes.layer(layer).alpha;
      for (std::size_t i = 0; i < alpha.size(); ++i) counts[i] += alpha[i] > 0 ? 1 : 0;
    }
    return counts;
  };
  const std::vector<int> four = depths(quads({{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(four, std::vector<int>(four.size(), 1));
  const std::vector<int> twice = depths(quads({{0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(std::ranges::count(twice, 2), std::ranges::count_if(twice, [](int depth) { return depth > 0; }));
  EXPECT_GT(std::ranges::count(twice, 2), 30);
}

}  // namespace
}  // namespace penumbra::visibility
