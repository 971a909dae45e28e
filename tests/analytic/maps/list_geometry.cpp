// SPDX-License-Identifier: Apache-2.0
// Tests depth lists to a hundredth of a texel or to one light sample: at borders of a hemicube's faces, and at
// receivers' horizons.

#include "tests/analytic/maps/fixture.hpp"

#include "maps/products/lists/layered_depth.hpp"
#include "maps/products/lists/layered_depth.shared.h"
#include "maps/sampling/methods.hpp"
#include "selftest/list_checks.hpp"

#include <fmt/format.h>

#include <cmath>

namespace penumbra::tests {
namespace {

class LayeredHemicubes : public MapsTest {};
class ListHorizons : public MapsTest {};

// A sample nearer to a wall than the light's centre sees below itself what the centre sees sideways. An entry's depth
// is the wall's where the ray through the texel's middle meets it, so that it lies exactly on the wall. If a texel's
// middle were off by a share of the texel, the entry would be in front of or behind the wall by that share of its
// width.
TEST_F(LayeredHemicubes, AWallIsAsFarAsItIsFromWhicheverFaceItWasSeen) {
  constexpr std::uint32_t kSize = 60;
  constexpr double kWall = 2, kAside = 0.6;
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -3});
  add_quad(scene, {kWall, 3, 0}, {0, 3, 0}, {0, 0, 3});
  scene.lights.push_back(ceiling_light(5, 1));
  scene.cameras.push_back(camera({0, 4, 7}, {0, 1, 0}, 60));
  Stage stage(scene, 4, 4, light_samples(1));
  stage.light.points.front() += glm::vec3(kAside, 0, 0);
  selftest::ListSource made(device(), stage, kSize);
  ASSERT_EQ(made.centre.faces, 5U);
  maps::LayeredDepth product(device(), 0.01);
  product.make(*made.source);
  std::vector<maps::gpu::LayerEntry> entries(std::size_t{5} * kSize * kSize * product.layers());
  product.buffer().read<maps::gpu::LayerEntry>(entries);
  std::size_t compared = 0;
  for (std::uint32_t texel = 0; texel < 5 * kSize * kSize; ++texel) {
    const auto face = maps::face_of(made.centre.views.front(), made.basis, texel / (kSize * kSize));
    if (glm::dot(face.w, glm::dvec3(1, 0, 0)) < 0.9) continue;
    const glm::dvec3 at = kWall * face.direction(texel % kSize, texel / kSize % kSize, kSize);
    // Texels that the sample sees below 45 degrees and the centre above; with a margin for the images of texels that
    // reach across.
    const double below = -at.y;
    if (below < kWall - kAside + 0.15 || below > kWall || std::abs(at.z) > below - 0.15) continue;
    for (std::size_t e = 0; e < product.layers(); ++e) {
      const auto& entry = entries[std::size_t{texel} * product.layers() + e];
      if (entry.weight == 0) continue;
      ++compared;
      // A texel below the sample is 2 / 60 wide at depth 1; rasterisers snap corners to 1/256 of that.
      EXPECT_NEAR(entry.t, kWall, 0.01 * 2 / kSize * (below + 0.15)) << "texel " << texel;
    }
  }
  EXPECT_GT(compared, 100U);
}

// Where nothing casts, each receiver sees exactly the light samples above its own plane. On a ball under a wide light
// these planes cut the light everywhere.
TEST_F(ListHorizons, WhereNothingCastsTheSamplesAboveTheHorizonAreCounted) {
  constexpr int kSamples = 64;
  scenes::Scene scene;
  add_object(scene, "ball", sphere({0, 2, 0}, 1, 24)).casts_shadow = false;
  scene.lights.push_back(ceiling_light(5, 2));
  scene.cameras.push_back(camera({0, 2.5, 6}, {0, 2, 0}, 25));
  const Stage stage(scene, 40, 40, light_samples(kSamples));
  bool is_first = true;
  for (const Factory& factory : {Factory(maps::make_deep_penumbra), Factory(maps::make_layered_attenuation)}) {
    const Masks found = run(factory, stage, {{"size", "64"}});
    std::size_t cut = 0, all = 0, compared = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (stage.samples.triangle[i] < 0) continue;
      int above = 0;
      double nearest = 1;
      for (const glm::vec3& l : stage.light.points) {
        const double height = glm::dot(glm::dvec3(stage.samples.n[i]), glm::dvec3(l) - glm::dvec3(stage.samples.p[i]));
        above += height > 0 ? 1 : 0;
        nearest = std::min(nearest, std::abs(height));
      }
      if (nearest < 1e-5) continue;  // rounding of floats may decide either way
      cut += above > 0 && above < kSamples ? 1 : 0;
      // Some maps do not hold a surface that they would see edge-on: layered-attenuation may count fewer.
      EXPECT_LE(found.visibility[i] * kSamples, above) << "pixel " << i;
      all += found.visibility[i] * kSamples == static_cast<float>(above) ? 1 : 0;
      ++compared;
    }
    EXPECT_GT(cut, 100U);
    fmt::print("{} of {} pixels, {} whose planes cut the light\n", all, compared, cut);
    EXPECT_GE(all, is_first ? compared : 100U);
    is_first = false;
  }
}

}  // namespace
}  // namespace penumbra::tests
