// SPDX-License-Identifier: Apache-2.0
// Edges cut at a light's plane inside their hierarchy, on vector units and on the device: the walk finds the same edges
// as cutting all records would give, and restoring leaves nothing behind.

#include "tests/agreement/lattice.hpp"
#include "tests/agreement/support.hpp"
#include "visibility/tree/tree_texels.hpp"
#include "volumes/edges/edge_sides.hpp"
#include "volumes/edges/device/edge_upload.hpp"
#include "volumes/edges/vectors/cut.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

namespace penumbra::volumes {
namespace {

using visibility::TriangleTree;

using Numbers = std::array<float, 20>;  // of an edge: its ends, and normal, anchor and plane of each side

Numbers numbers_of(const vectors::WideEdges& leaf, std::size_t lane) {
  Numbers numbers{};
  std::size_t i = 0;
  for (const auto* points : {&leaf.a, &leaf.b, &leaf.n[0], &leaf.n[1], &leaf.anchor[0], &leaf.anchor[1]}) {
    for (const vectors::WideFloats& axis : *points) numbers[i++] = axis[lane];
  }
  numbers[i++] = static_cast<float>(leaf.plane[0][lane]);
  numbers[i] = static_cast<float>(leaf.plane[1][lane]);
  return numbers;
}

/// Returns all edges that a walk from the roots can reach, sorted.
std::vector<Numbers> reachable(const vectors::WideEdgeTree& tree) {
  std::vector<Numbers> found;
  std::vector<std::uint32_t> stack = tree.roots;
  while (!stack.empty()) {
    const vectors::WideNode& node = tree.nodes[stack.back()];
    stack.pop_back();
    for (std::uint32_t left = node.used; left != 0; left &= left - 1) {
      const std::uint32_t reference = node.reference[static_cast<std::size_t>(std::countr_zero(left))];
      if ((reference & TriangleTree::kLeafBit) == 0) {
        stack.push_back(reference);
        continue;
      }
      const vectors::WideEdges& leaf = tree.leaves[reference & ~TriangleTree::kLeafBit];
      for (std::uint32_t used = leaf.used; used != 0; used &= used - 1) {
        found.push_back(numbers_of(leaf, static_cast<std::size_t>(std::countr_zero(used))));
      }
    }
  }
  std::ranges::sort(found);
  return found;
}

/// Returns all edges below a root of a hierarchy that is given as texels.
std::vector<Numbers> reachable(const EdgeTexels& texels, std::uint32_t root) {
  std::vector<Numbers> found;
  if (texels.depth == 0) return found;
  std::vector<std::uint32_t> stack{root};
  while (!stack.empty()) {
    const std::uint32_t first = stack.back() * TriangleTree::kWidth;
    stack.pop_back();
    for (std::uint32_t child = first; child < first + TriangleTree::kWidth; ++child) {
      const std::uint32_t reference = texels.nodes[std::size_t{3} * child].number;
      if (reference == TriangleTree::kNoChild) continue;
      if ((reference & TriangleTree::kLeafBit) == 0) {
        stack.push_back(reference);
        continue;
      }
      const std::size_t leaf = std::size_t{reference & ~TriangleTree::kLeafBit} * TriangleTree::kWidth;
      for (std::size_t slot = leaf; slot < leaf + TriangleTree::kWidth; ++slot) {
        if (texels.slots[2][slot].number == 0) continue;
        Numbers numbers{};
        std::size_t i = 0;
        for (const std::size_t list : {0U, 1U, 2U, 4U, 3U, 5U}) {
          for (int axis = 0; axis < 3; ++axis) numbers[i++] = texels.slots[list][slot].value[axis];
        }
        numbers[i++] = static_cast<float>(texels.slots[0][slot].number);
        numbers[i] = static_cast<float>(texels.slots[1][slot].number);
        found.push_back(numbers);
      }
    }
  }
  std::ranges::sort(found);
  return found;
}

std::vector<Numbers> reachable(const CutEdges& edges) {
  return reachable(edges.tree());
}
/// Returns all edges of the hierarchy on the device, from the parts of its buffers that are in use.
std::vector<Numbers> reachable(const EdgeUpload& edges) {
  EdgeTexels texels = edges.texels();
  const auto read = [](const render::Buffer& from, std::vector<visibility::Texel>& texels_to) {
    from.read(std::span(texels_to));
  };
  read(edges.nodes(), texels.nodes);
  for (std::size_t i = 0; i < texels.slots.size(); ++i) read(edges.slots(i), texels.slots[i]);
  return reachable(texels, edges.root());
}

/// `make(records, scale)` makes the hierarchy under test.
template <typename Make>
void expect_cut_like_all_records(std::uint32_t soups, const Make& make) {
  std::size_t cut = 0, third = 0, kept = 0;
  for (std::uint32_t seed = 0; seed < soups; ++seed) {
    tests::LatticeSoup soup(seed, 2);
    scenes::Scene scene;
    tests::add_object(scene, "soup", soup.triangles(5 + soup.below(120)));
    visibility::SampleRequest request;
    scene.lights.push_back(soup.light(request));
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    const float scale = visibility::device_scale(floats);
    const TriangleTree triangles = visibility::make_triangle_tree(floats);
    EdgeSides sides("test");
    sides.prepare_mesh(floats);
    const std::vector<EdgeRecord> all = edge_records(floats, sides.casters());
    auto edges = make(all, scale);
    const std::vector<Numbers> whole = reachable(edges);
    ASSERT_EQ(whole.size(), all.size());
    for (int turn = 0; turn < 2; ++turn) {  // one light after the other: the second cuts edges that the first has cut
      const visibility::Light light = visibility::make_light(scene, 0, floats.origin, request);
      const LightEdges asked = sides.prepare_light(light, visibility::make_device_light(light, scale), scale);
      for (const auto& side : {asked.front, asked.back}) {
        if (!side) continue;
        edges.cut({floats, triangles, sides.casters(), -1, *side});
        const std::vector<EdgeRecord> expected = cut_records(floats, sides.casters(), *side);
        EXPECT_EQ(reachable(edges), reachable(wide_edges(expected, scale))) << "seed " << seed;
        const std::size_t in_plane = edges_in_plane(floats, sides.casters(), sides.casters().triangle, *side).size();
        cut += all.size() - std::min(all.size(), expected.size() - in_plane);
        third += in_plane;
        kept += expected.size() - in_plane;
      }
      scene.lights[0] = soup.light(request);
    }
    edges.restore();
    EXPECT_EQ(reachable(edges), whole) << "seed " << seed;
  }
  EXPECT_GT(cut, 3 * soups);
  EXPECT_GT(third, 3 * soups);
  EXPECT_GT(kept, 3 * soups);
}

TEST(CutEdges, AreThoseOfAllRecordsCut) {
  expect_cut_like_all_records(
      300, [](const std::vector<EdgeRecord>& records, float scale) { return CutEdges(wide_edges(records, scale)); });
}

using CutEdgesOnDevice = tests::DeviceTest;

TEST_F(CutEdgesOnDevice, AreThoseOfAllRecordsCut) {
  expect_cut_like_all_records(100, [&](const std::vector<EdgeRecord>& records, float scale) {
    return EdgeUpload(device(), edge_texels(records, scale));
  });
}

}  // namespace
}  // namespace penumbra::volumes
