// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/backprojection/patches/fill.shared.h"
#include "visibility/method_options.hpp"

/// Options shared by methods of this room.
namespace penumbra::maps {

constexpr visibility::ChoiceOption<std::uint32_t, 4> fill_option(std::uint32_t otherwise) {
  return {"fill",
          {{"none", gpu::kFillNone},
           {"edges", gpu::kFillEdges},
           {"diagonal", gpu::kFillDiagonal},
           {"shared", gpu::kFillShared}},
          otherwise,
          "extension of patches to close gaps: to those of the left and lower neighbours; also to the diagonal one; or "
          "shared borders, which also make patches smaller"};
}

}  // namespace penumbra::maps
