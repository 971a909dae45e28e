// SPDX-License-Identifier: Apache-2.0
// Tests that V of soft-volume has the same bits wherever silhouettes and wedges are built.

#include "tests/agreement/differences.hpp"
#include "tests/agreement/lattice.hpp"
#include "tests/agreement/volumes/soft_stage.hpp"

#include "mesh/shapes/broken_meshes.hpp"
#include "volumes/soft/methods.hpp"

namespace penumbra::volumes {
namespace {

using tests::SoftStage;

class SoftVolumeWedges : public tests::DeviceTest {
 protected:
  static visibility::MethodOptions with(visibility::MethodOptions options, const char* wedges) {
    options["wedges"] = wedges;
    return options;
  }
  static void expect_same(const std::string& name, const scenes::Scene& scene, std::uint32_t width,
                          std::uint32_t height, const visibility::MethodOptions& options = {}) {
    const auto on_device = make_soft_volume(device(), with(options, "device")),
               on_host = make_soft_volume(device(), with(options, "host"));
    expect_same(name, scene, width, height, *on_device, *on_host);
  }
  static void expect_same(const std::string& name, const scenes::Scene& scene, std::uint32_t width,
                          std::uint32_t height, visibility::Method& on_device, visibility::Method& on_host) {
    const SoftStage stage(scene, device(), width, height);
    const std::vector<float> found = stage.run(on_device);
    EXPECT_EQ(found, stage.run(on_host)) << name;
    const auto counters = on_device.counters();
    EXPECT_EQ(counters.at("silhouetteEdges"), on_host.counters().at("silhouetteEdges")) << name;
    EXPECT_EQ(on_host.counters().at("edgesOnHost"), counters.at("silhouetteEdges")) << name;
    edges_ += counters.at("silhouetteEdges");
    on_host_ += counters.at("edgesOnHost");
    penumbra_ += static_cast<std::size_t>(std::ranges::count_if(found, [](float v) { return v > 0 && v < 1; }));
  }
  void TearDown() override {
    fmt::print("{} edges, {} of them by the host; {} pixels in penumbra\n", edges_, on_host_, penumbra_);
    EXPECT_GT(penumbra_, 100U);
    edges_ = on_host_ = penumbra_ = 0;
    DeviceTest::TearDown();
  }

  static scenes::Scene with_disk(scenes::Scene scene) {
    const auto rectangle = std::get<scenes::Rectangle>(scene.lights.at(0).shape);
    scene.lights[0].shape =
        scenes::Disk{rectangle.center, glm::cross(rectangle.half_u, rectangle.half_v), glm::length(rectangle.half_u)};
    return scene;
  }

  static inline std::uint64_t edges_ = 0, on_host_ = 0, penumbra_ = 0;
};

TEST_F(SoftVolumeWedges, ShippedScenes) {
  for (const char* name : {"broken", "contact", "fusion", "parallel-square", "room", "textured-light"}) {
    expect_same(name, tests::shipped_scene(name), 40, 30);
  }
  expect_same("fusion, disk", with_disk(tests::shipped_scene("fusion")), 40, 30);
  expect_same("broken, split", tests::shipped_scene("broken"), 40, 30, {{"split", "2"}});
  expect_same("contact, tight", tests::shipped_scene("contact"), 40, 30, {{"construction", "tight"}});
}

TEST_F(SoftVolumeWedges, Blended) {
  for (const char* name : {"broken", "fusion"}) {
    const auto on_device = make_soft_volume_blend(device(), {}),
               on_host = make_soft_volume_blend(device(), {{"wedges", "host"}});
    expect_same(name, tests::shipped_scene(name), 40, 30, *on_device, *on_host);
  }
  EXPECT_THROW(static_cast<void>(make_soft_volume_blend(device(), {{"wedges", "moon"}})), UsageError);
  EXPECT_THROW(static_cast<void>(make_soft_volume(device(), {{"wedges", ""}})), UsageError);
}

TEST_F(SoftVolumeWedges, ShippedScenesFull) {
  for (const char* name : {"broken", "bunny", "contact", "fusion", "large-penumbra", "parallel-square", "room",
                           "self-shadow", "textured-light", "thin"}) {
    expect_same(name, tests::shipped_scene(name), 160, 120);
    if (std::string(name) != "textured-light") expect_same(name, with_disk(tests::shipped_scene(name)), 160, 120);
    expect_same(name, tests::shipped_scene(name), 160, 120, {{"split", "2"}, {"coverage", "table"}});
  }
}

TEST_F(SoftVolumeWedges, FlawedMeshes) {
  const auto on_device = make_soft_volume(device(), {}), on_host = make_soft_volume(device(), {{"wedges", "host"}});
  for (const mesh::DefectName& defect : mesh::broken_defects()) {
    const mesh::BrokenMesh mesh = mesh::make_broken_mesh({{std::string(defect.name)}, 1, {0, 1, 0}, 1});
    expect_same(std::string(defect.name), tests::with_a_floor(mesh.soup), 24, 18, *on_device, *on_host);
  }
}

TEST_F(SoftVolumeWedges, WhereEverythingCoincides) {
  const auto on_device = make_soft_volume(device(), {}), on_host = make_soft_volume(device(), {{"wedges", "host"}});
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    tests::LatticeSoup soup(seed, 2);
    visibility::SampleRequest request;
    const scenes::Scene scene = tests::lattice_scene(soup, request);
    if (!std::holds_alternative<scenes::Rectangle>(scene.lights[0].shape)) continue;
    expect_same(fmt::format("soup {}", seed), seed % 2 == 0 ? with_disk(scene) : scene, 33, 25, *on_device, *on_host);
  }
}

/// One method, with a light that moves from call to call, and back: nothing of an earlier frame may remain.
TEST_F(SoftVolumeWedges, TwentyFramesOfAMovingLight) {
  scenes::Scene scene = tests::shipped_scene("fusion");
  const auto on_device = make_soft_volume(device(), {}), on_host = make_soft_volume(device(), {{"wedges", "host"}});
  const SoftStage stage(scene, device(), 24, 18);
  on_device->prepare_mesh(stage.floats);
  on_host->prepare_mesh(stage.floats);
  const auto base = std::get<scenes::Rectangle>(scene.lights.at(0).shape);
  for (int frame = 0; frame < 20; ++frame) {
    auto moved = base;
    moved.center += 0.5 * glm::dvec3(std::sin(0.7 * frame), 0.3 * std::cos(0.9 * frame), std::cos(0.7 * frame));
    scene.lights[0].shape = moved;
    const visibility::Light light = visibility::make_light(scene, 0, stage.floats.origin, {});
    std::array<std::vector<float>, 2> v;
    for (const auto& [method, result] : {std::pair(on_device.get(), v.data()), {on_host.get(), v.data() + 1}}) {
      method->prepare_light(light);
      if (frame == 0) method->prepare_view(stage.samples);
      method->evaluate({0, stage.samples.height});
      result->resize(stage.samples.size());
      method->read_visibility(*result);
    }
    ASSERT_EQ(v[0], v[1]) << "frame " << frame;
    penumbra_ += static_cast<std::size_t>(std::ranges::count_if(v[0], [](float x) { return x > 0 && x < 1; }));
  }
}

}  // namespace
}  // namespace penumbra::volumes
