// SPDX-License-Identifier: Apache-2.0
// Tests silhouettes, shadow volumes and wedges of the 3D view, compared with places found by hand and with the
// library's results.
#include "app/view/space_shadows.hpp"

#include "app/view/space_view.hpp"
#include "base/error.hpp"
#include "mesh/silhouettes.hpp"
#include "tests/unit/view/space_reading.hpp"
#include "volumes/wedges/wedge_body.hpp"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace penumbra::app {
namespace {

using Edge = std::array<glm::dvec3, 2>;

visibility::Light made_light(const scenes::LightShape& shape) {
  scenes::Scene scene = space_scene();
  scene.lights[0].shape = shape;
  return visibility::make_light(scene, 0, glm::dvec3(0), {});
}

void expect_point(const glm::dvec3& found, const glm::dvec3& wanted) {
  EXPECT_LT(glm::length(found - wanted), 1e-6) << found.x << " " << found.y << " " << found.z;
}

TEST(SpaceShadows, PointsOfTheLightAreOnIt) {
  const auto rectangle = made_light(scenes::Rectangle{{0, 6, 0}, {2, 0, 0}, {0, 0, 1}});
  expect_point(light_point(rectangle, {0.5, -1}), {1, 6, -1});
  const auto disk = made_light(scenes::Disk{{0, 6, 0}, {0, -1, 0}, 2});
  EXPECT_NEAR(glm::length(light_point(disk, {1, 1}) - glm::dvec3(0, 6, 0)), 2,
              1e-6);  // on the rim, not in the corner of the square
  const auto sphere = made_light(scenes::Sphere{{0, 6, 0}, 2});
  expect_point(light_point(sphere, {0.5, 0}), {1, 6, 0});
  // A triangle: centroid (0, 6, 1); a corner of its bounding rectangle is pulled back to its outline.
  const auto polygon = made_light(scenes::Polygon{{{-3, 6, 0}, {3, 6, 0}, {0, 6, 3}}});
  expect_point(light_point(polygon, {0, 0}), {0, 6, 1});
  for (const glm::dvec2 place : {glm::dvec2(1, 1), glm::dvec2(-1, 1), glm::dvec2(1, -1), glm::dvec2(0.9, 0.2)}) {
    const glm::dvec3 p = light_point(polygon, place);
    EXPECT_NEAR(p.y, 6, 1e-9);
    EXPECT_GE(p.z, -1e-6);
    EXPECT_LE(p.z + std::abs(p.x), 3 + 1e-6);
    EXPECT_GT(glm::length(p - glm::dvec3(0, 6, 1)), 0.5);
  }
}

TEST(SpaceShadows, SidesOfVolumesReachTheBox) {
  const volumes::Box box{{-8, 0, -8}, {8, 4, 8}};
  const glm::dvec3 l(0, 4, 0);
  const Edge edge = {glm::dvec3(1, 2, -1),
                     {1, 2, 1}};  // half way down from the light: on the floor it is twice as far and twice as long
  std::vector<glm::dvec3> side = volume_side(edge, l, box);
  ASSERT_EQ(side.size(), 4U);
  for (const glm::dvec3& wanted : {edge[0], edge[1], glm::dvec3(2, 0, 2), glm::dvec3(2, 0, -2)}) {
    EXPECT_TRUE(std::ranges::any_of(side, [&](const glm::dvec3& p) { return glm::length(p - wanted) < 1e-12; }));
  }
  for (const double height : {0.0, 1.0}) {
    const auto line = side_at(edge, l, box, height);
    ASSERT_TRUE(line);
    const double far = (4 - height) / 2;
    for (const glm::dvec3& end : *line) expect_point(glm::dvec3(end.x, end.y, std::abs(end.z)), {far, height, far});
  }
  EXPECT_FALSE(side_at(edge, l, box, 3));  // the height is above the edge
  const auto on_it = side_at(edge, l, box, 2);
  ASSERT_TRUE(on_it);
  EXPECT_EQ(glm::length((*on_it)[0] - (*on_it)[1]), 2);
  const auto cut = side_at(edge, l, {{-8, 0, -1}, {8, 4, 8}}, 0);
  ASSERT_TRUE(cut);
  EXPECT_NEAR(glm::length((*cut)[0] - (*cut)[1]), 3, 1e-12);                   // from z = −1 to 2
  EXPECT_TRUE(volume_side({glm::dvec3(0, 3, 0), {0, 2, 0}}, l, box).empty());  // the edge points at the light
}

struct Built {
  scenes::Scene scene = space_scene();
  visibility::SceneFloats floats = visibility::make_scene_floats(scene);
  visibility::Light light = visibility::make_light(scene, 0, floats.origin, {});
  volumes::Casters casters = volumes::casters_of(floats, light);

  [[nodiscard]] SpaceAnswer answer(const SpaceShadows& request) const {
    return SpaceAnswer(shadows_message(casters, light, floats.origin, request));
  }
};

TEST(SpaceShadows, MessageHasTheLibrarysOwnSilhouettesAndWedges) {
  const Built built;
  for (const char* const construction : {"original", "tight"}) {
    for (const char* const from : {"centre", "anywhere"}) {
      SpaceShadows request;
      request.wedges.construction = construction;
      request.wedges.from = from;
      const SpaceAnswer answer = built.answer(request);
      const session::BuiltWedges wedges(built.scene, request.wedges);
      ASSERT_EQ(answer.header["wedges"], wedges.wedges.size());
      const std::vector<float> edges = answer.floats("wedgeEdges");
      for (std::size_t i = 0; i < wedges.wedges.size(); ++i) {
        EXPECT_EQ(edges[6 * i + 1], static_cast<float>(wedges.wedges[i].a.y));
        EXPECT_EQ(edges[6 * i + 5], static_cast<float>(wedges.wedges[i].b.z));
        EXPECT_EQ(answer.indices("wedgeSources")[i], wedges.casting.edges[wedges.wedges[i].source]);
      }
      const std::vector<std::uint32_t> bodies = answer.indices("bodies");
      std::size_t triangles = 0, lines = 0, floor_lines = 0;
      for (std::size_t i = 0; i < bodies.size(); i += 4) {
        const volumes::Box box = volumes::bounds_of(wedges.casters);
        const volumes::WedgeBody body = volumes::wedge_body(wedges.wedges[bodies[i]], box);
        EXPECT_EQ(bodies[i + 1], body.triangles.size());
        EXPECT_EQ(bodies[i + 2], body.edges.size());
        const std::size_t corners =
            body.triangles.empty() ? 0 : 2 + body.triangles.size() / 2;  // Euler: V − 3 T / 2 + T = 2
        EXPECT_EQ(body.corners.size(), corners);
        triangles += bodies[i + 1];
        lines += bodies[i + 2];
        floor_lines += bodies[i + 3];
      }
      EXPECT_EQ(answer.floats("bodyTriangles").size(), 9 * triangles);
      EXPECT_EQ(answer.floats("bodyLines").size(), 6 * lines);
      EXPECT_EQ(answer.floats("floorLines").size(), 6 * floor_lines);
      EXPECT_GT(floor_lines, 0U);
    }
  }
}

TEST(SpaceShadows, SilhouettesAreThoseOfThePoint) {
  const Built built;
  // Seen from above, the block's top has four silhouettes and the floor has its own four. The block's sides are
  // silhouettes only for a point beyond them.
  const SpaceAnswer above = built.answer({});
  EXPECT_EQ(above.header["silhouettes"], 8);
  const std::vector<std::int32_t> counts = above.numbers<std::int32_t>("multiplicities");
  EXPECT_EQ(std::ranges::count_if(counts, [](int k) { return std::abs(k) == 2; }), 4);
  EXPECT_EQ(std::ranges::count_if(counts, [](int k) { return std::abs(k) == 1; }), 4);
  EXPECT_EQ(above.header["floor"], 0);
  // The top's edges at ±0.5, 4 below the light, are cast to ±0.5 · 6 / 4 on the floor, 6 below it.
  const std::vector<float> lines = above.floats("shadowLines");
  ASSERT_EQ(lines.size(), 8U * 6);
  int of_block = 0;
  for (std::size_t i = 0; i < lines.size(); i += 3) {
    EXPECT_EQ(lines[i + 1], -1);  // heights are relative to the origin, which is at height 1
    of_block +=
        std::abs(std::abs(lines[i]) - 0.75F) < 1e-6F && std::abs(std::abs(lines[i + 2]) - 0.75F) < 1e-6F ? 1 : 0;
  }
  EXPECT_EQ(of_block, 8);
  SpaceShadows beside;
  beside.place = {1, 0};
  const SpaceAnswer answer = built.answer(beside);
  EXPECT_EQ(answer.header["silhouettes"], 10);
  EXPECT_EQ(answer.header["point"], nlohmann::json({1, 6, 0}));
}

TEST(SpaceShadows, WedgesOfAPointAreThoseThatContainIt) {
  const Built built;
  SpaceShadows request;
  request.wedges.construction = "tight";
  // The light's sides cast the top's edge at x = 0.5 to x = 0.25 and x = 1.25 on the floor.
  for (const auto& [x, count] : {std::pair{0.2, 0}, std::pair{0.3, 1}, std::pair{1.2, 1}, std::pair{1.3, 0}}) {
    request.point = glm::dvec3(x, 0, 0) - built.floats.origin;
    EXPECT_EQ(built.answer(request).header["inside"]["count"], count) << x;
  }
}

TEST(SpaceShadows, OneWedgeIsOneBody) {
  const Built built;
  SpaceShadows request;
  request.wedge = 3;
  const SpaceAnswer one = built.answer(request);
  EXPECT_EQ(one.header["bodies"], 1);
  EXPECT_EQ(one.indices("bodies")[0], 3U);
  EXPECT_EQ(one.header["leftOut"], 0);
  request.wedge = 1000;
  EXPECT_EQ(built.answer(request).header["bodies"], 0);
}

TEST(SpaceShadows, RequestsAreCheckedNumberByNumber) {
  const SpaceShadows request = parse_space_shadows(
      "/space/shadows?light=key%20one&construction=tight&from=anywhere&s=-0.5&t=1&floor=2.5&wedge=7");
  EXPECT_EQ(request.wedges.light, "key one");
  EXPECT_EQ(request.wedges.construction, "tight");
  EXPECT_EQ(request.wedges.from, "anywhere");
  EXPECT_EQ(request.place, glm::dvec2(-0.5, 1));
  EXPECT_EQ(request.floor, 2.5);
  EXPECT_EQ(request.wedge, 7U);
  EXPECT_FALSE(parse_space_shadows("/space/shadows").floor);
  for (const char* const wrong :
       {"s=1.1", "s=", "t=x", "floor=inf", "floor=nan", "wedge=-1", "wedge=1.5", "wedge=4294967296"})
    EXPECT_THROW(parse_space_shadows(std::string("/space/shadows?") + wrong), UsageError) << wrong;
  const Built built;
  SpaceShadows unknown;
  unknown.wedges.construction = "best";
  EXPECT_THROW(static_cast<void>(built.answer(unknown)), UsageError);
}

}  // namespace
}  // namespace penumbra::app
