#pragma once

#include "visibility/method_options.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// What makes a method wrong, cause by cause, and which other runs do without each: docs/error-budget.md.
namespace penumbra::visibility {

enum class ErrorCause : std::uint8_t { resolution, view, layers, fusion, gaps, bias };
inline constexpr ErrorCause kErrorCauses[] = {ErrorCause::resolution, ErrorCause::view, ErrorCause::layers,
                                              ErrorCause::fusion,     ErrorCause::gaps, ErrorCause::bias};
constexpr const char* name_of(ErrorCause cause) {
  constexpr const char* kNames[] = {"resolution", "view", "layers", "fusion", "gaps", "bias"};
  return kNames[static_cast<std::size_t>(cause)];
}

/// A run of a method, or of one that differs from it only in what is repaired.
struct RepairRun {
  std::string method;
  MethodOptions options;
  std::uint32_t light_parts = 1;    ///< the light is cut in so many parts along each axis; V is their mean
  std::uint32_t light_samples = 0;  ///< of the light, or of each part; 0: those of the command line
};

/// How runs lead to the state without a cause.
enum class RepairEnd : std::uint8_t {
  last,   ///< the last is it
  limit,  ///< each halves what the cause lives from; the limit is estimated from the last three, the run as asked first
  settled,  ///< the first that gives the same V as the one before is it
};

/// One cause repaired alone.
struct ErrorRepair {
  ErrorCause cause = ErrorCause::resolution;
  RepairEnd end = RepairEnd::last;
  std::vector<RepairRun> runs = {};  ///< in this order; none: the cause cannot be separated
  std::string words = {};            ///< what is done, or why nothing can be; no full stop
};

struct ErrorRepairs {
  std::vector<ErrorRepair> alone;  ///< one a cause, in the order of kErrorCauses
  /// All that can be combined, the most thorough first: the first that runs counts.
  std::vector<RepairRun> together;
  std::vector<RepairRun> one_view = {};  ///< likewise, of the view; none where `view` cannot be separated
};

}  // namespace penumbra::visibility
