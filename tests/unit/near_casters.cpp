// SPDX-License-Identifier: Apache-2.0
// Tests which casters may meet the disks that some view samples see of a sphere, compared with the disks themselves.

#include "engines/vectors/disk_plane.hpp"
#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/near_casters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

namespace penumbra::vectors {
namespace {

/// Returns the disk that p sees of a sphere of radius 1 around 0: its circle is where lines from p touch the sphere.
LightCone cone_from(const glm::dvec3& p) {
  const double d = glm::length(p), radius = std::sqrt(1 - 1 / (d * d));
  const glm::dvec3 toward = -p / d, aside = std::abs(toward.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(toward, aside)), v = glm::cross(toward, u);
  return {(d - 1 / d) * toward, radius * u, radius * v};
}

struct Seen {
  std::vector<LightCone> cones;
  std::vector<GridSample> samples;
  LightGrid grid;

  explicit Seen(const std::vector<glm::vec3>& from) {
    for (const glm::vec3& p : from) {
      samples.emplace_back().p = p;
      samples.back().cone = static_cast<std::uint32_t>(cones.size());
      cones.push_back(cone_from(glm::dvec3(p)));
    }
    grid.cones = LightGrid::Cones{};
    grid.cones->of = cones;
    grid.cones->deviation = 0x1p-20F;
    grid.cones->reach = 8;
  }
  [[nodiscard]] std::set<std::size_t> found(const std::vector<NearCaster>& casters) const {
    const NearCasters all = side_by_side(casters);
    NearSpheres out;
    find_near_disks(grid, samples, all.spheres, out);
    const std::vector<double>& numbers = out.columns[NearSpheres::kNumber];
    std::set<std::size_t> result;
    for (std::size_t i = 0; i < out.count; ++i) result.insert(static_cast<std::size_t>(numbers[i]));
    return result;
  }
  [[nodiscard]] bool anyone_meets(const NearCaster& caster) const {
    return std::ranges::any_of(samples, [&](const GridSample& at) {
      const LightCone& cone = cones[at.cone];
      return meets_disk(DiskPlane(cone, glm::dvec3(at.p)), caster, slab_of(*grid.cones),
                        around_disk(*grid.cones, cone));
    });
  }
};

NearCaster small_caster(const glm::dvec3& at, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> offset(-size, size);
  NearCaster caster;
  for (glm::dvec3& corner : caster.corners) corner = at + glm::dvec3(offset(random), offset(random), offset(random));
  std::ranges::sort(caster.corners, comes_first);
  caster.middle = (caster.corners[0] + caster.corners[1] + caster.corners[2]) / 3.0;
  for (const glm::dvec3& corner : caster.corners)
    caster.radius = std::max(caster.radius, 1.001 * glm::length(corner - caster.middle));
  return caster;
}

// Two view samples, one behind the other: their disks are parallel, and 1/2 - 1/4 apart.
TEST(NearCasters, OfDisksOneBehindTheOtherBothAreMet) {
  std::mt19937 random(1);
  const std::vector<NearCaster> casters{small_caster({0, 0, 0.25}, 0.01, random),
                                        small_caster({0, 0, 0.5}, 0.01, random),
                                        small_caster({0, 0, 0.9}, 0.01, random)};
  EXPECT_EQ(Seen({{0, 0, 4}}).found(casters), (std::set<std::size_t>{0}));
  for (const std::vector<glm::vec3>& from : {std::vector<glm::vec3>{{0, 0, 4}, {0, 0, 2}}, {{0, 0, 2}, {0, 0, 4}}}) {
    EXPECT_EQ(Seen(from).found(casters), (std::set<std::size_t>{0, 1})) << "the first one at " << from[0].z;
  }
}

TEST(NearCasters, NoneThatAnyoneMeetsIsLeftOut) {
  std::size_t met = 0, left_out = 0;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto vector = [&] { return glm::dvec3(number(random), number(random), number(random)); };
    const glm::dvec3 first = glm::normalize(vector()) * (2.5 + number(random));
    std::vector<glm::vec3> from;
    for (int i = 0; i < 4; ++i) from.emplace_back(first * (1 + 0.2 * number(random)) + 0.1 * vector());
    const Seen seen(from);
    std::vector<NearCaster> casters;
    for (int i = 0; i < 100; ++i) casters.push_back(small_caster(1.5 * vector(), 0.01 + 0.05 * (i % 3), random));
    const std::set<std::size_t> found = seen.found(casters);
    for (std::size_t i = 0; i < casters.size(); ++i) {
      const bool meets = seen.anyone_meets(casters[i]);
      met += meets ? 1 : 0;
      left_out += found.contains(i) ? 0 : 1;
      EXPECT_TRUE(!meets || found.contains(i)) << "seed " << seed << ", caster " << i;
    }
  }
  EXPECT_GT(met, 500U);
  EXPECT_GT(left_out, 10'000U);
}

}  // namespace
}  // namespace penumbra::vectors
