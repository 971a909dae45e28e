// SPDX-License-Identifier: Apache-2.0
// Tests the parts from which trees are built: groups of neighbouring boxes, and halves of the last few dozen boxes.

#include "visibility/tree/box_groups.hpp"

#include "visibility/tree/halves.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

namespace penumbra::visibility {
namespace {

/// Small cubes at random places of a lattice, some of them at the same place.
std::vector<NumberedBox> cubes(std::uint32_t count, int cells) {
  std::mt19937 random(count);
  std::uniform_int_distribution<int> place(0, cells);
  std::vector<NumberedBox> boxes;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 at(place(random), place(random), place(random));
    boxes.push_back({at, i, at + 1.0F, 0});
  }
  return boxes;
}

GroupedBoxes grouped(const std::vector<NumberedBox>& boxes) {
  return group_boxes(boxes.size(), [&](std::size_t i) { return boxes[i]; });
}

bool holds(const BoxGroup& group, const NumberedBox& box) {
  return glm::min(group.lower, box.lower) == group.lower && glm::max(group.upper, box.upper) == group.upper;
}

TEST(BoxGroups, HoldEveryBoxOnceInGroupsThatFollowOneAnother) {
  for (const std::uint32_t count : {1U, 16U, 17U, 1000U, 40000U}) {
    for (const int cells : {0, 3, 200}) {
      const std::vector<NumberedBox> boxes = cubes(count, cells);
      const GroupedBoxes made = grouped(boxes);
      std::vector<int> seen(count);
      std::vector<BoxGroup> groups = made.groups;
      std::ranges::sort(groups, {}, &BoxGroup::first);
      std::uint32_t next = 0;
      for (const BoxGroup& group : groups) {
        EXPECT_EQ(group.first, next);
        next += group.count;
        for (std::uint32_t i = group.first; i < next; ++i) {
          const NumberedBox& box = made.boxes[i];
          ++seen[box.number];
          EXPECT_EQ(box.lower, boxes[box.number].lower);
          EXPECT_TRUE(holds(group, box));
        }
        EXPECT_LE(group.count, kGroup)
            << "boxes in 200 cells need no cell to be halved, and boxes at one place must be divided, too";
      }
      EXPECT_EQ(next, count);
      EXPECT_EQ(std::ranges::count(seen, 1), count);
    }
  }
}

TEST(BoxGroups, AreCompactAndNotMuchSmallerThanTheyMayBe) {
  const std::vector<NumberedBox> boxes = cubes(40000, 200);  // one cube per 200 places
  const GroupedBoxes made = grouped(boxes);
  EXPECT_LT(made.groups.size(), 40000 / 5U);
  for (const BoxGroup& group : made.groups) {
    const glm::vec3 size = group.upper - group.lower;
    // A group has at most sixteen boxes, from a cell that is halved if it has more: 8 · 16 · 200 places are a cube of
    // side 30. A cell may be four times as long as wide, and chance adds some.
    EXPECT_LT(std::max({size.x, size.y, size.z}), 110);
  }
}

TEST(BoxGroups, LeaveABoxAloneThatAloneWouldMakeItsGroupLarge) {
  std::vector<NumberedBox> boxes = cubes(1000, 9);
  const glm::vec3 middle = 0.5F * boxes[500].lower + 0.5F * boxes[500].upper;
  boxes[500].lower = middle - 400.0F;
  boxes[500].upper = middle + 400.0F;
  const GroupedBoxes made = grouped(boxes);
  const auto large = std::ranges::find_if(made.groups, [](const BoxGroup& g) { return g.upper.x - g.lower.x > 100; });
  ASSERT_NE(large, made.groups.end());
  EXPECT_EQ(large->count, 1U);
  EXPECT_EQ(made.boxes[large->first].number, 500U);
  EXPECT_EQ(std::ranges::count_if(made.groups, [](const BoxGroup& g) { return g.upper.x - g.lower.x > 100; }), 1);
}

TEST(BoxGroups, OfOneCellAreGroupedAgainByAGridOfTheirOwn) {
  std::vector<NumberedBox> boxes = cubes(300, 20);
  for (NumberedBox& box : boxes) box.lower *= 0x1p-20F, box.upper *= 0x1p-20F;
  boxes.push_back({glm::vec3(1000), 300, glm::vec3(1001), 0});
  GroupedBoxes made = grouped(boxes);
  ASSERT_EQ(made.groups.size(), 2U) << "all but one are in one cell";
  const BoxGroup& dense = made.groups[made.groups[0].count == 300 ? 0 : 1];
  ASSERT_EQ(dense.count, 300U);
  const std::span<NumberedBox> inside(made.boxes.get() + dense.first, dense.count);
  const std::vector<BoxGroup> again = group_again(inside);
  EXPECT_GE(again.size(), 300 / kGroup);
  std::set<std::uint32_t> numbers;
  for (const BoxGroup& group : again) {
    for (const NumberedBox& box : inside.subspan(group.first, group.count)) {
      EXPECT_TRUE(holds(group, box));
      numbers.insert(box.number);
    }
  }
  EXPECT_EQ(numbers.size(), 300U);
}

TEST(Halves, HaveTheLeastFirstAlongTheLongestSide) {
  std::mt19937 random(7);
  for (const std::size_t count : {9U, 16U, 17U, 33U, 40U, 64U, 65U, 150U}) {
    std::uniform_int_distribution<int> place(0, static_cast<int>(count) / 2);  // some are equal
    std::vector<Divided> items;
    for (std::uint32_t i = 0; i < count; ++i)
      items.push_back({glm::vec3(0.25F * static_cast<float>(i % 5), static_cast<float>(place(random)), 0), i});
    std::vector<std::uint32_t> sizes, seen;
    float highest = -1;
    const std::size_t first = (count + 7) / 8 / 2 * 8;
    halve(std::span(items), 8, [&](std::span<const Divided> part) {
      sizes.push_back(static_cast<std::uint32_t>(part.size()));
      for (const Divided& item : part) {
        if (seen.size() < first) highest = std::max(highest, item.middle.y);
        EXPECT_TRUE(seen.size() < first || item.middle.y >= highest) << "of " << count;
        seen.push_back(item.at);
      }
    });
    for (std::size_t i = 0; i + 1 < sizes.size(); ++i) EXPECT_EQ(sizes[i], 8U) << "all but the last are full";
    std::ranges::sort(seen);
    std::vector<std::uint32_t> all(count);
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_EQ(seen, all);
  }
}

TEST(Halves, OfOnePlaceKeepTheirOrder) {
  std::vector<Divided> items;
  for (std::uint32_t i = 0; i < 40; ++i) items.push_back({glm::vec3(3), i});
  std::vector<std::uint32_t> seen;
  halve(std::span(items), 8, [&](std::span<const Divided> part) {
    for (const Divided& item : part) seen.push_back(item.at);
  });
  EXPECT_TRUE(std::ranges::is_sorted(seen));
}

}  // namespace
}  // namespace penumbra::visibility
