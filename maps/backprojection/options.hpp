#pragma once

#include "maps/backprojection/fill.shared.h"
#include "visibility/method_options.hpp"

/// Options that methods of this room share.
namespace penumbra::maps {

constexpr visibility::ChoiceOption<std::uint32_t, 3> fill_option(std::uint32_t otherwise) {
  return {"fill",
          {{"none", gpu::kFillNone}, {"edges", gpu::kFillEdges}, {"diagonal", gpu::kFillDiagonal}},
          otherwise,
          "patches reach to those of their left and lower neighbours; of the diagonal one, too"};
}

}  // namespace penumbra::maps
