// SPDX-License-Identifier: Apache-2.0
// Tests the table of the kinds of light: area, points and form factor of a light agree with the region given by the
// kind's traits, by numbers that no code of the product computes.
#include "visibility/light_samples.hpp"
#include "visibility/lights/unshadowed_light.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

namespace penumbra::visibility {
namespace {

const glm::vec3 kReceiver(0.25f, 0.125f, -0.5f);

/// One light of each kind, in the order of the table; all shine down. (Domes have no rim: see unit/dome_samples.cpp.)
const std::array<scenes::LightShape, 6> kShapes{
    scenes::Rectangle{{0, 3, 0}, {0.125, 0, -0.5}, {0.75, 0, 0.25}},
    scenes::Disk{{0.5, 3, 0}, {0, -1, 0}, 0.5},
    scenes::Ellipse{{0, 3, 0.25}, {0.125, 0, -0.5}, {0.75, 0, 0.25}},
    scenes::Polygon{{{1, 3, -0.25}, {1, 3, 0.5}, {0.5, 3, 0.75}, {0, 3, 0}}},
    scenes::Sphere{{0.25, 3, 0.5}, 0.5},
    scenes::Sun{{0.6, -0.8, 0}, 20},
};
static_assert(kShapes.size() + 1 == scenes::kLightTraits.size(), "a shape of each kind but domes");

Light light_of_kind(std::size_t kind, std::uint32_t samples) {
  scenes::Scene scene;
  scene.lights.emplace_back();
  scene.lights.back().name = "one";
  scene.lights.back().shape = kShapes.at(kind);
  return make_light(scene, 0, glm::dvec3(0), {.count = samples});
}

/// Twice the signed area of a flat loop.
glm::dvec3 doubled_area(const std::vector<glm::dvec3>& loop) {
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < loop.size(); ++i) sum += glm::cross(loop[i], loop[(i + 1) % loop.size()]);
  return sum;
}

/// Returns the outline of the light as p sees it, with `sides` sides if it is round.
std::vector<glm::dvec3> rim_of(const Light& light, const glm::vec3& p, int sides) {
  if (!is_round(light.kind)) return {light.outline.begin(), light.outline.end()};
  const auto [center, u, v] = light_frame_from(light, p);
  std::vector<glm::dvec3> rim;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    rim.push_back(center + std::cos(angle) * u + std::sin(angle) * v);
  }
  return rim;
}

std::vector<glm::vec3> points_of(const Light& light, const glm::vec3& p) {
  std::vector<glm::vec3> points(light.sample_count());
  light_points_for(light, p, points.data());
  return points;
}

/// A polygon with n sides inscribed in a circle has the share sin(x) / x of its area, x = 2π/n.
TEST(LightKindsMade, AreaIsTheLimitOfOutlines) {
  constexpr int kSides = 64;
  constexpr double kStep = 2 * std::numbers::pi / kSides;
  for (std::size_t kind = 0; kind < kShapes.size(); ++kind) {
    const Light light = light_of_kind(kind, 64);
    EXPECT_EQ(light.kind, scenes::kLightTraits[kind].kind);
    const glm::vec3 far(0, -1e6f, 0);  // seen from there a sphere is a disk of its radius
    const double share = is_round(light.kind) ? std::sin(kStep) / kStep : 1;
    const double area = glm::length(doubled_area(rim_of(light, far, kSides))) / 2 / share;
    EXPECT_NEAR(area, light.area, 1e-6 * light.area) << name_of(light.kind);
  }
}

TEST(LightKindsMade, SamplesLieInTheRegion) {
  for (std::size_t kind = 0; kind < kShapes.size(); ++kind) {
    const Light light = light_of_kind(kind, 256);
    const auto [center, u, v] = light_frame_from(light, kReceiver);
    for (const glm::dvec2& st : light.coordinates) {
      EXPECT_LE(std::max(std::abs(st.x), std::abs(st.y)), 1);
      EXPECT_LE(is_round(light.kind) ? glm::length(st) : 0, 1 + 1e-15);
    }
    const std::vector<glm::vec3> points = points_of(light, kReceiver);
    const std::vector<glm::dvec3> rim = rim_of(light, kReceiver, 720);
    const glm::dvec3 normal = glm::normalize(doubled_area(rim));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::dvec3 at(points[i]);
      for (std::size_t j = 0; j < rim.size(); ++j) {
        const glm::dvec3 edge = rim[(j + 1) % rim.size()] - rim[j];
        EXPECT_GE(glm::dot(glm::cross(edge, at - rim[j]), normal), -2e-5 * glm::length(edge)) << name_of(light.kind);
      }
      if (is_polygon(light.kind)) continue;  // its coordinates are relative to its bounding rectangle
      EXPECT_LT(glm::distance(at, center + light.coordinates[i].x * u + light.coordinates[i].y * v), 1e-6);
    }
  }
}

/// The form factor is 1/π ∫ cos θp cos θl / d² over the light samples, which have equal shares of the part that p sees.
TEST(LightKindsMade, FormFactorIsTheSumOverSamples) {
  const glm::vec3 n(0, 1, 0);
  for (std::size_t kind = 0; kind < kShapes.size(); ++kind) {
    const Light light = light_of_kind(kind, 4096);
    const std::vector<glm::dvec3> rim = rim_of(light, kReceiver, 4096);
    const glm::dvec3 area = doubled_area(rim) / 2.0;
    double sum = 0;
    for (const glm::vec3& l : points_of(light, kReceiver)) {
      const glm::dvec3 direction = direction_to(light, kReceiver, l);
      const double squared = glm::dot(direction, direction);
      sum += direction.y * std::abs(glm::dot(direction, area)) / (squared * squared);
    }
    const UnshadowedLight seen(light, kReceiver, n);
    EXPECT_TRUE(seen.above_horizon()) << name_of(light.kind);
    EXPECT_NEAR(seen.whole(), sum / std::numbers::pi / light.sample_count(), 1e-4 * seen.whole())
        << name_of(light.kind);
    EXPECT_FALSE(UnshadowedLight(light, kReceiver, -n).above_horizon()) << name_of(light.kind);
    EXPECT_EQ(UnshadowedLight(light, kReceiver, -n).whole(), 0) << name_of(light.kind);
  }
}

/// The element's plane cuts each light at a corner of its outline, or at its rim.
TEST(LightKindsMade, HorizonThatCutsTheLightIsSeen) {
  for (std::size_t kind = 0; kind < kShapes.size(); ++kind) {
    const Light light = light_of_kind(kind, 64);
    const std::vector<glm::dvec3> rim = rim_of(light, kReceiver, 8);
    const glm::dvec3 origin = light.sun ? glm::dvec3(0) : glm::dvec3(kReceiver);
    glm::dvec3 mean(0);
    for (const glm::dvec3& corner : rim) mean += (corner - origin) / static_cast<double>(rim.size());
    for (const glm::dvec3& corner : rim) {
      const glm::dvec3 to = corner - origin, aside = glm::normalize(glm::cross(glm::cross(mean, to), to));
      const auto tilted = [&](double by) { return glm::vec3(-aside - by * glm::normalize(to)); };
      const glm::vec3 cuts = tilted(1e-3), clears = tilted(-3e-1);
      EXPECT_FALSE(UnshadowedLight(light, kReceiver, cuts).above_horizon()) << name_of(light.kind);
      EXPECT_TRUE(UnshadowedLight(light, kReceiver, clears).above_horizon()) << name_of(light.kind);
    }
  }
}

TEST(LightKindsMade, RefusalNamesLightAndKind) {
  const Light light = light_of_kind(5, 16);
  EXPECT_NO_THROW(require_kind(light, LightKinds{LightKind::sun}, ": never said"));
  try {
    require_kind(light, kPlanarLights, ": maps do {}", kPlanarLights.words());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "light \"one\" is a sun: maps do rectangle, disk, ellipse, polygon");
  }
}

}  // namespace
}  // namespace penumbra::visibility
