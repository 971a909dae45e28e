// SPDX-License-Identifier: Apache-2.0
// Sorts light samples by Morton code, so that rays traced together are similar.

#include "reference/tracing_order.hpp"

#include "visibility/dome_faces.hpp"

#include <algorithm>
#include <numeric>

namespace penumbra::reference {

std::vector<std::uint32_t> tracing_order(const visibility::Light& light) {
  const auto spread = [](double coordinate) {  // inserts a zero between neighbouring bits, for 16 bits
    auto x = static_cast<std::uint32_t>(std::clamp((coordinate + 1) / 2, 0.0, 1.0) * 65535);
    x = (x | (x << 8)) & 0x00ff00ffu;
    x = (x | (x << 4)) & 0x0f0f0f0fu;
    x = (x | (x << 2)) & 0x33333333u;
    return (x | (x << 1)) & 0x55555555u;
  };
  std::vector<std::uint64_t> codes;
  std::vector<std::uint32_t> order(light.sample_count());
  for (const glm::dvec2& st : light.coordinates) codes.push_back(spread(st.x) | (spread(st.y) << 1));
  if (light.dome) {  // sorted by faces
    for (std::size_t i = 0; i < codes.size(); ++i)
      codes[i] |= std::uint64_t{visibility::dome_face_of(*light.dome, light.points[i])} << 32U;
  }
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
  return order;
}

}  // namespace penumbra::reference
