// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace penumbra::app {

/// Binary message of the page's 3D view: message_start() with `buffers`, a list of `name`, `type` (float32, uint32 or
/// int32) and `count` of each array, then the arrays one after the other.
class SpaceMessage {
 public:
  void add(std::string_view name, std::span<const float> values);
  void add(std::string_view name, std::span<const std::uint32_t> values);
  void add(std::string_view name, std::span<const std::int32_t> values);
  [[nodiscard]] std::string finish(nlohmann::ordered_json header) const;

 private:
  struct Array {
    std::string name, type;
    std::size_t count;
  };
  template <typename Value>
  void append(std::string_view name, const char* type, std::span<const Value> values);

  std::vector<Array> arrays_;
  std::string bytes_;
};

}  // namespace penumbra::app
