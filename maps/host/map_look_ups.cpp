// SPDX-License-Identifier: Apache-2.0
// Part of MapMethod: records look-ups. Workgroups that have nothing to look at are excluded first, if the recipe has a
// sorting pass (group_list.glsl); some drivers end a workgroup's loops after a fixed number of iterations, and such
// workgroups are repeated with fewer rows of a map at a time.

#include "maps/host/recipe_method.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

namespace penumbra::maps {

std::optional<render::ComputePass> MapMethod::make_sort() const {
  if (!sorts_out()) return std::nullopt;
  const std::size_t push_bytes = sizeof(gpu::LookupPush) + sizeof(std::uint32_t) * recipe_.push_words;
  return std::optional<render::ComputePass>(
      std::in_place, *device_,
      render::ComputePassOptions{.name = recipe_.look_up_name + " (sorting)",
                                 .spirv = recipe_.sort_out,
                                 .push_bytes = static_cast<std::uint32_t>(push_bytes),
                                 .constants = constants_});
}

gpu::LookupPush MapMethod::push_of(const Receivers::Part& part, std::uint32_t first, std::uint32_t count) const {
  return {.basis = basis_.rounded(),
          .bias = static_cast<float>(options_.bias),
          .size = options_.size,
          .two_sided = is_body(light_->kind) ? 2u
                       : light_->two_sided   ? 1u
                                             : 0u,
          .first_receiver = part.first_receiver,
          .receiver_count = part.count,
          .first_result = part.first_result,
          .words_per_pixel = words_per_pixel(),
          .first_point = first,
          .point_count = count,
          .faces = fitted_.faces,
          .layers = recipe_.layers.count,
          .depth_use = static_cast<std::uint32_t>(options_.depth),
          .first_row = 0,
          .last_row = options_.size - 1,
          .width = receivers_.width(),
          .own_depth = options_.receiver_plane ? 0u : 1u};
}

std::vector<render::BufferReference> MapMethod::buffers_of(const Receivers::Part& part) const {
  std::vector<render::BufferReference> buffers{*part.receivers, *views_, *depths_, *results_};
  if (options_.fit.has_faces()) buffers.emplace_back(faces_.table());
  for (const std::unique_ptr<MapProduct>& product : recipe_.products) {
    std::ranges::copy(product->buffers(), std::back_inserter(buffers));
  }
  return buffers;
}

void MapMethod::sort_out(const visibility::Tile& tile) {
  const std::uint64_t list =
      (results_->bytes() - sizeof(gpu::CutLoops) - sizeof(gpu::GroupList)) / sizeof(std::uint32_t);
  gpu::GroupList head{.count = 0, .first = tile_pixels_ * (words_per_pixel() + 2)};
  listed_groups_.clear();
  for (const Receivers::Part& part : receivers_.parts(tile)) {
    render::Commands commands(*device_);
    commands.fill(*results_, 0, list * sizeof(std::uint32_t), sizeof(std::uint32_t));
    commands.fill(*results_, head.first, (list + 1) * sizeof(std::uint32_t), sizeof(std::uint32_t));
    std::vector<std::uint32_t> words = push_words(push_of(part, 0, 1));
    words.insert(words.end(), own_push_.begin(), own_push_.end());
    sort_->record(commands, std::as_bytes(std::span(words)), buffers_of(part),
                  (packets(part) + gpu::kLookupGroup - 1) / gpu::kLookupGroup);
    times_.add(commands.submit());
    results_->read(std::span(&head.count, 1), list * sizeof(std::uint32_t));
    listed_groups_.push_back(head.count);
  }
}

void MapMethod::ask(render::Commands& commands, const visibility::Tile& tile, std::uint32_t first, std::uint32_t count,
                    std::uint32_t rows_at_once) {
  const std::vector<Receivers::Part> parts = receivers_.parts(tile);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Receivers::Part& part = parts[k];
    gpu::LookupPush push = push_of(part, first, count);
    const std::vector<render::BufferReference> buffers = buffers_of(part);
    const std::uint64_t groups = sorts_out()                ? listed_groups_[k]
                                 : recipe_.group_a_receiver ? packets(part)
                                                            : part.groups();
    if (groups == 0) continue;
    if (sorts_out()) {
      const std::uint64_t list = results_->bytes() - sizeof(gpu::CutLoops) - sizeof(gpu::GroupList);
      commands.fill(*results_, listed_groups_[k], list, sizeof(std::uint32_t));
    }
    for (std::uint32_t row = 0; row < options_.size; row += rows_at_once) {
      push.first_row = row;
      push.last_row = std::min(row + rows_at_once, options_.size) - 1;
      std::vector<std::uint32_t> words = push_words(push);
      words.insert(words.end(), own_push_.begin(), own_push_.end());
      look_up_.record(commands, std::as_bytes(std::span(words)), buffers, groups);
    }
  }
}

void MapMethod::ask_all(const visibility::Tile& tile) {
  if (!recipe_.group_a_receiver) {
    render::Commands commands(*device_);
    for (std::uint32_t first = 0; first < point_count(); first += batch_) {
      const std::uint32_t count = std::min(batch_, point_count() - first);
      if (recipe_.points == MapPoints::light_samples) render_maps(commands, first, count);
      ask(commands, tile, first, count, options_.size);
      times_.add(commands.submit());
    }
    return;
  }
  PENUMBRA_ASSERT(point_count() == 1, "{}: workgroups ask one map", recipe_.description.name);
  if (sorts_out()) sort_out(tile);
  const std::uint64_t end = results_->bytes() / sizeof(std::uint32_t) - sizeof(gpu::CutLoops) / sizeof(std::uint32_t);
  const auto set = [&](render::Commands& commands, std::uint64_t word, std::uint32_t value) {
    commands.fill(*results_, value, (end + word) * sizeof(std::uint32_t), sizeof(std::uint32_t));
  };
  gpu::CutLoops cut{.any = 0, .asked = 0, .to_ask = tile_pixels_ * words_per_pixel()};
  for (std::uint32_t rows = options_.size;; rows = (rows + 3) / 4) {
    render::Commands commands(*device_);
    set(commands, 0, 0);
    set(commands, 1, cut.asked);
    set(commands, 2, cut.to_ask);
    commands.fill(*results_, 0, std::uint64_t{cut.to_ask} * sizeof(std::uint32_t),
                  std::uint64_t{tile_pixels_} * sizeof(std::uint32_t));
    ask(commands, tile, 0, 1, rows);
    times_.add(commands.submit());
    results_->read(std::span(&cut.any, 1), end * sizeof(std::uint32_t));
    if (cut.any == 0) return;
    if (rows == 1) {
      throw ResourceError("method {}: {} ends a loop before it has processed one row of a map; take a smaller size",
                          recipe_.description.name, device_->info().name);
    }
    const std::uint32_t other = cut.asked != 0 ? cut.asked : cut.to_ask + tile_pixels_;
    cut.asked = std::exchange(cut.to_ask, other);
  }
}

}  // namespace penumbra::maps
