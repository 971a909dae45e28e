// SPDX-License-Identifier: Apache-2.0
// Compares the device's silhouettes with mesh/silhouettes: the same edges, multiplicities and order, also where every
// second facing is a tie.

#include "tests/agreement/support.hpp"

#include "mesh/shapes/broken_meshes.hpp"
#include "mesh/shapes/shapes.hpp"
#include "selftest/edge_checks.hpp"
#include "tests/unit/passed.hpp"
#include "volumes/edges/device/silhouette_pass.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace penumbra::volumes {
namespace {

using Mesh = selftest::EdgeMesh;

class SilhouettePassTest : public tests::DeviceTest {
 protected:
  SilhouettePassTest() : pass_(device()) {}

  /// Expects exact silhouettes from all points: first with both sides of every triangle counted, then with only some
  /// sides.
  void expect_exact(const std::string& name, const Mesh& mesh, const std::vector<glm::vec3>& points) {
    ASSERT_TRUE(pass_.prepare_mesh({mesh.positions, mesh.triangles, &mesh.graph}));
    std::vector<std::uint32_t> all(mesh.triangles.size(), gpu::kBothBits), some(all);
    for (std::size_t i = 0; i < some.size(); ++i) some[i] = static_cast<std::uint32_t>(i * 7 / 3 % 4);
    for (const glm::vec3& l : points) {
      expect_edges(name, mesh, l, all);
      expect_edges(name, mesh, l, some);
    }
    const std::vector<mesh::SilhouetteEdge> last = pass_.read_edges();
    pass_.evaluate(points.back(), some);
    EXPECT_EQ(pass_.read_edges(), last) << name << ": once more";
  }

  /// Tests facings alone; returns how many of them the device left to the host.
  std::uint64_t expect_facings(const std::string& name, const Mesh& mesh, const std::vector<glm::vec3>& points) {
    EXPECT_TRUE(pass_.prepare_mesh({mesh.positions, mesh.triangles, &mesh.graph}));
    const std::vector<std::uint32_t> none(mesh.triangles.size(), 0U);
    std::uint64_t open = 0;
    for (const glm::vec3& l : points) {
      pass_.evaluate(l, none);
      std::vector<std::uint32_t> expected;
      for (const mesh::Side side : mesh::facings(mesh.view(), mesh.graph, l)) expected.push_back(bits_of(side));
      EXPECT_EQ(pass_.read_sides(), expected) << name << " from " << tests::text_of(l);
      open += pass_.open_facings();
    }
    return open;
  }

  void expect_edges(const std::string& name, const Mesh& mesh, const glm::vec3& l,
                    const std::vector<std::uint32_t>& counted) {
    SCOPED_TRACE(name);
    tests::expect_passed(selftest::check_silhouettes(pass_, mesh, l, counted, tally_));
  }

  SilhouettePass pass_;
  selftest::SilhouetteTally tally_;
};

std::vector<glm::vec3> around(std::uint32_t seed, std::size_t count, float reach) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> draw(-reach, reach);
  std::vector<glm::vec3> points;
  while (points.size() < count) {
    const float x = draw(random), y = draw(random), z = draw(random);
    points.emplace_back(x, y, z);
  }
  return points;
}

TEST_F(SilhouettePassTest, Knots) {
  mesh::KnotShape knot;
  knot.segments = 100;
  knot.sides = 20;
  for (const double scale : {1.0, 0x1p-70, 0x1p60}) {
    std::vector<glm::vec3> points = around(1, 6, 2);
    for (glm::vec3& p : points) p *= static_cast<float>(scale);
    expect_exact(fmt::format("knot times {}", scale), Mesh(mesh::make_knot(knot), scale), points);
  }
  const Mesh sheet(mesh::make_knot(knot));
  expect_exact("from a corner of its own", sheet, {sheet.positions[17], sheet.positions[1000]});
  expect_exact("from far away", sheet, {glm::vec3(0, 1e30F, 0), glm::vec3(-1e38F, 1e38F, 1e37F)});
  fmt::print("{} points, {} silhouettes, {} ties, {} facings by the host\n", tally_.points, tally_.silhouettes,
             tally_.ties, tally_.open);
  EXPECT_GT(tally_.silhouettes, 1000U);
  EXPECT_GT(tally_.open, 0U);  // far away
}

TEST_F(SilhouettePassTest, EveryDefect) {
  for (const mesh::DefectName& defect : mesh::broken_defects()) {
    const Mesh mesh(mesh::make_broken_mesh({{std::string(defect.name)}, 2, {0, 1, 0}, 1}).soup);
    std::vector<glm::vec3> points = around(2, 2, 2);
    points.insert(points.end(), {{0.3F, 4, 0.1F}, {0, 1, 0}, mesh.positions.front()});
    expect_exact(std::string(defect.name), mesh, points);
  }
  fmt::print("{} points, {} silhouettes, {} ties\n", tally_.points, tally_.silhouettes, tally_.ties);
  EXPECT_GT(tally_.ties, 100U);
}

/// Points of the lattice lie in most of the planes through it.
TEST_F(SilhouettePassTest, LatticeSoups) {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    // A tilt by a third makes most of the products inexact: then ties are left to the host.
    const Mesh mesh(mesh::make_lattice_soup({100 * seed, 1 + seed % 5, seed, glm::dvec3(0), 2}),
                    seed % 2 ? 1 : 1 / 3.0);
    std::vector<glm::vec3> points(mesh.positions.begin(), mesh.positions.begin() + 6);
    points.emplace_back(0, 3, 0);
    expect_exact(fmt::format("soup {}", seed), mesh, points);
  }
  fmt::print("{} points, {} silhouettes, {} ties, {} facings by the host\n", tally_.points, tally_.silhouettes,
             tally_.ties, tally_.open);
  EXPECT_GT(tally_.ties, 1000U);
  EXPECT_GT(tally_.open, 100U);
}

TEST_F(SilhouettePassTest, TiesOnAxisAlignedPlanesNeedNoHost) {
  // Level and upright triangles, points of a lattice: only exact products and exact zeros.
  std::mt19937 random(3);
  std::uniform_int_distribution<int> step(-5, 5);
  std::vector<glm::vec3> points(60);
  for (glm::vec3& p : points) {
    for (int i = 0; i < 3; ++i) p[i] = 0.25F * static_cast<float>(step(random));
  }
  for (const mesh::TriangleSoup& shape :
       {mesh::make_grid({.cells_u = 8, .cells_v = 8}), mesh::make_box({0, 0, 0}, {1, 0.5, 0.25})}) {
    EXPECT_EQ(expect_facings("axis-aligned", Mesh(shape), points), 0U);
  }
}

TEST_F(SilhouettePassTest, FacingsAtHugeAndTinyScales) {
  const mesh::TriangleSoup blob = mesh::make_blob({.subdivisions = 2});
  for (const double scale : {1e-44, 1e-40, 1e-38, 1e-37, 1e-30, 1e-20, 1e-10, 1e5, 1e15, 1e30, 1e38}) {
    const Mesh mesh(blob, scale);
    std::vector<glm::vec3> points;
    for (const glm::vec3& p : around(4, 20, 2)) points.emplace_back(glm::dvec3(p) * scale);
    const std::uint64_t open = expect_facings(fmt::format("times {}", scale), mesh, points);
    if (scale > 1e-37) {
      EXPECT_LT(open, points.size() * mesh.triangles.size() / 1000) << scale;
    }
  }
}

mesh::TriangleSoup loose_triangles(std::size_t count, const std::function<glm::vec3()>& corner) {
  mesh::TriangleSoup soup;
  for (std::uint32_t i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) soup.positions.emplace_back(corner());
    soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return soup;
}

std::vector<glm::vec3> many(std::size_t count, const std::function<glm::vec3()>& point) {
  std::vector<glm::vec3> points(count);
  std::ranges::generate(points, point);
  return points;
}

TEST_F(SilhouettePassTest, FacingsWithMagnitudesMixedInOneMesh) {
  // Values from the smallest subnormal to the largest float next to each other, in corners and points alike.
  const std::array<float, 14> values = {0,       -0.0F, 1,      -1,       1.5F,      1 + 0x1p-23F, 1e-20F,
                                        -1e-20F, 1e15F, -1e15F, 0x1p-80F, 0x1p-126F, 0x1p-149F,    3e38F};
  std::mt19937 random(5);
  for (const std::size_t most : {7U, 9U, 13U, 14U}) {
    const auto value = [&] { return values[std::uniform_int_distribution<std::size_t>(0, most - 1)(random)]; };
    const auto point = [&] {
      const float x = value(), y = value(), z = value();
      return glm::vec3(x, y, z);
    };
    expect_facings(fmt::format("{} magnitudes", most), Mesh(loose_triangles(300, point)), many(40, point));
  }
}

TEST_F(SilhouettePassTest, FacingsOfNearlyCoplanarTriangles) {
  // Triangles of one tilted plane and points on it, each height rounded or moved by an ulp: most are left to the host.
  std::mt19937 random(6);
  std::uniform_real_distribution<float> draw(-1, 1);
  std::uniform_int_distribution<int> draw_step(-1, 1);
  const auto near_plane = [&] {
    const float x = draw(random), y = draw(random);
    float z = 0.3F * x - 0.7F * y;
    const int step = draw_step(random);
    if (step != 0) z = std::nextafter(z, static_cast<float>(step) * std::numeric_limits<float>::infinity());
    return glm::vec3(x, y, z);
  };
  const Mesh mesh(loose_triangles(200, near_plane));
  EXPECT_GT(expect_facings("one plane", mesh, many(60, near_plane)), 60U * 200 / 2);
  // Needles, whose normals are mostly rounding error.
  const auto near_line = [&] {
    const float t = draw(random);
    const float y = std::nextafter(3 * t, 9 * draw(random)), z = std::nextafter(5 * t, 9 * draw(random));
    return glm::vec3(t, y, z);
  };
  expect_facings("needles", Mesh(loose_triangles(200, near_line)), many(60, near_line));
}

TEST_F(SilhouettePassTest, NothingIsNoSilhouette) {
  mesh::TriangleSoup none, repeated;
  repeated.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  repeated.triangles = {{0, 0, 1}, {2, 1, 2}};
  for (const mesh::TriangleSoup& soup : {none, repeated}) {
    const Mesh mesh(soup);
    ASSERT_TRUE(pass_.prepare_mesh({mesh.positions, mesh.triangles, &mesh.graph}));
    pass_.evaluate({0, 5, 0}, std::vector<std::uint32_t>(mesh.triangles.size(), gpu::kBothBits));
    EXPECT_EQ(pass_.count(), 0U);
    EXPECT_TRUE(pass_.read_edges().empty());
    EXPECT_EQ(pass_.read_sides(), std::vector<std::uint32_t>(mesh.triangles.size(), 0U));
  }
}

}  // namespace
}  // namespace penumbra::volumes
