#pragma once

#include "maps/backprojection/patches/fill.shared.h"
#include "visibility/method_options.hpp"

/// Options shared by methods of this room.
namespace penumbra::maps {

constexpr visibility::ChoiceOption<std::uint32_t, 4> fill_option(std::uint32_t otherwise) {
  return {
      "fill",
      {{"none", gpu::kFillNone},
       {"edges", gpu::kFillEdges},
       {"diagonal", gpu::kFillDiagonal},
       {"shared", gpu::kFillShared}},
      otherwise,
      "patches reach to those of their left and lower neighbours; of the diagonal one, too; or begin where those end, "
      "which makes them smaller, too"};
}

}  // namespace penumbra::maps
