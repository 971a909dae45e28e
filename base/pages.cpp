// SPDX-License-Identifier: Apache-2.0
// Replaces the global `operator new`: large arrays lie in large pages and are reused (kept_arrays.hpp).

#include "base/pages.hpp"

#include "base/kept_arrays.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

#include <malloc.h>
#include <sys/mman.h>

// Linked into Penumbra's own executables, never into the library: a host program keeps its own allocator.

// Sanitizers replace operator new themselves, and detect more.
#ifndef PENUMBRA_SHADOW_MEMORY

namespace {

using penumbra::KeptArrays;
using penumbra::kLargePage;

constexpr std::size_t kUsual = alignof(std::max_align_t);

/// The C library may allocate more than requested, up to a large page.
constexpr std::size_t kLeastAsked = KeptArrays::kLeast - kLargePage - 4096;

bool is_kept_size(void* first) {
  return malloc_usable_size(first) >= KeptArrays::kLeast;
}

void* memory_of(std::size_t bytes, std::size_t alignment) {
  if (bytes < penumbra::kLargeArray) {
    if (alignment <= kUsual) return std::malloc(std::max<std::size_t>(bytes, 1));
    return std::aligned_alloc(alignment, std::max<std::size_t>((bytes + alignment - 1) / alignment, 1) * alignment);
  }
  const bool may_be_kept = bytes >= kLeastAsked && alignment <= kLargePage;
  if (void* const kept = may_be_kept ? penumbra::kept_arrays().take(bytes) : nullptr) return kept;
  void* first = nullptr;
  if (::posix_memalign(&first, std::max(alignment, kLargePage), bytes) != 0) first = nullptr;
  // Covers only pages that belong to the array alone. A system without large pages provides small ones.
  if (first != nullptr) static_cast<void>(::madvise(first, bytes / kLargePage * kLargePage, MADV_HUGEPAGE));
  if (may_be_kept) penumbra::kept_arrays().settle(bytes, is_kept_size(first) ? malloc_usable_size(first) : 0);
  return first;
}

void give_back(void* first) {
  const bool ours = reinterpret_cast<std::uintptr_t>(first) % kLargePage == 0;
  if (!ours || !is_kept_size(first) || !penumbra::kept_arrays().keep(first, malloc_usable_size(first)))
    std::free(first);
}

void* memory_or_throw(std::size_t bytes, std::size_t alignment) {
  for (;;) {
    if (void* const first = memory_of(bytes, alignment)) return first;
    if (penumbra::kept_arrays().bytes() > 0) {
      penumbra::kept_arrays().free_all();
      continue;
    }
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

}  // namespace

void* operator new(std::size_t bytes) {
  return memory_or_throw(bytes, kUsual);
}

void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return memory_or_throw(bytes, static_cast<std::size_t>(alignment));
}

void operator delete(void* first) noexcept {
  give_back(first);
}

void operator delete(void* first, std::size_t /*bytes*/) noexcept {
  give_back(first);
}

void operator delete(void* first, std::align_val_t /*alignment*/) noexcept {
  give_back(first);
}

void operator delete(void* first, std::size_t /*bytes*/, std::align_val_t /*alignment*/) noexcept {
  give_back(first);
}

#endif
