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
  const visibility::SampleRequest& samples;  ///< pattern and seed for runs with another number of light samples
  const Entry& entry;                        ///< its description must have repairs
  std::span<const float> visibility;         ///< V of each pixel with the requested options
};

/// V from the runs of repairs under one light, for its judged pixels. Kept, since repairs of several methods may need
/// the same run.
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
/// and left out, and one in `runs` is not repeated. `limit`: end of the pictures' scale.
BudgetAnswer measure_error_budget(const BudgetQuestion& question, double limit, const render::Machine& machine,
                                  BudgetRuns& runs, Progress& progress);

}  // namespace penumbra::session
