// SPDX-License-Identifier: Apache-2.0
// Reads the layers of a picture of the library: its lights, V, colours and other layers, by light and by number.

#include "library/picture_state.hpp"

#include "base/error.hpp"
#include "library/float3.hpp"

#include <utility>

namespace penumbra {
namespace {

template <typename List>
const auto& of_light(const List& list, std::size_t light) {
  if (light >= list.size()) throw UsageError("light {}: the picture has {} lights, from 0", light, list.size());
  return list[light];
}

}  // namespace

Picture::Picture(std::shared_ptr<const State> state) : state_(std::move(state)) {}

std::uint32_t Picture::width() const {
  return state_->width;
}
std::uint32_t Picture::height() const {
  return state_->height;
}
const std::vector<std::string>& Picture::lights() const {
  return state_->lights;
}
std::span<const float> Picture::visibility(std::size_t light) const {
  return of_light(state_->frame.visibility, light);
}
std::span<const Picture::Float3> Picture::beauty() const {
  return as_floats(state_->frame.sum);
}
std::span<const Picture::Float3> Picture::beauty(std::size_t light) const {
  return as_floats(of_light(state_->frame.beauty, light));
}
std::span<const float> Picture::alpha() const {
  return state_->frame.alpha;
}
std::span<const Picture::Float3> Picture::positions() const {
  return as_floats(state_->positions);
}
std::span<const Picture::Float3> Picture::relative_positions() const {
  return as_floats(state_->relative_positions);
}
std::array<double, 3> Picture::origin() const {
  return {state_->origin.x, state_->origin.y, state_->origin.z};
}
std::span<const Picture::Float3> Picture::normals() const {
  return as_floats(state_->normals);
}
std::span<const float> Picture::depth() const {
  return state_->depth;
}
std::span<const std::uint32_t> Picture::ids() const {
  return state_->ids;
}
std::span<const std::uint32_t> Picture::masks(std::size_t light) const {
  static_cast<void>(of_light(state_->words, light));
  if (light >= state_->frame.masks.size()) return {};
  return state_->frame.masks[light];
}
std::size_t Picture::words_per_mask(std::size_t light) const {
  return of_light(state_->words, light);
}
std::size_t Picture::light_samples(std::size_t light) const {
  return of_light(state_->light_samples, light);
}
const std::string& Picture::method(std::size_t light) const {
  return of_light(state_->methods, light);
}
const std::string& Picture::stats_json() const {
  return state_->stats;
}

}  // namespace penumbra
