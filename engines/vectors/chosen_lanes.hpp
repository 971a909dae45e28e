// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace penumbra::vectors {

/// Table for compacting `Lanes` lanes of `Parts` parts each: for each subset of lanes (bit i: lane i), the parts of the
/// chosen lanes in order, then arbitrary parts. Inside pack-inl.hpp only.
template <std::size_t Lanes, std::size_t Parts>
constexpr auto chosen_lanes() {
  std::array<std::array<std::uint8_t, Lanes * Parts>, std::size_t{1} << Lanes> all{};
  for (std::size_t choice = 0; choice < all.size(); ++choice) {
    std::size_t count = 0;
    for (std::size_t lane = 0; lane < Lanes; ++lane) {
      if ((choice >> lane & 1) == 0) continue;
      for (std::size_t part = 0; part < Parts; ++part)
        all[choice][count++] = static_cast<std::uint8_t>(lane * Parts + part);
    }
  }
  return all;
}
inline constexpr auto kWordsOfEight = chosen_lanes<8, 1>();
inline constexpr auto kWordsOfFour = chosen_lanes<4, 2>();
inline constexpr auto kBytesOfFour = chosen_lanes<4, 4>();
inline constexpr auto kBytesOfTwo = chosen_lanes<2, 8>();

}  // namespace penumbra::vectors
