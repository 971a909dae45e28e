// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method_options.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// Causes of a method's error, and runs without each of them: docs/error-budget.md.
namespace penumbra::visibility {

enum class ErrorCause : std::uint8_t { resolution, view, layers, fusion, gaps, bias, samples, falloff };
inline constexpr ErrorCause kErrorCauses[] = {ErrorCause::resolution, ErrorCause::view,   ErrorCause::layers,
                                              ErrorCause::fusion,     ErrorCause::gaps,   ErrorCause::bias,
                                              ErrorCause::samples,    ErrorCause::falloff};
constexpr const char* name_of(ErrorCause cause) {
  constexpr const char* kNames[] = {"resolution", "view", "layers", "fusion", "gaps", "bias", "samples", "falloff"};
  return kNames[static_cast<std::size_t>(cause)];
}

/// A run of a method, or of another method that differs from it only in the repaired cause.
struct RepairRun {
  std::string method;
  MethodOptions options;
  std::uint32_t light_parts = 1;    ///< the light is divided into this many parts along each axis; V is their mean
  std::uint32_t light_samples = 0;  ///< light samples of the light, or of each part; 0: those of the command line
};

/// How a sequence of runs gives the result without a cause.
enum class RepairEnd : std::uint8_t {
  last,     ///< the last run has no such error
  limit,    ///< each run halves the size of the cause; the limit is estimated from the last three of all runs, the
            ///< original one being the first
  settled,  ///< the first run with the same V as its predecessor has no such error
};

/// Repair of a single cause.
struct ErrorRepair {
  ErrorCause cause = ErrorCause::resolution;
  RepairEnd end = RepairEnd::last;
  std::vector<RepairRun> runs = {};  ///< in this order; empty: the cause cannot be separated
  std::string words = {};            ///< description of the repair, or why there is none; without a full stop
};

struct ErrorRepairs {
  std::vector<ErrorRepair> alone;  ///< one for each cause, in the order of kErrorCauses
  /// Runs with all possible repairs together, the most thorough first: the first that succeeds counts.
  std::vector<RepairRun> together;
  std::vector<RepairRun> one_view = {};  ///< like `together`, but the cause `view` stays; empty if `view` cannot be
                                         ///< separated
};

}  // namespace penumbra::visibility
