#pragma once

#include "base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra {

/// Numbers of elements, sorted into buckets; each bucket ascending.
struct Buckets {
  std::vector<std::uint32_t> first;  ///< one a bucket and one past the last's end
  std::vector<std::uint32_t> items;

  [[nodiscard]] std::size_t size() const { return first.size() - 1; }
  [[nodiscard]] std::span<std::uint32_t> operator[](std::size_t bucket) {
    return std::span(items).subspan(first[bucket], first[bucket + 1] - first[bucket]);
  }
};

/// Sorts 0 … count − 1 by bucket_of(i) < buckets in linear time, on all cores: what is small enough to be sorted within
/// its bucket needs no other sorting. The result does not depend on the number of threads.
template <typename BucketOf>
Buckets into_buckets(std::size_t count, std::size_t buckets, const BucketOf& bucket_of) {
  Buckets result;
  result.first.assign(buckets + 1, 0);
  result.items.resize(count);
  const auto counter = [&](std::size_t bucket) { return std::atomic_ref(result.first[bucket]); };
  mesh::for_each_index(count, [&](std::size_t i) { counter(bucket_of(i)).fetch_add(1, std::memory_order_relaxed); });
  std::uint32_t sum = 0;
  for (std::uint32_t& first : result.first) first = sum += first;  // where the bucket ends
  mesh::for_each_index(count, [&](std::size_t i) {
    result.items[counter(bucket_of(i)).fetch_sub(1, std::memory_order_relaxed) - 1] = static_cast<std::uint32_t>(i);
  });
  mesh::for_each_index(buckets, [&](std::size_t bucket) { std::ranges::sort(result[bucket]); });
  return result;
}

}  // namespace penumbra
