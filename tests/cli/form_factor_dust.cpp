// SPDX-License-Identifier: Apache-2.0
// Tests beauty where little or nothing of a round light is above the receiver's plane: `exact` and the default method
// sum different pieces, and agree within the rounding of sums of terms up to 1 (docs/radiance.md).
#include "tests/cli/program.hpp"

#include "base/exr.hpp"

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace penumbra::tests {
namespace {

constexpr const char* kDustScene = R"({{"format": "penumbra-scene/1", "size": [24, 24],
  "camera": {{"eye": [0, 1, 0], "target": [0, 0, 0], "up": [0, 0, -1], "verticalFov": 90}},
  "meshes": [{{"name": "floor", "color": [1, 1, 1], "triangles": [[-2, 0, -2, -2, 0, 2, 2, 0, 2], [-2, 0, -2, 2, 0.25, 2, 2, 0, -2]]}}
    {}],
  "lights": [{{"name": "k", {}, "radiance": [1, 1, 1]}}]}})";
constexpr const char* kDustBoards = R"(, {"name": "boards", "triangles": [[-0.5, 2, -2, 0.75, 2.5, 1, 1.5, 1.25, -0.5],
  [-1.5, 0.5, 0.5, -0.25, 1.25, -1, -0.5, 0.25, 1.5], [0.5, 1, 1.75, 0.75, 0.125, 0.25, -0.5, 1, 0.75]]})";

class FormFactorDust : public ProgramTest {
 protected:
  [[nodiscard]] ExrFile render(const std::string& light, const std::string& meshes,
                               std::vector<std::string> more) const {
    write("scene.json", fmt::format(fmt::runtime(kDustScene), meshes, light));
    std::vector<std::string> arguments = {"render", path("scene.json"), "-o", path("out.exr")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.code == 0 ? read_exr(path("out.exr")) : ExrFile{};
  }
};

constexpr const char* kDustLights[] = {
    R"("sphere": {"center": [-0.375, -0.25, 0], "radius": 0.25})",  // touches the floor's plane from below
    R"("sphere": {"center": [-0.375, 0.25, 0], "radius": 0.25})",   // touches it from above
    R"("sphere": {"center": [0.5, 0.125, 1.5], "radius": 0.5})",    // is cut by it
    R"("sphere": {"center": [-0.25, 4, -0.375], "radius": 0.5})",
    R"("sun": {"direction": [0, 2, -1], "angle": 90})",  // 18 degrees of its cone are above the horizon
    R"("sun": {"direction": [0, -1, -8], "angle": 120})"};

TEST_F(FormFactorDust, IsBounded) {
  for (const char* light : kDustLights) {
    const ExrFile exact = render(light, kDustBoards, {"--method", "exact"}), usual = render(light, kDustBoards, {});
    ASSERT_EQ(exact.attributes.at("penumbra.method"), "exact");
    ASSERT_EQ(usual.attributes.at("penumbra.method"), "edge-scatter");
    for (std::size_t i = 0; i < exact.floats.at("V").size(); ++i) {
      const double v = exact.floats.at("V")[i], other_v = usual.floats.at("V")[i];
      const double f = exact.floats.at("R")[i], other_f = usual.floats.at("R")[i];
      EXPECT_NEAR(v, other_v, 0x1p-24) << light << " pixel " << i;
      EXPECT_NEAR(f, other_f, 0x1p-46 + 0x1p-23 * f) << light << " pixel " << i;
      EXPECT_TRUE(v == 0 || v >= 0x1p-44) << light << " pixel " << i << ": " << v;
      if (v == 0) {
        EXPECT_EQ(f, 0) << light << " pixel " << i;
      }
      if (other_v == 0) {
        EXPECT_EQ(other_f, 0) << light << " pixel " << i;
      }
    }
  }
}

/// Returns the form factor at p of a ball that nothing hides: 1/π of the integral of max(0, n · ω) over the cone of
/// directions to it, in rings around its axis with 4096 parts each. Uses none of the program's code.
double arriving(const glm::dvec3& p, const glm::dvec3& n, const glm::dvec3& center, double radius) {
  constexpr int kRings = 1024, kParts = 4096;
  const glm::dvec3 to = center - p;
  const double distance = std::sqrt(to.x * to.x + to.y * to.y + to.z * to.z);
  const double along = (n.x * to.x + n.y * to.y + n.z * to.z) / distance, across = std::sqrt(1 - along * along);
  const double least = std::sqrt(1 - radius * radius / (distance * distance));  // cosine of the cone's half-angle
  double sum = 0;
  for (int ring = 0; ring < kRings; ++ring) {
    const double cosine = least + (1 - least) * (ring + 0.5) / kRings, sine = std::sqrt(1 - cosine * cosine);
    for (int part = 0; part < kParts; ++part) {
      const double turn = 2 * std::numbers::pi * (part + 0.5) / kParts;
      sum += std::max(0.0, cosine * along + sine * across * std::cos(turn));
    }
  }
  return sum * 2 * (1 - least) / (double{kRings} * kParts);
}

TEST_F(FormFactorDust, ABallThatThePlaneCutsGivesWhatQuadratureGives) {
  const ExrFile exact = render(kDustLights[2], "", {"--method", "exact"}), usual = render(kDustLights[2], "", {});
  for (const std::size_t i : {std::size_t{30}, std::size_t{131}, std::size_t{300}, std::size_t{420}}) {
    const auto at = [&](const std::string& layer) {
      return glm::dvec3(exact.floats.at(layer + ".X")[i], exact.floats.at(layer + ".Y")[i],
                        exact.floats.at(layer + ".Z")[i]);
    };
    const double expected = arriving(at("P"), at("N"), {0.5, 0.125, 1.5}, 0.5);
    EXPECT_NEAR(exact.floats.at("R")[i], expected, 1e-5 * expected) << i;
    EXPECT_NEAR(usual.floats.at("R")[i], expected, 1e-5 * expected) << i;
  }
}

}  // namespace
}  // namespace penumbra::tests
