// Spheres and suns, which every view sample sees otherwise, where nothing is in general position: every bit of the
// methods that do them is the exact decision on the light points of its view sample, without tolerance.

#include "tests/agreement/mask_methods.hpp"
#include "tests/property/lattice_truth.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <tuple>

namespace penumbra {
namespace {

using tests::PairCounts;

constexpr std::array kSamples{
    visibility::SampleRequest{9, 0, 0, visibility::SamplePattern::grid, 0},
    visibility::SampleRequest{16, 0, 0, visibility::SamplePattern::rows, 0},
    visibility::SampleRequest{23, 0, 0, visibility::SamplePattern::sobol, 3},
    visibility::SampleRequest{1, 0, 0, visibility::SamplePattern::grid, 0},
};

scenes::LightShape sphere_of(tests::LatticeSoup& soup, int range) {
  glm::dvec3 center = soup.point();
  if (soup.below(2) == 0) center.y = range + 1.0 + soup.below(3);
  static constexpr std::array kRadii{0.25, 0.5, 1.0, 2.0, 0x1p-10};
  return scenes::Sphere{center, kRadii[soup.below(kRadii.size())]};
}

scenes::LightShape sun_of(tests::LatticeSoup& soup, int) {
  glm::dvec3 direction = soup.point();
  if (direction == glm::dvec3(0)) direction.y = -1;
  static constexpr std::array kAngles{0.53, 0.0, 30.0, 90.0, 170.0, 1e-5, 179.9, 179.98};
  return scenes::Sun{direction, kAngles[soup.below(kAngles.size())]};
}

struct ConeRun {
  scenes::LightShape (*shape)(tests::LatticeSoup&, int);
  int range;
  std::uint32_t first, count;
};

PairCounts expect_cone_truth(visibility::Method& method, const ConeRun& run) {
  PairCounts counts;
  for (std::uint32_t i = run.first; i < run.first + run.count; ++i) {
    const std::uint32_t seed = i + 1000 * static_cast<std::uint32_t>(run.range);
    tests::LatticeSoup soup(seed, run.range);
    visibility::SampleRequest request;
    scenes::Scene scene = tests::lattice_scene(soup, request);
    scene.lights[0].shape = run.shape(soup, run.range);
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    const visibility::Light light = visibility::make_light(scene, 0, floats.origin, kSamples[i % kSamples.size()]);
    const visibility::ViewSamples samples = tests::all_samples(scene, floats, soup.random());
    const tests::Masks masks = tests::run(method, floats, light, samples);
    EXPECT_TRUE(tests::equals_truth(floats, light, samples, masks, &counts))
        << "seed " << seed << " range " << run.range;
  }
  return counts;
}

using Shape = scenes::LightShape (*)(tests::LatticeSoup&, int);
class ConeLattices : public tests::DeviceTest,
                     public testing::WithParamInterface<std::tuple<int, Shape, tests::MaskMethod>> {
 protected:
  static PairCounts look(std::uint32_t first, std::uint32_t count) {
    const auto method = std::get<2>(GetParam()).make(device(), {});
    return expect_cone_truth(*method, {std::get<1>(GetParam()), std::get<0>(GetParam()), first, count});
  }
  static void expect_all_kinds(const PairCounts& counts) {
    EXPECT_GT(counts.visible, counts.pairs / 20);
    EXPECT_GT(counts.blocked, counts.pairs / 20);
    EXPECT_GT(counts.horizon, counts.pairs / 20);
    EXPECT_GT(counts.zero, counts.pairs / 1000);
  }
};

TEST_P(ConeLattices, EveryPairIsTheExactDecision) {
  expect_all_kinds(look(0, 60));
}
/// 60,000 soups of each kind of light for each method.
TEST_P(ConeLattices, TensOfThousandsFull) {
  PairCounts counts;
  for (std::uint32_t done = 0; done < 20'000 && !HasFailure(); done += 1000) {
    counts += look(1000 + done, 1000);
    fmt::print("{}, range {}: {} soups, {} pairs, {} of them by a zero\n", std::get<2>(GetParam()).name,
               std::get<0>(GetParam()), done + 1000, counts.pairs, counts.zero);
    std::fflush(stdout);
  }
  expect_all_kinds(counts);
}
INSTANTIATE_TEST_SUITE_P(Lights, ConeLattices,
                         testing::Combine(testing::Values(1, 2, 4), testing::Values(&sphere_of, &sun_of),
                                          testing::ValuesIn(tests::kConeMethods)),
                         [](const auto& it) {
                           const bool sphere = std::get<1>(it.param) == &sphere_of;
                           return fmt::format("{}_{}_{}", std::get<2>(it.param).name, sphere ? "spheres" : "suns",
                                              std::get<0>(it.param));
                         });

}  // namespace
}  // namespace penumbra
