// SPDX-License-Identifier: Apache-2.0
// Table of the family's methods.

#include "hybrids/methods.hpp"

#include <array>

namespace penumbra::hybrids {

std::span<const engines::MethodRow> methods() {
  static const std::array kRows{engines::on_device<hybrid_volume_description, make_hybrid_volume>()};
  return kRows;
}

}  // namespace penumbra::hybrids
