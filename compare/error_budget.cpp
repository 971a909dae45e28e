// SPDX-License-Identifier: Apache-2.0
// Computes error budgets: the change of RMSE by the repair of one cause of error (docs/error-budget.md), with limits of
// sequences by Aitken's Δ².

#include "compare/error_budget.hpp"

#include <algorithm>
#include <cmath>

namespace penumbra::compare {
namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(const std::optional<double>& number) {
  return number ? Json(*number) : Json();
}

Json run_json(const BudgetRun& run) {
  Json options = Json::object();
  for (const auto& [key, value] : run.run.options) options[key] = value;
  return {{"method", run.run.method},
          {"options", options},
          {"lightParts", run.run.light_parts},
          {"lightSamples", run.run.light_samples},
          {"rmse", number_or_null(run.rmse)},
          {"actsOn", number_or_null(run.acts_on)},
          {"failure", run.failure.empty() ? Json() : Json(run.failure)}};
}

}  // namespace

std::optional<double> ErrorBudget::change(const BudgetPart& part) const {
  if (!part.rmse) return std::nullopt;
  return *part.rmse - rmse;
}

double ErrorBudget::if_causes_added_up() const {
  double sum = rmse;
  for (const BudgetPart& part : parts) sum += change(part).value_or(0);
  return sum;
}

Limit limit_of(double y0, double y1, double y2) {
  const double first = y0 - y1, second = y1 - y2;
  if (second == 0) return {y2, true};
  if (std::abs(second) > 0.6 * std::abs(first)) return {y2, false};
  const double ratio = second / first;
  return {std::max(0.0, y2 - second * ratio / (1 - ratio)), true};
}

void conclude(BudgetPart& part, visibility::RepairEnd end, double rmse, bool settled) {
  std::vector<double> squares{rmse * rmse};
  for (const BudgetRun& run : part.runs) {
    if (!run.rmse) break;
    squares.push_back(*run.rmse * *run.rmse);
  }
  const std::size_t count = squares.size();
  if (count == 1) return;
  part.rmse = std::sqrt(squares.back());
  switch (end) {
    case visibility::RepairEnd::last:
      part.reached = count == part.runs.size() + 1;
      return;
    case visibility::RepairEnd::settled:
      part.reached = settled;
      return;
    case visibility::RepairEnd::limit:
      if (count < 3) return;
      const Limit limit = limit_of(squares[count - 3], squares[count - 2], squares[count - 1]);
      part.rmse = std::sqrt(limit.value);
      part.reached = limit.reached;
  }
}

double share_changed(std::span<const float> visibility, std::span<const float> before,
                     std::span<const std::uint32_t> pixels) {
  const auto changed = std::ranges::count_if(
      pixels, [&](std::uint32_t pixel) { return std::abs(double{visibility[pixel]} - double{before[pixel]}) > kActs; });
  return pixels.empty() ? 0 : static_cast<double>(changed) / static_cast<double>(pixels.size());
}

Json to_json(const ErrorBudget& budget) {
  Json json = Json::object();
  for (const BudgetPart& part : budget.parts) json[name_of(part.cause)] = number_or_null(budget.change(part));
  json["remainder"] = number_or_null(budget.together.rmse);
  return json;
}

Json runs_json(const ErrorBudget& budget) {
  Json json{{"rmse", budget.rmse}, {"ifCausesAddedUp", budget.if_causes_added_up()}};
  for (const BudgetPart& part : budget.parts) {
    Json runs = Json::array();
    for (const BudgetRun& run : part.runs) runs.push_back(run_json(run));
    json[name_of(part.cause)] = {{"words", part.words},
                                 {"rmse", number_or_null(part.rmse)},
                                 {"reached", part.rmse ? Json(part.reached) : Json()},
                                 {"runs", runs}};
  }
  json["together"] = run_json(budget.together);
  json["allButView"] = budget.one_view ? run_json(*budget.one_view) : Json();
  return json;
}

}  // namespace penumbra::compare
