// The device's facings against the exact predicate on every pair, where zeros are the rule, in real shapes, at scales
// far from one, near planes and far away.

#include "tests/agreement/support.hpp"

#include "mesh/predicates.hpp"
#include "mesh/shapes/shapes.hpp"
#include "volumes/edges/facing.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>
#include <functional>
#include <limits>
#include <random>

namespace penumbra::volumes {
namespace {

using mesh::Side;

struct Mesh {
  std::vector<glm::vec3> positions;
  std::vector<mesh::Triangle> triangles;
};

Mesh mesh_of(const mesh::TriangleSoup& soup, double scale = 1, const glm::dvec3& offset = glm::dvec3(0)) {
  Mesh mesh;
  for (const glm::dvec3& p : soup.positions) mesh.positions.emplace_back(p * scale + offset);
  mesh.triangles = soup.triangles;
  return mesh;
}

class FacingPassTest : public tests::DeviceTest {
 protected:
  using Point = std::function<glm::vec3()>;

  static std::vector<glm::vec3> many(std::size_t count, const Point& point) {
    std::vector<glm::vec3> points(count);
    for (glm::vec3& p : points) p = point();
    return points;
  }

  static Mesh soup(std::size_t triangles, const Point& point) {
    Mesh mesh;
    mesh.positions = many(3 * triangles, point);
    for (std::uint32_t i = 0; i < triangles; ++i) mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    return mesh;
  }

  /// Every pair, tile by tile. Returns the number of exact zeros.
  static std::uint64_t expect_exact(FacingPass& pass, const Mesh& mesh, const std::vector<glm::vec3>& points) {
    pass.prepare_mesh(mesh.positions, mesh.triangles);
    std::uint64_t zeros = 0;
    for (std::size_t first = 0; first < points.size();) {
      const std::size_t count = std::min<std::size_t>(pass.max_points(), points.size() - first);
      const auto tile = std::span(points).subspan(first, count);
      pass.evaluate(tile);
      zeros += expect_exact(mesh, tile, pass.read());
      first += count;
    }
    EXPECT_EQ(pass.counts().pairs, mesh.triangles.size() * points.size());
    return zeros;
  }

  static std::uint64_t expect_exact(const Mesh& mesh, std::span<const glm::vec3> points, const FacingBits& bits) {
    EXPECT_EQ(bits.triangle_count, mesh.triangles.size());
    EXPECT_EQ(bits.point_count, points.size());
    std::atomic<std::uint64_t> wrong = 0, zeros = 0;
    tbb::parallel_for(std::size_t{0}, mesh.triangles.size(), [&](std::size_t t) {
      const auto [a, b, c] = mesh.triangles[t];
      for (std::size_t j = 0; j < points.size(); ++j) {
        const Side exact = mesh::side_of_plane(mesh.positions[a], mesh.positions[b], mesh.positions[c], points[j]);
        zeros += exact == Side::on ? 1 : 0;
        const Side side = bits.side(static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(j));
        const std::size_t word = t / 32 * points.size() + j;
        const bool undecided = ((bits.front[word] & bits.back[word]) >> (t % 32) & 1U) != 0;
        if ((side == exact && !undecided) || wrong++ != 0) continue;
        ADD_FAILURE() << fmt::format("triangle {} {} {} {} from {}: device {}, exact {}", t,
                                     tests::text_of(mesh.positions[a]), tests::text_of(mesh.positions[b]),
                                     tests::text_of(mesh.positions[c]), tests::text_of(points[j]),
                                     static_cast<int>(side), static_cast<int>(exact));
      }
    });
    EXPECT_EQ(wrong, 0u) << "of " << mesh.triangles.size() * points.size();
    for (std::size_t j = 0; j < points.size() && mesh.triangles.size() % 32 != 0; ++j) {
      const std::size_t word = mesh.triangles.size() / 32 * points.size() + j;
      const std::uint32_t beyond = ~0U << (mesh.triangles.size() % 32);
      EXPECT_EQ((bits.front[word] | bits.back[word]) & beyond, 0u) << "bits beyond the last triangle";
    }
    return zeros;
  }

  std::mt19937 random_{11};
  int number(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
  glm::vec3 lattice(int reach) {
    return glm::vec3(number(-reach, reach), number(-reach, reach), number(-reach, reach));
  }
  glm::vec3 in_cube(float half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
};

TEST_F(FacingPassTest, LatticeSoupWhereZerosAreTheRule) {
  FacingPass pass(device());
  for (const int reach : {1, 2, 5}) {
    const Mesh mesh = soup(333, [&] { return lattice(reach); });
    const auto points = many(700, [&] { return lattice(reach + 1); });
    EXPECT_GT(expect_exact(pass, mesh, points), 2000u);
    EXPECT_GT(pass.counts().undecided, 0u);
  }
}

TEST_F(FacingPassTest, TiesOnAxisAlignedPlanesNeedNoHost) {
  // A lattice of level and upright squares, and one of points: nothing but exact products and exact zeros.
  const mesh::TriangleSoup floor = mesh::make_grid({.cells_u = 8, .cells_v = 8});
  const mesh::TriangleSoup box = mesh::make_box({0, 0, 0}, {1, 0.5, 0.25});
  for (const mesh::TriangleSoup& shape : {floor, box}) {
    FacingPass pass(device());
    const Mesh mesh = mesh_of(shape);
    const auto points = many(500, [&] { return 0.25F * lattice(5); });
    EXPECT_GT(expect_exact(pass, mesh, points), 500u);
    EXPECT_EQ(pass.counts().undecided, 0u);
  }
}

TEST_F(FacingPassTest, RealShapes) {
  for (const mesh::TriangleSoup& shape :
       {mesh::make_sphere({.segments = 48, .rings = 24}), mesh::make_blob({.subdivisions = 3}), mesh::make_torus({}),
        mesh::make_room({})}) {
    FacingPass pass(device());
    const Mesh mesh = mesh_of(shape);
    std::vector<glm::vec3> points = many(300, [&] { return in_cube(3); });
    for (int i = 0; i < 300; ++i) {  // on the surface: on, or nearly on, a triangle's own plane
      const auto [a, b, c] =
          mesh.triangles[static_cast<std::size_t>(number(0, static_cast<int>(mesh.triangles.size()) - 1))];
      const float s = between(0, 1), t = between(0, 1 - s);
      points.push_back((1 - s - t) * mesh.positions[a] + s * mesh.positions[b] + t * mesh.positions[c]);
    }
    expect_exact(pass, mesh, points);
    EXPECT_LT(pass.counts().undecided, pass.counts().pairs / 100);
  }
}

TEST_F(FacingPassTest, HugeAndTinyScales) {
  const mesh::TriangleSoup blob = mesh::make_blob({.subdivisions = 2});
  for (const double scale : {1e-44, 1e-40, 1e-38, 1e-37, 1e-30, 1e-20, 1e-10, 1e5, 1e15, 1e30, 1e38}) {
    SCOPED_TRACE(scale);
    FacingPass pass(device());
    const Mesh mesh = mesh_of(blob, scale);
    const auto points = many(300, [&] { return glm::vec3(glm::dvec3(in_cube(2)) * scale); });
    expect_exact(pass, mesh, points);
    if (scale > 1e-37) {
      EXPECT_LT(pass.counts().undecided, pass.counts().pairs / 1000);
    }
  }
}

TEST_F(FacingPassTest, ScalesMixedInOneMesh) {
  // Magnitudes from the least subnormal to the largest float side by side, corners, points and edges alike.
  const std::array<float, 14> values = {0,       -0.0F, 1,      -1,       1.5F,      1 + 0x1p-23F, 1e-20F,
                                        -1e-20F, 1e15F, -1e15F, 0x1p-80F, 0x1p-126F, 0x1p-149F,    3e38F};
  for (const std::size_t most : {7U, 9U, 13U, 14U}) {
    FacingPass pass(device());
    const auto value = [&] { return values[static_cast<std::size_t>(number(0, static_cast<int>(most) - 1))]; };
    const auto point = [&] { return glm::vec3(value(), value(), value()); };
    expect_exact(pass, soup(300, point), many(400, point));
  }
}

TEST_F(FacingPassTest, NearlyCoplanar) {
  // Triangles of one tilted plane and points on it, each coordinate rounded or pushed by an ulp: most are undecided.
  const auto near_plane = [&] {
    const float x = between(-1, 1), y = between(-1, 1);
    float z = 0.3F * x - 0.7F * y;
    const int steps = number(-1, 1);
    if (steps != 0) z = std::nextafter(z, static_cast<float>(steps) * std::numeric_limits<float>::infinity());
    return glm::vec3(x, y, z);
  };
  FacingPass pass(device());
  expect_exact(pass, soup(200, near_plane), many(600, near_plane));
  EXPECT_GT(pass.counts().undecided, pass.counts().pairs / 2);
  // Needles, and slivers whose normals are nothing but rounding.
  const auto near_line = [&] {
    const float t = between(-1, 1);
    return glm::vec3(t, std::nextafter(3 * t, between(-9, 9)), std::nextafter(5 * t, between(-9, 9)));
  };
  expect_exact(pass, soup(200, near_line), many(600, [&] { return number(0, 1) == 0 ? near_line() : in_cube(5); }));
}

TEST_F(FacingPassTest, PointsBeyondAllFloats) {
  FacingPass pass(device());
  const Mesh mesh = mesh_of(mesh::make_sphere({.segments = 12, .rings = 6}), 1e-30);
  const auto points = many(200, [&] { return std::ldexp(1.0F, number(-149, 120)) * in_cube(1); });
  expect_exact(pass, mesh, points);
  EXPECT_GT(pass.counts().undecided, 0u);
}

TEST_F(FacingPassTest, SmallBuffersAndShortListsChangeNothing) {
  const Mesh mesh = soup(500, [&] { return lattice(2); });
  const auto points = many(300, [&] { return lattice(3); });
  FacingPass large(device());
  expect_exact(large, mesh, points);
  EXPECT_EQ(large.counts().list_retries, 0u);
  FacingPass small(device(), {.most_bytes = 5000, .first_list = 1});
  expect_exact(small, mesh, points);
  EXPECT_LT(small.max_points(), 30u) << "several tiles, and four triangle buffers each";
  EXPECT_GT(small.counts().list_retries, 0u);
  EXPECT_EQ(small.counts().undecided, large.counts().undecided);
}

TEST_F(FacingPassTest, AListThatIsJustLongEnoughIsNotRetried) {
  // One tilted triangle 32 times, and points on its plane: a word a point, each undecided.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 1}, {0, 1, 2}};
  mesh.triangles.assign(32, {0, 1, 2});
  const auto points = many(77, [&] {
    const float x = static_cast<float>(number(-50, 50)), y = static_cast<float>(number(1, 50));
    return glm::vec3(x, y, x + 2 * y);
  });
  for (const std::uint32_t capacity : {77U, 76U}) {
    FacingPass pass(device(), {.most_bytes = 0, .first_list = capacity});
    EXPECT_EQ(expect_exact(pass, mesh, points), 32u * 77);
    EXPECT_EQ(pass.counts().undecided, 32u * 77);
    EXPECT_EQ(pass.counts().list_retries, 77 - capacity);
  }
}

TEST_F(FacingPassTest, NothingToDo) {
  FacingPass pass(device());
  pass.prepare_mesh({}, {});
  pass.evaluate(std::vector<glm::vec3>{{1, 2, 3}});
  EXPECT_TRUE(pass.read().front.empty());
  const Mesh mesh = soup(40, [&] { return lattice(2); });
  pass.prepare_mesh(mesh.positions, mesh.triangles);
  pass.evaluate({});
  EXPECT_TRUE(pass.read().back.empty());
  EXPECT_EQ(pass.counts().pairs, 0u);
  FacingPass tiny(device(), {.most_bytes = 1200});
  const Mesh many_triangles = soup(4000, [&] { return lattice(2); });
  tiny.prepare_mesh(many_triangles.positions, many_triangles.triangles);
  EXPECT_THROW((void)tiny.max_points(), ResourceError);
}

TEST_F(FacingPassTest, FullMillionsOfPairs) {
  // The figures in volumes/README.md.
  for (const auto& [name, shape] : {std::pair{"blob, 82k triangles", mesh::make_blob({.subdivisions = 6})},
                                    std::pair{"terrain, 80k triangles", mesh::make_terrain({.cells = {200, 200}})}}) {
    const Mesh mesh = mesh_of(shape);
    std::vector<glm::vec3> points = many(1024, [&] { return in_cube(4); });
    for (int i = 0; i < 1024; ++i) {
      const auto [a, b, c] =
          mesh.triangles[static_cast<std::size_t>(number(0, static_cast<int>(mesh.triangles.size()) - 1))];
      points.push_back(0.5F * mesh.positions[a] + 0.25F * mesh.positions[b] + 0.25F * mesh.positions[c]);
    }
    FacingPass pass(device());
    pass.prepare_mesh(mesh.positions, mesh.triangles);
    pass.evaluate(std::span(points).first(1));  // warm up
    pass.prepare_mesh(mesh.positions, mesh.triangles);
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t cpu_start = std::clock();
    pass.evaluate(points);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    const FacingCounts counts = pass.counts();
    const double millions = static_cast<double>(counts.pairs) / 1e6;
    fmt::print("{}: {:.0f} M pairs, {:.0f} M/s ({:.0f} M a second of this process's processor time), {} undecided\n",
               name, millions, millions / seconds, millions / cpu_seconds, counts.undecided);
    expect_exact(mesh, points, pass.read());
  }
}

}  // namespace
}  // namespace penumbra::volumes
