#include "base/pages.hpp"

#include "base/kept_arrays.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>

#include <malloc.h>
#include <sys/mman.h>

namespace {

constinit penumbra::KeptArrays arrays;  // before any other object

}  // namespace

penumbra::KeptArrays& penumbra::kept_arrays() {
  return arrays;
}

// Address sanitizer has an operator new of its own, which finds more.
#ifndef __SANITIZE_ADDRESS__

namespace {

using penumbra::KeptArrays;
using penumbra::kLargePage;

constexpr std::size_t kUsual = alignof(std::max_align_t);

void* memory_of(std::size_t bytes, std::size_t alignment) {
  if (bytes < penumbra::kLargeArray) {
    if (alignment <= kUsual) return std::malloc(std::max<std::size_t>(bytes, 1));
    return std::aligned_alloc(alignment, std::max<std::size_t>((bytes + alignment - 1) / alignment, 1) * alignment);
  }
  const bool may_be_kept = bytes >= KeptArrays::kLeast && alignment <= kLargePage;
  if (void* const kept = may_be_kept ? arrays.take(bytes) : nullptr) return kept;
  void* const first = std::aligned_alloc(std::max(alignment, kLargePage), bytes);
  // Whole pages alone, so that the array takes no byte more. A system without large pages gives small ones.
  if (first != nullptr) static_cast<void>(::madvise(first, bytes / kLargePage * kLargePage, MADV_HUGEPAGE));
  if (const std::size_t taken = malloc_usable_size(first); taken >= KeptArrays::kLeast) arrays.count(taken);
  return first;
}

void give_back(void* first) {
  const std::size_t bytes = malloc_usable_size(first);
  if (bytes < KeptArrays::kLeast || !arrays.keep(first, bytes)) std::free(first);
}

void* memory_or_throw(std::size_t bytes, std::size_t alignment) {
  for (;;) {
    if (void* const first = memory_of(bytes, alignment)) return first;
    if (arrays.bytes() > 0) {
      arrays.free_all();
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
