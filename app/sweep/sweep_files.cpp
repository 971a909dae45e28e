// SPDX-License-Identifier: Apache-2.0
// Writes sweeps as JSON, CSV and SVG.

#include "app/sweep/sweep_files.hpp"

#include "base/csv.hpp"
#include "compare/error_plot.hpp"
#include "compare/report_text.hpp"
#include "session/methods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace penumbra::app {
namespace {

using Json = nlohmann::ordered_json;

template <typename Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

template <typename Map>
Json object_of(const Map& map) {
  Json json = Json::object();
  for (const auto& [key, value] : map) json[key] = value;
  return json;
}

/// Returns the value of a swept key in a row; empty if the method has no such option.
std::string value_of(const SweepRow& row, const std::string& key) {
  if (const auto light = row.light.find(key); light != row.light.end()) return light->second;
  const auto& options = row.result.stats.options;
  const auto option = options.find(key);
  return option != options.end() ? option->second : std::string();
}

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.9g}", *value) : std::string();
}

/// Returns "light.half=0.5"; empty for the scene's own lights.
std::string name_of(const std::map<std::string, std::string>& light) {
  std::string name;
  for (const auto& [key, value] : light) name += fmt::format("{}{}={}", name.empty() ? "" : ", ", key, value);
  return name;
}

constexpr const char* kStyle =
    "<style>text{font:12px sans-serif;fill:#222;paint-order:stroke;stroke:#fff;stroke-width:4px}.axis{fill:#666}"
    ".grid{stroke:#ddd}.frame{stroke:#888;fill:none}.leader{stroke:#999;fill:none}.geometry{fill:#1f77b4}"
    ".image{fill:#d1580b}.reference{fill:#222}.title{font-size:15px}</style>\n";

/// Returns a plot of the rows of one size of the lights, each method's rows joined; the method's name is at its last
/// mark.
std::string drawing(std::span<const SweepRow> rows) {
  compare::ErrorPlot plot;
  std::map<std::string, std::vector<std::size_t>> marks;
  for (const SweepRow& row : rows) {
    const auto& error = row.result.all_lights_error;
    const auto seconds = row.result.stats.seconds.shadow();
    if (!error || !seconds || *seconds <= 0) continue;
    marks[row.result.stats.method].push_back(plot.marks.size());
    plot.marks.push_back({{},
                          fmt::format("{}: RMSE {:.3g}, {:.3g} s", row.result.entry, error->rmse, *seconds),
                          visibility::name_of(session::describe_method(row.result.stats.method).family),
                          *seconds,
                          error->rmse});
  }
  for (const auto& [method, line] : marks) {
    plot.marks[line.back()].name = method;
    plot.lines.push_back(line);
  }
  return compare::error_plot_svg(plot, "width=\"860\" height=\"420\" y=\"30\"");
}

}  // namespace

Json sweep_json(const Sweep& sweep) {
  Json over = Json::object(), rows = Json::array(), summaries = Json::array();
  for (const SweptKey& key : sweep.over) over[key.name] = key.values;
  for (const SweepRow& row : sweep.rows) {
    const compare::Stats& stats = row.result.stats;
    const auto& error = row.result.all_lights_error;
    Json entry = {{"method", stats.method},
                  {"entry", row.result.entry},
                  {"options", object_of(stats.options)},
                  {"light", object_of(row.light)},
                  {"lightSamples", stats.light_samples},
                  {"seconds",
                   {{"light", or_null(stats.seconds.light)},
                    {"evaluate", or_null(stats.seconds.evaluate)},
                    {"shadow", or_null(stats.seconds.shadow())}}},
                  {"runs", stats.runs},
                  {"peakMemoryBytes", stats.peak_memory_bytes}};
    entry["error"] = error ? Json{{"mean", error->mean}, {"rmse", error->rmse},     {"p999", error->p999},
                                  {"max", error->max},   {"over05", error->over05}, {"bias", error->bias}}
                           : Json();
    entry["pareto"] = row.on_hull;
    const auto& failure = row.result.failure;
    entry["failure"] = failure ? Json{{"exitCode", failure->exit_code}, {"message", failure->message}} : Json();
    rows.push_back(std::move(entry));
  }
  for (const SweepSummary& summary : sweep.summaries) {
    Json to = Json::object();
    for (const SecondsTo& one : summary.to) {
      to[fmt::format("1/{:.0f}", 1 / one.rmse)] =
          one.seconds ? Json{{"seconds", *one.seconds}, {"entry", one.entry}} : Json();
    }
    summaries.push_back({{"method", summary.method}, {"light", object_of(summary.light)}, {"secondsTo", to}});
  }
  return {{"scene", sweep.reference.scene},
          {"size", {sweep.reference.width, sweep.reference.height}},
          {"triangles", sweep.reference.triangles},
          {"reference",
           {{"method", sweep.reference.method},
            {"options", object_of(sweep.reference.options)},
            {"lightSamples", sweep.reference.light_samples},
            {"device", sweep.reference.device}}},
          {"over", over},
          {"rows", rows},
          {"methods", summaries}};
}

std::string sweep_csv(const Sweep& sweep) {
  std::vector<std::string> keys;
  for (const SweptKey& key : sweep.over) {
    if (key.name != "light-samples") keys.push_back(key.name);
  }
  std::string csv = "method,entry";
  for (const std::string& key : keys) csv += "," + csv_field(key);
  csv +=
      ",lightSamples,rmse,mean,p999,max,bias,lightSeconds,evaluateSeconds,shadowSeconds,runs,peakMemoryBytes,"
      "pareto\r\n";
  for (const SweepRow& row : sweep.rows) {
    const compare::Stats& stats = row.result.stats;
    csv += csv_field(stats.method) + "," + csv_field(row.result.entry);
    for (const std::string& key : keys) csv += "," + csv_field(value_of(row, key));
    csv += fmt::format(",{}", stats.light_samples);
    const auto& error = row.result.all_lights_error;
    for (const auto part :
         {&compare::VisibilityError::rmse, &compare::VisibilityError::mean, &compare::VisibilityError::p999,
          &compare::VisibilityError::max, &compare::VisibilityError::bias})
      csv += "," + number(error ? std::optional((*error).*part) : std::nullopt);
    csv += fmt::format(",{},{},{},{},{},{}\r\n", number(stats.seconds.light), number(stats.seconds.evaluate),
                       number(stats.seconds.shadow()), stats.runs, stats.peak_memory_bytes, row.on_hull ? 1 : 0);
  }
  return csv;
}

std::string sweep_svg(const Sweep& sweep) {
  std::string drawings;
  int count = 0;
  for (auto first = sweep.rows.begin(); first != sweep.rows.end(); ++count) {
    const auto end =
        std::find_if(first, sweep.rows.end(), [&](const SweepRow& row) { return row.light != first->light; });
    const std::string light = name_of(first->light);
    drawings += fmt::format(
        "<g transform=\"translate(0 {})\"><text class=\"title\" x=\"64\" y=\"22\">{}{}{}</text>\n{}</g>\n", 460 * count,
        compare::escape_html(sweep.reference.scene), light.empty() ? "" : ", ", light, drawing(std::span(first, end)));
    first = end;
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 860 {0}\" width=\"860\" height=\"{0}\">\n{1}<rect "
      "width=\"860\" "
      "height=\"{0}\" fill=\"#fff\"/>\n{2}</svg>\n",
      460 * std::max(count, 1), kStyle, drawings);
}

}  // namespace penumbra::app
