// SPDX-License-Identifier: Apache-2.0
// Cache of large freed arrays for `operator new` (pages.cpp).

#include "base/kept_arrays.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace {

constinit penumbra::KeptArrays arrays;  // constructed before any other object

}  // namespace

penumbra::KeptArrays& penumbra::kept_arrays() {
  return arrays;
}

namespace penumbra {

void KeptArrays::start_keeping() {
  const std::scoped_lock lock(mutex_);
  keeps_ = true;
}

void* KeptArrays::take(std::size_t bytes) {
  const std::scoped_lock lock(mutex_);
  Array* best = nullptr;
  for (Array& one : kept_) {
    const bool fits = one.first != nullptr && one.bytes >= bytes && one.bytes - bytes <= bytes / 2;
    if (fits && (best == nullptr || one.bytes < best->bytes)) best = &one;
  }
  if (best == nullptr) {
    used_bytes_ += bytes;
    free_more_than(std::max(most_used_bytes_, used_bytes_) - used_bytes_);
    return nullptr;
  }
  const Array taken = std::exchange(*best, {});
  kept_bytes_ -= taken.bytes;
  use(taken.bytes);
  return taken.first;
}

void KeptArrays::settle(std::size_t bytes, std::size_t made) {
  const std::scoped_lock lock(mutex_);
  used_bytes_ -= std::min(used_bytes_, bytes);
  use(made);
  free_more_than(most_used_bytes_ - used_bytes_);
}

bool KeptArrays::keep(void* first, std::size_t bytes) {
  const std::scoped_lock lock(mutex_);
  used_bytes_ -= std::min(used_bytes_, bytes);  // clamped: a library may have an operator new of its own
  const auto place = std::ranges::find(kept_, nullptr, &Array::first);
  if (!keeps_ || place == kept_.end()) return false;
  *place = {first, bytes};
  kept_bytes_ += bytes;
  return true;
}

void KeptArrays::free_all() {
  const std::scoped_lock lock(mutex_);
  free_more_than(0);
}

std::size_t KeptArrays::bytes() const {
  const std::scoped_lock lock(mutex_);
  return kept_bytes_;
}

void KeptArrays::use(std::size_t bytes) {
  used_bytes_ += bytes;
  most_used_bytes_ = std::max(most_used_bytes_, used_bytes_);
}

void KeptArrays::free_more_than(std::size_t room) {
  for (Array& one : kept_) {
    if (kept_bytes_ <= room) return;
    kept_bytes_ -= one.bytes;
    std::free(std::exchange(one, {}).first);
  }
}

}  // namespace penumbra
