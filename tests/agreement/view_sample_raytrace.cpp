// View-sample mapping and the ray caster on every shipped scene, pair by pair on the same view and light samples. They
// share no code that decides anything: a hierarchy of shafts and float arithmetic with error bounds here, Embree's rays
// there. Where they differ, the exact decision says who is right.

#include "tests/agreement/support.hpp"

#include "reference/ray_traced.hpp"
#include "render/visibility_buffer.hpp"
#include "scenes/reader.hpp"

#include <filesystem>

namespace penumbra {
namespace {

using visibility::PairOutcome;
using visibility::ViewSamples;

struct Differences {
  std::size_t pairs_all = 0, pairs = 0, differing = 0;
  std::size_t judged = 0, view_sample_right = 0, zero_predicate = 0;
  std::string first_wrong;
};

constexpr std::size_t kMostJudged = 2000;

Differences compare(const visibility::SceneFloats& floats, const ViewSamples& samples, const visibility::Light& light,
                    const tests::Masks& mapped, const tests::Masks& traced) {
  Differences result;
  const std::uint32_t n = light.sample_count();
  for (std::size_t pixel = 0; pixel < samples.size(); ++pixel) {
    if (samples.triangle[pixel] == ViewSamples::kBackground) continue;
    result.pairs_all += n;
    const auto partly = [&](const tests::Masks& masks) {
      return masks.visible_count(pixel) > 0 && masks.visible_count(pixel) < n;
    };
    if (partly(mapped) || partly(traced)) result.pairs += n;
    for (std::uint32_t j = 0; j < n; ++j) {
      if (mapped.visible(pixel, j) == traced.visible(pixel, j)) continue;
      ++result.differing;
      if (result.judged == kMostJudged) continue;
      const auto truth = visibility::decide_pair(floats, samples, pixel, light, j);
      ++result.judged;
      result.zero_predicate += truth.zero_predicate ? 1 : 0;
      if (mapped.visible(pixel, j) == (truth.outcome == PairOutcome::visible)) {
        ++result.view_sample_right;
      } else if (result.first_wrong.empty()) {
        result.first_wrong = tests::describe_pair(floats, samples, pixel, light, j);
      }
    }
  }
  return result;
}

class AgreementBase : public tests::DeviceTest {
 protected:
  void check(const scenes::Scene& scene, std::uint32_t size) {
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    const visibility::Light light = visibility::make_light(scene, 0, floats.origin, {});
    render::VisibilityBuffer view(device(), floats);
    const ViewSamples samples = view.render(visibility::make_camera(scene.cameras[0], floats.origin, size, size));
    const tests::Masks mapped = tests::map_view_samples(device(), floats, light, samples);
    const auto method = reference::make_ray_traced({});
    const tests::Masks traced = tests::run(*method, floats, light, samples);
    const Differences found = compare(floats, samples, light, mapped, traced);
    fmt::print(
        "{} {}x{}: {} of {} pairs differ ({:.2e}; {:.2e} of those in penumbra); of {} judged, {} with a zero, "
        "view-sample is right about {}\n",
        scene.name, size, size, found.differing, found.pairs_all,
        static_cast<double>(found.differing) / static_cast<double>(found.pairs_all),
        static_cast<double>(found.differing) / static_cast<double>(found.pairs), found.judged, found.zero_predicate,
        found.view_sample_right);
    EXPECT_GT(found.pairs, 0U);
    EXPECT_LE(static_cast<double>(found.differing), 2e-5 * static_cast<double>(found.pairs_all));
    EXPECT_LE(static_cast<double>(found.differing), 2e-4 * static_cast<double>(found.pairs));
    EXPECT_EQ(found.view_sample_right, found.judged) << found.first_wrong;
  }
};

class AgreementTest : public AgreementBase, public testing::WithParamInterface<std::string> {
 protected:
  void check(std::uint32_t size) {
    AgreementBase::check(scenes::read_scene(std::string(PENUMBRA_SCENES "/") + GetParam()), size);
  }
};

// A rectangle light whose sides are not at right angles: a little, as decimals make it, or far from it.
using AgreementOn = AgreementBase;
TEST_F(AgreementOn, ParallelogramLights) {
  for (const double skew : {1e-4, 0.3, -0.9}) {
    scenes::Scene scene = scenes::read_scene(PENUMBRA_SCENES "/fusion.json");
    auto& light = std::get<scenes::Rectangle>(scene.lights[0].shape);
    light.half_v += skew * light.half_u;
    check(scene, 96);
  }
}

std::vector<std::string> shipped_scenes(bool with_large_ones) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(PENUMBRA_SCENES)) {
    const std::string name = entry.path().filename().string();
    const bool scene = entry.path().extension() == ".json" && name.find(".schema") == std::string::npos;
    if (scene && (with_large_ones || name != "terrain-1m.json")) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string name_of_case(const testing::TestParamInfo<std::string>& info) {
  std::string name = std::filesystem::path(info.param).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

using Agreement = AgreementTest;
TEST_P(Agreement, WithTheRayCaster) {
  check(128);
}
INSTANTIATE_TEST_SUITE_P(Scenes, Agreement, testing::ValuesIn(shipped_scenes(false)), name_of_case);

class AgreementFull : public AgreementTest {};
TEST_P(AgreementFull, WithTheRayCaster) {
  check(512);
}
INSTANTIATE_TEST_SUITE_P(Scenes, AgreementFull, testing::ValuesIn(shipped_scenes(true)), name_of_case);

}  // namespace
}  // namespace penumbra
