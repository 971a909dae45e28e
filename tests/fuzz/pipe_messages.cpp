// SPDX-License-Identifier: Apache-2.0
// Fuzzes messages of `serve` and of the live view with any bytes: a refused message leaves the state as it was, and a
// state can always be written as a message.
#include "app/serve/message_pipe.hpp"
#include "app/view/live_state.hpp"
#include "base/assert.hpp"
#include "base/error.hpp"
#include "tests/fuzz/bytes.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>

namespace {

using penumbra::app::LiveState;

LiveState small_state() {
  penumbra::scenes::Scene scene;
  scene.name = "small";
  penumbra::scenes::AreaLight light;
  light.name = "key";
  light.shape = penumbra::scenes::Rectangle{{0, 4, 0}, {1, 0, 0}, {0, 0, 1}};
  scene.lights.push_back(light);
  light.name = "sun";
  light.shape = penumbra::scenes::Sun{{0, -1, 0}, 2};
  scene.lights.push_back(light);
  scene.cameras.push_back({.name = "front", .eye = {0, 0, 5}, .target = {0, 0, 0}});
  return penumbra::app::live_state(std::move(scene), "");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::span rest(reinterpret_cast<const char*>(data), size);
  penumbra::app::MessageSource source([&rest](std::span<char> into) {
    const std::size_t count = std::min(into.size(), rest.size());
    if (count > 0) std::memcpy(into.data(), rest.data(), count);
    rest = rest.subspan(count);
    return count;
  });
  LiveState state = small_state();
  try {
    while (const auto message = source.next()) {
      PENUMBRA_ASSERT(message->bytes.size() <= size, "{} bytes of {}", message->bytes.size(), size);
      const std::string before = penumbra::app::to_json(state).dump();
      try {
        penumbra::app::apply(state, message->head);
      } catch (const penumbra::Error&) {
        PENUMBRA_ASSERT(penumbra::app::to_json(state).dump() == before, "refused, and done: {}", message->head.dump());
      }
    }
  } catch (const penumbra::InputError&) {
  }
  return 0;
}
