// SPDX-License-Identifier: Apache-2.0
// Tests wedges of random and of awkward edges: every plane is proved, exactly, to bound the penumbra; points of the
// penumbra are inside; and the bound is as small as its construction promises.

#include "volumes/wedges/penumbra_wedge.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace penumbra::volumes {
namespace {

class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(engine_() % end); }
  double real(double size = 1) { return std::uniform_real_distribution<double>(-size, size)(engine_); }
  /// Returns a point in float32, as scenes store them.
  glm::dvec3 point(double size = 1) { return glm::dvec3(glm::vec3(glm::dvec3(real(size), real(size), real(size)))); }
  glm::dvec3 lattice_point(std::uint32_t range) {
    const auto one = [&] { return static_cast<double>(below(2 * range + 1)) - range; };
    const double x = one(), y = one(), z = one();
    return {x, y, z};
  }

 private:
  std::mt19937 engine_;
};

LightHull rectangle(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) {
  return {{center - u - v, center + u - v, center + u + v, center - u + v}, center, 0, false};
}

LightHull disk(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v, std::uint32_t sides) {
  LightHull hull{{}, center, 0, false};
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2 * M_PI * i / sides;
    hull.corners.push_back(center + std::cos(angle) * u + std::sin(angle) * v);
  }
  return hull;
}

/// Returns a point of the penumbra of the edge a b: x + t (x − l).
glm::dvec3 point_of_penumbra(const Wedge& wedge, const LightHull& light, Random& random) {
  glm::dvec3 l(0);
  double weight = 0;
  for (const glm::dvec3& corner : light.corners) {
    const double w = random.below(3) == 0 ? 0.0 : std::abs(random.real());
    l += w * corner;
    weight += w;
  }
  l = weight > 0 ? l / weight : light.corners[0];
  const double s = random.below(4) == 0 ? 0.0 : 0.5 + random.real(0.5);
  const glm::dvec3 x = wedge.a + s * (wedge.b - wedge.a);
  return x + std::exp(random.real(8)) * (x - l);
}

struct Case {
  const char* name;
  WedgeEdge (*edge)(Random&);
};

const LightHull kLight = rectangle({0, 4, 0}, {1, 0, 0}, {0, 0, 1});

const Case kCases[] = {
    {"anywhere",
     [](Random& r) {
       return WedgeEdge{r.point(4), r.point(4), {}};
     }},
    {"below the light",
     [](Random& r) {
       return WedgeEdge{r.point(2), r.point(2), {}};
     }},
    {"short and far",
     [](Random& r) {
       const glm::dvec3 a = r.point(50);
       return WedgeEdge{a, glm::dvec3(glm::vec3(a + r.point(1e-3))), {}};
     }},
    {"points at the light",
     [](Random& r) {
       const glm::dvec3 l(r.real(0.9), 4, r.real(0.9)), direction = r.point(2) - l;
       return WedgeEdge{glm::dvec3(glm::vec3(l + 0.5 * direction)),
                        glm::dvec3(glm::vec3(l + (1 + std::abs(r.real())) * direction)),
                        {}};
     }},
    {"longer than its distance",
     [](Random& r) {
       return WedgeEdge{glm::dvec3(-100, 3.9, r.real()), glm::dvec3(90, 3.8, r.real()), {}};
     }},
    {"through the light's plane",
     [](Random& r) {
       return WedgeEdge{glm::dvec3(2, 3, r.real()), glm::dvec3(3, 5, r.real()), {}};
     }},
    {"in the light's plane",
     [](Random& r) {
       return WedgeEdge{glm::dvec3(2, 4, r.real()), glm::dvec3(3, 4, r.real()), {}};
     }},
    {"on a lattice",
     [](Random& r) {
       return WedgeEdge{r.lattice_point(4), r.lattice_point(4), {}};
     }},
};

class Wedges : public testing::TestWithParam<std::tuple<Construction, Case>> {};

TEST_P(Wedges, ContainThePenumbra) {
  const auto& [construction, edges_of] = GetParam();
  Random random(1);
  std::vector<WedgeEdge> edges(300);
  for (WedgeEdge& edge : edges) edge = edges_of.edge(random);
  std::size_t proved = 0;
  for (const LightHull& light :
       {kLight, rectangle({0.5, 5, 0.25}, {1, 0.5, 0}, {0, -0.25, 0.5}), disk({0, 4, 0}, {1, 0, 0}, {0, 0, 1}, 32),
        rectangle({0, 4, 0}, {1e-3, 0, 0}, {0, 0, 1e-3})}) {
    for (const Wedge& wedge : build_wedges(edges, light, construction)) {
      EXPECT_EQ(wedge.outcome == WedgeOutcome::wedge, !wedge.planes.empty());
      for (const Plane& plane : wedge.planes) {
        EXPECT_TRUE(std::isfinite(plane.a + plane.b + plane.c + plane.d));
        EXPECT_GT(glm::length(plane.normal()), 0.5);
        ASSERT_TRUE(bounds_penumbra(plane, {wedge.a, wedge.b, light.corners})) << "edge " << wedge.source;
        ++proved;
      }
      for (int i = 0; i < 20 && wedge.outcome == WedgeOutcome::wedge; ++i) {
        const glm::dvec3 p = point_of_penumbra(wedge, light, random);
        // p is rounded: it is within 2⁻⁵¹ of its exact place, so it may be outside by as much.
        for (const Plane& plane : wedge.planes) {
          const double h = glm::dot(plane.normal(), p) + plane.d;
          ASSERT_GT(h, -0x1p-45 * (glm::length(p) + std::abs(plane.d) + 10)) << "edge " << wedge.source;
        }
      }
    }
  }
  EXPECT_GT(proved, 1000U);
}

INSTANTIATE_TEST_SUITE_P(Cases, Wedges,
                         testing::Combine(testing::Values(Construction::original, Construction::tight),
                                          testing::ValuesIn(kCases)),
                         [](const auto& test) {
                           std::string name = std::get<1>(test.param).name;
                           std::ranges::replace_if(
                               name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
                           return (std::get<0>(test.param) == Construction::tight ? "tight_" : "original_") + name;
                         });

/// Prints how often each outcome occurs, and checks the promises of the header.
TEST(WedgeOutcomes, AsDocumented) {
  Random random(2);
  for (const Case& c : kCases) {
    std::vector<WedgeEdge> edges(300);
    for (WedgeEdge& edge : edges) edge = c.edge(random);
    for (const Construction construction : {Construction::original, Construction::tight}) {
      std::array<int, 4> counts{};
      std::size_t planes = 0;
      for (const Wedge& wedge : build_wedges(edges, kLight, construction)) {
        ++counts[static_cast<std::size_t>(wedge.outcome)];
        planes += wedge.planes.size();
      }
      printf("%-26s %-8s wedges %4d split %4d everywhere %3d empty %2d, planes a wedge %.2f\n", c.name,
             construction == Construction::tight ? "tight" : "original", counts[0], counts[1], counts[2], counts[3],
             static_cast<double>(planes) / counts[0]);
      EXPECT_TRUE(counts[1] == 0 || construction == Construction::original) << "tight never splits";
    }
  }
  const auto one = [&](const glm::dvec3& a, const glm::dvec3& b, Construction construction) {
    const WedgeEdge edge{a, b, {}};
    return build_wedges(std::span(&edge, 1), kLight, construction).front().outcome;
  };
  for (const Construction construction : {Construction::original, Construction::tight}) {
    EXPECT_EQ(one({1, 2, 3}, {1, 2, 3}, construction), WedgeOutcome::empty);
    EXPECT_EQ(one({0, 3, 0}, {0, 5, 0}, construction), WedgeOutcome::everywhere) << "crosses the light";
    EXPECT_EQ(one({1, 3, 0}, {1, 4, 0}, construction), WedgeOutcome::everywhere) << "touches its border";
    EXPECT_EQ(one({1, 4, 1}, {3, 4, 1}, construction), WedgeOutcome::everywhere) << "touches its corner";
  }
  EXPECT_EQ(one({0, 1, 0}, {0, 2, 0}, Construction::tight), WedgeOutcome::wedge) << "points at the light";
}

/// The penumbra of the edge x ∈ [−1, 1], 1 below a square light of half-size ½, is convex: at depth d it reaches to x =
/// ±(1 + (1 + ½) d), z = ±½ d.
TEST(WedgeOutcomes, TheTightWedgeOfAParallelEdgeIsItsPenumbra) {
  const WedgeEdge edge{{-1, 0, 0}, {1, 0, 0}, {}};
  const LightHull light = rectangle({0, 1, 0}, {0.5, 0, 0}, {0, 0, 0.5});
  const std::vector<Wedge> wedges = build_wedges(std::span(&edge, 1), light, Construction::tight);
  ASSERT_EQ(wedges.size(), 1U);
  EXPECT_EQ(wedges[0].planes.size(), 4U);
  const double e = 1e-9;
  for (const double depth : {0.5, 1.0, 2.0}) {
    for (const double x : {-1.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) {
        const glm::dvec3 corner(x * (1 + 1.5 * depth), -depth, z * 0.5 * depth);
        EXPECT_TRUE(is_inside(wedges[0], corner - e * glm::dvec3(x, 0, z)));
        EXPECT_FALSE(is_inside(wedges[0], corner + e * glm::dvec3(x, 0, 0)));
        EXPECT_FALSE(is_inside(wedges[0], corner + e * glm::dvec3(0, 0, z)));
      }
    }
  }
  EXPECT_FALSE(is_inside(wedges[0], {0, 0.01, 0}));
}

/// Every point inside the tight wedge is inside the original: both contain the hull, and the tight wedge equals it.
TEST(WedgeOutcomes, TightLiesInOriginal) {
  Random random(3);
  std::size_t inside = 0, more = 0;
  for (int i = 0; i < 400; ++i) {
    const WedgeEdge edge{random.point(2), random.point(2), {}};
    const Wedge tight = build_wedges(std::span(&edge, 1), kLight, Construction::tight).front();
    const Wedge original = build_wedges(std::span(&edge, 1), kLight, Construction::original).front();
    if (original.outcome != WedgeOutcome::wedge) continue;
    for (int j = 0; j < 50; ++j) {
      const glm::dvec3 p = random.point(6);
      const bool in_tight = is_inside(tight, p);
      EXPECT_TRUE(!in_tight || is_inside(original, p)) << i;
      inside += in_tight ? 1 : 0;
      more += is_inside(original, p) ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 100U);
  EXPECT_GT(more, inside);
}

}  // namespace
}  // namespace penumbra::volumes
