// SPDX-License-Identifier: Apache-2.0
// Tests an identity of contours on every scene: how they are searched for never changes a bit of V (Yang et al. 2009,
// sections 1 and 4.3).

#include "mesh/shapes/broken_meshes.hpp"
#include "scenes/formats/reader.hpp"
#include "tests/agreement/differences.hpp"
#include "tests/analytic/maps/backprojection/contour_scenes.hpp"

#include <random>
#include <set>

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

/// All search variants, which must find the same contours.
std::vector<std::pair<Factory, MethodOptions>> all_variants() {
  std::vector<std::pair<Factory, MethodOptions>> variants;
  for (const char* search : {"none", "hsm", "mssm", "ysm"}) {
    variants.push_back({maps::make_contour, {{"search", search}, {"traversal", "flat"}}});
  }
  for (const char* traversal : {"hierarchy", "minmax"}) {
    for (const char* search : {"none", "hsm", "ysm"}) {
      variants.push_back({maps::make_contour, {{"search", search}, {"traversal", traversal}}});
    }
  }
  for (const char* packet : {"1x1", "2x2", "3x3", "8x8"}) variants.push_back({maps::make_packet, {{"packet", packet}}});
  for (const char* divergence : {"0", "0.31", "1"}) {
    variants.push_back({maps::make_packet, {{"packet", "4x2"}, {"divergence", divergence}}});
  }
  variants.push_back({maps::make_packet, {{"packet", "5x5"}, {"divergence", "1"}, {"hierarchy", "off"}}});
  variants.push_back({maps::make_packet, {{"packet", "3x7"}}});
  variants.push_back({maps::make_packet, {{"packet", "64x1"}, {"divergence", "1"}}});
  return variants;
}

class MapsContourVariants : public ContourTest {
 protected:
  static void expect_one_image(const Stage& stage, const char* size, const std::string& what) {
    const Masks first = run(maps::make_contour, stage, {{"size", size}, {"search", "none"}, {"traversal", "flat"}});
    std::set<float> values(first.visibility.begin(), first.visibility.end());
    for (const float v : values) EXPECT_TRUE(v >= 0 && v <= 1) << what << ": " << v;
    for (auto [factory, options] : all_variants()) {
      options["size"] = size;
      const std::vector<float> found = run(factory, stage, options).visibility;
      std::string variant;
      for (const auto& [name, value] : options) variant += fmt::format(" {}={}", name, value);
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (found[i] == first.visibility[i]) continue;
        ADD_FAILURE() << what << variant << ", pixel " << i << ": " << found[i] << " for " << first.visibility[i];
        break;
      }
    }
  }
};

TEST_F(MapsContourVariants, OneImageOnAShippedSceneOfAnySize) {
  const Stage stage(scenes::read_scene(std::filesystem::path(PENUMBRA_SCENES) / "bunny.json"), 41, 37,
                    light_samples(1));
  expect_one_image(stage, "100", "bunny");
}

TEST_F(MapsContourVariants, OneImageInHemicubesOnBothSidesAndForEveryShape) {
  scenes::Scene room;
  add_quad(room, {0, 0, 0}, {3, 0, 0}, {0, 0, 3});
  add_quad(room, {0, 2, -3}, {3, 0, 0}, {0, 2, 0});
  add_quad(room, {-3, 2, 0}, {0, 0, 3}, {0, 2, 0});
  add_quad(room, {-1.5, 2, -1.5}, {0.3, 0.3, 0}, {0, 0, 0.8});
  add_quad(room, {0.5, 1.5, 0}, {0.5, 0.1, 0}, {0, 0, 0.4});
  add_quad(room, {0.5, 3.5, 0}, {0.5, 0.1, 0}, {0, 0, 0.4});
  room.lights.push_back(ceiling_light(3, 0.4));
  room.lights.front().two_sided = true;
  room.cameras.push_back(camera({0, 2, 7}, {0, 1.7, 0}, 50));
  expect_one_image(Stage(room, 17, 16, light_samples(1)), "20", "room");
  for (const int shape : {1, 2, 3}) {
    expect_one_image(Stage(under_shape(shape), 16, 16, light_samples(1)), "40", "shape");
  }
}

// Triangles that touch, overlap, cross the light's plane, or lie behind it or on the receivers: V is defined, is the
// same in all variants, and does not depend on the order of the triangles.
TEST_F(MapsContourVariants, OneImageOfSoupsAndWithinBounds) {
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    std::mt19937 random(seed);
    const auto number = [&] { return static_cast<double>(random() % 7) - 3; };
    std::vector<Corners> triangles(12);
    for (Corners& corners : triangles) {
      for (glm::dvec3& corner : corners) corner = {number(), number(), number()};
    }
    const auto scene_of = [&](const std::vector<Corners>& soup) {
      scenes::Scene scene;
      add_object(scene, "soup", soup);
      scene.lights.push_back(rectangle_light({0, seed % 2 == 0 ? 4.0 : 1.0, 0}, {1, 0, 0}, {0, 0, 1}));
      scene.lights.front().two_sided = seed % 3 == 0;
      scene.cameras.push_back(camera({1, 2, 9}, {0, 0, 0}, 50));
      return scene;
    };
    const Stage stage(scene_of(triangles), 12, 10, light_samples(1));
    expect_one_image(stage, seed % 2 == 0 ? "8" : "21", fmt::format("seed {}", seed));
    const Masks first = run(maps::make_packet, stage, {{"size", "21"}});
    std::shuffle(triangles.begin(), triangles.end(), random);
    const Stage shuffled(scene_of(triangles), 12, 10, light_samples(1));
    EXPECT_EQ(run(maps::make_packet, shuffled, {{"size", "21"}}).visibility, first.visibility) << "seed " << seed;
  }
}

// Meshes with every named defect, and soups whose corners, edges and planes coincide.
TEST_F(MapsContourVariants, OneImageOfBrokenMeshesAndLatticeSoups) {
  for (const std::uint32_t seed : {1U, 2U}) {
    const mesh::LatticeSoup soup{.triangles = 40, .cells = 3, .seed = seed, .center = {0, 1, 0}};
    expect_one_image(Stage(with_a_floor(mesh::make_lattice_soup(soup)), 12, 12, light_samples(1)), "24",
                     fmt::format("lattice soup {}", seed));
  }
  std::vector<std::string> defects;
  for (const mesh::DefectName& defect : mesh::broken_defects()) defects.emplace_back(defect.name);
  const Stage broken(with_a_floor(mesh::make_broken_mesh({defects, 1, {0, 1, 0}, 1}).soup), 16, 16, light_samples(1));
  expect_one_image(broken, "32", "broken mesh");
}

// Nodes are entered for outlines only, whose length grows with a map's side: 4 times; areas would grow 16 times. The
// light's plane cuts the floor: a hemicube's sideways faces see most of the floor, and what is beside the light.
TEST_F(MapsContourVariants, HierarchiesFollowOutlinesInHemicubes) {
  scenes::Scene scene = contour_floor(0.6);
  add_object(scene, "ball", sphere({0, 1, 0}, 0.5, 24));
  scene.lights.front() = rectangle_light({0, 3, -2.5}, {1.2, 0, 0}, {0, 1, 0.6});
  const Stage stage(scene, 12, 12, light_samples(1));
  const auto found = [&](const char* size) { return counted(maps::make_contour, stage, {{"size", size}}); };
  const Counted small = found("32"), large = found("128");
  EXPECT_EQ(small.count("mapFaces"), 5);
  EXPECT_GT(small.count("edges"), 100);
  EXPECT_LE(large.count("cells"), 4 * small.count("cells"));
  expect_one_image(stage, "32", "hemicube");
}

}  // namespace
}  // namespace penumbra::tests
