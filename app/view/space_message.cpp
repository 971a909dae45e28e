// SPDX-License-Identifier: Apache-2.0
// A binary message of the 3D view: named arrays of numbers one after the other, listed in the message's JSON.

#include "app/view/space_message.hpp"

#include "app/view/message_text.hpp"

#include <nlohmann/json.hpp>

namespace penumbra::app {

template <typename Value>
void SpaceMessage::append(std::string_view name, const char* type, std::span<const Value> values) {
  arrays_.push_back({std::string(name), type, values.size()});
  bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

void SpaceMessage::add(std::string_view name, std::span<const float> values) {
  append(name, "float32", values);
}
void SpaceMessage::add(std::string_view name, std::span<const std::uint32_t> values) {
  append(name, "uint32", values);
}
void SpaceMessage::add(std::string_view name, std::span<const std::int32_t> values) {
  append(name, "int32", values);
}

std::string SpaceMessage::finish(nlohmann::ordered_json header) const {
  auto buffers = nlohmann::ordered_json::array();
  for (const auto& [name, type, count] : arrays_) buffers.push_back({{"name", name}, {"type", type}, {"count", count}});
  header["buffers"] = std::move(buffers);
  return message_start(header) + bytes_;
}

}  // namespace penumbra::app
