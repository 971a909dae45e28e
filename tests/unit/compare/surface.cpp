// SPDX-License-Identifier: Apache-2.0
// Colours of surfaces, compared with closed forms of interpolation, wrapping and filtering.
#include "compare/surface.hpp"

#include "compare/beauty.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace penumbra::compare {
namespace {

using scenes::PictureUse;

/// A triangle in the plane z = 0, seen from above at these points.
struct Surface {
  scenes::Scene scene;
  visibility::SceneFloats floats;
  visibility::ViewSamples samples;

  explicit Surface(const std::vector<glm::vec3>& points) {
    scene.soup.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    scene.soup.triangles = {{0, 1, 2}};
    scene.soup.object = {0};
    scene.soup.source_face = {0};
    scenes::Object object;
    object.color = {1, 0.5, 0.25};
    scene.objects = {object};
    scene.origin = glm::dvec3(0);
    floats = visibility::make_scene_floats(scene);
    samples.width = static_cast<std::uint32_t>(points.size());
    samples.height = 1;
    samples.p = points;
    samples.n.assign(points.size(), {0, 0, 1});
    samples.triangle.assign(points.size(), 0);
  }
  /// Adds a picture of 4 x 2 texels, red 0 or 255: its point (0, 0) is the triangle's first corner, and (1, 1) lies
  /// outside the triangle.
  void paint(PictureUse use) {
    scenes::Picture picture{"p", 4, 2, {}};
    for (const int red : {0, 255, 255, 0, 255, 0, 0, 255})
      picture.texels.push_back({static_cast<std::uint8_t>(red), 255, 255, 255});
    scene.pictures = {picture};
    scene.objects[0].picture = use;
    scene.looks.places = {{0, 0}, {1, 0}, {0, 1}};
  }
  [[nodiscard]] std::vector<double> reds() const {
    std::vector<double> all;
    for (const glm::dvec3& color : look_at(scene, floats, samples, false).colors) all.push_back(color.r);
    return all;
  }
};

TEST(Surface, ColoursOfVerticesAreLinear) {
  Surface stage({{1, 1, 0}, {0, 0, 0}, {2, 0, 0}});
  EXPECT_TRUE(look_at(stage.scene, stage.floats, stage.samples, false).colors.empty())
      << "empty: the colours of objects are enough";
  stage.scene.looks.colors = {{1, 1, 1, 1}, {0, 1, 1, 1}, {0.5f, 0, 1, 1}};
  const auto colors = look_at(stage.scene, stage.floats, stage.samples, false).colors;
  EXPECT_LT(glm::distance(colors[0], glm::dvec3(0.5 + 0.125, 0.5 * 0.75, 0.25)), 1e-15);
  EXPECT_EQ(colors[1], glm::dvec3(1, 0.5, 0.25));
  EXPECT_EQ(colors[2].r, 0.5);
  stage.samples.triangle[0] = visibility::ViewSamples::kBackground;
  EXPECT_EQ(look_at(stage.scene, stage.floats, stage.samples, false).colors[0], glm::dvec3(0));
}

TEST(Surface, PicturesAreFilteredBetweenTexelCentres) {
  // Centres of the upper row's texels are at x = 0.5, 1.5, 2.5, 3.5, its height at y = 1 of 4.
  Surface stage({{0.5f, 1, 0}, {1.5f, 1, 0}, {1, 1, 0}, {0.75f, 1, 0}, {1.5f, 2, 0}});
  stage.paint({.nearest = true});
  EXPECT_EQ(stage.reds(), (std::vector<double>{0, 1, 1, 0, 0}));
  stage.paint({});
  const std::vector<double> expected{0, 1, 0.5, 0.25,
                                     0.5};  // in linear light, where 0 and 1 have the same values as in sRGB
  const std::vector<double> reds = stage.reds();
  for (std::size_t i = 0; i < reds.size(); ++i) EXPECT_NEAR(reds[i], expected[i], 1e-15) << i;
}

TEST(Surface, PicturesEndRepeatOrTurnBack) {
  Surface stage({{0.5f, 1, 0}});
  const auto red_at = [&](double s, PictureUse::Wrap wrap) {
    stage.paint({.wrap_s = wrap, .nearest = true});
    stage.scene.looks.places.assign(3, {s, 0.25});
    return stage.reds()[0];
  };
  using Wrap = PictureUse::Wrap;
  // Texels 0 1 1 0; looks one to the right of the last, and two to the left of the first.
  EXPECT_EQ(red_at(1.125, Wrap::clamp), 0);
  EXPECT_EQ(red_at(1.375, Wrap::clamp), 0);
  EXPECT_EQ(red_at(1.375, Wrap::repeat), 1);
  EXPECT_EQ(red_at(-0.375, Wrap::repeat), 1);
  EXPECT_EQ(red_at(-0.125, Wrap::repeat), 0);
  stage.scene.pictures.clear();
  stage.paint({});
  EXPECT_EQ(red_at(1.125, Wrap::mirror), 0);
  EXPECT_EQ(red_at(1.375, Wrap::mirror), 1);
  EXPECT_EQ(red_at(2.375, Wrap::mirror), 1);
}

TEST(Surface, NormalsAreBetweenThoseOfVerticesOnTheViewersSide) {
  Surface stage({{1, 1, 0}, {4, 0, 0}});
  const float h = std::sqrt(0.5f);
  stage.scene.looks.normals = {{0, 0, 1}, {h, 0, h}, {0, h, h}};
  const auto normals = look_at(stage.scene, stage.floats, stage.samples, true).normals;
  const glm::dvec3 mean = glm::normalize(glm::dvec3(0.25 * double{h}, 0.25 * double{h}, 0.5 + 0.5 * double{h}));
  EXPECT_LT(glm::distance(glm::dvec3(normals[0]), mean), 1e-7);
  EXPECT_LT(glm::distance(glm::dvec3(normals[1]), glm::dvec3(double{h}, 0, double{h})), 1e-7);
  stage.samples.n.assign(2, {0, 0, -1});  // seen from below
  EXPECT_LT(glm::distance(glm::dvec3(look_at(stage.scene, stage.floats, stage.samples, true).normals[0]), -mean), 1e-7);
  stage.scene.looks.normals[2] = glm::vec3(0);
  EXPECT_EQ(look_at(stage.scene, stage.floats, stage.samples, true).normals[0], glm::vec3(0, 0, -1));
  EXPECT_TRUE(look_at(stage.scene, stage.floats, stage.samples, false).normals.empty());
}

/// Some exporters write rounded normals of facets: such a pixel is lit as if the file had no normals.
TEST(Surface, NormalsOfFacetsAreTheFacetsOwn) {
  Surface stage({{1, 1, 0}});
  stage.scene.looks.normals.assign(3, glm::normalize(glm::vec3(1e-6f, -2e-6f, 1)));
  EXPECT_EQ(look_at(stage.scene, stage.floats, stage.samples, true).normals[0], glm::vec3(0, 0, 1));
  stage.scene.looks.normals.assign(3, glm::normalize(glm::vec3(2e-4f, 0, 1)));
  EXPECT_NE(look_at(stage.scene, stage.floats, stage.samples, true).normals[0], glm::vec3(0, 0, 1));
  stage.scene.looks.normals.clear();
  EXPECT_TRUE(look_at(stage.scene, stage.floats, stage.samples, true).normals.empty()) << "the file has none";
}

/// A small distant light of area A and radiance 1 gives A cos cos / (π d²). The cosine at the surface is that of the
/// shading normal, for V and for form factors alike; behind that normal the light gives nothing.
TEST(Surface, CosinesAreThoseOfTheNormalsGiven) {
  Surface stage({{1, 1, 0}, {1, 1, 0}, {1, 1, 0}});
  scenes::AreaLight far{"far", scenes::Rectangle{{1, 1, 1000}, {0, 0.5, 0}, {0.5, 0, 0}}, glm::dvec3(1)};
  stage.scene.lights = {far};
  const visibility::Light light = visibility::make_light(stage.scene, 0, glm::dvec3(0), {});
  const std::vector<glm::vec3> normals = {{0, 0, 1}, {0.6f, 0, 0.8f}, {0.8f, 0, -0.6f}};
  const std::vector<glm::dvec3> colors(3, glm::dvec3(1)), form_factors(3, glm::dvec3(7));
  const std::vector<float> v(3, 0.5f);
  const auto shade = [&](const LightVisibility& seen) {
    return integrate_beauty({.scene = stage.floats,
                             .samples = stage.samples,
                             .colors = {},
                             .lights = {&light, 1},
                             .pixel_colors = colors,
                             .normals = normals},
                            {&seen, 1});
  };
  const double whole = 1 / (M_PI * 1e6);  // the neglected (light's size / distance)² is 1e-6
  const auto by_visibility = shade({.visibility = v});
  EXPECT_NEAR(by_visibility[0].x, 0.5 * whole, 2e-6 * whole);
  EXPECT_NEAR(by_visibility[1].x, 0.8 * 0.5 * whole, 2e-6 * whole);
  EXPECT_EQ(by_visibility[2].x, 0);
  const auto by_form_factors = shade({.visibility = v, .form_factors = form_factors});
  EXPECT_EQ(by_form_factors[0].x, 7) << "with the triangle's own normal, the method's form factor is used";
  EXPECT_NEAR(by_form_factors[1].x, 0.8 * whole, 2e-6 * whole) << "a form factor above the unshadowed one is cut to it";
  const std::vector<glm::dvec3> quarter(3, glm::dvec3(0.25 * whole));
  EXPECT_NEAR(shade({.visibility = v, .form_factors = quarter})[1].x, 0.8 * 0.25 * whole, 2e-6 * whole);
}

/// A light of 2 × 2, 1 above p, of which only the half x > 0.5 is seen, on a facet whose smooth normal leans by 0.3
/// toward +x and by 0.2 toward +y, compared with the integral over 400² parts. The visible form factor on the facet
/// gives a better result than the visible area.
TEST(Surface, SmoothPixelsInPenumbrae) {
  Surface stage({{1, 1, 0}});
  stage.scene.lights = {{"near", scenes::Rectangle{{1.5, 1, 1}, {0, 1, 0}, {1, 0, 0}}, glm::dvec3(1)}};
  const visibility::Light light = visibility::make_light(stage.scene, 0, glm::dvec3(0), {});
  const glm::dvec3 facet(0, 0, 1), smooth = glm::normalize(glm::dvec3(0.3, 0.2, 1));
  const auto integral = [](const glm::dvec3& normal, double from) {  // over the light's x from `from` on
    constexpr int kParts = 400;
    double sum = 0;
    for (int i = 0; i < kParts * kParts; ++i) {
      const glm::dvec3 d(from + (1.5 - from) * (i % kParts + 0.5) / kParts, -1 + 2 * (i / kParts + 0.5) / kParts, 1);
      const double distance = glm::length(d);
      sum += std::max(0.0, glm::dot(normal, d)) * d.z / std::pow(distance, 4);
    }
    return sum * (1.5 - from) * 2 / (kParts * double{kParts}) / M_PI;
  };
  const std::vector<glm::dvec3> colors(1, glm::dvec3(1)), seen(1, glm::dvec3(integral(facet, 0.5)));
  const std::vector<float> v(1, 0.5f);  // the half x > 0.5 of −0.5 … 1.5
  const std::vector<glm::vec3> normals = {glm::vec3(smooth)};
  const LightVisibility exact{.visibility = v, .form_factors = seen}, area{.visibility = v};
  const auto shade = [&](const LightVisibility& visibility) {
    return double{integrate_beauty({.scene = stage.floats,
                                    .samples = stage.samples,
                                    .colors = {},
                                    .lights = {&light, 1},
                                    .pixel_colors = colors,
                                    .normals = normals},
                                   {&visibility, 1})[0]
                      .x};
  };
  const double truth = integral(smooth, 0.5);
  EXPECT_NEAR(shade(exact), integral(smooth, -0.5) * integral(facet, 0.5) / integral(facet, -0.5), 1e-5);
  EXPECT_LT(std::abs(shade(exact) - truth), 0.6 * std::abs(shade(area) - truth));
}

}  // namespace
}  // namespace penumbra::compare
