// SPDX-License-Identifier: Apache-2.0
// The reference methods: rays to light samples (Embree), and exact areas by a sweep. Both run on the processor and need
// no device.

#include "reference/methods.hpp"

#include <array>

namespace penumbra::reference {

std::span<const engines::MethodRow> methods() {
  static const std::array kRows{engines::on_processor<make_ray_traced>(), engines::on_processor<make_exact>()};
  return kRows;
}

}  // namespace penumbra::reference
