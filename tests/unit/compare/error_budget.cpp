// SPDX-License-Identifier: Apache-2.0
// Tests the limits of sequences of runs, and the share of the error that each cause has.
#include "compare/error_budget.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace penumbra::compare {
namespace {

using visibility::ErrorCause;
using visibility::RepairEnd;

/// y = a + b h^p at h = 1, 1/2, 1/4: the ratio of the changes is 2^−p.
Limit limit_of_power(double a, double b, double p) {
  return limit_of(a + b, a + b * std::pow(0.5, p), a + b * std::pow(0.25, p));
}

TEST(ErrorBudget, TheLimitOfAPowerIsExact) {
  for (const double p : {1.0, 1.5, 2.0, 4.0}) {
    for (const double b : {0.7, -0.2}) {
      const Limit limit = limit_of_power(0.25, b, p);
      EXPECT_TRUE(limit.reached) << p;
      // Differences of numbers below 1 are off by less than 2^−52, and are divided by 1 − 2^−p ≥ 1/2 at most twice.
      EXPECT_NEAR(limit.value, 0.25, 1e-14) << p;
    }
  }
}

TEST(ErrorBudget, WhereChangesDoNotHalveTheLastRunCounts) {
  const Limit slow = limit_of_power(0.25, 0.5, 0.5);
  EXPECT_FALSE(slow.reached);
  EXPECT_EQ(slow.value, 0.25 + 0.5 * std::pow(0.25, 0.5));
  EXPECT_FALSE(limit_of(0.3, 0.3, 0.2).reached) << "not reached: the value changes only in the last step";
  EXPECT_TRUE(limit_of(0.3, 0.2, 0.2).reached);
  EXPECT_EQ(limit_of(0.3, 0.2, 0.2).value, 0.2);
  EXPECT_EQ(limit_of(1, 0.5, 0.1).value, 0.1) << "the changes 0.5 and 0.4 decrease too slowly to extrapolate";
  EXPECT_EQ(limit_of(1, 0.4, 0.05).value, 0) << "an extrapolated mean of squares is not negative";
  // The sequence swings around 0.25: + 0.08, − 0.04, + 0.02.
  EXPECT_NEAR(limit_of(0.33, 0.21, 0.27).value, 0.25, 1e-14);
}

BudgetPart part_of(const std::vector<std::optional<double>>& errors) {
  BudgetPart part;
  for (const auto& rmse : errors) part.runs.push_back({{}, rmse, rmse ? "" : "no memory"});
  return part;
}

TEST(ErrorBudget, ARepairIsTheChangeToWhereItsRunsLead) {
  const double base = 0.1;
  ErrorBudget budget{.rmse = base};
  const auto change = [&](BudgetPart part, RepairEnd end, bool settled = false) {
    conclude(part, end, base, settled);
    return std::pair(budget.change(part), part.reached);
  };
  EXPECT_EQ(change(part_of({0.07}), RepairEnd::last), std::pair(std::optional(0.07 - base), true));
  EXPECT_EQ(change(part_of({0.13}), RepairEnd::last), std::pair(std::optional(0.13 - base), true));
  EXPECT_EQ(change(part_of({0.07, 0.06}), RepairEnd::settled, true), std::pair(std::optional(0.06 - base), true));
  EXPECT_EQ(change(part_of({0.07, 0.06}), RepairEnd::settled, false), std::pair(std::optional(0.06 - base), false));
  // Mean squares of 0.0100, 0.0052, 0.0028 converge to 0.0004.
  const auto limit = change(part_of({std::sqrt(0.0052), std::sqrt(0.0028)}), RepairEnd::limit);
  EXPECT_NEAR(limit.first.value(), 0.02 - base, 1e-12);
  EXPECT_TRUE(limit.second);
  // If the part has a first run of its own, the limit is that of its last three runs.
  const auto own = change(part_of({0.2, std::sqrt(0.02), 0.1}), RepairEnd::limit);
  EXPECT_NEAR(own.first.value(), 0 - base, 1e-7) << "the square root of a rounding error";
  // Runs that failed end the sequence.
  EXPECT_EQ(change(part_of({0.07, std::nullopt}), RepairEnd::limit), std::pair(std::optional(0.07 - base), false));
  EXPECT_EQ(change(part_of({std::nullopt}), RepairEnd::last), std::pair(std::optional<double>(), false));
  EXPECT_EQ(change(part_of({}), RepairEnd::last), std::pair(std::optional<double>(), false));
}

TEST(ErrorBudget, JsonHasEveryCauseAndTheRemainder) {
  ErrorBudget budget{.rmse = 0.5};
  for (const ErrorCause cause : visibility::kErrorCauses) budget.parts.push_back({.cause = cause});
  budget.parts[0].rmse = 0.25;
  budget.parts[2].rmse = 0.75;
  budget.together = {{"bitmask", {{"layers", "16"}}, 4, 64}, 0.125};
  const auto json = to_json(budget);
  EXPECT_EQ(
      json.dump(),
      R"({"resolution":-0.25,"view":null,"layers":0.25,"fusion":null,"gaps":null,"bias":null,"samples":null,"falloff":null,"remainder":0.125})");
  const auto runs = runs_json(budget);
  EXPECT_EQ(runs.at("ifCausesAddedUp"), 0.5);
  EXPECT_EQ(runs.at("together").at("lightParts"), 4);
  EXPECT_EQ(runs.at("allButView"), nullptr);
  EXPECT_EQ(runs.at("view").at("rmse"), nullptr);
  EXPECT_EQ(runs.at("layers").at("rmse"), 0.75);
}

TEST(ErrorBudget, PixelsThatARepairActsOnAreThoseItChanges) {
  const std::vector<float> before{0.5F, 0.5F, 0.5F, 0.5F, 0}, after{0.5F, 0.505F, 0.52F, 0.48F, 1};
  EXPECT_EQ(share_changed(after, before, std::vector<std::uint32_t>{0, 1, 2, 3}), 0.5);
  EXPECT_EQ(share_changed(after, before, {}), 0);
}

}  // namespace
}  // namespace penumbra::compare
