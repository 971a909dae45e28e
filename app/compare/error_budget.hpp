#pragma once

#include "app/machine.hpp"
#include "app/compare/comparison_entries.hpp"
#include "app/compare/light_judge.hpp"
#include "app/process/progress.hpp"
#include "app/session.hpp"
#include "compare/error_budget.hpp"
#include "compare/report.hpp"

#include <optional>
#include <span>
#include <vector>

namespace penumbra::app {

/// What is explained: a method's V under one of the session's lights, over that light's judged pixels.
struct BudgetQuestion {
  const Session& session;
  const visibility::Light& light;            ///< of the session's lights
  const LightTruth& truth;                   ///< of that light; it has judged pixels
  const visibility::SampleRequest& samples;  ///< pattern and seed for runs with a number of light samples of their own
  const Entry& entry;                        ///< its description has repairs
  std::span<const float> visibility;         ///< as asked, of each pixel
};

struct BudgetAnswer {
  compare::ErrorBudget budget;
  std::vector<compare::BudgetPicture>
      pictures;  ///< where each repair changes V, by how much; not those that do nothing
};

/// Runs what the method's description says, one run after the other. A run that the device or the scene refuses is
/// noted and left out. `limit`: of the pictures' scale.
BudgetAnswer measure_error_budget(const BudgetQuestion& question, double limit, const render::Machine& machine,
                                  Progress& progress);

}  // namespace penumbra::app
