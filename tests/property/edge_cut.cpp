// Edges cut at a light's plane inside their hierarchy: what the walk finds is what cutting all records gives, and
// mending leaves nothing behind.

#include "visibility/tree_texels.hpp"
#include "tests/agreement/lattice.hpp"
#include "volumes/edges/edge_sides.hpp"
#include "volumes/scatter/vectors/cut.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

namespace penumbra::volumes {
namespace {

using visibility::TriangleTree;

using Numbers = std::array<float, 20>;  // of an edge: ends, and normal, anchor, plane of each side

Numbers numbers_of(const native::WideEdges& leaf, std::size_t lane) {
  Numbers numbers{};
  std::size_t i = 0;
  for (const auto* points : {&leaf.a, &leaf.b, &leaf.n[0], &leaf.n[1], &leaf.anchor[0], &leaf.anchor[1]}) {
    for (const native::WideFloats& axis : *points) numbers[i++] = axis[lane];
  }
  numbers[i++] = static_cast<float>(leaf.plane[0][lane]);
  numbers[i] = static_cast<float>(leaf.plane[1][lane]);
  return numbers;
}

/// All edges that a walk from the roots can reach, sorted.
std::vector<Numbers> reachable(const native::WideEdgeTree& tree) {
  std::vector<Numbers> found;
  std::vector<std::uint32_t> stack = tree.roots;
  while (!stack.empty()) {
    const native::WideNode& node = tree.nodes[stack.back()];
    stack.pop_back();
    for (std::uint32_t left = node.used; left != 0; left &= left - 1) {
      const std::uint32_t reference = node.reference[static_cast<std::size_t>(std::countr_zero(left))];
      if ((reference & TriangleTree::kLeafBit) == 0) {
        stack.push_back(reference);
        continue;
      }
      const native::WideEdges& leaf = tree.leaves[reference & ~TriangleTree::kLeafBit];
      for (std::uint32_t used = leaf.used; used != 0; used &= used - 1) {
        found.push_back(numbers_of(leaf, static_cast<std::size_t>(std::countr_zero(used))));
      }
    }
  }
  std::ranges::sort(found);
  return found;
}

TEST(CutEdges, AreThoseOfAllRecordsCut) {
  std::size_t cut = 0, third = 0, kept = 0;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
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
    const std::vector<EdgeRecord> all = sides.records(std::nullopt);
    CutEdges edges(wide_edges(all, scale));
    const std::vector<Numbers> whole = reachable(edges.tree());
    ASSERT_EQ(whole.size(), all.size());
    for (int turn = 0; turn < 2; ++turn) {  // one light after the other: the second cuts what the first has cut
      const visibility::Light light = visibility::make_light(scene, 0, floats.origin, request);
      const LightEdges asked = sides.prepare_light(light, visibility::make_light_frame(light, scale), scale);
      for (const auto& side : {asked.front, asked.back}) {
        if (!side) continue;
        edges.cut({floats, triangles, sides.casters(), -1, *side});
        const std::vector<EdgeRecord> expected = sides.records(side);
        EXPECT_EQ(reachable(edges.tree()), reachable(wide_edges(expected, scale))) << "seed " << seed;
        const std::size_t in_plane = edges_in_plane(floats, sides.casters(), sides.casters().triangle, *side).size();
        cut += all.size() - std::min(all.size(), expected.size() - in_plane);
        third += in_plane;
        kept += expected.size() - in_plane;
      }
      scene.lights[0] = soup.light(request);
    }
    edges.mend();
    EXPECT_EQ(reachable(edges.tree()), whole) << "seed " << seed;
  }
  EXPECT_GT(cut, 1000U);
  EXPECT_GT(third, 1000U);
  EXPECT_GT(kept, 1000U);
}

}  // namespace
}  // namespace penumbra::volumes
