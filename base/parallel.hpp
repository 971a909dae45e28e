// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstddef>

namespace penumbra {

/// Calls body(i) for each i below `count`, on all cores, in no order.
template <typename Body>
void for_each_index(std::size_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1024), [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
  });
}

/// Returns whether two lists are equal, comparing on all cores; equal lists are read completely.
template <typename List>
bool equal_on_all_cores(const List& a, const List& b) {
  if (a.size() != b.size()) return false;
  std::atomic<bool> equal = true;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, a.size(), 16384), [&](const tbb::blocked_range<std::size_t>& range) {
        const auto at = [&](const List& list, std::size_t i) { return list.begin() + static_cast<std::ptrdiff_t>(i); };
        if (!equal.load(std::memory_order_relaxed)) return;
        if (!std::equal(at(a, range.begin()), at(a, range.end()), at(b, range.begin()))) equal = false;
      });
  return equal;
}

}  // namespace penumbra
