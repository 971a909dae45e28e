// SPDX-License-Identifier: Apache-2.0
#include "reference/methods.hpp"

#include <array>

namespace penumbra::reference {

std::span<const engines::MethodRow> methods() {
  static const std::array kRows{engines::on_processor<make_ray_traced>(), engines::on_processor<make_exact>()};
  return kRows;
}

}  // namespace penumbra::reference
