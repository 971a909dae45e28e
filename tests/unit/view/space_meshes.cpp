// SPDX-License-Identifier: Apache-2.0
// Tests the meshes that the 3D view draws: coarser if there are too many triangles, with defects in colours.
#include "app/view/space_meshes.hpp"

#include "tests/unit/view/space_reading.hpp"

#include <gtest/gtest.h>

namespace penumbra::app {
namespace {

using mesh::Triangle;

/// A flat square of n × n cells of size 1, two triangles each.
struct Sheet {
  std::vector<glm::vec3> positions;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> objects;

  explicit Sheet(std::uint32_t n) {
    const std::uint32_t row = n + 1;
    for (std::uint32_t i = 0; i < row * row; ++i) positions.emplace_back(i % row, 0, i / row);
    for (std::uint32_t i = 0; i < n * n; ++i) {
      const std::uint32_t a = i / n * row + i % n;
      triangles.push_back({a, a + row, a + 1});
      triangles.push_back({a + 1, a + row, a + row + 1});
      objects.insert(objects.end(), 2, i % 2);
    }
  }
  [[nodiscard]] ShownTriangles shown(std::size_t most) const {
    return shown_triangles(positions, triangles, objects, most);
  }
};

TEST(SpaceMeshes, AreDrawnAsTheyAreUpToALimit) {
  const Sheet sheet(3);
  const ShownTriangles shown = sheet.shown(18);
  EXPECT_EQ(shown.positions, sheet.positions);
  EXPECT_EQ(shown.triangles, sheet.triangles);
  EXPECT_EQ(shown.objects, sheet.objects);
}

TEST(SpaceMeshes, AreCoarsenedOnAGrid) {
  // 64 cells along a side: 8192 triangles. On a grid of 32 cells, positions 0 and 1, 2 and 3, … are merged; the last is
  // alone.
  const ShownTriangles shown = Sheet(64).shown(8191);
  EXPECT_EQ(shown.triangles.size(), 2U * 32 * 32);
  EXPECT_EQ(shown.positions.size(), 33U * 33);
  EXPECT_EQ(shown.objects.size(), shown.triangles.size());
  for (const glm::vec3& p : shown.positions) {
    EXPECT_EQ(p.x, 2 * std::floor(p.x / 2));
    EXPECT_EQ(p.z, 2 * std::floor(p.z / 2));
  }
  double area = 0;
  for (const auto& [a, b, c] : shown.triangles) {
    const glm::vec3 u = shown.positions[b] - shown.positions[a], v = shown.positions[c] - shown.positions[a];
    area += 0.5 * (u.z * v.x - u.x * v.z);  // as seen from above
  }
  EXPECT_EQ(area, 64.0 * 64);
  EXPECT_LE(Sheet(64).shown(10).triangles.size(), 10U);
}

TEST(SpaceMeshes, MessageHasTheScenesNumbers) {
  const scenes::Scene scene = space_scene();
  const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
  const SpaceAnswer answer(meshes_message(scene, floats));
  EXPECT_EQ(answer.header["triangles"], scene.soup.triangles.size());
  EXPECT_EQ(answer.floats("positions").size(), 3 * floats.positions.size());
  EXPECT_EQ(answer.floats("positions")[5], floats.positions[1].z);
  EXPECT_EQ(answer.indices("triangles")[3 * 2 + 1], scene.soup.triangles[2][1]);  // also checks the winding
  EXPECT_EQ(answer.indices("objects"), scene.soup.object);
  EXPECT_EQ(answer.header["objects"][1]["name"], "block");
}

TEST(SpaceMeshes, DefectsAreThoseOfEachObject) {
  scenes::Scene scene = space_scene();
  const glm::dvec3 origin(1, 2, 3);
  const auto count_of = [](const SpaceAnswer& answer, const char* what) {
    for (const auto& kind : answer.header["kinds"]) {
      if (kind["what"] == what) return kind["count"].get<int>();
    }
    return 0;
  };
  const SpaceAnswer sound(defects_message(scene, origin));
  EXPECT_EQ(count_of(sound, "boundary edges"), 4);  // those of the floor
  EXPECT_EQ(sound.floats("lines").size(), 4U * 6);
  EXPECT_EQ(sound.indices("lineColors"), std::vector<std::uint32_t>(4, 0xff0000));
  EXPECT_EQ(count_of(sound, "inconsistent windings"), 0);
  std::swap(scene.soup.triangles.back()[0], scene.soup.triangles.back()[1]);
  EXPECT_EQ(count_of(SpaceAnswer(defects_message(scene, origin)), "inconsistent windings"), 3);
  scene.soup.triangles.pop_back();
  scene.soup.object.pop_back();
  scene.soup.source_face.pop_back();
  const SpaceAnswer open(defects_message(scene, origin));
  EXPECT_EQ(count_of(open, "boundary edges"), 7);
  for (const float number : open.floats("lines")) EXPECT_LE(std::abs(number), 10) << "relative to the origin";
}

}  // namespace
}  // namespace penumbra::app
