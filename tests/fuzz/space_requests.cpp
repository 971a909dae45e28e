// SPDX-License-Identifier: Apache-2.0
// Fuzzes requests for the live view's 3D view with any bytes: numbers are in their ranges, or the request is refused.
#include "app/view/space_view.hpp"
#include "base/assert.hpp"
#include "base/error.hpp"
#include "network/requests.hpp"

#include <cmath>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view target(reinterpret_cast<const char*>(data), size);
  PENUMBRA_ASSERT(!penumbra::network::has_token(target, "0123456789abcdef"), "a token that nobody knows: {}", target);
  try {
    const penumbra::app::SpaceShadows request = penumbra::app::parse_space_shadows(target);
    PENUMBRA_ASSERT(std::abs(request.place.x) <= 1 && std::abs(request.place.y) <= 1, "beside the light: {}", target);
    PENUMBRA_ASSERT(!request.floor || std::isfinite(*request.floor), "no height: {}", target);
    PENUMBRA_ASSERT(request.wedges.light.size() <= size, "a name longer than the target: {}", target);
  } catch (const penumbra::UsageError&) {
  }
  return 0;
}
