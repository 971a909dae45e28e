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
  std::optional<double> acts_on = {};  ///< fraction of the pixels of `rmse` that the run acts on (kActs)
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

/// Limit of a sequence y₀, y₁, y₂ whose error source is halved each time. Let d₁ = y₀ − y₁, d₂ = y₁ − y₂ and
/// r = d₂ / d₁; r is 1/2 at first order, and less at higher orders. If |r| ≤ 0.6 (a margin for sequences that are not a
/// power), the limit is that of the geometric sequence through the three values, y₂ − d₂ r / (1 − r) (Aitken's Δ²), or
/// 0 if that is negative. Otherwise the limit is y₂, and `reached` is false.
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
