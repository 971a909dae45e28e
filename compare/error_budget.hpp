// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compare/metrics.hpp"
#include "visibility/error_repair.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

/// Error budget of a method: the change of its RMSE when one cause of error alone is repaired (docs/error-budget.md).
namespace penumbra::compare {

/// A repair acts on a pixel if it changes V there by more than this.
inline constexpr double kActs = 0.01;

/// Run without a cause of error, or with less of it.
struct BudgetRun {
  visibility::RepairRun run = {};
  std::optional<double> rmse = {};  ///< over the pixels of `error` in metrics.json; empty: the run failed
  std::string failure = {};
  std::optional<double> acts_on = {};  ///< fraction of these pixels that the run acts on
};

/// Repair of one cause alone.
struct BudgetPart {
  visibility::ErrorCause cause = visibility::ErrorCause::resolution;
  std::string words = {};            ///< description of the repair, or reason why there is none
  std::vector<BudgetRun> runs = {};  ///< completed runs
  std::optional<double> rmse = {};   ///< without the cause; empty: not separable
  bool reached = false;              ///< the sequence of runs has a limit; else `rmse` is that of the last run
};

struct ErrorBudget {
  double rmse = 0;                         ///< of the method with the requested options
  std::vector<BudgetPart> parts = {};      ///< in the order of visibility::kErrorCauses
  BudgetRun together = {};                 ///< all combinable repairs at once
  std::optional<BudgetRun> one_view = {};  ///< all combinable repairs but the view; empty where the view cannot be
                                           ///< separated

  /// Returns the signed change of RMSE: negative if the repair reduces the error.
  [[nodiscard]] std::optional<double> change(const BudgetPart& part) const;
  /// Returns RMSE + the sum of all changes; differs from the remaining error of all repairs together if causes mask or
  /// amplify one another.
  [[nodiscard]] double if_causes_added_up() const;
};

/// Limit of a sequence whose error source is halved each time. With d₁ = y₀ − y₁, d₂ = y₁ − y₂ and r = d₂ / d₁: at
/// first order r is 1/2, and less at higher orders. Up to |r| = 0.6, with a margin for sequences that are no power, the
/// limit of the geometric sequence through the three, y₂ − d₂ r / (1 − r) (Aitken's Δ²), at least 0; else y₂, and
/// `reached` is false.
struct Limit {
  double value = 0;
  bool reached = false;
};
Limit limit_of(double y0, double y1, double y2);

/// Sets `rmse` and `reached` of a part from its runs, up to the first failed run. `settled`: the last run gave the same
/// V as the previous one. The limit is computed for mean squares, which are additive for independent causes.
void conclude(BudgetPart& part, visibility::RepairEnd end, double rmse, bool settled);

/// Returns the fraction of these pixels where V differs by more than kActs.
double share_changed(std::span<const float> visibility, std::span<const float> before,
                     std::span<const std::uint32_t> pixels);

/// Returns `errorBudget` of metrics.json: the parts, null where a cause cannot be separated, and the remainder.
nlohmann::ordered_json to_json(const ErrorBudget& budget);
/// Returns `errorBudgetRuns`: the runs of each part.
nlohmann::ordered_json runs_json(const ErrorBudget& budget);

}  // namespace penumbra::compare
