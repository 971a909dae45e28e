// SPDX-License-Identifier: Apache-2.0
// Pleats so steep that the normals of an edge's two triangles fill nearly a half-space, seen along the middle of that
// half-space by view samples close together: here the culling by cones of normals has its smallest margin.

#include "tests/agreement/mask_methods.hpp"
#include "tests/agreement/support.hpp"
#include "tests/unit/ray_traced_masks.hpp"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <random>

namespace penumbra::volumes {
namespace {

using visibility::Light;
using visibility::SceneFloats;
using visibility::ViewSamples;

/// Found among millions of boxes of view samples: one of the strip's edges is a silhouette from one of the boxes.
struct Pleats {
  glm::dvec3 across, up;       ///< axes of the strip's profile, unit vectors
  double height, half_length;  ///< of a pleat
  double steep, less;          ///< angles of its flanks in degrees
  glm::vec3 middle, half;      ///< of the view samples' box
  glm::dvec3 light;            ///< the light's centre, behind the strip
  double half_size;            ///< of the light
};

constexpr std::array kPleats{Pleats{{-0.55047099209651007, 0.49410327732197068, 0.67293657814089125},
                                    {-0.82758066859410506, -0.21678468264975348, -0.51779787401821165},
                                    0.00023446239746095936,
                                    0.00012465576161276474,
                                    89.946917456458451,
                                    87.142916861921279,
                                    {0.766794562F, 0.201151997F, 0.480228961F},
                                    {0.000368454726F, 0.000368454726F, 0.000297461083F},
                                    {-0.41639261233275326, -0.10948438272592742, -0.26106585533290216},
                                    0.00091057083778823438},
                             Pleats{{0.35946416304480561, -0.39539904983719254, -0.84524854739558275},
                                    {-0.85585227554396204, 0.22128976754280749, -0.46749087822873336},
                                    0.00017050873757155547,
                                    7.0248538129966242e-05,
                                    89.922460337062404,
                                    87.224538699541242,
                                    {0.429639637F, -0.111158714F, 0.23443836F},
                                    {0.000329292467F, 0.000173074353F, 0.000329292467F},
                                    {-0.15398569807851048, 0.03987147122332213, -0.083841963518110463},
                                    0.00091480252307334585},
                             Pleats{{-0.45207629918898723, 0.55628131275557446, -0.69726474225399071},
                                    {-0.3884267186897607, 0.5809211208547288, 0.71530087065009995},
                                    0.00011356969843398308,
                                    6.30722889467175e-05,
                                    89.941615629199063,
                                    87.048313626040468,
                                    {-0.233027145F, 0.348477691F, 0.428721845F},
                                    {5.76101265e-05F, 0.00027336317F, 0.00027336317F},
                                    {0.1413141103868979, -0.21144225336405142, -0.25978806686185885},
                                    0.00062929566583229998},
                             Pleats{{0.38725487391501945, 0.054685870840609691, 0.92034945437016835},
                                    {-0.91608641375813737, -0.089797435113535107, 0.39079675430431293},
                                    0.00030731594707378746,
                                    0.00016807780746048149,
                                    89.949852296862986,
                                    87.029767996801652,
                                    {-0.741915286F, -0.0727301016F, 0.316142619F},
                                    {0.000315453653F, 0.000200269162F, 0.000315453653F},
                                    {0.28497592434661434, 0.028001179767436865, -0.12126033980191059},
                                    0.0011321546993277808}};

scenes::Scene scene_of(const Pleats& pleats) {
  scenes::Scene scene;
  constexpr double kFar = 1.2;  // keeps the scene's origin at 0 and its reach the same
  tests::add_object(scene, "anchor",
                    {{glm::dvec3(-kFar), {-kFar + 0.01, -kFar, -kFar}, {-kFar, -kFar + 0.01, -kFar}},
                     {glm::dvec3(kFar), {kFar - 0.01, kFar, kFar}, {kFar, kFar - 0.01, kFar}}})
      .casts_shadow = false;
  const glm::dvec3 along = glm::cross(pleats.across, pleats.up);
  std::vector<glm::dvec2> profile{{-0.4, 0}, {0, 0}};
  for (const double angle : {pleats.steep, -pleats.less, pleats.less, -pleats.steep, pleats.steep, -pleats.less,
                             pleats.less, -pleats.steep}) {
    const double width = pleats.height / std::tan(std::abs(angle) * M_PI / 180);
    profile.push_back(profile.back() + glm::dvec2(width, angle > 0 ? -pleats.height : pleats.height));
  }
  profile.emplace_back(0.4, profile.back().y);
  std::vector<tests::Corners> strip;
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const auto at = [&](const glm::dvec2& x, double side) {
      return x.x * pleats.across + x.y * pleats.up + side * pleats.half_length * along;
    };
    const glm::dvec3 a = at(profile[i], -1), b = at(profile[i + 1], -1), c = at(profile[i + 1], 1),
                     d = at(profile[i], 1);
    strip.push_back({a, b, c});
    strip.push_back({a, c, d});
  }
  tests::add_object(scene, "strip", strip);
  const glm::dvec3 n = glm::normalize(pleats.light - glm::dvec3(pleats.middle));
  const glm::dvec3 u = glm::normalize(glm::cross(n, std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0))),
                   v = glm::cross(n, u);
  scene.lights.push_back(tests::rectangle_light(pleats.light, pleats.half_size * u, pleats.half_size * v));
  scene.lights[0].two_sided = true;
  const double size = 2 * glm::length(glm::dvec3(pleats.half)) + 1e-3;
  const glm::dvec3 below = glm::dvec3(pleats.middle) - 2 * size * n;
  tests::add_object(scene, "carrier", {{below - size * u - size * v, below + size * u - size * v, below + size * v}})
      .casts_shadow = false;
  return scene;
}

class WideCones : public tests::DeviceTest, public testing::WithParamInterface<tests::MaskMethod> {};

TEST_P(WideCones, HideNoSilhouette) {
  const auto method = GetParam().make(device(), {});
  for (const Pleats& pleats : kPleats) {
    const SceneFloats floats = visibility::make_scene_floats(scene_of(pleats));
    const Light light =
        visibility::make_light(scene_of(pleats), 0, floats.origin, {256, 0, 0, visibility::SamplePattern::rows, 3});
    ViewSamples samples;
    samples.width = samples.height = 8;
    const auto carrier = static_cast<std::int32_t>(floats.triangles.size() - 1);
    const auto [a, b, c] = floats.corners(static_cast<std::uint32_t>(carrier));
    const glm::dvec3 n = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
    const std::int8_t facing = glm::dot(n, pleats.light - glm::dvec3(pleats.middle)) > 0 ? 1 : -1;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> real(-1, 1);
    for (int i = 0; i < 64; ++i) {
      const auto at = [&](int axis) { return i < 8 ? ((i >> axis & 1) != 0 ? 1.0 : -1.0) : real(random); };
      const glm::dvec3 place(at(0), at(1), at(2));
      samples.triangle.push_back(carrier);
      samples.p.emplace_back(glm::dvec3(pleats.middle) + place * glm::dvec3(pleats.half) - floats.origin);
      samples.n.emplace_back(static_cast<double>(facing) * glm::normalize(n));
      samples.depth.push_back(1);
      samples.facing.push_back(facing);
    }
    EXPECT_TRUE(tests::equals_truth(floats, light, samples, tests::run(*method, floats, light, samples)));
  }
}

INSTANTIATE_TEST_SUITE_P(Method, WideCones, testing::ValuesIn(tests::kAllMaskMethods),
                         [](const auto& it) { return std::string(it.param.name); });

}  // namespace
}  // namespace penumbra::volumes
