// Writes the report's tables of numbers.

#include "compare/report_tables.hpp"

#include "compare/question.hpp"
#include "compare/report_budget.hpp"
#include "compare/report_looks.hpp"
#include "compare/report_parts.hpp"
#include "compare/report_plots.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra::compare {
namespace {

void add_error_cells(std::vector<ReportCell>& row, const std::optional<VisibilityError>& error, bool is_best) {
  if (!error) {
    row.insert(row.end(), 6, "–");
    return;
  }
  const auto best = [&](const std::string& text) {
    return is_best ? "<span class=\"best\">" + text + "</span>" : text;
  };
  row.insert(row.end(), {{error_text(error->mean), error->mean},
                         {best(error_text(error->rmse)), error->rmse},
                         {error_text(error->p999), error->p999},
                         {error_text(error->max), error->max},
                         {percent_text(error->over05), error->over05},
                         {signed_text(error->bias), error->bias}});
}

/// Writes an entry's name, linked to the page's description of its method.
std::string method_link_html(const MethodResult& result) {
  return fmt::format("<a href=\"#{}\">{}</a>", method_place(result.stats.method), escape_html(result.entry));
}

/// Scope of a table of errors: one light, or all together.
struct ErrorRows {
  std::string caption;
  std::optional<VisibilityError> (*error_of)(const MethodResult& result, std::size_t light);
  std::size_t light = 0;
  bool with_beauty = false;
  std::optional<VisibilityError> rays = {};  ///< error due to the methods' light samples
};

std::string errors_table_html(const ReportInput& in, const ErrorRows& rows) {
  ReportTable table{
      rows.caption, {"Method", "Mean", "RMSE", "99.9 % within", "Largest", "Off by over 0.05", "Bias"}, {}};
  if (rows.with_beauty) table.headers.emplace_back("RMSE of the beauty");
  std::optional<double> best;
  for (const MethodResult& result : in.metrics.methods) {
    const auto error = rows.error_of(result, rows.light);
    if (error && (!best || error->rmse < *best)) best = error->rmse;
  }
  const auto add = [&](std::string label, const std::optional<VisibilityError>& error, bool may_be_best) {
    std::vector<ReportCell> row{std::move(label)};
    add_error_cells(row, error, may_be_best && error && error_text(error->rmse) == error_text(*best));
    table.rows.push_back(std::move(row));
  };
  for (const MethodResult& result : in.metrics.methods) {
    if (result.failure) continue;
    add(method_link_html(result), rows.error_of(result, rows.light), true);
    if (!rows.with_beauty) continue;
    const auto& beauty = result.beauty_error;
    table.rows.back().push_back(beauty ? ReportCell(percent_text(beauty->relative_rmse), beauty->relative_rmse) : "–");
  }
  if (rows.rays) {
    add(label_html("rays on the same light samples", rays_label(in) + ": the cost of that number of light samples"),
        rows.rays, false);
    if (rows.with_beauty) table.rows.back().emplace_back("–");
  }
  return table_html(table);
}

std::optional<VisibilityError> error_under(const MethodResult& result, std::size_t light) {
  return light < result.lights.size() ? result.lights[light].error : std::nullopt;
}

std::optional<VisibilityError> horizon_error_under(const MethodResult& result, std::size_t light) {
  return light < result.lights.size() ? result.lights[light].horizon_error : std::nullopt;
}

/// Returns a result with the numbers of judged and horizon pixels under a light: the same for all methods.
const LightResult* pixels_under(const ReportInput& in, std::size_t light) {
  for (const MethodResult& result : in.metrics.methods) {
    if (light < result.lights.size()) return &result.lights[light];
  }
  return nullptr;
}

/// Writes the errors over the whole picture, and those of parts of the picture.
struct ErrorTables {
  std::string whole, parts;
};

ErrorTables errors_html(const ReportInput& in) {
  const std::string against = "Error of V against " + escape_html(in.metrics.reference.method);
  const bool several = in.lights.size() > 1;
  const SampleCost* cost = in.metrics.same_samples ? &*in.metrics.same_samples : nullptr;
  const auto cost_under = [&](std::size_t light) {
    return cost != nullptr && light < cost->lights.size() ? cost->lights[light].error : std::nullopt;
  };
  std::string html = "<h3>Errors</h3>\n", each, classes, horizon;
  if (several) {
    html += errors_table_html(in, {against + " under all lights together. 0 would be perfect.",
                                   [](const MethodResult& result, std::size_t) { return result.all_lights_error; }, 0,
                                   true, cost != nullptr ? cost->all_lights_error : std::nullopt});
  }
  for (std::size_t light = 0; light < in.lights.size(); ++light) {
    const LightResult* pixels = pixels_under(in, light);
    if (pixels == nullptr) continue;
    const std::string under = several ? " under light “" + escape_html(in.lights[light].name) + "”" : "";
    (several ? each : html) +=
        errors_table_html(in, {against + under + ". 0 would be perfect. " + count_text(pixels->judged_pixels) +
                                   " judged pixels, " + count_text(pixels->horizon_pixels) + " horizon pixels.",
                               error_under, light, !several, cost_under(light)});
    classes += classes_html(in, light, under);
    if (pixels->horizon_pixels == 0) continue;
    horizon +=
        errors_table_html(in, {against + under + " at " + count_text(pixels->horizon_pixels) + " horizon pixels.",
                               horizon_error_under, light});
  }
  return {html, folded_html("Errors under each light", each) + folded_html("Errors by class of pixel", classes) +
                    folded_html("Errors to the eye", looks_html(in)) + folded_html("Errors at the horizon", horizon)};
}

/// Exactness: comparison pair by pair with rays on the same light samples.
std::string pairs_html(const ReportInput& in) {
  const auto share = [](std::uint64_t part, std::uint64_t whole) -> ReportCell {
    if (whole == 0) return "–";
    const double value = static_cast<double>(part) / static_cast<double>(whole);
    return {fmt::format("{:.2g}", value), value};
  };
  const auto count = [](std::uint64_t number) { return ReportCell(count_text(number), static_cast<double>(number)); };
  std::string html;
  for (std::size_t light = 0; light < in.lights.size(); ++light) {
    const std::string under =
        in.lights.size() > 1 ? " Under light “" + escape_html(in.lights[light].name) + "”." : std::string();
    ReportTable table{
        "On how many (view sample, light sample) pairs does a method answer other than " + escape_html(rays_label(in)) +
            ", the same ones?" + under,
        {"Method", "Differing pairs", "of all pairs", "share", "of pairs in penumbrae", "share", "RMSE of V"},
        {}};
    ReportTable verdicts{
        "Who is right where they differ? Decided by exact arithmetic, which does not round." + under,
        {"Method", "Pairs decided", "of those that differ", "Method right", "Rays right", "Ties read by rule"},
        {}};
    for (const MethodResult& result : in.metrics.methods) {
      if (light >= result.lights.size() || !result.lights[light].same_samples) continue;
      const auto& [error, pairs, v] = *result.lights[light].same_samples;
      table.rows.push_back({escape_html(result.entry), count(pairs.differing), count(pairs.all),
                            share(pairs.differing, pairs.all), count(pairs.penumbra),
                            share(pairs.differing, pairs.penumbra),
                            error ? ReportCell(error_text(error->rmse), error->rmse) : "–"});
      if (v.decided == 0) continue;
      verdicts.rows.push_back({escape_html(result.entry),
                               count(v.decided),
                               {percent_text(decided_share(pairs, v)), decided_share(pairs, v)},
                               count(v.method_right),
                               count(v.reference_right),
                               count(v.zero_predicate)});
    }
    if (!table.rows.empty()) html += table_html(table);
    if (!verdicts.rows.empty()) html += table_html(verdicts);
  }
  if (html.empty()) return html;
  return html +
         "<p class=\"note\">Methods with a mask are held against rays on their own light samples, so that equal is "
         "compared with equal. A tie: the line of sight meets an edge or a corner exactly; the definition of "
         "visibility "
         "says how to read it. Where too many pairs differ, an evenly spaced sample of them is decided.</p>\n";
}

/// Returns an empty text if every method succeeded.
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
  const std::string asked = question_of({in.reference.description, reference});
  bool has_ratios = false;
  for (std::size_t i = 0; i < in.methods.size(); ++i) {
    const MethodResult& result = in.metrics.methods[i];
    has_ratios = has_ratios || (!result.failure && same_question(in, in.methods[i], result));
  }
  ReportTable table{
      "Seconds on the machine below; of repeated runs the median. Shadow = light + evaluate. Passes are kinds of work, "
      "each timed. " +
          (has_ratios
               ? std::string("A ratio is given where a method answers the same question as the reference, with as "
                             "many light samples.")
               : "There are no ratios to the reference, which was asked another question: " + asked +
                     (in.sampled_pixels == 0 ? "." : ", chosen pixels.")),
      {"Method", "Shadow", "against the reference", "Light", "Evaluate", "Mesh (once)", "Warm-up", "Memory", "Passes"},
      {}};
  const auto seconds_cell = [](const std::optional<double>& seconds) {
    return ReportCell(seconds_text(seconds), seconds);
  };
  const auto row = [&](const std::string& label, const Stats& stats, bool is_best, const std::string& speed) {
    const auto shadow = stats.seconds.shadow();
    ReportCell cell = seconds_cell(shadow);
    if (is_best) cell.html = "<span class=\"best\">" + cell.html + "</span>";
    const auto of_reference = reference.seconds.shadow();
    const bool has_ratio = shadow && of_reference && *shadow > 0 && speed.find("×") != std::string::npos;
    table.rows.push_back({label,
                          cell,
                          {speed, has_ratio ? std::optional(*of_reference / *shadow) : std::nullopt},
                          seconds_cell(stats.seconds.light),
                          seconds_cell(stats.seconds.evaluate),
                          seconds_cell(stats.seconds.mesh),
                          seconds_cell(stats.seconds.warmup),
                          {bytes_text(stats.peak_memory_bytes), static_cast<double>(stats.peak_memory_bytes)},
                          {count_text(stats.passes.size()), static_cast<double>(stats.passes.size())}});
  };
  row(label_html(reference.method, "the reference, " + asked), reference, false, "–");
  const std::vector<const MethodResult*> best =
      smallest(in.metrics.methods, shadow_of, [](double seconds) { return seconds_text(seconds); });
  for (std::size_t i = 0; i < in.methods.size(); ++i) {
    const MethodResult& result = in.metrics.methods[i];
    if (result.failure) continue;
    const std::string speed =
        same_question(in, in.methods[i], result) ? speed_text(shadow_of(result), reference.seconds.shadow()) : "–";
    // Most methods run on one device, which is named in the machine's facts.
    const bool elsewhere = result.stats.device != in.metrics.methods.front().stats.device;
    row(label_html(result.entry, question_of({in.methods[i].description, result.stats}) +
                                     (elsewhere ? ", " + result.stats.device : std::string())),
        result.stats, std::ranges::find(best, &result) != best.end(), speed);
  }
  if (!has_ratios) {
    table.headers.erase(table.headers.begin() + 2);
    for (auto& cells : table.rows) cells.erase(cells.begin() + 2);
  }
  return table_html(table);
}

std::string details_html(const ReportInput& in) {
  std::string html;
  for (const MethodResult& result : in.metrics.methods) {
    const Stats& stats = result.stats;
    if (stats.passes.empty() && stats.counters.empty()) continue;
    std::string tables;
    if (!stats.passes.empty()) {
      ReportTable table{"Where the time goes", {"Pass", "Time"}, {}};
      for (const visibility::PassTime& pass : stats.passes) {
        table.rows.push_back(
            {escape_html(pass.name), {seconds_text(pass.milliseconds / 1000), pass.milliseconds / 1000}});
      }
      tables += table_html(table);
    }
    if (!stats.counters.empty()) {
      ReportTable table{"What was counted", {"Counter", "Count"}, {}};
      for (const auto& [name, count] : stats.counters) {
        table.rows.push_back({escape_html(name), {count_text(count), static_cast<double>(count)}});
      }
      tables += table_html(table);
    }
    html += folded_html("Passes and counters of " + escape_html(result.entry), tables);
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

std::vector<const MethodResult*> smallest(const std::vector<MethodResult>& results, NumberOf number_of,
                                          TextOf text_of) {
  std::optional<double> best;
  for (const MethodResult& result : results) {
    const auto number = number_of(result);
    if (number && (!best || *number < *best)) best = number;
  }
  std::vector<const MethodResult*> tied;
  for (const MethodResult& result : results) {
    const auto number = number_of(result);
    if (number && text_of(*number) == text_of(*best)) tied.push_back(&result);
  }
  return tied;
}

std::string rays_label(const ReportInput& in) {
  const Stats& rays = in.metrics.same_samples ? in.metrics.same_samples->stats : in.metrics.reference;
  return fmt::format("{}, {} light samples", rays.method, rays.light_samples);
}

std::optional<double> rmse_of(const MethodResult& result) {
  return result.all_lights_error ? std::optional(result.all_lights_error->rmse) : std::nullopt;
}
std::optional<double> shadow_of(const MethodResult& result) {
  return result.stats.seconds.shadow();
}

std::string number_tables_html(const ReportInput& in) {
  const ErrorTables errors = errors_html(in);
  return failures_html(in) + error_against_time_html(in) + errors.whole + error_budget_html(in) +
         folded_html("More numbers: errors of parts of the picture, time, exactness pair by pair, passes",
                     errors.parts + folded_html("Time", seconds_html(in)) +
                         folded_html("Exactness, pair by pair", pairs_html(in)) +
                         folded_html("Passes and counters", details_html(in)));
}

}  // namespace penumbra::compare
