// SPDX-License-Identifier: Apache-2.0
// Tests that each method handles a flawed mesh as `inspect` predicts, for every method of the table and every defect of
// the generator. A verdict of "exact" allows no pair that differs from the exact predicates.

#include "areas/exact_area.hpp"
#include "mesh/shapes/broken_meshes.hpp"
#include "session/methods.hpp"
#include "session/pixel_samples.hpp"
#include "tests/agreement/differences.hpp"
#include "volumes/wedges/layer_areas.hpp"
#include "volumes/wedges/soft_visibility.hpp"

#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace penumbra::tests {
namespace {

using visibility::Output;
using visibility::PixelClass;
using visibility::Verdict;

visibility::ViewSamples samples_of(const visibility::SceneFloats& floats, const visibility::PinholeCamera& camera) {
  std::vector<std::uint32_t> pixels(std::size_t{camera.width} * camera.height);
  std::iota(pixels.begin(), pixels.end(), 0U);
  return session::samples_at(floats, camera, pixels);
}

/// One defect on a floor, in the form that methods get.
struct FlawedStage {
  explicit FlawedStage(const std::string& defect)
      : mesh(mesh::make_broken_mesh({{defect}, 2, {0, 1, 0}, 1}).soup),
        diagnosis(mesh::diagnose({mesh.positions, mesh.triangles})),
        scene(with_a_floor(mesh)),
        floats(visibility::make_scene_floats(scene)),
        light(light_of(64)),
        few(light_of(16)),
        samples(samples_of(floats, visibility::make_camera(scene.cameras[0], floats.origin, 24, 24))),
        classes(visibility::classify_pixels(floats, samples, light)) {
    const auto tracer = reference::make_ray_traced({});
    traced = run(*tracer, floats, light, samples);
    traced_few = run(*tracer, floats, few, samples);
  }
  FlawedStage(const FlawedStage&) = delete;
  FlawedStage& operator=(const FlawedStage&) = delete;

  [[nodiscard]] visibility::Light light_of(std::uint32_t count) const {
    return visibility::make_light(scene, 0, floats.origin, {count, 0, 0, visibility::SamplePattern::rows, 0});
  }
  [[nodiscard]] volumes::LitPoint lit(std::size_t pixel) const {
    return {samples.p[pixel], static_cast<std::uint32_t>(samples.triangle[pixel]), samples.facing[pixel]};
  }

  mesh::TriangleSoup mesh;
  mesh::Diagnosis diagnosis;
  scenes::Scene scene;
  visibility::SceneFloats floats;
  visibility::Light light, few;
  visibility::ViewSamples samples;
  std::vector<PixelClass> classes;
  Masks traced, traced_few;
};

std::vector<float> visibility_of(visibility::Method& method, const FlawedStage& stage) {
  method.prepare_mesh(stage.floats);
  method.prepare_light(stage.light);
  method.prepare_view(stage.samples);
  std::vector<float> result(stage.samples.size());
  const std::uint32_t rows = method.max_tile_rows();
  for (std::uint32_t first = 0; first < stage.samples.height; first += rows) {
    const visibility::Tile tile{first, std::min(rows, stage.samples.height - first)};
    method.evaluate(tile);
    const std::size_t width = stage.samples.width;
    method.read_visibility(std::span(result).subspan(first * width, tile.row_count * width));
  }
  return result;
}

/// Expects that every pair that differs from the ray caster's, and every pair of each sixteenth pixel, is as the exact
/// predicates decide it.
void expect_exact(const std::string& name, const FlawedStage& stage, const Masks& mapped) {
  const Differences found = differences(stage.floats, stage.samples, stage.light, mapped, stage.traced,
                                        std::numeric_limits<std::size_t>::max());
  EXPECT_EQ(found.mapped_right, found.differing) << name << ": " << found.first_wrong;
  for (std::size_t pixel = 0; pixel < stage.samples.size(); pixel += 16) {
    if (stage.samples.triangle[pixel] == visibility::ViewSamples::kBackground) continue;
    for (std::uint32_t j = 0; j < stage.light.sample_count(); ++j) {
      const auto truth = visibility::decide_pair(stage.floats, stage.samples, pixel, stage.light, j);
      ASSERT_EQ(mapped.visible(pixel, j), truth.outcome == visibility::PairOutcome::visible)
          << name << ": " << describe_pair(stage.floats, stage.samples, pixel, stage.light, j);
    }
  }
}

/// Checks V as an exact area: the hidden part is at most the sum of all layers, and less than that by at most the
/// overlaps of pairs of layers. V is stored in float.
void expect_exact_area(const std::string& name, const FlawedStage& stage, const std::vector<float>& found) {
  const volumes::Casters casters = volumes::casters_of(stage.floats, stage.light);
  const volumes::SoftVisibility soft(stage.floats, stage.light, casters);
  for (std::size_t i = 0; i < found.size(); i += 3) {
    if (stage.classes[i] != PixelClass::judged) continue;
    const volumes::LitPoint point = stage.lit(i);
    const auto layers = volumes::projected_layers(stage.light, point.p, soft.layers(point));
    const double sum = volumes::sum_of_layers(soft.outline(), layers),
                 overlap = volumes::overlap_of_layers(soft.outline(), layers, 1e3), hidden = 1.0 - found[i];
    ASSERT_LE(hidden, sum + 0x1p-24) << name << ", pixel " << i;
    ASSERT_GE(hidden, sum - overlap - 0x1p-24) << name << ", pixel " << i;
  }
}

class MeshVerdicts : public testing::Test {
 protected:
  static void SetUpTestSuite() { machine_ = std::make_unique<render::Machine>(); }
  static void TearDownTestSuite() { machine_.reset(); }

  static const render::Machine& machine() { return *machine_; }
  template <typename Visit>
  static void for_each_defect(const Visit& visit) {
    for (const mesh::DefectName& defect : mesh::broken_defects()) {
      const std::string name(defect.name);
      visit(name, FlawedStage(name));
    }
  }

 private:
  static inline std::unique_ptr<render::Machine> machine_;
};

/// Returns all methods of the table that support rectangles, except the ray caster, which is the reference. Maps are
/// small, as these methods are approximate anyway.
std::vector<std::unique_ptr<visibility::Method>> make_methods(const render::Machine& machine) {
  std::vector<std::unique_ptr<visibility::Method>> methods;
  for (const visibility::MethodDescription* method : session::all_methods()) {
    if (!method->lights.contains(visibility::LightKind::rectangle)) continue;
    const bool is_map = method->family == visibility::Family::image;
    const visibility::MethodOptions options =
        is_map ? visibility::MethodOptions{{"size", "64"}} : visibility::MethodOptions{};
    if (method->name != "raytrace") methods.push_back(session::make_method(method->name, options, machine));
  }
  return methods;
}

/// Returns the number of pairs that the method decides differently from the ray caster or, if it gives no masks, the
/// largest difference of its V from the exact area.
double error_of(visibility::Method& method, const FlawedStage& stage, const std::vector<float>& areas) {
  if (method.description().output == Output::mask) {
    const Masks mapped = run(method, stage.floats, stage.light, stage.samples);
    const Differences found = differences(stage.floats, stage.samples, stage.light, mapped, stage.traced, 0);
    return static_cast<double>(found.differing);
  }
  const std::vector<float> v = visibility_of(method, stage);
  double most = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    EXPECT_TRUE(v[i] >= 0 && v[i] <= 1) << method.description().name << ": V of pixel " << i << " is " << v[i];
    if (stage.classes[i] == PixelClass::judged) most = std::max<double>(most, std::abs(v[i] - areas[i]));
  }
  return most;
}

TEST_F(MeshVerdicts, AreWhatEachMethodDoesWithEachDefect) {
  const auto methods = make_methods(machine());
  std::map<std::string, double> most;  // largest errors of the approximate methods, over every sixth defect
  std::set<std::string> exact;
  std::size_t defects = 0;
  for_each_defect([&](const std::string& defect, const FlawedStage& stage) {
    std::vector<float> areas;
    for (std::size_t i = methods.size(); i-- > 0;) {  // backwards, so that `exact` comes first
      const auto& method = methods[i];
      const visibility::MethodDescription& description = method->description();
      const std::string what = description.name + " of " + defect;
      const Verdict verdict = description.verdict_on(stage.diagnosis).verdict;
      ASSERT_TRUE(verdict == Verdict::exact || verdict == Verdict::approximate) << what;
      if (verdict == Verdict::exact) exact.insert(description.name);
      if (verdict == Verdict::exact && description.output != Output::mask) {
        const std::vector<float> v = visibility_of(*method, stage);
        expect_exact_area(what, stage, v);
        if (description.name == "exact") areas = v;
      } else if (verdict == Verdict::exact) {
        expect_exact(what, stage, run(*method, stage.floats, stage.light, stage.samples));
      } else if (defects % 6 == 0) {
        most[description.name] = std::max(most[description.name], error_of(*method, stage, areas));
      }
    }
    ++defects;
  });
  for (const char* name : {"edge-scatter", "view-sample", "depth-complexity", "exact"})
    EXPECT_TRUE(exact.contains(name));
  EXPECT_EQ(most.size() + exact.size(), methods.size()) << "a method's verdict must be the same for every defect";
  for (const auto& [name, error] : most) {
    fmt::print("{}: off by {:.4f} {}\n", name, error, name == "accumulate" ? "pairs" : "of V");
    EXPECT_GT(error, 0.01) << name << " is called approximate, but is exact";
  }
}

/// The variants of depth-complexity: where `laine` is wrong, its verdict must predict it; where `forest` is wrong, it
/// is too bright.
TEST_F(MeshVerdicts, NameWhereVariantsOfDepthComplexityFail) {
  const auto laine = session::make_method("depth-complexity", {{"variant", "laine"}}, machine());
  const auto forest = session::make_method("depth-complexity", {{"variant", "forest"}}, machine());
  std::size_t wrong = 0, bright = 0, promised = 0;
  for_each_defect([&](const std::string& defect, const FlawedStage& stage) {
    const Masks mapped = run(*laine, stage.floats, stage.light, stage.samples);
    const std::string reason = laine->description().verdict_on(stage.diagnosis).reason;
    const bool warned = reason.find("variant=laine is only approximate") != std::string::npos;
    if (!warned) {
      expect_exact("laine of " + defect, stage, mapped);
      ++promised;
    } else {
      const Differences found = differences(stage.floats, stage.samples, stage.light, mapped, stage.traced);
      wrong += found.judged - found.mapped_right;
    }
    const Masks packed = run(*forest, stage.floats, stage.few, stage.samples);
    for (std::size_t pixel = 0; pixel < stage.samples.size(); ++pixel) {
      if (stage.samples.triangle[pixel] == visibility::ViewSamples::kBackground) continue;
      for (std::uint32_t j = 0; j < stage.few.sample_count(); ++j) {
        if (packed.visible(pixel, j) == stage.traced_few.visible(pixel, j)) continue;
        const auto truth = visibility::decide_pair(stage.floats, stage.samples, pixel, stage.few, j);
        const bool visible = truth.outcome == visibility::PairOutcome::visible;
        bright += packed.visible(pixel, j) && !visible ? 1 : 0;
        ASSERT_TRUE(packed.visible(pixel, j) || !visible) << "forest of " << defect << " is too dark";
      }
    }
  });
  fmt::print("laine: exact on {} defects as promised, {} wrong pairs on the others; forest: {} pairs too bright\n",
             promised, wrong, bright);
  EXPECT_GT(promised, 5U);
  EXPECT_GT(wrong, 0U);
  EXPECT_GT(bright, 0U);
}

}  // namespace
}  // namespace penumbra::tests
