// SPDX-License-Identifier: Apache-2.0
#include "mesh/shapes/broken_meshes.hpp"
#include "mesh/shapes/shapes.hpp"
#include "scenes/formats/json_meshes.hpp"
#include "scenes/formats/json_schema.hpp"
#include "tests/unit/scenes/support.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace penumbra::test {
namespace {

using mesh::TriangleSoup;

struct Shape {
  const char* name;
  TriangleSoup soup;
  std::size_t triangles;
  bool closed;
  double volume;  ///< volume of the ideal solid; the mesh's may be smaller by `share`
  double share;
};

std::vector<Shape> shapes() {
  constexpr double kPi = std::numbers::pi;
  return {
      {"quad", mesh::make_quad({1, 2, 3}, {1, 0, 0}, {0, 0, -1}), 2, false, 0, 0},
      {"grid", mesh::make_grid({.cells_u = 3, .cells_v = 5}), 30, false, 0, 0},
      {"box", mesh::make_box({1, 2, 3}, {1, 2, 3}), 12, true, 48, 1e-12},
      {"sphere", mesh::make_sphere({.radius = 2, .segments = 64, .rings = 32}), std::size_t{2} * 64 * 31, true,
       4.0 / 3 * kPi * 8, 0.01},
      {"smallest sphere", mesh::make_sphere({.segments = 3, .rings = 2}), 6, true, 4.0 / 3 * kPi, 0.9},
      {"icosphere", mesh::make_icosphere({5, 5, 5}, 1, 3), 1280, true, 4.0 / 3 * kPi, 0.02},
      {"blob", mesh::make_blob({.subdivisions = 4}), 5120, true, 4.0 / 3 * kPi, 0.3},
      {"cylinder", mesh::make_cylinder({.segments = 100}), 400, true, 2 * kPi, 0.01},
      {"open cylinder", mesh::make_cylinder({.segments = 10, .capped = false}), 20, false, 0, 0},
      {"cone", mesh::make_cone({.segments = 100}), 200, true, 2 * kPi / 3, 0.01},
      {"torus", mesh::make_torus({.segments = 96, .sides = 48}), std::size_t{2} * 96 * 48, true, 2 * kPi * kPi * 0.0625,
       0.01},
      {"knot", mesh::make_knot({.segments = 400, .sides = 32}), std::size_t{2} * 400 * 32, true, 0, 0},
      {"terrain", mesh::make_terrain({.cells = {7, 9}}), 126, false, 0, 0},
      {"fence", mesh::make_fence({.posts = 5, .rails = 3}), 96, true, 5 * 0.0009 + 3 * 4 * 0.0009, 1e-9},
      {"hair", mesh::make_hair({.strands = 11, .segments = 4}), 88, false, 0, 0},
      // Volume: outer box minus inner box minus the window's hole.
      {"room", mesh::make_room({.vertical_bars = 0, .horizontal_bars = 0}), 44, true,
       4.3 * 2.8 * 4.3 - 4 * 2.5 * 4 - 1.4 * 1.2 * 0.15, 1e-9},
      {"room with bars", mesh::make_room({.vertical_bars = 2, .horizontal_bars = 1}), 44 + 36, true, 0, 0},
      {"bars", mesh::make_bars({.count = 3, .segments = 8}), 96, true, 0, 0},
  };
}

/// Returns whether every directed edge occurs once, and its opposite once.
bool is_closed_manifold(const TriangleSoup& soup) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const mesh::Triangle& t : soup.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    const auto opposite = edges.find({edge.first.second, edge.first.first});
    return edge.second == 1 && opposite != edges.end() && opposite->second == 1;
  });
}

double volume(const TriangleSoup& soup) {
  double six_volumes = 0;
  for (const auto& [a, b, c] : soup.triangles) {
    six_volumes += glm::dot(soup.positions[a], glm::cross(soup.positions[b], soup.positions[c]));
  }
  return six_volumes / 6;
}

TEST(Shapes, HaveTheTrianglesTheyPromise) {
  for (const Shape& shape : shapes()) {
    EXPECT_EQ(shape.soup.triangles.size(), shape.triangles) << shape.name;
    EXPECT_EQ(shape.soup.object, std::vector<std::uint32_t>(shape.triangles, 0)) << shape.name;
    ASSERT_EQ(shape.soup.source_face.size(), shape.triangles) << shape.name;
    EXPECT_EQ(shape.soup.source_face.back(), shape.triangles - 1) << shape.name;
  }
}

TEST(Shapes, SayBeforehandHowLargeTheyAre) {
  const auto expect_size = [](const mesh::ShapeSize& size, const TriangleSoup& soup) {
    EXPECT_EQ(size.triangles, soup.triangles.size());
    EXPECT_EQ(size.vertices, soup.positions.size());
  };
  using nlohmann::json;
  for (const char* text :
       {R"({"type": "sphere", "segments": 7, "rings": 5})", R"({"type": "sphere", "segments": 9})",
        R"({"type": "icosphere", "subdivisions": 0})", R"({"type": "icosphere"})",
        R"({"type": "blob", "subdivisions": 2})", R"({"type": "box"})", R"({"type": "cylinder", "segments": 5})",
        R"({"type": "cylinder", "segments": 5, "capped": false})", R"({"type": "cone", "segments": 6})",
        R"({"type": "torus", "segments": 5, "sides": 4})", R"({"type": "knot", "segments": 11, "sides": 3})",
        R"({"type": "grid", "cells": [2, 5]})", R"({"type": "terrain", "cells": [3, 4]})",
        R"({"type": "fence", "posts": 4, "rails": 3})", R"({"type": "hair", "strands": 5, "segments": 3})",
        R"({"type": "room", "verticalBars": 2, "horizontalBars": 3})", R"({"type": "bars", "count": 3, "segments": 5})",
        R"({"type": "lattice-soup", "triangles": 9})"}) {
    SCOPED_TRACE(text);
    const json shape = json::parse(text);
    expect_size(scenes::size_of_shape(shape), scenes::read_shape(shape));
  }
  expect_size({2, 4}, mesh::make_quad({}, {1, 0, 0}, {0, 0, -1}));
  for (const mesh::DefectName& defect : mesh::broken_defects()) {
    SCOPED_TRACE(defect.name);
    const json shape = {{"type", "broken"}, {"defects", {"hole", std::string(defect.name)}}, {"size", 3}};
    const mesh::ShapeSize size = scenes::size_of_shape(shape);
    const TriangleSoup soup = scenes::read_shape(shape);
    EXPECT_EQ(size.triangles, soup.triangles.size());
    EXPECT_LE(size.vertices, soup.positions.size()) << "size_of_shape counts only distinct vertices";
  }
}

TEST(Shapes, UseEveryVertexAndHaveNoDegenerateTriangle) {
  for (const Shape& shape : shapes()) {
    std::vector<bool> used(shape.soup.positions.size(), false);
    for (const auto& [a, b, c] : shape.soup.triangles) {
      ASSERT_LT(std::max({a, b, c}), used.size()) << shape.name;
      used[a] = used[b] = used[c] = true;
      const auto& p = shape.soup.positions;
      EXPECT_GT(glm::length(glm::cross(p[b] - p[a], p[c] - p[a])), 0) << shape.name;
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << shape.name;
  }
}

TEST(Shapes, ClosedOnesAreWatertightWithNormalsOutward) {
  for (const Shape& shape : shapes()) {
    EXPECT_EQ(is_closed_manifold(shape.soup), shape.closed) << shape.name;
    if (shape.closed) {
      EXPECT_GT(volume(shape.soup), 0) << shape.name;
    }
    if (shape.volume > 0) {
      EXPECT_NEAR(volume(shape.soup) / shape.volume, 1, shape.share) << shape.name;
    }
  }
}

TEST(Shapes, OpenOnesFaceUp) {
  for (const TriangleSoup& soup :
       {mesh::make_grid({}), mesh::make_terrain({}), mesh::make_quad({}, {1, 0, 0}, {0, 0, -1})}) {
    for (const auto& [a, b, c] : soup.triangles) {
      const auto& p = soup.positions;
      EXPECT_GT(glm::cross(p[b] - p[a], p[c] - p[a]).y, 0);
    }
  }
}

TEST(Shapes, SameParametersSameNumbersOtherSeedOthers) {
  const mesh::TerrainShape terrain;
  EXPECT_EQ(mesh::make_terrain(terrain).positions, mesh::make_terrain(terrain).positions);
  EXPECT_NE(mesh::make_terrain(terrain).positions, mesh::make_terrain({.seed = 2}).positions);
  EXPECT_EQ(mesh::make_hair({}).positions, mesh::make_hair({}).positions);
  EXPECT_NE(mesh::make_hair({}).positions, mesh::make_hair({.seed = 2}).positions);
}

/// The height stays within its documented bounds.
TEST(Shapes, TerrainStaysWithinItsHeight) {
  for (const glm::dvec3& p : mesh::make_terrain({.center = {0, 10, 0}, .height = 3, .cells = {200, 200}}).positions) {
    EXPECT_GE(p.y, 8.5);
    EXPECT_LE(p.y, 11.5);
  }
}

TEST(Shapes, TerrainIsAsLongAndAsWideAsItsFileSays) {
  glm::dvec3 most(0);
  const auto shape = nlohmann::json::parse(R"({"type": "terrain", "halfSize": [3, 7], "cells": [4, 6]})");
  for (const glm::dvec3& p : scenes::read_shape(shape).positions) most = glm::max(most, glm::abs(p));
  EXPECT_EQ(most.x, 3);
  EXPECT_EQ(most.z, 7);
}

TEST(Shapes, AMillionTriangles) {
  EXPECT_EQ(mesh::make_terrain({.cells = {1000, 500}}).triangles.size(), 1'000'000u);
}

TEST(Shapes, TooFineIsRefusedBeforeMemoryIsAsked) {
  expect_error(ExitCode::input, "at most 50000000 are generated",
               [] { mesh::make_grid({.cells_u = 60000, .cells_v = 60000}); });
}

/// The schema's defaults are only annotations; the options structs hold the real ones. Writing a default out must
/// change nothing.
TEST(Shapes, SchemaKnowsTheDefaults) {
  const auto schema = nlohmann::json::parse(scenes::kSceneSchemaText);
  int types = 0;
  for (const auto& branch : schema["definitions"]["shape"]["oneOf"]) {
    nlohmann::json bare, written;
    bare["type"] = branch["properties"]["type"]["const"];
    if (bare["type"] == "grid") bare["halfU"] = {1, 0, 0}, bare["halfV"] = {0, 0, -1};
    if (bare["type"] == "broken") bare["defects"] = {"hole", "fin"};
    written = bare;
    for (const auto& [key, value] : branch["properties"].items()) {
      if (value.contains("default")) written[key] = value["default"];
    }
    const TriangleSoup a = scenes::read_shape(bare), b = scenes::read_shape(written);
    EXPECT_EQ(a.positions, b.positions) << bare;
    EXPECT_EQ(a.triangles, b.triangles) << bare;
    ++types;
  }
  EXPECT_EQ(types, 16);
}

TEST(Shapes, SchemaKnowsTheDefects) {
  const auto schema = nlohmann::json::parse(scenes::kSceneSchemaText);
  std::vector<std::string> named, known;
  for (const auto& branch : schema["definitions"]["shape"]["oneOf"]) {
    if (branch["properties"]["type"]["const"] != "broken") continue;
    named = branch["properties"]["defects"]["items"]["enum"].get<std::vector<std::string>>();
  }
  for (const mesh::DefectName& defect : mesh::broken_defects()) known.emplace_back(defect.name);
  EXPECT_EQ(named, known);
}

}  // namespace
}  // namespace penumbra::test
