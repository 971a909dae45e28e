// SPDX-License-Identifier: Apache-2.0
// Tests the data that methods keep from one frame's mesh to the next. Vertices of lattice soups move, alone or with all
// vertices at the same place, so that edges, planes and triangles without area come and go; each answer has the same
// bits as that of a method that has seen no other frame.

#include "tests/agreement/lattice.hpp"
#include "tests/agreement/mask_methods.hpp"
#include "tests/agreement/support.hpp"
#include "tests/agreement/volumes/exact_rows.hpp"
#include "volumes/edges/edge_sides.hpp"
#include "volumes/edges/vectors/scene_edges.hpp"
#include "visibility/tree/tree_refit.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <tuple>
#include <utility>

namespace penumbra::volumes {
namespace {

using visibility::SceneFloats;

/// Moves some vertices of a scene, as an animation does between frames.
void deform(scenes::Scene& scene, const scenes::Scene& at_rest, tests::LatticeSoup& soup) {
  std::vector<glm::dvec3>& positions = scene.soup.positions;
  const auto any = [&] { return soup.below(static_cast<std::uint32_t>(positions.size())); };
  const auto move_all_at = [&](const glm::dvec3& from, const glm::dvec3& to) {
    for (glm::dvec3& position : positions) position = position == from ? to : position;
  };
  switch (soup.below(6)) {
    case 0:  // one corner, away from what it touched
      positions[any()] = soup.point();
      break;
    case 1:  // all vertices at one place, perhaps to the place of others
      move_all_at(positions[any()], soup.point());
      break;
    case 2:  // by less than the lattice's step: planes separate, edges do not
      move_all_at(positions[any()], positions[any()] + 0.25 * glm::dvec3(soup.point()));
      break;
    case 3:  // one object shrinks to a point, as if its scale were 0
      for (std::size_t i = 0; i < scene.soup.triangles.size(); ++i) {
        if (scene.soup.object[i] != 0) continue;
        for (const std::uint32_t vertex : scene.soup.triangles[i]) positions[vertex] = glm::dvec3(1, 0, 1);
      }
      break;
    case 4:  // everything moves, with rounding
      for (glm::dvec3& position : positions) position = 1.1 * position + glm::dvec3(0.3, 0.1, 0.2);
      break;
    default:
      positions = at_rest.soup.positions;
  }
}

using Edge = std::array<float, 20>;  // the ends, and normal, anchor and plane of each side
std::vector<Edge> edges_of(const vectors::WideEdgeTree& tree) {
  std::vector<Edge> found;
  for (std::size_t i = 0; i < tree.leaves.size(); ++i) {
    const vectors::WideEdges& leaf = tree.leaves[i];
    for (std::size_t lane = 0; lane < vectors::kWide; ++lane) {
      if ((leaf.used >> lane & 1U) == 0) continue;
      Edge edge{};
      std::size_t next = 0;
      for (const auto* points : {&leaf.a, &leaf.b, &leaf.n[0], &leaf.n[1], &leaf.anchor[0], &leaf.anchor[1]}) {
        for (const vectors::WideFloats& axis : *points) edge[next++] = axis[lane];
      }
      edge[18] = static_cast<float>(leaf.plane[0][lane]);
      edge[19] = static_cast<float>(leaf.plane[1][lane]);
      found.push_back(edge);
    }
  }
  std::ranges::sort(found);
  return found;
}

/// Expects that every edge is in the boxes of all nodes above it: a tree of another scene would miss some.
void expect_in_boxes(const vectors::WideEdgeTree& tree) {
  const std::function<void(std::uint32_t, const std::vector<std::array<glm::vec3, 2>>&)> go =
      [&](std::uint32_t reference, const std::vector<std::array<glm::vec3, 2>>& boxes) {
        if ((reference & visibility::TriangleTree::kLeafBit) == 0) {
          const vectors::WideNode& node = tree.nodes[reference];
          for (std::size_t child = 0; child < vectors::kWide; ++child) {
            if ((node.used >> child & 1U) == 0) continue;
            auto more = boxes;
            std::array<glm::vec3, 2> box;
            for (int axis = 0; axis < 3; ++axis) {
              const auto a = static_cast<std::size_t>(axis);
              box[0][axis] = node.middle[a][child] - node.half[a][child];
              box[1][axis] = node.middle[a][child] + node.half[a][child];
            }
            more.push_back(box);
            go(node.reference[child], more);
          }
          return;
        }
        const vectors::WideEdges& leaf = tree.leaves[reference & ~visibility::TriangleTree::kLeafBit];
        for (std::size_t lane = 0; lane < vectors::kWide; ++lane) {
          if ((leaf.used >> lane & 1U) == 0) continue;
          for (const auto& [lower, upper] : boxes) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
              for (const float x : {leaf.a[axis][lane], leaf.b[axis][lane]}) {
                EXPECT_GE(x, lower[static_cast<int>(axis)] - 1e-6F);
                EXPECT_LE(x, upper[static_cast<int>(axis)] + 1e-6F);
              }
            }
          }
        }
      };
  for (const std::uint32_t root : tree.roots) go(root, {});
}

TEST(KeptEdges, AreThoseOfTheFrameByItself) {
  std::map<SceneEdges::Made, std::size_t> made;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    tests::LatticeSoup soup(seed, 1 + static_cast<int>(seed % 3));
    scenes::Scene scene;
    const scenes::Scene at_rest = [&] {
      tests::add_object(scene, "soup", soup.triangles(4 + soup.below(60)));
      tests::add_object(scene, "other", soup.triangles(4));
      scene.origin = glm::dvec3(0);
      return scene;
    }();
    SceneEdges kept;
    kept.expect_frames();
    for (int frame = 0; frame < 6; ++frame) {
      SCOPED_TRACE(fmt::format("seed {} frame {}", seed, frame));
      const SceneFloats floats = visibility::make_scene_floats(scene);
      const float scale = visibility::device_scale(floats);
      const visibility::TriangleTree triangles = visibility::make_triangle_tree(floats);
      const EdgeCasters casters = edge_casters(floats, -1);
      ++made[kept.make({floats, triangles, casters, scale})];
      SceneEdges fresh;
      EXPECT_EQ(fresh.make({floats, triangles, casters, scale}), SceneEdges::Made::built);
      EXPECT_EQ(edges_of(kept.edges().tree()), edges_of(fresh.edges().tree()));
      expect_in_boxes(kept.edges().tree());
      if (frame % 2 == 0 || soup.below(2) == 0) deform(scene, at_rest, soup);
    }
  }
  EXPECT_GT(made[SceneEdges::Made::refit], 300U);
  EXPECT_GT(made[SceneEdges::Made::tree_built], 30U);
  EXPECT_GT(made[SceneEdges::Made::built], 600U) << "connectivity changes";
}

/// Moves a whole sheet, and bends the part of it from `from` on.
void bend(scenes::Scene& scene, double from) {
  for (glm::dvec3& p : scene.soup.positions) p += glm::dvec3(0, p.x > from ? p.x * p.x + p.z * p.x : 0, 0.25);
}

/// Flat edges that bend are added to the hierarchy, which is then built again. If most of what moves bends, the rest is
/// added, too, so that the next frame needs no other hierarchy.
TEST(KeptEdges, WhatIsFlatByChanceIsTakenInAtOnce) {
  using Made = SceneEdges::Made;
  struct Case {
    double from;
    double hills;  // height of another sheet, which is never flat
    Made next;
  };
  for (const auto& [from, hills, next] :
       {Case{0.25, 0, Made::refit}, Case{0.95, 0, Made::tree_built}, Case{0.95, 1, Made::refit}}) {
    scenes::Scene scene;
    const auto add_sheet = [&scene](const std::string& name, int cells, double height) {
      std::vector<std::array<glm::dvec3, 3>> sheet;
      const auto at = [&](int x, int z) {
        return glm::dvec3(x, height * std::sin(7.3 * x * x + 5.1 * z), z) / double(cells) + glm::dvec3(0, -height, 0);
      };
      for (int x = 0; x < cells; ++x) {
        for (int z = 0; z < cells; ++z) {
          sheet.push_back({at(x, z), at(x + 1, z), at(x, z + 1)});
          sheet.push_back({at(x + 1, z), at(x + 1, z + 1), at(x, z + 1)});
        }
      }
      tests::add_object(scene, name, sheet);
    };
    add_sheet("sheet", 16, 0);
    if (hills > 0) add_sheet("hills", 64, hills);
    scene.origin = glm::dvec3(0);
    SceneEdges kept;
    kept.expect_frames();
    for (const Made expected : {Made::built, Made::tree_built, next}) {
      const SceneFloats floats = visibility::make_scene_floats(scene);
      const float scale = visibility::device_scale(floats);
      const visibility::TriangleTree triangles = visibility::make_triangle_tree(floats);
      const EdgeCasters casters = edge_casters(floats, -1);
      EXPECT_EQ(kept.make({floats, triangles, casters, scale}), expected) << from << ' ' << hills;
      SceneEdges fresh;
      fresh.make({floats, triangles, casters, scale});
      EXPECT_EQ(edges_of(kept.edges().tree()), edges_of(fresh.edges().tree()));
      expect_in_boxes(kept.edges().tree());
      bend(scene, expected == Made::built ? from : -1);
    }
  }
}

/// A mesh of this size has its leaves made on request; by then the list of casters may be that of another light.
TEST(SceneEdges, OfManyAreThoseThatAreMadeAtOnce) {
  scenes::Scene scene;
  std::vector<std::array<glm::dvec3, 3>> sheet;
  constexpr int kCells = 440;
  const auto at = [](int x, int z) { return glm::dvec3(x, std::sin(7.3 * x * x + 5.1 * z), z); };
  for (int x = 0; x < kCells; ++x) {
    for (int z = 0; z < kCells; ++z) {
      sheet.push_back({at(x, z), at(x + 1, z), at(x, z + 1)});
      sheet.push_back({at(x + 1, z), at(x + 1, z + 1), at(x, z + 1)});
    }
  }
  tests::add_object(scene, "sheet", sheet);
  const SceneFloats floats = visibility::make_scene_floats(scene);
  const visibility::TriangleTree triangles = visibility::make_triangle_tree(floats);
  EdgeCasters casters = edge_casters(floats, -1);
  const SceneMesh mesh{floats, triangles, casters, visibility::device_scale(floats)};
  SceneEdges at_once, later;
  at_once.expect_frames();
  at_once.make(mesh);
  later.make(mesh);
  casters = {};
  const std::uint64_t before = later.edges().tree().leaves.memory_bytes();
  EXPECT_EQ(edges_of(at_once.edges().tree()), edges_of(later.edges().tree()));
  expect_in_boxes(later.edges().tree());
  EXPECT_LT(before, later.edges().tree().leaves.memory_bytes());
}

/// Expects that a tree is kept if it still holds the same casters, and only then.
TEST(KeptTrees, HoldWhatTheyHeld) {
  std::size_t others = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    tests::LatticeSoup soup(seed, 3);
    scenes::Scene scene;
    tests::add_object(scene, "soup", soup.triangles(1 + soup.below(100)));
    const scenes::Scene at_rest = scene;
    const SceneFloats floats = visibility::make_scene_floats(scene);
    visibility::TriangleTree tree = visibility::make_triangle_tree(floats);
    EXPECT_TRUE(visibility::holds_casters(tree, floats));
    deform(scene, at_rest, soup);
    const SceneFloats moved = visibility::make_scene_floats(scene);
    if (!visibility::holds_casters(tree, moved)) {
      EXPECT_NE(moved.casts_shadow, floats.casts_shadow);
      ++others;
      continue;
    }
    EXPECT_EQ(moved.casts_shadow, floats.casts_shadow);
    visibility::refit_triangle_tree(tree, moved);
    std::size_t found = 0;
    for (std::uint32_t triangle = 0; triangle < moved.triangles.size(); ++triangle) {
      if (moved.casts_shadow[triangle] == 0) continue;
      const glm::vec3 corner = moved.corners(triangle)[triangle % 3];
      tree.for_each_near(corner, corner, [&](std::uint32_t near) { found += near == triangle ? 1 : 0; });
    }
    EXPECT_EQ(found, static_cast<std::size_t>(std::ranges::count(moved.casts_shadow, 1))) << seed;
  }
  EXPECT_GT(others, 10U);
}

class KeptMeshes : public tests::ExactRows {
 protected:
  static bool same(const Answer& a, const Answer& b) {
    return a.shares == b.shares && a.form_factors == b.form_factors;
  }
};

TEST_F(KeptMeshes, GiveTheBitsOfTheFrameByItself) {
  constexpr std::array kMethods{tests::kNativeViewSample, tests::kNativeEdgeScatter, tests::kNativeEdgeScatterPoints,
                                tests::kNativeDepthComplexity};
  std::map<std::string, std::uint64_t> counters;
  std::size_t partly = 0, frames = 0;
  for (std::uint32_t seed = 0; seed < 80; ++seed) {
    tests::LatticeSoup soup(seed + 700, 1 + static_cast<int>(seed % 3));
    visibility::SampleRequest request;
    scenes::Scene scene = lattice_scene(soup, request);
    scene.origin = glm::dvec3(0);
    const scenes::Scene at_rest = scene;
    std::vector<std::unique_ptr<visibility::Method>> kept;
    for (const auto& method : kMethods) kept.push_back(method.make(device(), {}));
    kept.push_back(make());
    for (const auto& method : kept) method->expect_frames();
    for (int frame = 0; frame < 5; ++frame, ++frames) {
      SCOPED_TRACE(fmt::format("seed {} frame {}", seed, frame));
      const SceneFloats floats = visibility::make_scene_floats(scene);
      const visibility::ViewSamples samples = tests::samples_on_triangles(floats, 6, 6, soup.random());
      visibility::Light light = visibility::make_light(scene, 0, floats.origin, request);
      for (std::size_t i = 0; i < kMethods.size(); ++i) {
        visibility::Light its = light;
        if (kMethods[i].no_rows) its.rows = its.columns = 0;
        const tests::Masks ours = tests::run(*kept[i], floats, its, samples);
        const tests::Masks alone = tests::run(*kMethods[i].make(device(), {}), floats, its, samples);
        EXPECT_EQ(ours.words, alone.words) << kMethods[i];
        EXPECT_EQ(ours.visibility, alone.visibility) << kMethods[i];
      }
      const Answer ours = run(*kept.back(), floats, light, samples), alone = run(*make(), floats, light, samples);
      EXPECT_TRUE(same(ours, alone));
      for (const float share : ours.shares) partly += share > 0 && share < 1 ? 1 : 0;
      for (const auto& [name, count] : kept.back()->take_mesh_counters()) counters[name] += count;
      deform(scene, at_rest, soup);
      if (soup.below(4) == 0) std::get<scenes::Rectangle>(scene.lights[0].shape).center += soup.point();
    }
  }
  EXPECT_GT(partly, 300U);
  EXPECT_EQ(counters["treesRefit"] + counters["treesBuilt"], frames);
  EXPECT_EQ(counters["edgesRefit"] + counters["edgeTreesBuilt"], frames);
  EXPECT_GT(counters["treesRefit"], 40U);
  EXPECT_GT(counters["edgesRefit"], 20U);
}

}  // namespace
}  // namespace penumbra::volumes
