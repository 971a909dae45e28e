// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/pages.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

/// Sorting in linear time on all cores: first into parts that fit a processor's cache, then each part by itself, so
/// that memory is read and written sequentially. No result depends on the number of threads.
namespace penumbra {

/// Indices of elements, each with a word, in parts of similar words; each part is in ascending order of index.
struct Parts {
  struct Item {
    std::uint32_t word, number;
  };
  std::vector<std::uint32_t> first;  ///< begin of each part, and the end of the last
  std::unique_ptr<Item[]> items;

  [[nodiscard]] std::size_t size() const { return first.size() - 1; }
  [[nodiscard]] std::span<const Item> operator[](std::size_t part) const {
    return {items.get() + first[part], first[part + 1] - first[part]};
  }
  /// Returns a good number of parts for `elements` elements: a power of two.
  static std::size_t good_count(std::size_t elements) {
    constexpr std::size_t kElements = 4096, kMost = 4096;  // elements of a part; most streams that are written
                                                           // concurrently
    return std::min(std::bit_ceil(std::max<std::size_t>(elements / kElements, 1)), kMost);
  }
};

/// Sorts 0 … count − 1 by word_of(i) >> shift, which must be below `parts`. Calls word_of twice for each element.
template <typename WordOf>
Parts into_parts(std::size_t count, std::size_t parts, unsigned shift, const WordOf& word_of) {
  constexpr std::size_t kChunk = 1U << 14U;
  Parts result;
  result.first.assign(parts + 1, 0);
  result.items = std::make_unique_for_overwrite<Parts::Item[]>(count);
  const std::size_t chunks = (count + kChunk - 1) / kChunk;
  std::vector<std::uint32_t> places(chunks * parts, 0);  // first the count of each chunk in each part, then the write
                                                         // positions
  const auto for_each_of = [&](std::size_t chunk, const auto& visit) {
    std::uint32_t* const place = places.data() + chunk * parts;
    for (std::size_t i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, count); ++i) {
      const std::uint32_t word = word_of(i);
      visit(place[word >> shift], Parts::Item{word, static_cast<std::uint32_t>(i)});
    }
  };
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
    for_each_of(chunk, [](std::uint32_t& place, const Parts::Item&) { ++place; });
  });
  std::uint32_t sum = 0;
  for (std::size_t part = 0; part < parts; ++part) {
    result.first[part] = sum;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) sum += std::exchange(places[chunk * parts + part], sum);
  }
  result.first[parts] = sum;
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
    for_each_of(chunk, [&](std::uint32_t& place, const Parts::Item& item) { result.items[place++] = item; });
  });
  return result;
}

/// Indices of elements, sorted into buckets; each bucket is in ascending order.
struct Buckets {
  std::vector<std::uint32_t> first;  ///< begin of each bucket, and the end of the last
  UnsetList<std::uint32_t> items;

  [[nodiscard]] std::size_t size() const { return first.size() - 1; }
  [[nodiscard]] std::span<std::uint32_t> operator[](std::size_t bucket) {
    return std::span(items).subspan(first[bucket], first[bucket + 1] - first[bucket]);
  }
};

/// Sorts 0 … count − 1 by bucket_of(i) < buckets. Calls bucket_of twice for each element.
template <typename BucketOf>
Buckets into_buckets(std::size_t count, std::size_t buckets, const BucketOf& bucket_of) {
  Buckets result;
  result.first.assign(buckets + 1, 0);
  result.first[buckets] = static_cast<std::uint32_t>(count);
  result.items.resize(count);
  if (buckets == 0) return result;
  unsigned shift = 0;
  while ((buckets - 1) >> shift >= Parts::good_count(count)) ++shift;
  const Parts parts = into_parts(count, ((buckets - 1) >> shift) + 1, shift, bucket_of);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    const std::span<const Parts::Item> here = parts[part];
    const std::size_t begin = part << shift, end = std::min((part + 1) << shift, buckets);
    for (const Parts::Item& item : here) ++result.first[item.word];
    std::uint32_t sum = parts.first[part];
    for (std::size_t bucket = begin; bucket < end; ++bucket) result.first[bucket] = sum += result.first[bucket];
    for (std::size_t i = here.size(); i-- > 0;) result.items[--result.first[here[i].word]] = here[i].number;
  });
  return result;
}

/// Returns for each of 0 … count − 1 the first element equal to it by same(i, j). same(i, j) must imply hash_of(i) =
/// hash_of(j). Hashes have 64 bits, of which the upper half must be well distributed.
template <typename HashOf, typename Same>
std::vector<std::uint32_t> first_of_same(std::size_t count, const HashOf& hash_of, const Same& same) {
  constexpr std::uint32_t kNone = 0xffffffffU;
  const std::size_t good = std::max<std::size_t>(Parts::good_count(count), 2);
  const auto shift = static_cast<unsigned>(32 - std::countr_zero(good));
  const Parts parts =
      into_parts(count, good, shift, [&](std::size_t i) { return static_cast<std::uint32_t>(hash_of(i) >> 32U); });
  std::vector<std::uint32_t> first;
  resize_on_all_cores(first, count);
  tbb::enumerable_thread_specific<std::vector<std::uint32_t>> tables;
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    const std::span<const Parts::Item> here = parts[part];
    std::vector<std::uint32_t>& table = tables.local();  // positions in `here`, indexed by the low bits of words
    table.assign(std::bit_ceil(2 * here.size() + 1), kNone);
    for (std::uint32_t i = 0; i < here.size(); ++i) {
      const auto [word, number] = here[i];
      std::size_t at = word & (table.size() - 1);
      while (table[at] != kNone && !(here[table[at]].word == word && same(here[table[at]].number, number)))
        at = (at + 1) & (table.size() - 1);
      if (table[at] == kNone) table[at] = i;
      first[number] = here[table[at]].number;
    }
  });
  return first;
}

}  // namespace penumbra
