// Writes the report's pictures.

#include "compare/report_gallery.hpp"

#include "compare/report_data.hpp"
#include "compare/report_parts.hpp"
#include "compare/report_tables.hpp"

#include <fmt/format.h>

#include <optional>

namespace penumbra::compare {
namespace {

/// Entry of the gallery: the reference, rays on the methods' light samples, or a method.
struct Shown {
  const ReportEntry& entry;
  std::string label, note;                 ///< plain text
  const std::vector<LightResult>* lights;  ///< nullptr for the reference
  std::optional<std::size_t> place;        ///< index in the script's data
};

std::vector<Shown> shown_entries(const ReportInput& in) {
  const bool has_data = !report_data_is_empty(in);
  std::size_t next = 0;
  const auto place = [&](const ReportEntry& entry) {
    return has_data && has_packed_numbers(entry) ? std::optional(next++) : std::nullopt;
  };
  std::vector<Shown> all{{in.reference, in.metrics.reference.method, "the reference", nullptr, place(in.reference)}};
  if (in.rays) {
    const SampleCost& cost = *in.metrics.same_samples;
    all.push_back({*in.rays, rays_label(in), "on the methods’ light samples", &cost.lights, place(*in.rays)});
  }
  for (std::size_t i = 0; i < in.methods.size(); ++i) {
    const MethodResult& result = in.metrics.methods[i];
    all.push_back(
        {in.methods[i], result.entry,
         fmt::format("{}, {}", visibility::name_of(in.methods[i].description.family), seconds_text(shadow_of(result))),
         &result.lights, place(in.methods[i])});
  }
  return all;
}

std::string caption_html(const std::string& label, const std::string& note) {
  return "<b>" + escape_html(label) + "</b>" + (note.empty() ? "" : "<span>" + escape_html(note) + "</span>");
}

std::string beauties_html(const std::vector<Shown>& entries) {
  std::string html;
  for (const Shown& shown : entries) {
    if (!shown.entry.beauty) continue;
    html += figure_html(*shown.entry.beauty, "Beauty by " + shown.label, caption_html(shown.label, shown.note),
                        {"beauty", shown.place, 0});
  }
  return html;
}

std::string visibilities_html(const std::vector<Shown>& entries, std::size_t light) {
  std::string html;
  for (const Shown& shown : entries) {
    if (light >= shown.entry.lights.size() || !shown.entry.lights[light].visibility) continue;
    html +=
        figure_html(*shown.entry.lights[light].visibility, "V by " + shown.label,
                    caption_html(shown.label, shown.lights == nullptr ? shown.note : ""), {"v", shown.place, light});
  }
  return html;
}

std::string errors_html(const std::vector<Shown>& entries, std::size_t light) {
  std::string html;
  for (const Shown& shown : entries) {
    if (light >= shown.entry.lights.size() || !shown.entry.lights[light].error) continue;
    std::string caption = "no judged pixel";
    if (shown.lights != nullptr && light < shown.lights->size() && (*shown.lights)[light].error) {
      const VisibilityError& error = *(*shown.lights)[light].error;
      caption = fmt::format("RMSE {}, largest {}", error_text(error.rmse), error_text(error.max));
    }
    html += figure_html(*shown.entry.lights[light].error, "Signed error of V by " + shown.label + ": " + caption,
                        caption_html(shown.label, caption), {"error", shown.place, light});
  }
  return html;
}

}  // namespace

std::string gallery_html(const ReportInput& in) {
  const std::vector<Shown> entries = shown_entries(in);
  std::string html =
      "<p class=\"note\">Click a picture to enlarge it, click again to "
      "go back.</p>\n";
  if (!report_data_is_empty(in)) {
    html =
        "<noscript><p>This page’s script paints the pictures. Without it, look at the .exr and -error.png files beside "
        "this page.</p></noscript>\n<p class=\"note\">Click a picture to look closely.</p>\n<p "
        "class=\"open-viewer\"><button type=\"button\" "
        "data-open=\"wipe\" hidden>Wipe between two</button><button type=\"button\" data-open=\"all\" hidden>All side "
        "by side, with one zoom</button></p>\n";
  }
  const std::string beauties = beauties_html(entries);
  if (!beauties.empty()) {
    html += fmt::format(
        "<h3>Beauty</h3>\n<p>The shaded picture, by each method. All are exposed alike (linear colours × {:.3g}).</p>\n"
        "<div class=\"gallery\">{}</div>\n",
        in.exposure, beauties);
  }
  for (std::size_t light = 0; light < in.lights.size(); ++light) {
    const std::string under =
        in.lights.size() > 1 ? fmt::format(" under light “{}”", escape_html(in.lights[light].name)) : "";
    const std::string visibilities = visibilities_html(entries, light), errors = errors_html(entries, light);
    if (!visibilities.empty()) {
      html += "<h3>V: how much of the light is seen" + under + "</h3>\n" +
              (light == 0 ? visibility_legend_html() : "") + "<div class=\"gallery\">" + visibilities + "</div>\n";
    }
    if (!errors.empty()) {
      html += "<h3>Where each method is wrong" + under + "</h3>\n" +
              (light == 0 ? error_legend_html(in.error_limit) : "") + "<div class=\"gallery\">" + errors + "</div>\n";
    }
  }
  return folded_section_html("pictures", "All pictures", html);
}

std::string first_look_html(const ReportInput& in) {
  const Shown *best = nullptr, *worst = nullptr;
  double least = 0, most = 0;
  const std::vector<Shown> entries = shown_entries(in);
  for (const Shown& shown : entries) {
    if (shown.lights == nullptr || &shown.entry == (in.rays ? &*in.rays : nullptr) || !shown.place) continue;
    if (shown.lights->empty() || !shown.lights->front().error) continue;
    const double rmse = shown.lights->front().error->rmse;
    if (best == nullptr || rmse < least) {
      best = &shown;
      least = rmse;
    }
    if (worst == nullptr || rmse > most) {
      worst = &shown;
      most = rmse;
    }
  }
  if (best == nullptr) return {};
  const auto name = [](const Shown& shown, double rmse) {
    return fmt::format("<b>{}</b>, RMSE {}", escape_html(shown.label), error_text(rmse));
  };
  const bool alone = best == worst;
  const Shown& beside = alone ? entries.front() : *best;
  const std::string under =
      in.lights.size() > 1 ? fmt::format(" under light “{}”", escape_html(in.lights.front().name)) : "";
  return fmt::format(
      R"html(<section id="look" class="first-look" hidden data-left="{0}" data-right="{1}">
<canvas width="{2}" height="{3}" role="img" aria-label="V{4} by {5} on the left of the line, by {6} on the right"></canvas>
<div><h2>{7}</h2>
<p>V, how much of the light each point sees{4}: on the left of the line {8}; on the right {9}.</p>
<p><label>Line <input type="range" min="0" max="100" value="50"></label>
<button type="button">Look closely</button></p></div></section>
)html",
      *worst->place, *beside.place, in.metrics.reference.width, in.metrics.reference.height, under,
      escape_html(worst->label), escape_html(beside.label),
      alone ? "The method beside the reference" : "The worst beside the best", name(*worst, most),
      alone ? "<b>" + escape_html(beside.label) + "</b>, the reference" : name(*best, least));
}

}  // namespace penumbra::compare
