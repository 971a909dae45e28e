// Writes the report's section on error budgets: bars, tables and pictures of repairs.

#include "compare/report_budget.hpp"

#include "compare/report_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::compare {
namespace {

using visibility::name_of;

/// Half of a bar's drawing: the length of the largest change of all.
constexpr double kHalfBar = 38;

/// Returns a bar; to the left of the middle the error decreases.
std::string bar_of_change(double change, double largest) {
  const double length = largest > 0 ? kHalfBar * std::abs(change) / largest : 0;
  return fmt::format(
      "<svg class=\"plot bar-of-budget\" viewBox=\"0 0 80 10\" aria-hidden=\"true\"><path class=\"frame\" d=\"M40 "
      "0V10\"/><rect class=\"{}\" x=\"{:.1f}\" y=\"2\" width=\"{:.1f}\" height=\"6\"/></svg>",
      change < 0 ? "better" : "worse", change < 0 ? 40 - length : 40.0, length);
}

/// Returns a bar from 0 on the left; a length of 80 is the largest error of all.
std::string bar_of_error(double rmse, double largest) {
  return fmt::format(
      "<svg class=\"plot bar-of-budget\" viewBox=\"0 0 80 10\" aria-hidden=\"true\"><path class=\"frame\" d=\"M1 "
      "0V10\"/><rect class=\"worse\" x=\"1\" y=\"2\" width=\"{:.1f}\" height=\"6\"/></svg>",
      largest > 0 ? 78 * rmse / largest : 0);
}

/// Returns a method's budget under a light; nullptr if there is none.
const ErrorBudget* budget_of(const MethodResult& result, std::size_t light) {
  if (light >= result.lights.size() || !result.lights[light].error_budget) return nullptr;
  return &*result.lights[light].error_budget;
}

/// Values of bars of full length; over all lights, so that tables can be compared.
struct Largest {
  double change = 0, error = 0;
};
Largest largest_of(const ReportInput& in) {
  Largest largest;
  for (const MethodResult& result : in.metrics.methods) {
    for (std::size_t light = 0; light < in.lights.size(); ++light) {
      const ErrorBudget* budget = budget_of(result, light);
      if (budget == nullptr) continue;
      for (const BudgetPart& part : budget->parts)
        largest.change = std::max(largest.change, std::abs(budget->change(part).value_or(0)));
      largest.error = std::max({largest.error, budget->rmse, budget->together.rmse.value_or(0)});
    }
  }
  return largest;
}

ReportTable changes_table(const ReportInput& in, std::size_t light) {
  const Largest largest = largest_of(in);
  ReportTable table{
      fmt::format(
          "Why each method is wrong under light “{}”: by how much its RMSE of V changes when one cause alone is "
          "repaired (negative: the error shrinks), and what is left of it when all are.",
          escape_html(in.lights[light].name)),
      {"Method", "RMSE as it is"},
      {}};
  for (const visibility::ErrorCause cause : visibility::kErrorCauses) table.headers.emplace_back(name_of(cause));
  table.headers.emplace_back("remainder");
  for (const MethodResult& result : in.metrics.methods) {
    const ErrorBudget* budget = budget_of(result, light);
    if (budget == nullptr) continue;
    std::vector<ReportCell> row{escape_html(result.entry)};
    row.emplace_back(error_text(budget->rmse) + bar_of_error(budget->rmse, largest.error), budget->rmse);
    for (const BudgetPart& part : budget->parts) {
      const auto change = budget->change(part);
      row.push_back(change ? ReportCell(signed_text(*change) + bar_of_change(*change, largest.change), change) : "–");
    }
    const auto& left = budget->together.rmse;
    row.push_back(left ? ReportCell(error_text(*left) + bar_of_error(*left, largest.error), left) : "–");
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string run_text(const visibility::RepairRun& run) {
  std::string text = run.method;
  for (const auto& [key, value] : run.options) text += fmt::format(":{}={}", key, value);
  if (run.light_parts > 1) text += fmt::format(", each of {0} × {0} parts of the light", run.light_parts);
  if (run.light_samples > 0)
    text += fmt::format(", {} light samples{}", run.light_samples, run.light_parts > 1 ? " a part" : "");
  return text;
}

std::string runs_html(const std::vector<BudgetRun>& runs) {
  std::string html;
  for (const BudgetRun& run : runs) {
    html += (html.empty() ? "" : "<br>") + escape_html(run_text(run.run)) + ": " +
            (run.rmse ? "RMSE " + error_text(*run.rmse) : "failed: " + escape_html(run.failure));
  }
  return html.empty() ? "none" : html;
}

ReportTable runs_table(const std::string& entry, const ErrorBudget& budget) {
  ReportTable table{"What was run for " + escape_html(entry),
                    {"Repaired", "How, or why not", "RMSE without it", "Pixels that it changes", "Runs"},
                    {}};
  const auto share = [](const std::vector<BudgetRun>& runs) {
    std::optional<double> acts_on;
    for (const BudgetRun& run : runs) acts_on = run.acts_on ? run.acts_on : acts_on;
    return acts_on ? ReportCell(percent_text(*acts_on), acts_on) : "–";
  };
  for (const BudgetPart& part : budget.parts) {
    const std::string note =
        part.rmse && !part.reached ? "; the runs do not lead there yet: this is the last one’s" : "";
    table.rows.push_back({name_of(part.cause), escape_html(part.words + note),
                          part.rmse ? ReportCell(error_text(*part.rmse), part.rmse) : "–", share(part.runs),
                          runs_html(part.runs)});
  }
  const auto at_once = [&](const char* what, const char* how, const BudgetRun& run) {
    table.rows.push_back(
        {what, how, run.rmse ? ReportCell(error_text(*run.rmse), run.rmse) : "–", share({run}), runs_html({run})});
  };
  if (budget.one_view) at_once(kAllButView, "what of the others can be combined", *budget.one_view);
  at_once(kAllAtOnce, "what of the above can be combined", budget.together);
  return table;
}

std::string pictures_html(const ReportLightView& view, const std::string& entry, const ErrorBudget& budget) {
  std::string html;
  for (const BudgetPicture& shown : view.budget_pictures) {
    std::string caption;
    for (const BudgetPart& part : budget.parts) {
      if (shown.repaired == name_of(part.cause) && part.rmse) caption = "RMSE " + signed_text(*budget.change(part));
    }
    const BudgetRun& at_once = shown.repaired == kAllButView && budget.one_view ? *budget.one_view : budget.together;
    if (caption.empty() && at_once.rmse) caption = "RMSE " + signed_text(*at_once.rmse - budget.rmse);
    html += figure_html(shown.picture,
                        fmt::format("By how much V of {} changes with {} repaired: {}", entry, shown.repaired, caption),
                        "<b>" + escape_html(shown.repaired) + "</b><span>" + escape_html(caption) + "</span>");
  }
  return html;
}

/// Returns the section of one light: the table with its bars, then for each method the pictures and the runs. Empty if
/// no method has a budget there.
std::string budget_of_light_html(const ReportInput& in, std::size_t light) {
  std::string html;
  for (std::size_t i = 0; i < in.methods.size(); ++i) {
    const MethodResult& result = in.metrics.methods[i];
    const ErrorBudget* budget = budget_of(result, light);
    if (budget == nullptr) continue;
    const std::string under = in.lights.size() > 1 ? fmt::format(" under light “{}”", in.lights[light].name) : "";
    const std::string pictures = pictures_html(in.methods[i].lights[light], result.entry + under, *budget);
    if (!pictures.empty()) {
      html += fmt::format(
          "<h4>Where repairs change V of {}</h4>\n<p class=\"note\">Blue becomes brighter, red darker, in the scale of "
          "the errors; white stays.</p>\n<div class=\"gallery\">{}</div>\n",
          escape_html(result.entry + under), pictures);
    }
    html += fmt::format(
        "<details><summary>How the budget of {} was found out</summary>\n{}<p class=\"note\">If causes added up, {} "
        "would be left.</p></details>\n",
        escape_html(result.entry + under), table_html(runs_table(result.entry + under, *budget)),
        signed_text(budget->if_causes_added_up()));
  }
  return html.empty() ? html : table_html(changes_table(in, light)) + html;
}

}  // namespace

std::string error_budget_html(const ReportInput& in) {
  std::string html;
  for (std::size_t light = 0; light < in.lights.size(); ++light) html += budget_of_light_html(in, light);
  if (html.empty()) return {};
  return "<h3 id=\"error-budget\">Error budget</h3>\n"
         "<p class=\"note\">Over each light’s judged pixels. A dash: nothing separates this cause for that method. The "
         "changes need not add up, since causes hide and feed one another; the remainder is what is left when all that "
         "can be combined is repaired at once.</p>\n" +
         html;
}

}  // namespace penumbra::compare
