// SPDX-License-Identifier: Apache-2.0
// A method that composes pictures of chosen view samples for another method and puts the answers back in their places.
// Consecutive view samples fill regions of 16 × 16 pixels in Z order, which engines evaluate together.

#include "session/pictures/asked_areas.hpp"

#include "base/assert.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace penumbra::session {
namespace {

using visibility::Tile;
using visibility::ViewSamples;

/// Size of a region: engines evaluate regions of this many pixels along each side, with pixels in Z order.
constexpr std::size_t kRegion = 16, kRegionPixels = kRegion * kRegion, kRegionsAcross = 64;

/// Compacts the bits at even places.
std::uint32_t even_bits(std::uint32_t bits) {
  bits &= 0x55555555u;
  bits = (bits | bits >> 1) & 0x33333333u;
  bits = (bits | bits >> 2) & 0x0f0f0f0fu;
  bits = (bits | bits >> 4) & 0x00ff00ffu;
  return (bits | bits >> 8) & 0x0000ffffu;
}

}  // namespace

AskedAreas::AskedAreas(visibility::Method& method) : method_(method) {
  PENUMBRA_ASSERT(method.description().gives_area(), "{}", method.description().name);
}

void AskedAreas::prepare_light(const visibility::Light& light) {
  method_.prepare_light(light);
  counters_.clear();
}

std::uint32_t AskedAreas::max_tile_rows() const {
  constexpr std::uint32_t kMostSamples = 1u << 21;
  return std::max(kMostSamples / samples_->width, 1u);
}

std::vector<AreaAnswer> AskedAreas::ask(const ViewSamples& samples) {
  method_.prepare_view(samples);
  std::vector<AreaAnswer> answers(samples.size());
  std::vector<float> shares;
  std::vector<glm::dvec3> form_factors;
  const std::uint32_t rows = std::max(method_.max_tile_rows(), 1u);
  for (std::uint32_t row = 0; row < samples.height; row += rows) {
    const Tile tile{row, std::min(rows, samples.height - row)};
    const std::size_t first = std::size_t{row} * samples.width, size = std::size_t{tile.row_count} * samples.width;
    method_.evaluate(tile);
    shares.resize(size);
    form_factors.resize(size);
    method_.read_visibility(shares);
    method_.read_form_factors(form_factors);
    for (std::size_t i = 0; i < size; ++i) answers[first + i] = {shares[i], form_factors[i]};
  }
  // Statistics are reset by prepare_light() alone, which is not called in between: the last ones cover all pictures.
  return answers;
}

std::vector<std::size_t> AskedAreas::in_regions(std::uint32_t width, std::uint32_t height) {
  std::vector<std::size_t> places;
  places.reserve(std::size_t{width} * height);
  for (std::size_t top = 0; top < height; top += kRegion) {
    for (std::size_t left = 0; left < width; left += kRegion) {
      for (std::uint32_t spot = 0; spot < kRegionPixels; ++spot) {
        const std::size_t x = left + even_bits(spot), y = top + even_bits(spot >> 1);
        if (x < width && y < height) places.push_back(y * width + x);
      }
    }
  }
  return places;
}

AskedAreas::Packed AskedAreas::packed(std::span<const std::size_t> which) const {
  const ViewSamples& all = *samples_;
  const std::size_t regions = (which.size() + kRegionPixels - 1) / kRegionPixels,
                    across = std::min(regions, kRegionsAcross), down = (regions + across - 1) / across;
  Packed made;
  ViewSamples& some = made.samples;
  some.width = static_cast<std::uint32_t>(across * kRegion);
  some.height = static_cast<std::uint32_t>(down * kRegion);
  some.camera = all.camera;
  some.eye = all.eye;
  const std::size_t size = std::size_t{some.width} * some.height;
  some.triangle.assign(size, ViewSamples::kBackground);
  some.p.resize(size, glm::vec3(0));
  some.n.resize(size, glm::vec3(0));
  some.depth.resize(size, 0);
  some.facing.resize(size, 0);
  made.at.resize(which.size());
  tbb::parallel_for(std::size_t{0}, which.size(), [&](std::size_t i) {
    const std::size_t region = i / kRegionPixels;
    const auto spot = static_cast<std::uint32_t>(i % kRegionPixels);
    const std::size_t x = region % across * kRegion + even_bits(spot),
                      y = region / across * kRegion + even_bits(spot >> 1);
    const std::size_t to = y * some.width + x, from = which[i];
    made.at[i] = to;
    some.triangle[to] = all.triangle[from];
    some.p[to] = all.p[from];
    some.n[to] = all.n[from];
    some.depth[to] = all.depth[from];
    some.facing[to] = all.facing[from];
  });
  return made;
}

void AskedAreas::evaluate(const Tile& tile) {
  const std::size_t first = std::size_t{tile.first_row} * samples_->width;
  answers_.assign(std::size_t{tile.row_count} * samples_->width, {});
  std::vector<std::size_t> open = answer(tile, answers_);
  if (!open.empty()) ask_open(std::move(open), first);
  keep(tile, answers_);
}

void AskedAreas::ask_open(std::vector<std::size_t> open, std::size_t first) {
  for (std::size_t& at : open) at += first;
  const Packed part = packed(open);
  const std::vector<AreaAnswer> answers = ask(part.samples);
  tbb::parallel_for(std::size_t{0}, open.size(),
                    [&](std::size_t i) { answers_[open[i] - first] = answers[part.at[i]]; });
}

void AskedAreas::read_visibility(std::span<float> visibility) {
  PENUMBRA_ASSERT(visibility.size() == answers_.size(), "{} of {}", visibility.size(), answers_.size());
  std::ranges::transform(answers_, visibility.begin(), &AreaAnswer::visibility);
}

void AskedAreas::read_form_factors(std::span<glm::dvec3> form_factors) {
  PENUMBRA_ASSERT(form_factors.size() == answers_.size(), "{} of {}", form_factors.size(), answers_.size());
  std::ranges::transform(answers_, form_factors.begin(), &AreaAnswer::form_factor);
}

std::map<std::string, std::uint64_t> AskedAreas::counters() const {
  std::map<std::string, std::uint64_t> all = method_.counters();
  for (const auto& [name, number] : counters_) all[name] += number;
  return all;
}

std::uint64_t AskedAreas::memory_bytes() const {
  return method_.memory_bytes() + answers_.capacity() * sizeof(AreaAnswer);
}

}  // namespace penumbra::session
