// The device's silhouettes against mesh/silhouettes: the same edges, multiplicities and order, also where every second
// facing is a tie.

#include "tests/agreement/support.hpp"

#include "mesh/shapes/broken_meshes.hpp"
#include "mesh/shapes/shapes.hpp"
#include "volumes/edges/silhouette_pass.hpp"

#include <cmath>

namespace penumbra::volumes {
namespace {

struct Mesh {
  explicit Mesh(const mesh::TriangleSoup& soup, double scale = 1) : triangles(soup.triangles) {
    for (const glm::dvec3& p : soup.positions) positions.emplace_back(p * scale);
    wide = mesh::widened(positions);
    graph = mesh::build_edge_graph(view());
  }
  [[nodiscard]] mesh::MeshView view() const { return {wide, triangles}; }

  std::vector<glm::vec3> positions;
  std::vector<glm::dvec3> wide;
  std::vector<mesh::Triangle> triangles;
  mesh::EdgeGraph graph;
};

struct Tally {
  std::size_t points = 0, silhouettes = 0, ties = 0, open = 0;
};

class SilhouettePassTest : public tests::DeviceTest {
 protected:
  SilhouettePassTest() : pass_(device()) {}

  /// From all points, every side that a triangle is seen from counting, and then only some.
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

  void expect_edges(const std::string& name, const Mesh& mesh, const glm::vec3& l,
                    const std::vector<std::uint32_t>& counted) {
    std::vector<mesh::Side> sides = mesh::facings(mesh.view(), mesh.graph, l);
    pass_.evaluate(l, counted);
    const std::vector<std::uint32_t> found = pass_.read_sides();
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const std::uint32_t side = bits_of(sides[i]);
      ASSERT_EQ(found[i], side | (side & counted[i]) << gpu::kCountedShift) << name << ", triangle " << i;
      tally_.ties += sides[i] == mesh::Side::on ? 1 : 0;
      if ((side & counted[i]) == 0) sides[i] = mesh::Side::on;
    }
    std::vector<mesh::SilhouetteEdge> expected;
    for (std::uint32_t edge = 0; edge < mesh.graph.edges.size(); ++edge) {
      const int k = mesh::signed_multiplicity(mesh.graph, edge, sides);
      if (k != 0) expected.push_back({edge, k});
    }
    ASSERT_EQ(pass_.read_edges(), expected) << name << " from " << tests::text_of(l);
    ASSERT_EQ(pass_.count(), expected.size());
    ++tally_.points;
    tally_.silhouettes += expected.size();
    tally_.open += pass_.open_facings();
  }

  SilhouettePass pass_;
  Tally tally_;
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

/// Points of the lattice are on most planes through it.
TEST_F(SilhouettePassTest, LatticeSoups) {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    // A tilt by a third keeps most of the products from being exact: then ties are the host's.
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
