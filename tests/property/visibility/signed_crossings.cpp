// SPDX-License-Identifier: Apache-2.0
// The sum of signed crossings over clipped edges is the number of triangles that the open segment meets, as integers,
// by the exact pair decision. Soups are drawn from a tiny lattice: edges through the segment, corners and edges on the
// planes of the light and of p, light points on triangles' planes, edges along the ray, doubled and degenerate
// triangles are the normal case.

#include "mesh/silhouettes.hpp"
#include "visibility/pair_truth.hpp"
#include "tests/property/visibility/signed_crossings_sum.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>
#include <vector>

namespace penumbra::visibility {
namespace {

struct Soup {
  std::vector<glm::vec3> positions;
  std::vector<mesh::Triangle> triangles;
};

std::string text(const glm::vec3& v) {
  std::ostringstream out;
  out << '(' << v.x << ' ' << v.y << ' ' << v.z << ')';
  return out.str();
}

/// Counts of special cases, so that a test can check that it covered them.
struct Tally {
  int pairs = 0, met = 0, several = 0, zeros = 0, cut_at_light = 0, cut_at_p = 0, cancelled = 0;
};

int segment_count(const Soup& soup, const CrossingPair& pair, const Light& light, Tally& tally) {
  int count = 0;
  bool zero = false;
  for (const mesh::Triangle& t : soup.triangles) {
    const std::array<glm::vec3, 3> corners = {soup.positions[t[0]], soup.positions[t[1]], soup.positions[t[2]]};
    const Meeting meeting = segment_meets_triangle(pair.p, pair.l, corners, light);
    count += meeting.meets ? 1 : 0;
    zero |= meeting.zero_predicate;
  }
  tally.zeros += zero ? 1 : 0;
  return count;
}

void expect_equal(const Soup& soup, const CrossingPair& pair, const Light& light, Tally& tally) {
  const std::vector<glm::dvec3> positions = mesh::widened(soup.positions);
  const mesh::MeshView view{positions, soup.triangles};
  const mesh::EdgeGraph graph = mesh::build_edge_graph(view);
  const std::vector<Side> facings = mesh::facings(view, graph, glm::dvec3(pair.p));
  const SignedCrossings sum = signed_crossings(view, graph, facings, pair, light);
  const int count = segment_count(soup, pair, light, tally);
  std::ostringstream what;
  if (sum.total() != count) {
    what << "p " << text(pair.p) << " l " << text(pair.l) << " light " << text(light.center) << text(light.center_u)
         << text(light.center_v) << " edges " << sum.edges << " cuts " << sum.cuts_at_light << ' ' << sum.cuts_at_p;
    for (const mesh::Triangle& t : soup.triangles) {
      what << "\n  " << text(soup.positions[t[0]]) << text(soup.positions[t[1]]) << text(soup.positions[t[2]]);
    }
  }
  ASSERT_EQ(sum.total(), count) << what.str();
  ++tally.pairs;
  tally.met += count > 0 ? 1 : 0;
  tally.several += count > 1 ? 1 : 0;
  tally.cut_at_light += sum.cuts_at_light != 0 ? 1 : 0;
  tally.cut_at_p += sum.cuts_at_p != 0 ? 1 : 0;
  tally.cancelled += count == 0 && sum.edges != 0 ? 1 : 0;
}

class Draw {
 public:
  explicit Draw(std::uint32_t seed) : random_(seed) {}

  int number(int lowest, int highest) { return std::uniform_int_distribution<int>(lowest, highest)(random_); }
  glm::vec3 point(int reach) { return {number(-reach, reach), number(-reach, reach), number(-reach, reach)}; }

  /// Corners from a pool of few positions, so that edges are shared, crossed and doubled; some positions are listed
  /// twice, so that edges are shared by position and not by number.
  Soup soup(int triangles, int reach) {
    Soup soup;
    const int pool = number(3, 2 * triangles + 2);
    for (int i = 0; i < pool; ++i) soup.positions.push_back(point(reach));
    soup.positions.push_back(soup.positions.front() * 1.0f);
    for (int i = 0; i < triangles; ++i) {
      mesh::Triangle t{};
      for (std::uint32_t& corner : t) corner = static_cast<std::uint32_t>(number(0, pool));
      soup.triangles.push_back(t);
    }
    return soup;
  }

  /// Any frame on the lattice; half of the frames are level, so that the planes of p and of the light contain lattice
  /// points.
  Light frame(int reach) {
    Light light;
    const bool level = number(0, 1) == 0;
    do {
      light.center = point(reach);
      light.center_u = point(reach);
      light.center_v = point(reach);
      if (level) light.center_u.y = light.center_v.y = light.center.y;
    } while (collinear(light.center, light.center_u, light.center_v));
    return light;
  }

  /// A pair whose p is not on the light's plane through l.
  CrossingPair pair(const Light& light, int reach) {
    const glm::dvec3 c(light.center), n = glm::cross(glm::dvec3(light.center_u) - c, glm::dvec3(light.center_v) - c);
    CrossingPair pair;
    do {
      pair = {point(reach), point(reach)};
      if (number(0, 1) == 0) pair.l = light.center;
    } while (glm::dot(n, glm::dvec3(pair.p) - glm::dvec3(pair.l)) == 0);  // small integers: exact
    return pair;
  }

  std::mt19937& random() { return random_; }

 private:
  std::mt19937 random_;
};

class SignedCrossingsOnLattice : public testing::TestWithParam<std::uint32_t> {};

TEST_P(SignedCrossingsOnLattice, EqualTheTrianglesMet) {
  Draw draw(GetParam());
  Tally tally;
  for (int round = 0; round < 6000; ++round) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << " round " << round);
    const int reach = draw.number(1, 3);
    const Light light = draw.frame(reach);
    ASSERT_NO_FATAL_FAILURE(expect_equal(draw.soup(draw.number(1, 8), reach), draw.pair(light, reach), light, tally));
  }
  EXPECT_GT(tally.met, 500);
  EXPECT_GT(tally.several, 50);
  EXPECT_GT(tally.zeros, 700);
  EXPECT_GT(tally.cut_at_light, 200);
  EXPECT_GT(tally.cut_at_p, 200);
  EXPECT_GT(tally.cancelled, 100);
}

TEST_P(SignedCrossingsOnLattice, EveryWayToStraddle) {
  // One triangle at a time across the slab 0 < y < 1, with corners on both planes and beyond them: cuts decide most
  // cases.
  Draw draw(GetParam() + 100);
  Tally tally;
  Light light;
  light.center_u = {1, 0, 0};
  light.center_v = {0, 0, 1};
  for (int round = 0; round < 6000; ++round) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << " round " << round);
    const auto corner = [&] { return glm::vec3(draw.number(-2, 2), 0.5 * draw.number(-2, 4), draw.number(-2, 2)); };
    const Soup soup{{corner(), corner(), corner()}, {{0, 1, 2}}};
    const int down = draw.number(0, 1);
    const CrossingPair pair{{draw.number(-1, 1), down, draw.number(-1, 1)}, {0, 1 - down, 0}};
    ASSERT_NO_FATAL_FAILURE(expect_equal(soup, pair, light, tally));
  }
  EXPECT_GT(tally.met, 200);
  EXPECT_GT(tally.zeros, 200);
  EXPECT_GT(tally.cut_at_light, 50);
  EXPECT_GT(tally.cut_at_p, 50);
}

TEST_P(SignedCrossingsOnLattice, LightPointsThatRoundingPutBesideTheirPlane) {
  // No lattice: frames and points in general position and an ulp from special ones, with magnitudes far apart.
  Draw draw(GetParam() + 200);
  std::uniform_real_distribution<float> anywhere(-1, 1);
  Tally tally;
  for (int round = 0; round < 1000; ++round) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << " round " << round);
    const auto point = [&] {
      return glm::vec3(anywhere(draw.random()), anywhere(draw.random()), anywhere(draw.random()));
    };
    Light light;
    light.center = point();
    light.center_u = light.center + 0.25f * point();
    light.center_v = light.center + 0.25f * point();
    CrossingPair pair{point(), light.center + 0.3f * (light.center_u - light.center)};
    const glm::vec3 middle = 0.5f * (pair.p + pair.l);
    Soup soup;
    for (int i = 0; i < 6; ++i) soup.positions.push_back(middle + std::ldexp(1.0f, -draw.number(0, 30)) * point());
    soup.positions.insert(soup.positions.end(), {pair.l, middle, light.center, light.center_v});
    for (int i = 0; i < 12; ++i) {
      mesh::Triangle t{};
      for (std::uint32_t& corner : t) corner = static_cast<std::uint32_t>(draw.number(0, 9));
      soup.triangles.push_back(t);
    }
    ASSERT_NO_FATAL_FAILURE(expect_equal(soup, pair, light, tally));
  }
  EXPECT_GT(tally.met, 50);
  EXPECT_GT(tally.cut_at_light, 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SignedCrossingsOnLattice, testing::Range(0u, 6u));

TEST(SignedCrossings, CutsAloneCanDecide) {
  // A sheet at z = 1 through the whole slab 0 < y < 1, with the ray along +z. The cut at p's plane is at infinity on
  // the ray. If the light point is behind the sheet, nothing else is on its ray; if it is in front, the cut at the
  // light's plane is, too.
  Light light;
  light.center_u = {0, 0, 1};
  light.center_v = {1, 0, 0};
  const std::vector<glm::dvec3> positions = {{-9, -1, 1}, {9, -1, 1}, {0, 9, 1}};
  const std::vector<mesh::Triangle> triangles = {{0, 1, 2}};
  const mesh::MeshView view{positions, triangles};
  const mesh::EdgeGraph graph = mesh::build_edge_graph(view);
  const glm::vec3 p(0, 0, -1);
  const auto facings = mesh::facings(view, graph, p);
  const SignedCrossings behind = signed_crossings(view, graph, facings, {p, {0, 1, 4}}, light);
  EXPECT_EQ(behind.edges, 0);
  EXPECT_EQ(behind.cuts_at_p, 1);
  EXPECT_EQ(behind.cuts_at_light, 0);
  const SignedCrossings before = signed_crossings(view, graph, facings, {p, {0, 1, 0}}, light);
  EXPECT_EQ(before.edges, 0);
  EXPECT_EQ(before.cuts_at_p, 1);
  EXPECT_EQ(before.cuts_at_light, -1);
}

}  // namespace
}  // namespace penumbra::visibility
