// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compare/error_budget.hpp"
#include "compare/report.hpp"
#include "session/comparison/comparison_entries.hpp"
#include "session/comparison/light_judge.hpp"
#include "session/machine.hpp"
#include "session/process/progress.hpp"
#include "session/session.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace penumbra::session {

/// V of a method to be explained, under one of the session's lights, over that light's judged pixels.
struct BudgetQuestion {
  const Session& session;
  const visibility::Light& light;            ///< one of the session's lights
  const LightTruth& truth;                   ///< of this light; must have judged pixels
  const visibility::SampleRequest& samples;  ///< pattern and seed for runs with a number of light samples of their own
  const Entry& entry;                        ///< its description must have repairs
  std::span<const float> visibility;         ///< with the requested options, of each pixel
};

/// V by the runs of repairs under one light, for its judged pixels: repairs of several methods may be the same run.
struct BudgetRuns {
  /// Method, options, parts of the light, light samples.
  using Key = std::tuple<std::string, visibility::MethodOptions, std::uint32_t, std::uint32_t>;
  std::map<Key, std::shared_ptr<const std::vector<float>>> known;
};

struct BudgetAnswer {
  compare::ErrorBudget budget;
  std::vector<compare::BudgetPicture> pictures;  ///< change of V by each repair; without repairs that change nothing
};

/// Runs the repairs of the method's description one after another. A run that the device or the scene rejects is noted
/// and left out, and one in `runs` is not repeated. `limit`: of the pictures' scale.
BudgetAnswer measure_error_budget(const BudgetQuestion& question, double limit, const render::Machine& machine,
                                  BudgetRuns& runs, Progress& progress);

}  // namespace penumbra::session
