// SPDX-License-Identifier: Apache-2.0
// Compares edge-scatter with rows=exact with the exact areas for lights of every shape: disks, ellipses, polygons,
// textures, spheres, suns.

#include "base/error.hpp"
#include "tests/agreement/volumes/exact_rows.hpp"
#include "tests/agreement/hostile_lamps.hpp"
#include "tests/agreement/lattice.hpp"
#include "tests/agreement/volumes/light_span.hpp"
#include "tests/agreement/volumes/soft_stage.hpp"
#include "volumes/edges/light_window.hpp"

#include <algorithm>
#include <cstring>

namespace penumbra::volumes {
namespace {

using tests::ExactRows;
using tests::SoftStage;
using visibility::Light;
using visibility::SceneFloats;
using visibility::ViewSamples;

enum class Shape : std::uint8_t { disk, ellipse, polygon, thin_polygon, textured, sphere, sun, thin_sun };
constexpr std::array kShapes{Shape::disk,     Shape::ellipse, Shape::polygon, Shape::thin_polygon,
                             Shape::textured, Shape::sphere,  Shape::sun,     Shape::thin_sun};
std::string name_of(Shape shape) {
  return shape == Shape::disk           ? "disk"
         : shape == Shape::ellipse      ? "ellipse"
         : shape == Shape::polygon      ? "polygon"
         : shape == Shape::thin_polygon ? "thinpolygon"
         : shape == Shape::textured     ? "textured"
         : shape == Shape::sphere       ? "sphere"
         : shape == Shape::sun          ? "sun"
                                        : "thinsun";
}

std::uint32_t below(std::mt19937& random, std::uint32_t end) {
  return static_cast<std::uint32_t>(random() % end);
}

/// Makes a polygon in the ellipse with the rectangle's axes: its frame, the first three corners, is at any angle. With
/// `many`, corners are so close together that the frame is a needle.
scenes::Polygon polygon_in(const scenes::Rectangle& r, bool many, std::mt19937& random) {
  const std::uint32_t count = many ? 40 + below(random, 60) : 3 + below(random, 5);
  std::vector<double> angles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double jitter = many ? 0 : below(random, 64) / 80.0;
    angles.push_back(2 * std::numbers::pi * (i + jitter) / count);
  }
  scenes::Polygon polygon;
  for (const double angle : angles)
    polygon.vertices.push_back(r.center + std::cos(angle) * r.half_u + std::sin(angle) * r.half_v);
  return polygon;
}

/// Turns the scene's first light, a rectangle, into another shape in its plane, about as large. (A sun shines in its
/// direction.)
void reshape(scenes::Scene& scene, Shape shape, std::mt19937& random) {
  scenes::AreaLight& light = scene.lights[0];
  const auto r = std::get<scenes::Rectangle>(light.shape);
  switch (shape) {
    case Shape::disk:
      light.shape = scenes::Disk{r.center, glm::cross(r.half_u, r.half_v),
                                 below(random, 2) == 0 ? glm::length(r.half_u) : 0.5 * glm::length(r.half_v)};
      break;
    case Shape::ellipse:
      light.shape = scenes::Ellipse{r.center, r.half_u, r.half_v};
      break;
    case Shape::polygon:
    case Shape::thin_polygon:
      light.shape = polygon_in(r, shape == Shape::thin_polygon, random);
      break;
    case Shape::sphere:
      light.shape = scenes::Sphere{r.center, 0.5 * std::min(glm::length(r.half_u), glm::length(r.half_v))};
      break;
    case Shape::sun:
    case Shape::thin_sun:
      light.shape = scenes::Sun{glm::cross(r.half_u, r.half_v), shape == Shape::thin_sun ? 0x1p-10
                                                                : below(random, 2) == 0  ? 100.0
                                                                                         : 10.0};
      break;
    case Shape::textured: {
      scenes::Texture texture{"made by hand", 1 + below(random, 7), 1 + below(random, 5), {}};
      for (std::uint32_t i = 0; i < texture.width * texture.height; ++i) {
        const auto share = [&] { return static_cast<float>(below(random, 5)) / 4; };
        const float red = share(), green = share(), blue = share();
        texture.texels.emplace_back(red, green, blue);
      }
      texture.texels.back() = {1, 1, 1};  // ensures that not all are black
      light.texture = texture;
      break;
    }
  }
}

class ExactRowsOfShapes : public ExactRows, public testing::WithParamInterface<std::tuple<const char*, Shape>> {};

TEST_P(ExactRowsOfShapes, AreTheExactAreas) {
  const auto [name, shape] = GetParam();
  std::mt19937 random(7);
  scenes::Scene scene = tests::shipped_scene(name);
  reshape(scene, shape, random);
  const std::uint32_t side = shape == Shape::thin_polygon ? 28 : 40;  // the exact areas of many corners take long
  const SoftStage stage(scene, device(), side, side);
  Found found;
  compare(stage.floats, stage.light, stage.samples, tests::kExactRowsTolerance, found);
  fmt::print("{} {}: {} pixels, {} partly lit, {} unproven, off by {:.1e} at most, form factors by {:.1e}\n", name,
             name_of(shape), found.pixels, found.partly, found.unproven, found.largest, found.largest_form_factor);
  EXPECT_EQ(found.wrong, 0U);
  EXPECT_TRUE(found.partly > 15U || shape == Shape::thin_sun)
      << found.partly;  // a thousandth of a degree is too thin for that
  // Some hundred times 2⁻⁵³ of the scene's extent is more than 2⁻²⁶ of the area that so thin a sun covers: where edges
  // cross that area, integer arithmetic is used.
  EXPECT_LE(found.unproven, found.pixels / 200 + (shape == Shape::thin_sun ? 2 * found.partly : 0));
  EXPECT_EQ(found.wrong_form_factors, 0U);
}
INSTANTIATE_TEST_SUITE_P(Shipped, ExactRowsOfShapes,
                         testing::Combine(testing::Values("bunny", "contact", "fusion", "room", "thin"),
                                          testing::ValuesIn(kShapes)),
                         [](const auto& it) {
                           return std::string(std::get<0>(it.param)) + name_of(std::get<1>(it.param));
                         });

/// Form factors found together with V or afterwards are the same, and so is V. Tests the rectangle, then all other
/// shapes.
TEST_F(ExactRows, FormFactorsAreTheSameOnTheWay) {
  const auto same = [](const auto& a, const auto& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
  };
  for (std::size_t i = 0; i <= kShapes.size(); ++i) {
    std::mt19937 random(11);
    scenes::Scene scene = tests::shipped_scene("contact");
    if (i > 0) reshape(scene, kShapes[i - 1], random);
    SCOPED_TRACE(i > 0 ? name_of(kShapes[i - 1]) : "rectangle");
    const SoftStage stage(scene, device(), 32, 32);
    const auto method = make();
    const auto [shares, form_factors] = run(*method, stage.floats, stage.light, stage.samples);
    const auto counters = method->counters();
    for (const bool wanted : {true, false, true}) {
      method->want_form_factors(wanted);
      const auto again = run(*method, stage.floats, stage.light, stage.samples);
      EXPECT_TRUE(same(again.shares, shares)) << wanted;
      EXPECT_TRUE(same(again.form_factors, form_factors)) << wanted;
      EXPECT_EQ(method->counters(), counters) << wanted;
    }
    const auto partly = std::ranges::count_if(shares, [](float share) { return share > 0 && share < 1; });
    EXPECT_TRUE(partly > 10 || (i > 0 && kShapes[i - 1] == Shape::thin_sun)) << partly;
  }
}

/// Everything coincides with something: edges along tangents and through the centre, ends on the rim and on the
/// outline.
TEST_F(ExactRows, LatticeSoupsUnderShapes) {
  for (const Shape shape : kShapes) {
    Found found;
    for (const int range : {1, 2, 4}) {
      for (std::uint32_t seed = 0; seed < 30; ++seed) {
        tests::LatticeSoup soup(seed + 7000 * static_cast<std::uint32_t>(range), range);
        visibility::SampleRequest request;
        scenes::Scene scene = lattice_scene(soup, request);
        if (!std::holds_alternative<scenes::Rectangle>(scene.lights[0].shape)) continue;
        reshape(scene, shape, soup.random());
        const SceneFloats floats = visibility::make_scene_floats(scene);
        const Light light = visibility::make_light(scene, 0, floats.origin, {});
        const ViewSamples samples = tests::samples_on_triangles(floats, 8, 8, soup.random());
        SCOPED_TRACE(fmt::format("{} seed {} range {}", name_of(shape), seed, range));
        compare(floats, light, samples, tests::kExactRowsTolerance, found);
      }
    }
    fmt::print("{}: {} view samples, {} partly lit, {} unproven, off by {:.1e} at most, form factors by {:.1e}\n",
               name_of(shape), found.pixels, found.partly, found.unproven, found.largest, found.largest_form_factor);
    EXPECT_EQ(found.wrong, 0U);
    EXPECT_EQ(found.wrong_form_factors, 0U);
    EXPECT_GT(found.partly, found.pixels / 20);
  }
}

class LooksAtHostileShapes : public ExactRows {
 protected:
  static void look(tests::Hostility hostility, Shape shape, std::uint32_t first, std::uint32_t count) {
    Found found;
    std::uint32_t refused = 0, without_area = 0, seed = first;
    for (; seed < first + count && found.wrong == 0; ++seed) {
      SCOPED_TRACE(fmt::format("{} {} seed {}", name_of(hostility), name_of(shape), seed));
      tests::HostileLamp lamp(hostility, seed);
      scenes::Scene scene = lamp.scene();
      reshape(scene, shape, lamp.random());
      const SceneFloats floats = visibility::make_scene_floats(scene);
      const std::optional<Light> light = tests::light_with_area(scene, floats.origin, {});
      without_area += light ? 0 : 1;
      if (!light) continue;
      const ViewSamples samples = tests::hostile_samples(floats, lamp.random(), 6, 8);
      try {
        compare(floats, *light, samples, tests::kExactRowsTolerance, found);
      } catch (const InputError& error) {  // because of the window around such a light
        if (!tests::refuses_size(error)) throw;
        ++refused;
      }
    }
    EXPECT_LE(refused + without_area, count / 100);
    fmt::print(
        "{} {}: {} lamps, {} refused, {} without an area, {} view samples, {} partly lit, {} unproven, off by {:.2e} "
        "at most\n",
        name_of(hostility), name_of(shape), count, refused, without_area, found.pixels, found.partly, found.unproven,
        found.largest);
    EXPECT_EQ(found.wrong, 0U) << "last seed: " << seed - 1;
    EXPECT_GT(found.partly, found.pixels / 50);
    EXPECT_LT(found.unproven, found.pixels / 2);
  }
};

class HostileShapes : public LooksAtHostileShapes,
                      public testing::WithParamInterface<std::tuple<tests::Hostility, Shape>> {};
TEST_P(HostileShapes, AreTheExactAreas) {
  look(std::get<0>(GetParam()), std::get<1>(GetParam()), 0, 60);
}
INSTANTIATE_TEST_SUITE_P(Kinds, HostileShapes,
                         testing::Combine(testing::ValuesIn(tests::kHostilities), testing::ValuesIn(kShapes)),
                         [](const auto& it) {
                           return tests::name_of(std::get<0>(it.param)) + name_of(std::get<1>(it.param));
                         });

/// With h / (H − h) in the thousands, edges were lost when X − foot was computed from feet rounded over the whole
/// light.
class PanelsUnderThinSuns : public LooksAtHostileShapes, public testing::WithParamInterface<std::uint32_t> {};
TEST_P(PanelsUnderThinSuns, KeepTheirEdges) {
  look(tests::Hostility::panels, Shape::thin_sun, GetParam() - 30, 60);
}
INSTANTIATE_TEST_SUITE_P(Seeds, PanelsUnderThinSuns, testing::Values(4951u, 19207u, 42460u));

/// A hundred thousand lamps of each kind and shape, in ten parts, so that a stopped run can be continued.
class ManyHostileShapes : public LooksAtHostileShapes,
                          public testing::WithParamInterface<std::tuple<tests::Hostility, Shape, std::uint32_t>> {};
TEST_P(ManyHostileShapes, AreTheExactAreasFull) {
  const auto [hostility, shape, part] = GetParam();
  look(hostility, shape, 1000 + 10000 * part, 10000);
}
INSTANTIATE_TEST_SUITE_P(Kinds, ManyHostileShapes,
                         testing::Combine(testing::ValuesIn(tests::kHostilities), testing::ValuesIn(kShapes),
                                          testing::Range(0u, 10u)),
                         [](const auto& it) {
                           return fmt::format("{}{}{}", tests::name_of(std::get<0>(it.param)),
                                              name_of(std::get<1>(it.param)), std::get<2>(it.param));
                         });

/// The window contains the outline, whatever the frame, and its places agree with its axes.
TEST(LightWindow, HoldsThePolygon) {
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    tests::HostileLamp lamp(tests::Hostility::needles, static_cast<std::uint32_t>(round));
    scenes::Scene scene = lamp.scene();
    reshape(scene, round % 2 == 0 ? Shape::polygon : Shape::thin_polygon, random);
    const SceneFloats floats = visibility::make_scene_floats(scene);
    const Light light = visibility::make_light(scene, 0, floats.origin, {});
    const LightWindow window = window_of(light);
    const WindowAxes axes = axes_of(light, window);
    const auto [center, u, v] = visibility::light_frame(light);
    for (const glm::dvec2 share : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0.25, 0.75)}) {
      const glm::dvec2 st = window.frame_place(share);
      const glm::dvec3 off = center + st.x * u + st.y * v - (axes.corner + share.x * axes.u + share.y * axes.v);
      EXPECT_LT(glm::length(off),
                1e-12 * axes.skew * (glm::length(axes.u) + glm::length(axes.v) + glm::length(center)));
    }
    EXPECT_LT(std::abs(glm::dot(axes.u, axes.v)), 1e-9 * axes.skew * glm::length(axes.u) * glm::length(axes.v));
    for (const glm::vec3& corner : light.outline) {
      const glm::dvec3 d = glm::dvec3(corner) - axes.corner;
      for (const glm::dvec3& side : {axes.u, axes.v}) {
        const double share = glm::dot(d, side) / glm::dot(side, side);
        EXPECT_GT(share, 0.01);
        EXPECT_LT(share, 0.99);
      }
    }
  }
}

}  // namespace
}  // namespace penumbra::volumes
