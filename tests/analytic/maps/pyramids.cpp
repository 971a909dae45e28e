// SPDX-License-Identifier: Apache-2.0
// Tests pyramids of smallest and largest depths: those that the device builds against brute force, which cells a query
// covers, and how many nodes a walk visits (Yang et al. 2009, section 4.2).

#include "base/error.hpp"
#include "maps/products/depth_pyramid.hpp"
#include "selftest/map_checks.hpp"
#include "tests/analytic/maps/fixture.hpp"
#include "tests/unit/passed.hpp"

#include <algorithm>
#include <random>
#include <set>

namespace penumbra::tests {
namespace {

using maps::PyramidKind;
using maps::gpu::PyramidHeader;

constexpr std::uint64_t kPlenty = std::uint64_t{1} << 40;
constexpr std::array kKinds{PyramidKind::hsm, PyramidKind::ysm, PyramidKind::mssm};

class MapsPyramids : public MapsTest {};

TEST_F(MapsPyramids, EachNodeHasTheRangeOfItsTexels) {
  std::mt19937 random(15);
  for (const PyramidKind kind : kKinds) {
    for (const auto& [size, faces] : {std::pair(8U, 1U), std::pair(33U, 5U), std::pair(13U, 2U), std::pair(64U, 1U)}) {
      std::vector<float> depths(std::size_t{size} * size * faces);
      for (float& depth : depths) depth = random() % 8 == 0 ? 1.0F : static_cast<float>(random() % 1000) / 1000;
      expect_passed(selftest::check_depth_pyramid(device(), kind, depths, size, faces));
    }
  }
}

/// The cells that a query's nodes cover (first and last column and row), and the number of nodes.
struct Covered {
  glm::uvec2 lower, upper;
  std::uint32_t fetches;
};
Covered covered(const PyramidHeader& header, const glm::uvec2& lower, const glm::uvec2& upper) {
  const maps::gpu::PyramidQuery query = maps::gpu::pyramid_query(lower, upper, header.whole, header.top);
  EXPECT_LE(query.level, header.top);
  EXPECT_EQ(query.shift, std::min(query.level, header.whole));
  Covered result{};
  std::uint32_t count[2] = {0, 0};
  for (int axis = 0; axis < 2; ++axis) {
    std::uint32_t next = query.from[axis];  // the first node of the level that is not covered yet
    for (std::uint32_t at = query.from[axis];; at = std::min(at + query.step, query.to[axis] + 1 - query.step)) {
      EXPECT_LE(at, next) << "no gap";
      next = at + query.step;
      ++count[axis];
      if (at + query.step > query.to[axis]) break;
    }
    result.lower[axis] = query.from[axis] << query.shift;
    result.upper[axis] = (next << query.shift) - 1;
    EXPECT_LE(result.lower[axis], lower[axis]);
    EXPECT_GE(result.upper[axis], upper[axis]);
  }
  result.fetches = count[0] * count[1];
  return result;
}

// Schwarz and Stamminger 2008: a query to an HSM covers more cells than one to a YSM, and that more than one to an
// MSSM, which covers exactly the requested cells.
TEST_F(MapsPyramids, QuestionsCoverTheirCellsTighterInRicherPyramids) {
  constexpr std::uint32_t kSize = 36;
  std::array<PyramidHeader, 3> headers;
  std::ranges::transform(kKinds, headers.begin(),
                         [](PyramidKind kind) { return maps::pyramid_header(kind, kSize, 1, kPlenty); });
  for (std::uint32_t x0 = 0; x0 <= kSize; ++x0) {
    for (std::uint32_t x1 = x0; x1 <= kSize; ++x1) {
      for (const auto& [y0, y1] : {std::pair(3U, 10U), std::pair(x0, x1), std::pair(15U, 16U), std::pair(0U, kSize)}) {
        const glm::uvec2 lower(x0, y0), upper(x1, y1);
        const Covered hsm = covered(headers[0], lower, upper), ysm = covered(headers[1], lower, upper),
                      mssm = covered(headers[2], lower, upper);
        EXPECT_EQ(mssm.lower, lower);
        EXPECT_EQ(mssm.upper, upper);
        EXPECT_TRUE(ysm.lower.x >= hsm.lower.x && ysm.lower.y >= hsm.lower.y);
        EXPECT_TRUE(ysm.upper.x <= hsm.upper.x && ysm.upper.y <= hsm.upper.y);
        EXPECT_LE(hsm.fetches, 4U);
        PyramidHeader low = headers[2];  // without its upper levels
        low.top = 1;
        EXPECT_EQ(covered(low, lower, upper).upper, upper);
        if (x1 - x0 == y1 - y0) {
          EXPECT_LE(mssm.fetches, 4U);
          EXPECT_LE(ysm.fetches, 4U);
        }
      }
    }
  }
}

struct Visits {
  std::uint32_t above_leaves = 0, leaves = 0, beside = 0;  // beside: visited children that hold no requested cell
};
/// Walks below nodes of this level, and descends into every node that holds a requested cell.
Visits walk(const PyramidHeader& header, const glm::uvec2& lower, const glm::uvec2& upper, std::uint32_t level,
            std::set<std::pair<std::uint32_t, std::uint32_t>>* cells = nullptr) {
  Visits visits;
  const std::uint32_t shift = std::min(level, header.whole), width = 1U << level;
  const glm::uvec2 first((lower.x >> shift) << shift, (lower.y >> shift) << shift);
  for (std::uint32_t y = first.y; y <= upper.y; y += width) {
    for (std::uint32_t x = first.x; x <= upper.x; x += width) {
      for (auto at = maps::gpu::pyramid_walk({x, y}, level); !at.done;) {
        const std::uint32_t reach = (1U << at.level) - 1;
        const bool holds =
            at.at.x <= upper.x && at.at.y <= upper.y && at.at.x + reach >= lower.x && at.at.y + reach >= lower.y;
        (at.level > 0 ? visits.above_leaves : visits.leaves) += 1;
        visits.beside += holds ? 0 : 1;
        if (holds && at.level == 0 && cells != nullptr) {
          EXPECT_TRUE(cells->emplace(at.at.x, at.at.y).second) << "no cell twice";
        }
        at = holds && at.level > 0 ? maps::gpu::pyramid_down(at) : maps::gpu::pyramid_past(at);
      }
    }
  }
  return visits;
}

// Yang 2009, 4.2: for an 8 × 8 kernel of which nothing is skipped, an MSSM visits 1 + 2² + 4² = 21 nodes above the
// leaves, wherever the kernel is. The paper gives 21 … 57 for an HSM: that holds from one node above the four that
// cover the kernel. From the single node of the tree that covers it, a kernel across a border of large nodes takes up
// to 89.
TEST_F(MapsPyramids, NodesAboveTheLeavesOfAnEightByEightKernel) {
  constexpr std::uint32_t kSize = 127;
  const PyramidHeader hsm = maps::pyramid_header(PyramidKind::hsm, kSize, 1, kPlenty),
                      mssm = maps::pyramid_header(PyramidKind::mssm, kSize, 1, kPlenty);
  std::uint32_t least_from_four = 1000, most_from_four = 0, least_from_one = 1000, most_from_one = 0;
  for (std::uint32_t y = 0; y < 32; ++y) {
    for (std::uint32_t x = 0; x < 32; ++x) {
      const glm::uvec2 lower(x, y), upper = lower + 7U;
      const Visits whole = walk(mssm, lower, upper, maps::gpu::pyramid_root_level(lower, upper, mssm.whole, mssm.top));
      ASSERT_EQ(whole.above_leaves, 21U) << x << ", " << y;
      ASSERT_EQ(whole.leaves, 64U);
      ASSERT_EQ(whole.beside, 0U);
      const std::uint32_t covering = maps::gpu::pyramid_root_level(lower, upper, hsm.whole, hsm.top);
      const std::uint32_t one = walk(hsm, lower, upper, covering).above_leaves;
      least_from_one = std::min(least_from_one, one);
      most_from_one = std::max(most_from_one, one);
      // The finest level at which four nodes cover the kernel, and one node above them if they are more than one.
      const std::uint32_t four = maps::gpu::pyramid_query(lower, upper, hsm.whole, hsm.top).level;
      const std::uint32_t count = four == covering ? one : 1 + walk(hsm, lower, upper, four).above_leaves;
      least_from_four = std::min(least_from_four, count);
      most_from_four = std::max(most_from_four, count);
    }
  }
  EXPECT_EQ(least_from_four, 21U);
  EXPECT_EQ(most_from_four, 57U);
  EXPECT_EQ(least_from_one, 21U);
  EXPECT_EQ(most_from_one, 89U);
  RecordProperty("most nodes of an HSM from one covering node", static_cast<int>(most_from_one));
}

TEST_F(MapsPyramids, AWalkFindsEachCellOfAnyRectangleOnceFromOneRootOrMany) {
  constexpr std::uint32_t kSize = 40;
  for (const PyramidKind kind : kKinds) {
    for (const std::uint32_t most_top : {99U, 2U}) {  // with all levels, and without the upper ones
      PyramidHeader header = maps::pyramid_header(kind, kSize, 1, kPlenty);
      header.top = std::max(std::min(header.top, most_top), header.whole);
      for (const auto& [x0, y0, x1, y1] :
           {std::tuple(0U, 0U, 40U, 40U), std::tuple(3U, 5U, 17U, 6U), std::tuple(39U, 1U, 40U, 33U),
            std::tuple(7U, 7U, 7U, 7U), std::tuple(15U, 16U, 16U, 31U)}) {
        const glm::uvec2 lower(x0, y0), upper(x1, y1);
        std::set<std::pair<std::uint32_t, std::uint32_t>> cells;
        walk(header, lower, upper, maps::gpu::pyramid_root_level(lower, upper, header.whole, header.top), &cells);
        EXPECT_EQ(cells.size(), std::size_t{x1 - x0 + 1} * (y1 - y0 + 1));
      }
    }
  }
}

// Schwarz and Stamminger 2007: an HSM takes 4/3 of the map's ranges, an MSSM one range per texel and level.
TEST_F(MapsPyramids, BytesAreThoseOfTheStructureAndFinestNodesGiveWay) {
  constexpr double kMega = 1 << 20;
  const auto bytes = [](PyramidKind kind) {
    return static_cast<double>(maps::pyramid_bytes(maps::pyramid_header(kind, 1024, 1, kPlenty), 1));
  };
  // There is one more cell than texels on each side: 2/1024 more cells in all, and in a quadtree one more node at each
  // level's border.
  EXPECT_NEAR(bytes(PyramidKind::hsm), 4.0 / 3 * 8 * kMega, 0.01 * 11 * kMega);
  EXPECT_NEAR(bytes(PyramidKind::mssm), 11 * 8 * kMega, 0.003 * 88 * kMega);
  EXPECT_LT(bytes(PyramidKind::ysm), 2 * bytes(PyramidKind::hsm));
  const PyramidHeader fewer = maps::pyramid_header(PyramidKind::mssm, 1024, 5, std::uint64_t{128} << 20);
  EXPECT_EQ(fewer.whole, 2U) << "from the first level on, 147 MB";
  const Covered all = covered(fewer, glm::uvec2(0), glm::uvec2(1024));
  EXPECT_LE(all.fetches, 4U) << "upper levels are there: some drivers end loops after 65,535 turns";
  try {
    maps::pyramid_header(PyramidKind::mssm, 4096, 2, std::uint64_t{128} << 20);
    ADD_FAILURE() << "two maps of 4096² are 358 MB";
  } catch (const ResourceError& error) {
    const std::string message = error.what();
    const std::size_t at = message.rfind("size=");
    ASSERT_NE(at, std::string::npos) << message;
    const auto size = static_cast<std::uint32_t>(std::stoul(message.substr(at + 5)));
    EXPECT_NO_THROW(maps::pyramid_header(PyramidKind::mssm, size, 2, std::uint64_t{128} << 20));
    EXPECT_THROW(maps::pyramid_header(PyramidKind::mssm, size + 1, 2, std::uint64_t{128} << 20), ResourceError);
  }
}

}  // namespace
}  // namespace penumbra::tests
