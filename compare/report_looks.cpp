// Writes the report's tables of errors by class of pixel and of perceived errors.

#include "compare/report_looks.hpp"

#include "compare/report_parts.hpp"
#include "compare/report_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace penumbra::compare {
namespace {

/// Error over `pixels` pixels, under this name.
struct Part {
  std::string name;
  std::uint64_t pixels;
  const std::optional<VisibilityError>& error;
};

std::vector<Part> parts_of(const std::vector<ClassError>& classes) {
  std::vector<Part> parts;
  for (const ClassError& one : classes) parts.push_back({one.name, one.pixels, one.error});
  return parts;
}

std::vector<Part> parts_of(const std::vector<RangeError>& ranges) {
  std::vector<Part> parts;
  for (const RangeError& one : ranges) {
    const std::string name =
        std::isfinite(one.to) ? fmt::format("{} … {}", one.from, one.to) : fmt::format("from {}", one.from);
    parts.push_back({name, one.pixels, one.error});
  }
  return parts;
}

/// Returns a table with one row for each method that has parts. Where all methods have the same pixels, the headers
/// have their number.
template <typename PartsOf>
std::string parts_html(const ReportInput& in, std::size_t light, std::string caption, bool same_pixels,
                       const PartsOf& all_of) {
  ReportTable table{std::move(caption), {"Method"}, {}};
  for (const MethodResult& result : in.metrics.methods) {
    if (light >= result.lights.size()) continue;
    const std::vector<Part> parts = parts_of(all_of(result.lights[light]));
    if (parts.empty()) continue;
    if (table.headers.size() == 1) {
      for (const Part& part : parts)
        table.headers.push_back(same_pixels ? fmt::format("{} ({})", part.name, count_text(part.pixels)) : part.name);
    }
    std::vector<ReportCell> row = {label_html(result.entry, "")};
    for (const Part& part : parts) {
      if (!part.error) {
        row.emplace_back("–");
        continue;
      }
      const std::string pixels = same_pixels ? "" : fmt::format(" of {}", count_text(part.pixels));
      row.emplace_back(fmt::format("{:.4f} ({:+.4f}){}", part.error->rmse, part.error->bias, pixels), part.error->rmse);
    }
    table.rows.push_back(std::move(row));
  }
  return table.rows.empty() ? std::string() : table_html(table);
}

std::string eye_html(const ReportInput& in, std::size_t light, const std::string& under) {
  ReportTable table{
      "What an eye sees" + under +
          ": the share of judged pixels off by more than 1/255; steps between neighbours in the penumbra "
          "that the reference does not have (banding and noise, RMS); and FLIP of the beauty, 0 to 1, for "
          "a screen .7 m wide with 3840 pixels, .7 m away.",
      {"Method", "Off by over 1/255", "Banding"},
      {}};
  const bool with_flip = light == 0;
  if (with_flip) table.headers.insert(table.headers.end(), {"FLIP", "FLIP at most"});
  for (const MethodResult& result : in.metrics.methods) {
    if (light >= result.lights.size() || !result.lights[light].eye) continue;
    const EyeError& eye = *result.lights[light].eye;
    std::vector<ReportCell> row = {label_html(result.entry, ""), {percent_text(eye.over255), eye.over255}};
    row.push_back(eye.banding ? ReportCell(error_text(*eye.banding), eye.banding) : "–");
    if (with_flip) {
      row.push_back(result.flip ? ReportCell(error_text(result.flip->mean), result.flip->mean) : "–");
      row.push_back(result.flip ? ReportCell(error_text(result.flip->max), result.flip->max) : "–");
    }
    table.rows.push_back(std::move(row));
  }
  return table.rows.empty() ? std::string() : table_html(table);
}

std::string separation_html(const ReportInput& in) {
  ReportTable table{
      "What separation costs the beauty of methods that know V alone: V · ∫G in place of ∫G V. RMSE of the luminance "
      "of "
      "judged pixels, relative to its mean: of the method; of what separation alone does to the reference’s own V; of "
      "the errors of V alone; and by how much the method's RMSE changes when separation alone is repaired.",
      {"Method", "Beauty", "Separation alone", "Errors of V alone", "Change without separation"},
      {}};
  const auto cell = [](double share) { return ReportCell(percent_text(share), share); };
  for (const MethodResult& result : in.metrics.methods) {
    if (!result.separation || !result.beauty_error) continue;
    const double whole = result.beauty_error->relative_rmse, of_v = result.separation->of_v.relative_rmse;
    table.rows.push_back({label_html(result.entry, ""),
                          cell(whole),
                          cell(result.separation->alone.relative_rmse),
                          cell(of_v),
                          {signed_text(of_v - whole), of_v - whole}});
  }
  return table.rows.empty() ? std::string() : table_html(table);
}

}  // namespace

std::string classes_html(const ReportInput& in, std::size_t light, const std::string& under) {
  const std::string rmse = "RMSE of V" + under;
  return parts_html(
             in, light,
             rmse +
                 " by what happens at the pixel: all, some or none of the light is seen; another object hides "
                 "some of it (cast), or the one that is seen does (self). + is too bright.",
             true, [](const LightResult& result) -> const auto& { return result.classes; }) +
         parts_html(
             in, light, rmse + " in penumbrae, by how many pixels wide they are there.", true,
             [](const LightResult& result) -> const auto& { return result.by_width; }) +
         parts_html(
             in, light, rmse + " in penumbrae, by how many texels of the method's map wide they are there.", false,
             [](const LightResult& result) -> const auto& { return result.by_texels; }) +
         parts_html(
             in, light, rmse + " in shadows, by how many pixels away the nearest is that hides some of the light.",
             true, [](const LightResult& result) -> const auto& { return result.by_contact; });
}

std::string looks_html(const ReportInput& in) {
  std::string html;
  for (std::size_t light = 0; light < in.lights.size(); ++light) {
    const std::string under = in.lights.size() > 1 ? " under light “" + escape_html(in.lights[light].name) + "”" : "";
    html += eye_html(in, light, under);
  }
  return html + separation_html(in);
}

}  // namespace penumbra::compare
