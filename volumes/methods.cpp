// SPDX-License-Identifier: Apache-2.0
// The table of the shadow-volume family, one row for each method: its description, and which engines it runs on. The
// papers are in README.md and on the methods' pages.

#include "volumes/methods.hpp"

#include "volumes/counters/methods.hpp"
#include "volumes/scatter/methods.hpp"
#include "volumes/soft/methods.hpp"

#include <array>

namespace penumbra::volumes {

std::span<const engines::MethodRow> methods() {
  using namespace engines;
  static const std::array kRows{
      on_either<edge_scatter_description, make_edge_scatter, edge_scatter_on_vectors>(2),
      on_either<depth_complexity_description, make_depth_complexity, depth_complexity_on_vectors>(),
      on_device<soft_volume_description, make_soft_volume>(),
      on_device<soft_volume_blend_description, make_soft_volume_blend>(),
      on_processor<make_soft_irregular>(),
      on_device<wedge_ramp_description, make_wedge_ramp>(),
      on_device<plateaus_description, make_plateaus>(),
      on_device<hard_volume_description, make_hard_volume>(),
  };
  return kRows;
}

}  // namespace penumbra::volumes
