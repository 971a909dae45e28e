// SPDX-License-Identifier: Apache-2.0
// Cropping (Lehtinen et al. 2006) leaves edges that are no silhouettes, as seen from a group of view samples, out of
// the group's list. Tests that it removes nothing that matters, and counts how much it removes.

#include "tests/agreement/differences.hpp"
#include "tests/unit/shipped_scene.hpp"

#include "visibility/lights/device_light.hpp"
#include "volumes/counters/methods.hpp"
#include "volumes/edges/device/edge_lists.hpp"

namespace penumbra::volumes {
namespace {

/// View samples of a scene's first camera under the scene's first light.
struct CropStage {
  CropStage(const render::Device& device, const std::string& name, std::uint32_t size)
      : scene(tests::shipped_scene(name)),
        floats(visibility::make_scene_floats(scene)),
        light(visibility::make_light(scene, 0, floats.origin, {64, 0, 0, visibility::SamplePattern::rows, 0})),
        samples(render::VisibilityBuffer(device, floats)
                    .render(visibility::make_camera(scene.cameras[0], floats.origin, size, size))) {}

  scenes::Scene scene;
  visibility::SceneFloats floats;
  visibility::Light light;
  visibility::ViewSamples samples;
};

/// The slots in the list of a cluster of view samples, in ascending order, and the cluster's judged pixels.
struct ClusterList {
  std::vector<std::uint32_t> slots, pixels;
};

/// Returns the lists, by number of cluster. No part of the scene may be behind the light or be its body, so that slots
/// are those of `records`.
std::vector<ClusterList> lists_of(const render::Device& device, const CropStage& stage, bool crops) {
  constexpr std::uint32_t kBlock = 8, kClusters = 4, kNone = 0xffffffffU, kHead = 2;  // as in edge_scatter.glsl
  const float scale = visibility::device_scale(stage.floats);
  const visibility::TriangleTree tree = visibility::make_triangle_tree(stage.floats);
  device::TriangleUpload triangles;
  triangles.prepare(device, stage.floats, tree, scale);
  device::ViewUpload view(device);
  const visibility::Tile whole{0, stage.samples.height};
  view.prepare(stage.samples, stage.floats, stage.light, scale);
  view.load(whole);
  EdgeLists edges(device, "edge_crop", crops);
  edges.prepare_mesh(stage.floats, tree, scale);
  edges.prepare_light(stage.light, visibility::make_device_light(stage.light, scale));
  render::Commands commands(device);
  gpu::ScatterPush push{};
  push.rows = push.columns = 2;
  push.question_capacity = 1;
  EXPECT_TRUE(edges.find(commands, push, {view, triangles, stage.samples.width, whole, whole, 1}));
  const std::uint32_t across = (stage.samples.width + kBlock - 1) / kBlock,
                      clusters = kClusters * across * ((stage.samples.height + kBlock - 1) / kBlock);
  std::vector<std::uint32_t> heads(2 * std::size_t{clusters} + stage.samples.size()), memory(kHead + edges.words());
  edges.heads().read(std::span(heads));
  edges.lists().read(std::span(memory));
  std::vector<ClusterList> lists(clusters);
  const auto classes = visibility::classify_pixels(stage.floats, stage.samples, stage.light);
  for (std::uint32_t pixel = 0; pixel < stage.samples.size(); ++pixel) {
    if (classes[pixel] != visibility::PixelClass::judged) continue;
    const std::uint32_t block = pixel / stage.samples.width / kBlock * across + pixel % stage.samples.width / kBlock;
    lists[block * kClusters + heads[2 * std::size_t{clusters} + pixel]].pixels.push_back(pixel);
  }
  for (std::uint32_t cluster = 0; cluster < clusters; ++cluster) {
    std::vector<std::uint32_t>& slots = lists[cluster].slots;
    if (lists[cluster].pixels.empty()) continue;
    for (std::uint32_t piece = heads[2 * std::size_t{cluster}]; piece != kNone; piece = memory[kHead + piece]) {
      const auto first = memory.begin() + kHead + piece + 2;
      slots.insert(slots.end(), first, first + memory[kHead + piece + 1]);
    }
    std::ranges::sort(slots);
  }
  return lists;
}

/// Returns k_e(p) of a record, in float: accurate enough for counting, not for decisions.
int multiplicity(const EdgeTexels& texels, std::uint32_t slot, const glm::vec3& p) {
  int sum = 0;
  for (const std::size_t side : {2U, 4U}) {
    const visibility::Texel &n = texels.slots[side][slot], &anchor = texels.slots[side + 1][slot];
    const float f = glm::dot(n.value, p - anchor.value);
    sum += f > 0 ? 1 : f < 0 ? -1 : 0;
  }
  return sum;
}

class EdgeCropBase : public tests::DeviceTest, public testing::WithParamInterface<const char*> {
 protected:
  void check(std::uint32_t size) {
    const CropStage stage(device(), GetParam(), size);
    const auto all = lists_of(device(), stage, false), cropped = lists_of(device(), stage, true);
    const float scale = visibility::device_scale(stage.floats);
    const EdgeTexels texels = edge_texels(edge_records(stage.floats, edge_casters(stage.floats, -1)), scale);
    double pixels = 0, reached = 0, kept = 0, silhouettes = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_TRUE(std::ranges::includes(all[i].slots, cropped[i].slots)) << i;
      if (all[i].slots.empty()) continue;
      const auto here = static_cast<double>(all[i].pixels.size());
      pixels += here;
      reached += here * static_cast<double>(all[i].slots.size());
      kept += here * static_cast<double>(cropped[i].slots.size());
      const glm::vec3 p = stage.samples.p[all[i].pixels[all[i].pixels.size() / 2]] * scale;
      const auto is_silhouette = [&](std::uint32_t slot) { return multiplicity(texels, slot, p) != 0; };
      silhouettes += here * static_cast<double>(std::ranges::count_if(all[i].slots, is_silhouette));
    }
    EXPECT_GT(pixels, 0);
    EXPECT_LT(kept, reached);
    fmt::print(
        "{} {}x{}: {} judged view samples; edges each: {:.1f} in the shaft, {:.1f} cropped, {:.1f} silhouettes\n",
        GetParam(), size, size, pixels, reached / pixels, kept / pixels, silhouettes / pixels);
  }

  /// Expects that cropping changes neither masks nor V.
  void compare(std::uint32_t size, const std::vector<const char*>& variants) {
    const CropStage stage(device(), GetParam(), size);
    for (const char* variant : variants) {
      const auto run = [&](const char* crop) {
        const auto method = make_depth_complexity(device(), {{"variant", variant}, {"crop", crop}});
        return tests::run(*method, stage.floats, stage.light, stage.samples);
      };
      const tests::Masks on = run("on"), off = run("off");
      EXPECT_EQ(on.words, off.words) << variant;
      EXPECT_EQ(on.visibility, off.visibility) << variant;
    }
  }
};

std::string name_of_case(const testing::TestParamInfo<const char*>& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
}

class EdgeCrop : public EdgeCropBase {};
TEST_P(EdgeCrop, LeavesOutOnlyWhatDoesNotMatter) {
  check(32);
  compare(32, {"soup"});
}
INSTANTIATE_TEST_SUITE_P(Scenes, EdgeCrop, testing::Values("contact", "room"), name_of_case);

class EdgeCropFull : public EdgeCropBase {};
TEST_P(EdgeCropFull, LeavesOutOnlyWhatDoesNotMatter) {
  check(256);
  compare(96, {"soup", "laine"});
}
INSTANTIATE_TEST_SUITE_P(Scenes, EdgeCropFull,
                         testing::Values("bunny", "contact", "fusion", "large-penumbra", "room", "self-shadow", "thin"),
                         name_of_case);

}  // namespace
}  // namespace penumbra::volumes
