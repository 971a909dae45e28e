#include "compare/report_tables.hpp"

#include "compare/question.hpp"
#include "compare/report_parts.hpp"

#include <fmt/format.h>

namespace penumbra::compare {
namespace {

std::vector<std::string> error_cells(const std::optional<VisibilityError>& error) {
  if (!error) return std::vector<std::string>(6, "–");
  return {error_text(error->mean), error_text(error->rmse),     error_text(error->p999),
          error_text(error->max),  percent_text(error->over05), signed_text(error->bias)};
}

std::string errors_html(const ReportInput& in) {
  const std::string judged = count_text(in.metrics.judged_pixels), horizon = count_text(in.metrics.horizon_pixels);
  ReportTable table{"Error of V against " + escape_html(in.metrics.reference.method) + ". 0 would be perfect. " +
                        judged + " judged pixels, " + horizon + " horizon pixels.",
                    {"Method", "Pixels", "Mean", "RMSE", "99.9 % within", "Largest", "Off by over 0.05", "Bias",
                     "RMSE of the beauty"},
                    {}};
  const MethodResult* best = smallest(in.metrics.methods, rmse_of);
  for (const MethodResult& result : in.metrics.methods) {
    if (result.failure) continue;
    std::vector<std::string> cells = error_cells(result.error);
    if (&result == best) cells[1] = "<span class=\"best\">" + cells[1] + "</span>";
    cells.insert(cells.begin(), {escape_html(result.entry), "judged"});
    cells.push_back(result.beauty_error ? percent_text(result.beauty_error->relative_rmse) : "–");
    table.rows.push_back(cells);
    if (result.horizon_error) {
      cells = error_cells(result.horizon_error);
      cells.insert(cells.begin(), {label_html(result.entry, "horizon pixels"), "horizon"});
      cells.emplace_back("–");
      table.rows.push_back(cells);
    }
  }
  return table_html(table);
}

std::string pairs_html(const ReportInput& in) {
  ReportTable table{"Pair by pair: on how many (view sample, light sample) pairs does a method answer other than " +
                        escape_html(in.metrics.reference.method) + "?",
                    {"Method", "Differing pairs", "of all pairs", "share", "of pairs in penumbrae", "share"},
                    {}};
  ReportTable verdicts{
      "Who is right where they differ? Decided by exact arithmetic, which does not round.",
      {"Method", "Pairs decided", "of those that differ", "Method right", "Reference right", "Ties read by rule"},
      {}};
  const auto share = [](std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? std::string("–")
                      : fmt::format("{:.2g}", static_cast<double>(part) / static_cast<double>(whole));
  };
  for (const MethodResult& result : in.metrics.methods) {
    if (result.pairs) {
      const PairCounts& pairs = *result.pairs;
      table.rows.push_back({escape_html(result.entry), count_text(pairs.differing), count_text(pairs.all),
                            share(pairs.differing, pairs.all), count_text(pairs.penumbra),
                            share(pairs.differing, pairs.penumbra)});
    }
    if (result.verdicts) {
      const PairVerdicts& v = *result.verdicts;
      verdicts.rows.push_back({escape_html(result.entry), count_text(v.decided),
                               percent_text(result.pairs ? decided_share(*result.pairs, v) : 1),
                               count_text(v.method_right), count_text(v.reference_right),
                               count_text(v.zero_predicate)});
    }
  }
  std::string html;
  if (!table.rows.empty()) html += table_html(table);
  if (!verdicts.rows.empty()) {
    html +=
        table_html(verdicts) +
        "<p class=\"note\">A tie: the line of sight meets an edge or a corner exactly; the "
        "definition of visibility says how to read it. Where too many pairs differ, an evenly spaced sample of them "
        "is decided.</p>\n";
  }
  return html;
}

/// Nothing if every method answered.
std::string failures_html(const ReportInput& in) {
  ReportTable table{"Methods that gave no answer, and why. Nothing else on this page is about them.",
                    {"Method", "What went wrong"},
                    {}};
  for (const MethodResult& result : in.metrics.methods) {
    if (result.failure) table.rows.push_back({escape_html(result.entry), escape_html(result.failure->message)});
  }
  return table.rows.empty() ? std::string() : table_html(table);
}

std::string seconds_html(const ReportInput& in) {
  const Stats& reference = in.metrics.reference;
  ReportTable table{
      "Seconds: medians of repeated runs on the machine below. Shadow = light + evaluate. A ratio is given "
      "where a method answers the same question as the reference, with as many light samples; elsewhere "
      "the cell says what the reference was asked.",
      {"Method", "Shadow", "against the reference", "Light", "Evaluate", "Mesh (once)", "Warm-up", "Memory"},
      {}};
  const auto row = [&](const std::string& label, const Stats& stats, bool is_best, const std::string& speed) {
    const std::string shadow = seconds_text(stats.seconds.shadow());
    table.rows.push_back({label, is_best ? "<span class=\"best\">" + shadow + "</span>" : shadow, speed,
                          seconds_text(stats.seconds.light), seconds_text(stats.seconds.evaluate),
                          seconds_text(stats.seconds.mesh), seconds_text(stats.seconds.warmup),
                          bytes_text(stats.peak_memory_bytes)});
  };
  const std::string asked = question_of({in.reference.description, reference});
  row(label_html(reference.method, "the reference, " + asked), reference, false, "–");
  const MethodResult* best = smallest(in.metrics.methods, shadow_of);
  for (std::size_t i = 0; i < in.methods.size(); ++i) {
    const MethodResult& result = in.metrics.methods[i];
    if (result.failure) continue;
    const std::string speed =
        same_question(in, in.methods[i], result)
            ? speed_text(shadow_of(result), reference.seconds.shadow())
            : "another question<small>the reference: " + (in.sampled_pixels == 0 ? asked : asked + ", chosen pixels") +
                  "</small>";
    row(label_html(result.entry,
                   fmt::format("{}, {}", question_of({in.methods[i].description, result.stats}), result.stats.device)),
        result.stats, &result == best, speed);
  }
  return table_html(table);
}

std::string details_html(const ReportInput& in) {
  std::string html;
  for (const MethodResult& result : in.metrics.methods) {
    const Stats& stats = result.stats;
    if (stats.passes.empty() && stats.counters.empty()) continue;
    html += "<details><summary>Passes and counters of " + escape_html(result.entry) + "</summary>\n";
    if (!stats.passes.empty()) {
      ReportTable table{"Where the time goes", {"Pass", "Time"}, {}};
      for (const visibility::PassTime& pass : stats.passes) {
        table.rows.push_back({escape_html(pass.name), seconds_text(pass.milliseconds / 1000)});
      }
      html += table_html(table);
    }
    if (!stats.counters.empty()) {
      ReportTable table{"What was counted", {"Counter", "Count"}, {}};
      for (const auto& [name, count] : stats.counters) table.rows.push_back({escape_html(name), count_text(count)});
      html += table_html(table);
    }
    html += "</details>\n";
  }
  return html;
}

}  // namespace

bool same_question(const ReportInput& in, const ReportEntry& entry, const MethodResult& result) {
  return compare::same_question({entry.description, result.stats}, {in.reference.description, in.metrics.reference},
                                in.sampled_pixels != 0);
}

std::string label_html(const std::string& name, const std::string& small) {
  return escape_html(name) + (small.empty() ? "" : "<small>" + escape_html(small) + "</small>");
}

std::optional<double> rmse_of(const MethodResult& result) {
  return result.error ? std::optional(result.error->rmse) : std::nullopt;
}
std::optional<double> shadow_of(const MethodResult& result) {
  return result.stats.seconds.shadow();
}

std::string number_tables_html(const ReportInput& in) {
  return failures_html(in) + errors_html(in) + pairs_html(in) + seconds_html(in) + details_html(in);
}

}  // namespace penumbra::compare
