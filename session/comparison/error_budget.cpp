// SPDX-License-Identifier: Apache-2.0
// Runs the repairs of a method's error and concludes its budget (docs/error-budget.md).

#include "session/comparison/error_budget.hpp"

#include "compare/error_picture.hpp"
#include "compare/metrics.hpp"
#include "session/methods.hpp"
#include "session/process/failure.hpp"
#include "session/runner.hpp"
#include "visibility/lights/light_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

namespace penumbra::session {
namespace {

using compare::BudgetPart;
using compare::BudgetRun;
using visibility::ErrorCause;
using visibility::ErrorRepair;
using visibility::Light;
using visibility::RepairEnd;
using visibility::RepairRun;

/// Returns the reason why a light cannot be divided into parts; empty if it can.
std::string why_whole(const Light& light) {
  if (!visibility::is_planar(light.kind))
    return fmt::format("the light is a {}: only lights in one plane are divided into parts",
                       visibility::name_of(light.kind));
  if (light.texture) return "the light has a texture, which its parts would lack";
  return {};
}

/// Number of repairs that a method runs.
std::size_t count_of(const visibility::ErrorRepairs& repairs) {
  const auto runs =
      std::ranges::count_if(repairs.alone, [](const ErrorRepair& repair) { return !repair.runs.empty(); });
  return static_cast<std::size_t>(runs) + (repairs.one_view.empty() ? 0 : 1) + (repairs.together.empty() ? 0 : 1);
}

class RepairRuns {
 public:
  RepairRuns(const BudgetQuestion& question, const render::Machine& machine, BudgetRuns& runs, Progress& progress)
      : question_(question), machine_(machine), runs_(runs), progress_(progress) {
    const Entry& entry = question.entry;
    runs_.known[key_of({entry.description.name, visibility::complete_options(entry.description, entry.options)})] =
        std::make_shared<const std::vector<float>>(question.visibility.begin(), question.visibility.end());
  }

  /// Returns V of each pixel; nullptr, with the reason in `run`, if the run fails.
  std::shared_ptr<const std::vector<float>> visibility_of(BudgetRun& run, const std::string& stage) {
    auto& known = runs_.known[key_of(run.run)];
    try {
      if (!known) known = std::make_shared<const std::vector<float>>(evaluate(run.run, stage));
    } catch (...) {
      run.failure = current_failure().message;
      progress_.clear();
      return nullptr;
    }
    run.rmse = compare::visibility_error(*known, question_.truth.reference, question_.truth.judged)->rmse;
    run.acts_on = compare::share_changed(*known, question_.visibility, question_.truth.judged);
    return known;
  }

 private:
  static BudgetRuns::Key key_of(const RepairRun& run) {
    return {run.method, run.options, run.light_parts, run.light_samples};
  }

  std::vector<float> evaluate(const RepairRun& run, const std::string& stage) {
    const auto method = make_method(run.method, run.options, machine_);
    const Light whole = light_for(run);
    const std::vector<visibility::LightPart> parts = visibility::light_parts(whole, run.light_parts);
    std::vector<double> sum(question_.session.pixel_count(), 0.0);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::string part = parts.size() > 1 ? fmt::format(", part {} of {}", i + 1, parts.size()) : "";
      const RunPlan plan{
          .lights = {&parts[i].light, 1}, .runs = 1, .pixels = question_.truth.judged, .stage = stage + part};
      const MethodRun done = run_method(*method, question_.session, plan, {}, progress_);
      const std::vector<float>& values = done.visibility.front();
      for (std::size_t pixel = 0; pixel < sum.size(); ++pixel)
        sum[pixel] += parts[i].weight * static_cast<double>(values[pixel]);
    }
    machine_.check_validation();
    return {sum.begin(), sum.end()};
  }

  [[nodiscard]] Light light_for(const RepairRun& run) const {
    const Light& light = question_.light;
    if (run.light_samples == 0) return light;
    visibility::SampleRequest request = question_.samples;
    request.rows = request.columns = 0;
    request.count = run.light_samples;
    return visibility::make_light(question_.session.scene, static_cast<std::uint32_t>(light.index),
                                  question_.session.floats.origin, request);
  }

  const BudgetQuestion& question_;
  render::Machine machine_;
  BudgetRuns& runs_;
  Progress& progress_;
};

/// Returns a picture of the change of V by a repair, over judged pixels.
Image8 picture_of(const BudgetQuestion& question, const std::vector<float>& repaired, double limit) {
  constexpr float kNobody = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> shown(repaired.size(), kNobody);
  for (const std::uint32_t pixel : question.truth.judged) shown[pixel] = repaired[pixel];
  return compare::error_picture(question.session.samples, shown, question.visibility, limit);
}

}  // namespace

BudgetAnswer measure_error_budget(const BudgetQuestion& question, double limit, const render::Machine& machine,
                                  BudgetRuns& known, Progress& progress) {
  const Entry& entry = question.entry;
  const std::string whole = why_whole(question.light);
  const visibility::ErrorRepairs repairs = entry.description.repairs(entry.description, entry.options);
  RepairRuns runs(question, machine, known, progress);
  std::size_t begun = 0;
  const auto next_stage = [&, all = count_of(repairs)](const char* repaired) {
    return fmt::format("{}: {} repaired ({} of {})", entry.label, repaired, ++begun, all);
  };
  BudgetAnswer answer;
  compare::ErrorBudget& budget = answer.budget;
  budget.rmse = compare::visibility_error(question.visibility, question.truth.reference, question.truth.judged)->rmse;
  const auto show = [&](const char* repaired, const BudgetRun& run, const std::vector<float>& visibility) {
    if (run.acts_on.value_or(0) > 0) answer.pictures.push_back({repaired, picture_of(question, visibility, limit)});
  };

  for (const ErrorRepair& repair : repairs.alone) {
    const std::string stage = repair.runs.empty() ? std::string() : next_stage(name_of(repair.cause));
    BudgetPart& part = budget.parts.emplace_back(BudgetPart{.cause = repair.cause, .words = repair.words});
    std::shared_ptr<const std::vector<float>> last;
    BudgetRun last_made;
    bool settled = false;
    for (const RepairRun& run : repair.runs) {
      if (run.light_parts > 1 && !whole.empty()) {
        part.words = whole;
        break;
      }
      if (repair.cause == ErrorCause::samples && run.light_samples != 0 &&
          run.light_samples <= question.light.sample_count()) {
        part.words =
            fmt::format("it already has {} light samples, as many as the repair uses", question.light.sample_count());
        break;
      }
      BudgetRun& made = part.runs.emplace_back(BudgetRun{run});
      const auto now = runs.visibility_of(made, stage);
      if (!now) break;
      settled = last != nullptr && std::ranges::all_of(question.truth.judged, [&](std::uint32_t pixel) {
                  return (*now)[pixel] == (*last)[pixel];
                });
      last = now;
      last_made = made;
      if (repair.end == RepairEnd::settled && settled) break;
    }
    conclude(part, repair.end, budget.rmse, settled);
    if (last) show(name_of(repair.cause), last_made, *last);
  }

  // The most thorough repair that can be run.
  const auto first_of = [&](const std::vector<RepairRun>& wanted, const char* repaired) {
    BudgetRun made;
    const std::string stage = wanted.empty() ? std::string() : next_stage(repaired);
    for (RepairRun run : wanted) {
      if (!whole.empty()) run.light_parts = 1;
      made = {run};
      const auto visibility = runs.visibility_of(made, stage);
      if (!visibility) continue;
      show(repaired, made, *visibility);
      break;
    }
    return made;
  };
  if (!repairs.one_view.empty()) budget.one_view = first_of(repairs.one_view, compare::kAllButView);
  budget.together = first_of(repairs.together, compare::kAllAtOnce);
  return answer;
}

}  // namespace penumbra::session
