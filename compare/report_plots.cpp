// Plots errors against seconds for the report.

#include "compare/report_plots.hpp"

#include "compare/error_plot.hpp"
#include "compare/report_parts.hpp"
#include "compare/report_tables.hpp"

#include <fmt/format.h>

namespace penumbra::compare {

std::string error_against_time_html(const ReportInput& in) {
  ErrorPlot plot;
  for (std::size_t i = 0; i < in.methods.size(); ++i) {
    const MethodResult& result = in.metrics.methods[i];
    const auto rmse = rmse_of(result), shadow = shadow_of(result);
    if (!rmse || !shadow || *shadow <= 0) continue;
    plot.marks.push_back({result.entry,
                          fmt::format("{}: RMSE {}, {}", result.entry, error_text(*rmse), seconds_text(*shadow)),
                          visibility::name_of(in.methods[i].description.family), *shadow, *rmse});
  }
  if (plot.marks.empty()) return {};
  if (in.metrics.same_samples && in.metrics.same_samples->all_lights_error) {
    plot.level = {in.metrics.same_samples->all_lights_error->rmse,
                  fmt::format("what {} light samples cost", in.metrics.same_samples->stats.light_samples)};
  }
  if (in.lights.size() > 1) plot.across += " of all lights";
  std::string html = "<h3>Error against time</h3>\n<div class=\"wide\">" +
                     error_plot_svg(plot,
                                    "role=\"img\" aria-label=\"Error of V against time, one mark a method; the tables "
                                    "below have the numbers\"") +
                     "</div>\n"
                     "<details><summary>How to read the plot</summary>\n<p class=\"note\">Further down is closer to "
                     "the reference, further left is faster; both scales "
                     "step by tens. Circles are geometry-based methods, squares image-based ones, diamonds references.";
  if (plot.level && plot.level->rmse >= kNoError) {
    html += fmt::format(
        " The dashed line is how far rays on the methods’ own {} light samples are from the reference: a method with a "
        "mask can be as exact as can be and yet come no lower, and it is no fault of its own.",
        in.metrics.same_samples->stats.light_samples);
  }
  return html + "</p></details>\n";
}

}  // namespace penumbra::compare
