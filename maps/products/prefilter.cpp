// SPDX-License-Identifier: Apache-2.0
// Prefilters functions of depth for means over windows: summed areas in integers (Crow 1984), mip levels (Williams
// 1983), N-buffers (Décoret 2005).

#include "maps/products/prefilter.hpp"

#include "base/error.hpp"
#include "maps/products/prefilter_level.comp.spv.hpp"
#include "maps/products/prefilter_values.comp.spv.hpp"
#include "maps/products/prefilter_values_fitted.comp.spv.hpp"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

namespace penumbra::maps {
namespace {

std::uint64_t groups_of(std::uint64_t invocations) {
  return (invocations + 63) / 64;
}

/// Returns the texels on a side of a level.
std::uint32_t level_size(PrefilterKind kind, std::uint32_t size, std::uint32_t level) {
  return kind == PrefilterKind::pyramid ? (size + (1U << level) - 1) >> level : size;
}

std::uint32_t level_count(PrefilterKind kind, std::uint32_t size) {
  if (kind == PrefilterKind::table) return 1;
  const std::uint32_t floor = static_cast<std::uint32_t>(std::bit_width(size)) - 1;
  return floor + (kind == PrefilterKind::pyramid && !std::has_single_bit(size) ? 2 : 1);
}

/// Returns the largest number of bits of a texel for which the sum of size² texels is below 2³².
std::uint32_t bits_of_limb(std::uint32_t size) {
  std::uint32_t bits = 0;
  while (std::uint64_t{size} * size << (bits + 1) <= std::uint64_t{1} << 32) ++bits;
  return bits;
}

}  // namespace

std::optional<PrefilterLayout> prefilter_layout(const PrefilterOptions& options, std::uint32_t size,
                                                std::uint32_t faces, std::uint64_t buffer_bytes) {
  const std::uint32_t levels = level_count(options.kind, size);
  std::uint64_t block = 0;
  for (std::uint32_t level = 0; level < levels; ++level) {
    const std::uint64_t side = level_size(options.kind, size, level);
    block += faces * side * side;
  }
  const std::uint64_t per_buffer = buffer_bytes / (block * sizeof(std::uint32_t));
  PrefilterLayout layout;
  for (const PrefilterFunction& function : options.functions) {
    const bool summed = options.kind == PrefilterKind::table && function.digits != 0;
    const std::uint32_t bits = summed ? bits_of_limb(size) : 0;
    const std::uint32_t limbs = summed ? (function.digits + bits - 1) / bits : 1;
    layout.values.push_back({function.kind, function.power, function.a, function.b, layout.blocks, limbs, bits});
    layout.blocks += limbs;
  }
  if (layout.blocks > per_buffer * gpu::kPrefilterBuffers) return std::nullopt;
  layout.table = {.scheme = static_cast<std::uint32_t>(options.kind),
                  .size = size,
                  .faces = faces,
                  .levels = levels,
                  .block = static_cast<std::uint32_t>(block),
                  .per_buffer = static_cast<std::uint32_t>(per_buffer),
                  .value_count = static_cast<std::uint32_t>(layout.values.size())};
  return layout;
}

std::uint32_t size_that_fits(const PrefilterOptions& options, std::uint32_t size, std::uint32_t faces,
                             std::uint64_t buffer_bytes) {
  constexpr std::uint32_t kStep = 64;
  const auto fits = [&](std::uint32_t side) {
    return prefilter_layout(options, side, faces, buffer_bytes).has_value();
  };
  if (fits(size)) return size;
  std::uint32_t less = std::max((size - 1) / kStep, 1U) * kStep;
  while (less > kStep && !fits(less)) less -= kStep;
  return less;
}

Prefilter::Prefilter(const render::Device& device, PrefilterOptions options, const Sources& sources)
    : device_(&device),
      options_(std::move(options)),
      sources_(sources),
      values_(device, {.name = "prefilter values",
                       .spirv = shaders::kPrefilterValuesComp,
                       .push_bytes = sizeof(gpu::PrefilterValuesPush),
                       .constants = value_constants()}),
      level_(device, {.name = "prefilter level",
                      .spirv = shaders::kPrefilterLevelComp,
                      .push_bytes = sizeof(gpu::PrefilterLevelPush),
                      .constants = {}}),
      sums_(device) {}

void Prefilter::record(render::Commands& commands, const MapSet& maps) {
  const std::uint32_t faces = std::max(maps.faces, 1U);
  const auto layout = prefilter_layout(options_, maps.size, faces, buffer_bytes());
  if (!layout) {
    std::uint32_t size = maps.size;
    while (size > 1 && !prefilter_layout(options_, size, faces, buffer_bytes())) --size;
    throw ResourceError(
        "method option size={}: the prefiltered data of {} maps do not fit into {} buffers of {}; take size={} or less",
        maps.size, faces, gpu::kPrefilterBuffers, device_->info().name, size);
  }
  const gpu::PrefilterTable& table = layout->table;
  render::grow(*device_, table_, "prefilter table",
               sizeof(gpu::PrefilterTable) + layout->values.size() * sizeof(gpu::PrefilterValue));
  table_->write<gpu::PrefilterTable>(std::span(&table, 1));
  table_->write<gpu::PrefilterValue>(layout->values, sizeof(gpu::PrefilterTable));
  for (std::uint32_t i = 0; i < gpu::kPrefilterBuffers; ++i) {
    blocks_[i] = std::min(layout->blocks - std::min(layout->blocks, i * table.per_buffer), table.per_buffer);
    render::grow(*device_, images_[i], "prefiltered images",
                 std::max<std::uint64_t>(std::uint64_t{blocks_[i]} * table.block, 1) * sizeof(std::uint32_t));
  }
  const gpu::PrefilterValuesPush push{faces * maps.size * maps.size};
  if (maps.faces == 0) return;  // there is no receiver
  record_values(commands, maps, push);
  if (options_.kind != PrefilterKind::table) return record_levels(commands, table);
  for (std::uint32_t i = 0; i < gpu::kPrefilterBuffers; ++i) {
    if (blocks_[i] > 0) sums_.record(commands, *images_[i], blocks_[i] * faces, maps.size);
  }
}

void Prefilter::record_values(render::Commands& commands, const MapSet& maps, const gpu::PrefilterValuesPush& push) {
  std::vector<render::BufferReference> buffers{*table_,
                                               options_.of_bits ? sources_.bits->buffer() : maps.depths,
                                               maps.views,
                                               sources_.nearest->buffer(),
                                               sources_.frame->buffer(),
                                               *images_[0],
                                               *images_[1],
                                               *images_[2],
                                               *images_[3]};
  const auto bytes = std::as_bytes(std::span(&push, 1));
  if (maps.face_table == nullptr) return values_.record(commands, bytes, buffers, groups_of(push.texels));
  if (!fitted_values_) {
    fitted_values_.emplace(*device_, render::ComputePassOptions{.name = "prefilter values",
                                                                .spirv = shaders::kPrefilterValuesFittedComp,
                                                                .push_bytes = sizeof(gpu::PrefilterValuesPush),
                                                                .constants = value_constants()});
  }
  buffers.emplace_back(*maps.face_table);
  fitted_values_->record(commands, bytes, buffers, groups_of(push.texels));
}

std::vector<std::uint32_t> Prefilter::value_constants() const {
  return {static_cast<std::uint32_t>(options_.kind), options_.of_bits ? 1U : 0U, options_.slope ? 1U : 0U};
}

void Prefilter::record_levels(render::Commands& commands, const gpu::PrefilterTable& table) const {
  std::uint32_t from = 0;
  for (std::uint32_t level = 1; level < table.levels; ++level) {
    const std::uint32_t before = level_size(options_.kind, table.size, level - 1),
                        side = level_size(options_.kind, table.size, level);
    const std::uint32_t to = from + table.faces * before * before;
    for (std::uint32_t i = 0; i < gpu::kPrefilterBuffers; ++i) {
      if (blocks_[i] == 0) continue;
      const gpu::PrefilterLevelPush push{.scheme = table.scheme,
                                         .size = table.size,
                                         .faces = table.faces,
                                         .level = level,
                                         .from = from,
                                         .to = to,
                                         .block = table.block,
                                         .blocks = blocks_[i]};
      level_.record(commands, push, {*images_[i]}, groups_of(std::uint64_t{table.faces} * side * side * blocks_[i]));
    }
    from = to;
  }
}

std::vector<render::BufferReference> Prefilter::buffers() const {
  std::vector<render::BufferReference> buffers{*table_};
  for (const auto& images : images_) buffers.emplace_back(*images);
  return buffers;
}

std::uint64_t Prefilter::buffer_bytes() const {
  return options_.buffer_bytes != 0 ? options_.buffer_bytes : device_->limits().max_storage_buffer_range;
}

std::vector<std::uint32_t> Prefilter::constants(std::uint32_t size, std::uint32_t faces) const {
  const auto layout = prefilter_layout(options_, size, faces, buffer_bytes());
  const bool one = layout && layout->blocks <= layout->table.per_buffer;
  return {static_cast<std::uint32_t>(options_.kind), one ? 1 : gpu::kPrefilterBuffers};  // if there is no layout,
                                                                                         // record() reports it
}

void Prefilter::add_counters(std::map<std::string, std::uint64_t>& counters) const {
  if (options_.is_reduced) counters[kReducedMaps] = 1;
}

std::uint64_t Prefilter::memory_bytes() const {
  std::uint64_t bytes = table_ ? table_->bytes() : 0;
  for (const auto& images : images_) bytes += images ? images->bytes() : 0;
  return bytes;
}

}  // namespace penumbra::maps
