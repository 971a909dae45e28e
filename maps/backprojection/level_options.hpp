// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/backprojection/level_maps.hpp"
#include "visibility/method_options.hpp"

#include <cstdint>
#include <memory>

/// Options of methods that use coarse levels of their maps (levels.glsl).
namespace penumbra::maps {

inline constexpr visibility::IntegerOption kMapLevel{"level", 0, gpu::kCoarsestLevel, 0,
                                                     "blocks of 2^level texels a side are one texel"};
inline constexpr visibility::IntegerOption kTexelBudget{
    "budget", 0, 1u << 28, 0,
    "largest number of a face's texels that a receiver reads; beyond it, coarser levels replace them; 0: no limit"};
inline constexpr visibility::ChoiceOption<bool, 2> kBlendLevels =
    visibility::flag_option("blend", true, "with a budget: pass from one level to the next without steps");

struct LevelChoice {
  std::uint32_t level = 0;   ///< with a budget, the finest level
  std::uint32_t budget = 0;  ///< 0: no budget
  bool blend = true;

  /// Returns the shader's constant kLevels: gpu::kFinestLevel …
  [[nodiscard]] std::uint32_t levels() const {
    return budget > 0 ? gpu::kLevelsByBudget : level > 0 ? gpu::kOneLevel : gpu::kFinestLevel;
  }
};

inline LevelChoice level_choice(const visibility::ParsedOptions& parsed) {
  return {parsed[kMapLevel], parsed[kTexelBudget], parsed[kBlendLevels]};
}

/// Returns the levels that `choice` may use.
inline std::unique_ptr<LevelMaps> make_level_maps(const render::Device& device, const LevelChoice& choice) {
  if (choice.budget > 0) return std::make_unique<LevelMaps>(device, 1, gpu::kCoarsestLevel);
  return std::make_unique<LevelMaps>(device, choice.level, choice.level);
}

}  // namespace penumbra::maps
