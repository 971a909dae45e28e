#pragma once

#include "compare/metrics.hpp"
#include "visibility/error_repair.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

/// Why a method is wrong: by how much its RMSE changes when one cause alone is repaired (docs/error-budget.md).
namespace penumbra::compare {

/// A repair acts on a pixel whose V it changes by more than this.
inline constexpr double kActs = 0.01;

/// A run that does without a cause, or with less of it.
struct BudgetRun {
  visibility::RepairRun run = {};
  std::optional<double> rmse = {};  ///< over the pixels of `error` in metrics.json; none: it failed
  std::string failure = {};
  std::optional<double> acts_on = {};  ///< the share of these pixels that it acts on
};

/// One cause repaired alone.
struct BudgetPart {
  visibility::ErrorCause cause = visibility::ErrorCause::resolution;
  std::string words = {};            ///< what was done, or why nothing could be
  std::vector<BudgetRun> runs = {};  ///< as far as they were made
  std::optional<double> rmse = {};   ///< without the cause; none: it cannot be separated
  bool reached = false;              ///< the runs led to where they should; else `rmse` is the last run's
};

struct ErrorBudget {
  double rmse = 0;                         ///< as the method was asked
  std::vector<BudgetPart> parts = {};      ///< in the order of visibility::kErrorCauses
  BudgetRun together = {};                 ///< all repairs at once that can be combined
  std::optional<BudgetRun> one_view = {};  ///< all but the view; none where the view cannot be separated

  /// The signed change of RMSE: negative if the repair helps.
  [[nodiscard]] std::optional<double> change(const BudgetPart& part) const;
  /// RMSE + the sum of all changes; causes that hide or feed one another make it differ from what is left together.
  [[nodiscard]] double if_causes_added_up() const;
};

/// Where a sequence leads whose error source is halved each time. With d₁ = y₀ − y₁, d₂ = y₁ − y₂ and r = d₂ / d₁: at
/// first order r is 1/2, and less at higher ones. Up to |r| = 0.6, which leaves room for what is no power, the limit of
/// the geometric sequence through the three, y₂ − d₂ r / (1 − r) (Aitken's Δ²), at least 0; else y₂, and `reached` is
/// false.
struct Limit {
  double value = 0;
  bool reached = false;
};
Limit limit_of(double y0, double y1, double y2);

/// Sets `rmse` and `reached` of a part whose runs were made: up to the first that failed, if any. `settled`: the last
/// run gave the same V as the one before. The limit is of mean squares, which are what causes that do not know of each
/// other add up to.
void conclude(BudgetPart& part, visibility::RepairEnd end, double rmse, bool settled);

/// Share of these pixels where V differs by more than kActs.
double share_changed(std::span<const float> visibility, std::span<const float> before,
                     std::span<const std::uint32_t> pixels);

/// `errorBudget` of metrics.json: the parts, null where a cause cannot be separated, and the remainder.
nlohmann::ordered_json to_json(const ErrorBudget& budget);
/// `errorBudgetRuns`: how each part was come by.
nlohmann::ordered_json runs_json(const ErrorBudget& budget);

}  // namespace penumbra::compare
