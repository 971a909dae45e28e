// SPDX-License-Identifier: Apache-2.0
// Edges that the light's plane cuts and that continue past p, almost through it: their end at the light is stored as
// floats, and its rounding error moves the part of the edge next to p much farther. (docs/edge-scatter.md, bound cut)

#include "tests/agreement/mask_methods.hpp"
#include "tests/agreement/volumes/aimed_scene.hpp"

#include <array>

namespace penumbra::volumes {
namespace {

tests::OneLightScene past_p(std::uint32_t seed, bool is_disk) {
  tests::Draws aim(seed);
  const double size = aim.power(-5, -3), height = size * aim.power(-1, 0.5);
  const glm::dvec3 center(aim.real(-0.9, 0.9), aim.real(-0.9, 0.9), aim.real(-0.9, 0.9));
  const glm::dvec3 n = aim.direction(), u = aim.across(n), v = glm::cross(n, u);
  const auto on_light = [&] { return center + size * (aim.real(-1, 1) * u + aim.real(-1, 1) * v); };
  const glm::dvec3 p = on_light() + height * n, through = on_light();
  const double length = glm::length(through - p);
  const glm::dvec3 along = (through - p) / length;
  const auto off = [&] { return 6e-8 * glm::dvec3(aim.real(-1, 1), aim.real(-1, 1), aim.real(-1, 1)); };
  const glm::dvec3 a = p - length * aim.real(0.3, 2) * along + off(), b = p + length * aim.real(1.1, 3) * along + off();
  const glm::dvec3 beside = length * aim.power(-2, 0) * aim.across(along);
  scenes::LightShape shape = scenes::Rectangle{center, size * u, size * v};
  if (is_disk) shape = scenes::Disk{center, n, size};
  tests::OneLightScene scene(shape, {64, 0, 0, visibility::SamplePattern::rows, 3});
  scene.add_occluder({{a, b, p + length * aim.real(-1, 1) * along + beside}});
  scene.look_from(aim, p, glm::normalize(n + 0.2 * aim.direction()), 4 * size, aim.power(-8.5, -6.5));
  return scene;
}

class CutEdges : public tests::DeviceTest, public testing::WithParamInterface<tests::MaskMethod> {
 protected:
  void is_right(std::uint32_t first, std::uint32_t count) {
    const auto method = GetParam().make(device(), {});
    for (std::uint32_t seed = first; seed < first + count; ++seed) {
      const bool is_disk = GetParam().any_light && seed % 2 == 1;
      const tests::OneLightScene scene = past_p(seed, is_disk);
      EXPECT_TRUE(tests::equals_truth(scene.floats, scene.light, scene.samples,
                                      tests::run(*method, scene.floats, scene.light, scene.samples)))
          << "seed " << seed;
    }
  }
};

TEST_P(CutEdges, AreRightPastP) {
  is_right(0, 100);
}
TEST_P(CutEdges, AreRightPastPFull) {
  is_right(100, GetParam().on_device() ? 2000 : 20000);
}

INSTANTIATE_TEST_SUITE_P(Method, CutEdges, testing::ValuesIn(tests::kAllMaskMethods),
                         [](const auto& it) { return std::string(it.param.name); });

}  // namespace
}  // namespace penumbra::volumes
