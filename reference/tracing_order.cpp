#include "reference/tracing_order.hpp"

#include <algorithm>
#include <numeric>

namespace penumbra::reference {

std::vector<std::uint32_t> tracing_order(const visibility::Light& light) {
  const auto spread = [](double coordinate) {  // 16 bits, a zero between each two
    auto x = static_cast<std::uint32_t>(std::clamp((coordinate + 1) / 2, 0.0, 1.0) * 65535);
    x = (x | (x << 8)) & 0x00ff00ffu;
    x = (x | (x << 4)) & 0x0f0f0f0fu;
    x = (x | (x << 2)) & 0x33333333u;
    return (x | (x << 1)) & 0x55555555u;
  };
  std::vector<std::uint32_t> codes, order(light.sample_count());
  for (const glm::dvec2& st : light.coordinates) codes.push_back(spread(st.x) | (spread(st.y) << 1));
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
  return order;
}

}  // namespace penumbra::reference
