// SPDX-License-Identifier: Apache-2.0
// Groups boxes by Morton order: C. Lauterbach, M. Garland, S. Sengupta, D. Luebke, D. Manocha, Fast BVH construction on
// GPUs, 2009; groups as the items that the surface area heuristic divides: J. Pantaleoni, D. Luebke, HLBVH, 2010. In
// those papers all cells have one size; here they are as large as their boxes allow, and dense ones get their own grid.

#include "visibility/tree/box_groups.hpp"

#include "base/buckets.hpp"
#include "base/parallel.hpp"
#include "visibility/tree/box_around.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace penumbra::visibility {
namespace {

constexpr unsigned kAxisBits = 10, kWordBits = 3 * kAxisBits;

/// Inserts two zeros after each bit.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16U) & 0x030000ffU;
  bits = (bits | bits << 8U) & 0x0300f00fU;
  bits = (bits | bits << 4U) & 0x030c30c3U;
  return (bits | bits << 2U) & 0x09249249U;
}

/// Cubic cells, as many along the longest side as the word has values.
class Grid {
 public:
  explicit Grid(const BoxAround& middles) : lower_(middles.lower()) {
    const glm::dvec3 size = glm::dvec3(middles.upper()) - lower_;
    const double longest = std::max({size.x, size.y, size.z});
    cells_ = longest > 0 ? kCells / longest : 0;
  }
  [[nodiscard]] std::uint32_t word_of(const glm::vec3& middle) const {
    const auto cell = [&](int axis) {
      return spread(static_cast<std::uint32_t>(std::min((middle[axis] - lower_[axis]) * cells_, kCells - 1)));
    };
    return cell(0) << 2U | cell(1) << 1U | cell(2);
  }

 private:
  static constexpr double kCells = 1U << kAxisBits;
  glm::dvec3 lower_;
  double cells_ = 0;  // cells in a unit of length; 0: all middles are equal
};

/// Radix sort by word, stable.
void sort_by_word(std::span<Parts::Item> items, unsigned bits, std::vector<Parts::Item>& space) {
  constexpr std::size_t kFew = 48;
  if (items.size() <= kFew) {
    std::sort(items.begin(), items.end(), [](const Parts::Item& a, const Parts::Item& b) {
      return std::pair(a.word, a.number) < std::pair(b.word, b.number);
    });
    return;
  }
  constexpr unsigned kDigit = 8;
  space.resize(items.size());
  std::span<Parts::Item> from = items, to = space;
  for (unsigned shift = 0; shift < bits; shift += kDigit) {
    std::array<std::uint32_t, std::size_t{1} << kDigit> places{};
    const auto digit = [&](const Parts::Item& item) { return item.word >> shift & (places.size() - 1); };
    for (const Parts::Item& item : from) ++places[digit(item)];
    std::uint32_t sum = 0;
    for (std::uint32_t& place : places) sum += std::exchange(place, sum);
    for (const Parts::Item& item : from) to[places[digit(item)]++] = item;
    std::swap(from, to);
  }
  if (from.data() != items.data()) std::ranges::copy(from, items.begin());
}

/// Makes groups of boxes that are sorted by their words.
class Cutter {
 public:
  /// `first`: index of the first box in the list.
  Cutter(std::span<NumberedBox> list, std::vector<BoxGroup>& groups) : list_(list), groups_(groups) {}

  /// Groups the boxes from `first` on, which have these words; the words agree above `bit`.
  void cut(std::uint32_t first, std::span<const Parts::Item> words, unsigned bit) {
    if (words.size() <= kGroup) return add(first, static_cast<std::uint32_t>(words.size()));
    if (bit == 0) return add_close(first, static_cast<std::uint32_t>(words.size()));
    const auto upper = std::ranges::partition_point(
        words, [&](const Parts::Item& item) { return (item.word >> (bit - 1) & 1U) == 0; });
    const auto count = static_cast<std::size_t>(upper - words.begin());
    if (count > 0) cut(first, words.first(count), bit - 1);
    if (count < words.size()) cut(first + static_cast<std::uint32_t>(count), words.subspan(count), bit - 1);
  }

 private:
  /// Groups the boxes of one cell: by a finer grid, or, if all middles are equal, in their order.
  void add_close(std::uint32_t first, std::uint32_t count) {
    const std::span<const NumberedBox> boxes = list_.subspan(first, count);
    const glm::vec3 middle = boxes.front().middle();
    if (!std::ranges::all_of(boxes, [&](const NumberedBox& box) { return box.middle() == middle; }))
      return add_group(first, count);
    for (std::uint32_t i = 0; i < count; i += kGroup) add(first + i, std::min(count - i, kGroup));
  }

  void add(std::uint32_t first, std::uint32_t count) {
    // A single box that makes the group large is moved to the end and out of it.
    for (; count > 1; --count) {
      const std::span<NumberedBox> boxes = list_.subspan(first, count);
      BoxAround all;
      double largest_area = -1;
      std::size_t largest = 0;
      for (std::size_t i = 0; i < count; ++i) {
        all.include(boxes[i]);
        BoxAround one;
        one.include(boxes[i]);
        const double area = one.area();
        if (area > largest_area) largest_area = area, largest = i;
      }
      if (!(largest_area > 0.25 * all.area())) break;
      BoxAround others;
      for (std::size_t i = 0; i < count; ++i) {
        if (i != largest) others.include(boxes[i]);
      }
      if (!(others.area() < 0.5 * all.area())) break;
      std::swap(boxes[largest], boxes[count - 1]);
      add_group(first + count - 1, 1);
    }
    add_group(first, count);
  }

  void add_group(std::uint32_t first, std::uint32_t count) {
    BoxAround all;
    for (const NumberedBox& box : list_.subspan(first, count)) all.include(box);
    groups_.push_back({all.lower(), first, all.upper(), count});
  }

  std::span<NumberedBox> list_;
  std::vector<BoxGroup>& groups_;
};

BoxAround joined(BoxAround a, const BoxAround& b) {
  a.include(b);
  return a;
}

/// Writes boxes to `to`, in the order of groups. `middles`: bounds of their middles.
std::vector<BoxGroup> group(std::span<const NumberedBox> from, const BoxAround& middles, std::span<NumberedBox> to) {
  const Grid grid(middles);
  const std::size_t good = Parts::good_count(from.size());
  // bits in which words of a part differ
  const unsigned bits = kWordBits - static_cast<unsigned>(std::countr_zero(good));
  const Parts parts =
      into_parts(from.size(), good, bits, [&](std::size_t i) { return grid.word_of(from[i].middle()); });
  std::vector<std::vector<BoxGroup>> groups(parts.size());
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    const std::uint32_t first = parts.first[part];
    const std::span<Parts::Item> items(parts.items.get() + first, parts[part].size());
    std::vector<Parts::Item> space;
    sort_by_word(items, bits, space);
    for (std::size_t i = 0; i < items.size(); ++i) to[first + i] = from[items[i].number];
    groups[part].reserve(items.size() / (kGroup / 2));
    if (!items.empty()) Cutter(to, groups[part]).cut(first, items, bits);
  });
  std::size_t sum = 0;
  for (const auto& some : groups) sum += some.size();
  std::vector<BoxGroup> all;
  all.reserve(sum);
  for (const auto& some : groups) all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace

GroupedBoxes group_boxes(std::size_t count, const std::function<NumberedBox(std::size_t)>& box) {
  const auto boxes = std::make_unique_for_overwrite<NumberedBox[]>(count);
  const BoxAround middles = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, 4096), BoxAround(),
      [&](const tbb::blocked_range<std::size_t>& range, BoxAround extent) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          boxes[i] = box(i);
          extent.include(boxes[i].middle());
        }
        return extent;
      },
      joined);
  GroupedBoxes made;
  made.boxes = std::make_unique_for_overwrite<NumberedBox[]>(count);
  made.groups = group({boxes.get(), count}, middles, {made.boxes.get(), count});
  return made;
}

std::vector<BoxGroup> group_again(std::span<NumberedBox> boxes) {
  const std::vector<NumberedBox> from(boxes.begin(), boxes.end());
  BoxAround middles;
  for (const NumberedBox& box : from) middles.include(box.middle());
  return group(from, middles, boxes);
}

}  // namespace penumbra::visibility
