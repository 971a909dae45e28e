// SPDX-License-Identifier: Apache-2.0
// Runs all checks on small scenes.

#include "selftest/self_test.hpp"

#include "base/error.hpp"
#include "mesh/shapes/shapes.hpp"
#include "render/features.hpp"
#include "selftest/crowd.hpp"
#include "selftest/edge_checks.hpp"
#include "selftest/list_checks.hpp"
#include "selftest/map_checks.hpp"
#include "selftest/mask_checks.hpp"
#include "selftest/prefilter_checks.hpp"
#include "selftest/rasteriser_checks.hpp"
#include "volumes/counters/depth_counters.hpp"
#include "volumes/counters/methods.hpp"
#include "volumes/scatter/methods.hpp"
#include "vsm/methods.hpp"

#include <fmt/format.h>

#include <functional>
#include <random>
#include <string>
#include <utility>

namespace penumbra::selftest {
namespace {

using maps::Rasteriser;

/// Runs one check on all its cases. A ResourceError is recorded in the check, and the other checks continue.
Check repeated(const std::string& pass, const std::function<void(Check&)>& work) {
  Check all;
  all.pass = pass;
  try {
    work(all);
  } catch (const render::LacksFeature& error) {
    all.refused = error.what();
    all.lacking = true;
  } catch (const ResourceError& error) {
    all.refused = error.what();
  }
  return all;
}

void join(Check& all, const Check& one) {
  all.pass = one.pass;
  all.against = one.against;
  all.rule = one.rule;
  all.add(one);
}

/// Returns a scene that tests any rasteriser: the scene of crowd.hpp, with a second copy of its tilted board in the
/// opposite winding and two very thin triangles.
scenes::Scene crowd_with_needles(bool wall, bool two_sided) {
  scenes::Scene scene = crowd(wall, two_sided);
  add_quad(scene, {-0.7, 1.5, 0.1}, {-0.43, -0.21, 0}, {0, 0, 0.77});
  add_object(scene, "needles",
             {{glm::dvec3(-1.5, 0.4, -1.2), {1.4, 0.6, 1.1}, {1.4, 0.6, 1.1003}},
              {glm::dvec3(1.1, 0.9, -1.3), {1.1004, 0.9, -1.3}, {-0.9, 0.7, 1.4}}});
  scene.cameras.front() = camera({0.7, 3, 6}, {0, 0.7, 0});
  return scene;
}

class SelfTest {
 public:
  explicit SelfTest(const render::Device& device) : device_(device) {
    for (const auto& [wall, two_sided] : {std::pair(false, false), std::pair(true, false), std::pair(false, true)}) {
      stages_.emplace_back(crowd_with_needles(wall, two_sided), kPixels, kPixels, light_samples(36));
    }
    scenes::Scene disk = crowd_with_needles(false, true), triangle = crowd_with_needles(true, false);
    disk.lights[0].shape = scenes::Disk{{0, 3, 0}, {0.2, -1, 0.1}, 0.5};
    triangle.lights[0].shape = scenes::Polygon{{{-0.5, 3, -0.4}, {0.6, 3, -0.3}, {0.1, 3, 0.6}}};
    point_stages_.emplace_back(disk, kPixels, kPixels, light_samples(36));
    point_stages_.emplace_back(triangle, kPixels, kPixels,
                               visibility::SampleRequest{50, 0, 0, visibility::SamplePattern::sobol, 1});
  }

  std::vector<Check> run() {
    std::vector<Check> checks;
    for (const auto& [name, sampler] :
         {std::pair("Vulkan", ViewSampler::vulkan), std::pair("OpenGL", ViewSampler::opengl),
          std::pair("processor", ViewSampler::vectors)}) {
      checks.push_back(each_stage(fmt::format("view samples ({})", name), [this, by = sampler](const Stage& stage) {
        return check_view_samples(device_, stage.floats,
                                  visibility::brute_force_view_samples(stage.floats, stage.pinhole), by);
      }));
    }
    for (const Rasteriser rasteriser : {Rasteriser::vulkan, Rasteriser::opengl}) {
      const char* name = rasteriser == Rasteriser::vulkan ? "Vulkan" : "OpenGL";
      checks.push_back(each_stage(fmt::format("depth maps ({})", name),
                                  [&](const Stage& stage) { return check_maps(device_, stage, kTexels, rasteriser); }));
      checks.push_back(each_stage(fmt::format("slices ({})", name), [&](const Stage& stage) {
        return check_slices(device_, stage, kTexels, 5, rasteriser);
      }));
      checks.push_back(each_stage(fmt::format("nearest ids ({})", name), [&](const Stage& stage) {
        return check_nearest_ids(device_, stage, kTexels, rasteriser);
      }));
    }
    checks.push_back(each_stage("depth maps, Vulkan's",
                                [&](const Stage& stage) { return check_rasterisers_agree(device_, stage, kTexels); }));
    checks.push_back(each_stage("nearest caster",
                                [&](const Stage& stage) { return check_nearest_caster(device_, stage, kTexels); }));
    checks.push_back(repeated("summed areas", [&](Check& all) { sums(all); }));
    checks.push_back(repeated("depth pyramids", [&](Check& all) { pyramids(all); }));
    checks.push_back(each_stage("prefiltered tables",
                                [&](const Stage& stage) { return check_prefilter_tables(device_, stage, kTexels); }));
    for (const maps::PrefilterKind kind : {maps::PrefilterKind::pyramid, maps::PrefilterKind::windows}) {
      checks.push_back(each_stage("prefiltered levels", [&](const Stage& stage) {
        return check_prefilter_levels(device_, stage, kTexels, kind);
      }));
    }
    checks.push_back(
        each_stage("penumbra events", [&](const Stage& stage) { return check_penumbra_events(device_, stage, 12); }));
    checks.push_back(repeated("silhouettes", [&](Check& all) { silhouettes(all); }));
    checks.push_back(repeated("penumbra wedges", [&](Check& all) { wedges(all); }));
    checks.push_back(masks("view-sample", vsm::make_view_sample, {{"engine", "vulkan"}}));
    checks.push_back(masks("edge-scatter", volumes::make_edge_scatter, {{"engine", "vulkan"}}));
    checks.push_back(repeated("masks of edge-scatter, light samples anywhere", [&](Check& all) {
      for (const Stage& stage : point_stages_) {
        join(all, check_masks(*volumes::make_edge_scatter(device_, {{"engine", "vulkan"}}), stage,
                              "edge-scatter, light samples anywhere"));
      }
    }));
    checks.push_back(masks("depth-complexity", volumes::make_depth_complexity, {{"engine", "vulkan"}}));
    checks.push_back(each_stage("counters of depth-complexity", [&](const Stage& stage) {
      CounterTally tally;
      return check_counters(*volumes::make_depth_counters(device_), stage, 1, tally);
    }));
    return checks;
  }

 private:
  static constexpr std::uint32_t kPixels = 48, kTexels = 48;

  template <typename Run>
  Check each_stage(const std::string& pass, const Run& run) const {
    return repeated(pass, [&](Check& all) {
      for (const Stage& stage : stages_) join(all, run(stage));
    });
  }

  void sums(Check& all) const {
    std::mt19937 random(1);
    for (const std::uint32_t size : {8U, 9U, 100U, 257U}) {
      std::vector<std::uint32_t> words(std::size_t{3} * size * size);
      for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random());  // most sums wrap around
      join(all, check_summed_areas(device_, words, size));
    }
  }

  void pyramids(Check& all) const {
    std::mt19937 random(15);
    for (const maps::PyramidKind kind : {maps::PyramidKind::hsm, maps::PyramidKind::ysm, maps::PyramidKind::mssm}) {
      for (const auto& [size, faces] : {std::pair(8U, 1U), std::pair(33U, 5U), std::pair(13U, 2U)}) {
        std::vector<float> depths(std::size_t{size} * size * faces);
        for (float& depth : depths) depth = random() % 8 == 0 ? 1.0F : static_cast<float>(random() % 1000) / 1000;
        join(all, check_depth_pyramid(device_, kind, depths, size, faces));
      }
    }
  }

  static mesh::TriangleSoup knot() {
    mesh::KnotShape shape;
    shape.center = {0, 1, 0};
    shape.segments = 60;
    shape.sides = 12;
    return mesh::make_knot(shape);
  }

  void silhouettes(Check& all) const {
    const EdgeMesh mesh(knot());
    volumes::SilhouettePass pass(device_);
    pass.prepare_mesh({mesh.positions, mesh.triangles, &mesh.graph});
    const std::vector<std::uint32_t> counted(mesh.triangles.size(), volumes::gpu::kBothBits);
    SilhouetteTally tally;
    // Points above, at one of the mesh's corners (ties), and where floats decide nothing.
    for (const glm::vec3& l : {glm::vec3(0.3F, 4, 0.2F), mesh.positions[17], glm::vec3(0, 1e30F, 0)}) {
      join(all, check_silhouettes(pass, mesh, l, counted, tally));
    }
  }

  void wedges(Check& all) const {
    scenes::Scene scene;
    const mesh::TriangleSoup soup = knot();
    std::vector<Corners> triangles;
    for (const mesh::Triangle& t : soup.triangles) {
      triangles.push_back({soup.positions[t[0]], soup.positions[t[1]], soup.positions[t[2]]});
    }
    add_object(scene, "knot", triangles);
    scene.lights.push_back(ceiling_light(5, 0.7));
    scene.lights.push_back({"disk", scenes::Disk{{1.5, 4, 1}, {-0.3, -1, 0}, 0.6}, glm::dvec3(1), false});
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    std::vector<visibility::Light> lights;
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
      lights.push_back(visibility::make_light(scene, i, floats.origin, {}));
    }
    WedgeTally tally;
    join(all, check_wedges(device_, floats, lights, volumes::Layers::one_a_solid, true, tally));
  }

  template <typename Make>
  Check masks(const std::string& name, const Make& make, const visibility::MethodOptions& options) const {
    return each_stage("masks of " + name,
                      [&](const Stage& stage) { return check_masks(*make(device_, options), stage, name); });
  }

  const render::Device& device_;
  std::vector<Stage> stages_, point_stages_;  // light samples in rows; anywhere
};

}  // namespace

std::vector<Check> run_self_test(const render::Device& device) {
  return SelfTest(device).run();
}

}  // namespace penumbra::selftest
