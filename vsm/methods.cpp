// SPDX-License-Identifier: Apache-2.0
// The table of view-sample mapping, one row for each method: its description, and which engines it runs on. The papers
// are in methods.hpp and on the methods' pages.

#include "vsm/methods.hpp"

#include <array>

namespace penumbra::vsm {

std::span<const engines::MethodRow> methods() {
  using namespace engines;
  static const std::array kRows{
      on_either<view_sample_description, make_view_sample, view_sample_on_vectors>(1),
      on_processor<make_hierarchical_penumbra>(),
      on_processor<make_view_sample_planar>(),
      on_processor<make_alias_free>(),
  };
  return kRows;
}

}  // namespace penumbra::vsm
