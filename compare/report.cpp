// Assembles the report: one self-contained HTML page.

#include "compare/report.hpp"

#include "base/assert.hpp"
#include "base/atomic_file.hpp"
#include "compare/question.hpp"
#include "compare/report_data.hpp"
#include "compare/report_gallery.hpp"
#include "compare/report_parts.hpp"
#include "compare/report_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

namespace penumbra::compare {
namespace {

/// Returns the light samples of the reference in words. `same`: suffix if the samples are those of the methods.
std::string samples_of_reference(const ReportInput& in, const char* same) {
  const bool mask = in.reference.description.output == visibility::Output::mask;
  return question_of({in.reference.description, in.metrics.reference}) + (mask && in.same_samples ? same : "");
}

std::string options_text(const visibility::MethodOptions& options) {
  std::string text;
  for (const auto& [key, value] : options) text += fmt::format("{}{}={}", text.empty() ? "" : ", ", key, value);
  return text;
}

std::string facts_html(const std::vector<ReportFact>& facts) {
  std::string html = "<div class=\"scroll\"><table class=\"facts\"><tbody>\n";
  for (const ReportFact& fact : facts) {
    html +=
        fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape_html(fact.name), escape_html(fact.value));
  }
  return html + "</tbody></table></div>\n";
}

/// Lists the first few entries, and how many more there are.
std::string names_text(const std::vector<const MethodResult*>& results) {
  constexpr std::size_t kNamed = 3;
  std::string text;
  for (std::size_t i = 0; i < results.size() && i < kNamed; ++i) text += (i == 0 ? "" : ", ") + results[i]->entry;
  return results.size() > kNamed ? fmt::format("{} and {} more", text, results.size() - kNamed) : text;
}

/// Writes a card that names the methods that answer every pair as rays do, or else the ones with the fewest
/// differences.
template <typename Card>
std::string exactness_card(const ReportInput& in, const Card& card) {
  struct Sum {
    const MethodResult* result;
    PairCounts pairs;
  };
  std::vector<Sum> sums;
  for (const MethodResult& result : in.metrics.methods) {
    Sum sum{&result, {}};
    for (const LightResult& light : result.lights) {
      if (light.same_samples) sum.pairs += light.same_samples->pairs;
    }
    if (sum.pairs.all > 0) sums.push_back(sum);
  }
  if (sums.empty()) return {};
  const std::uint64_t fewest =
      std::ranges::min(sums, {}, [](const Sum& s) { return s.pairs.differing; }).pairs.differing;
  std::vector<const MethodResult*> tied;
  std::uint64_t all = 0;
  for (const Sum& sum : sums) {
    if (sum.pairs.differing != fewest) continue;
    tied.push_back(sum.result);
    all = sum.pairs.all;
  }
  return card("Most exact", names_text(tied),
              fmt::format("{} of {} answers differ from rays on the same light samples",
                          fewest == 0 ? "none" : count_text(fewest), count_text(all)));
}

std::string glance_html(const ReportInput& in) {
  const auto card = [](std::string_view title, const std::string& name, const std::string& text) {
    return fmt::format("<div><dt>{}</dt><dd><b>{}</b><br>{}</dd></div>\n", title, escape_html(name), text);
  };
  const Stats& reference = in.metrics.reference;
  std::string html = "<dl class=\"glance\">\n";
  const auto closest = smallest(in.metrics.methods, rmse_of, error_text);
  if (!closest.empty()) {
    const VisibilityError& error = *closest.front()->all_lights_error;
    html += card("Closest to the reference", names_text(closest),
                 fmt::format("{}V is off by {} on average (RMSE {})", closest.size() > 1 ? "a tie: " : "",
                             error_text(error.mean), error_text(error.rmse)));
  }
  html += exactness_card(in, card);
  const auto fastest = smallest(in.metrics.methods, shadow_of, [](double seconds) { return seconds_text(seconds); });
  if (!fastest.empty()) {
    const MethodResult* best = fastest.front();
    const ReportEntry& entry = in.methods[static_cast<std::size_t>(best - in.metrics.methods.data())];
    const std::string speed =
        same_question(in, entry, *best) ? speed_text(shadow_of(*best), reference.seconds.shadow()) : std::string("–");
    html +=
        card("Least time", names_text(fastest),
             fmt::format(
                 "{}{} for the shadow, {}{}", fastest.size() > 1 ? "a tie: " : "", seconds_text(shadow_of(*best)),
                 question_of({entry.description, best->stats}),
                 speed == "–" ? "" : fmt::format(": {} {} the reference", speed, speed == "as fast" ? "as" : "than")));
  }
  html += card("Judged by", reference.method,
               fmt::format("{}, {} for the shadow", samples_of_reference(in, ", the same as the methods’"),
                           seconds_text(reference.seconds.shadow())));
  html += card("Compared on", in.metrics.reference.scene,
               fmt::format("{} × {} pixels, {} of them judged", reference.width, reference.height,
                           count_text(in.metrics.judged_pixels)));
  return html + "</dl>\n";
}

std::string question_html(const ReportInput& in) {
  std::uint32_t samples = 0;  // stays 0 if all methods compute areas
  for (const MethodResult& method : in.metrics.methods) samples = std::max(samples, method.stats.light_samples);
  std::string html = R"(<div class="two"><div>
<p>A lamp with a size casts soft shadows: a point behind an object sees none of the lamp, a point beside it sees all,
and between the two lies a band that sees a part. So the question, asked at every point that the picture shows, is:
<strong>how much of the light does it see?</strong> The answer is a number <var>V</var> between 0 (nothing) and 1 (all
of it). Get <var>V</var> right, and the shadow is right.</p>
)";
  html += fmt::format(
      "<p>Each pixel of the picture became one point of the scene, and every method below was asked about the very "
      "same points. {}The methods differ in how they find out what stands between, and so in speed and in the mistakes "
      "they make. <strong>{}</strong> served as the reference; {}.</p>\n",
      samples == 0 ? ""
                   : fmt::format("Those that look for points of the light (not every method does) looked for the "
                                 "very same {}. ",
                                 count_text(samples)),
      escape_html(in.metrics.reference.method),
      in.lights.size() == 1
          ? "the light in question is “" + escape_html(in.lights.front().name) + "”"
          : fmt::format("each of the scene’s {} lights is judged by itself, and all together", in.lights.size()));
  if (in.same_samples && in.reference.description.output == visibility::Output::mask) {
    html +=
        "<p>The reference looked for the same points of the light, so that every single answer can be compared, not "
        "only "
        "their sums.</p>\n";
  } else if (in.reference.description.output != visibility::Output::mask) {
    html += "<p>The reference needs no points of the light: it measures the area that is visible.</p>\n";
  } else {
    html += fmt::format(
        "<p>The reference looked for {} points of the light. Its own V is an estimate too, in steps of 1/{}: errors "
        "of about that size belong to both sides.{}</p>\n",
        count_text(in.metrics.reference.light_samples), in.metrics.reference.light_samples,
        in.metrics.same_samples ? " So methods that look for points are also compared with rays to their own points, "
                                  "answer by answer."
                                : "");
  }
  return folded_section_html("question", "What is asked",
                             html + "</div><div class=\"wide\">" + shadow_drawing_html() + "</div></div>\n");
}

std::string scene_html(const ReportInput& in) {
  std::string html = "<div class=\"two\"><div>" + facts_html(in.scene) + "</div><div>";
  if (in.reference.beauty) {
    html += figure_html(*in.reference.beauty, "The scene " + in.metrics.reference.scene + " as the reference shades it",
                        "<b>" + escape_html(in.metrics.reference.scene) + "</b><span>shaded by the reference, " +
                            escape_html(in.metrics.reference.method) + "</span>");
  }
  return folded_section_html("scene", "The scene", html + "</div></div>\n");
}

/// Describes a method: its place among the page's links, its options and the name of its page.
std::string method_text_html(const visibility::MethodDescription& d) {
  ReportTable options{"Options", {"Option", "Values", "Default", "What it does"}, {}};
  for (const visibility::OptionDescription& option : d.options) {
    options.rows.push_back({escape_html(option.name), escape_html(option.values()), escape_html(option.default_value),
                            escape_html(option.help)});
  }
  return fmt::format(
      "<details id=\"{}\"><summary>{}</summary>\n<p>{}-based; after {}. Exact for {}. Answers with {}.{} "
      "<code>penumbra methods {}</code> says the same; its derivation is in "
      "<code>docs/{}.md</code>.</p>\n{}</details>\n",
      method_place(d.name), escape_html(d.name), visibility::name_of(d.family), escape_html(d.paper),
      escape_html(d.exact_for), visibility::name_of(d.output),
      d.on_request ? " Compared on request alone: it takes long, or is there for others to be held against." : "",
      escape_html(d.name), escape_html(d.name), options.rows.empty() ? "" : table_html(options));
}

std::string methods_html(const ReportInput& in) {
  ReportTable table{"What each method is", {"Method", "Family", "Answers with", "Exact for", "After", "Options"}, {}};
  const auto row = [&](const std::string& label, const visibility::MethodDescription& d,
                       const visibility::MethodOptions& options) {
    const std::string chosen = options_text(options);
    table.rows.push_back({label, visibility::name_of(d.family), visibility::name_of(d.output), escape_html(d.exact_for),
                          escape_html(d.paper), chosen.empty() ? "defaults" : escape_html(chosen)});
  };
  row(label_html(in.metrics.reference.method, "the reference"), in.reference.description, in.metrics.reference.options);
  for (std::size_t i = 0; i < in.methods.size(); ++i) {
    row(escape_html(in.metrics.methods[i].entry), in.methods[i].description, in.metrics.methods[i].stats.options);
  }
  std::string texts;
  std::vector<std::string> told;
  const auto tell = [&](const visibility::MethodDescription& d, const std::string& name) {
    if (std::ranges::find(told, name) != told.end()) return;
    told.push_back(name);
    visibility::MethodDescription named = d;
    named.name = name;
    texts += method_text_html(named);
  };
  for (std::size_t i = 0; i < in.methods.size(); ++i)
    tell(in.methods[i].description, in.metrics.methods[i].stats.method);
  return folded_section_html(
      "methods", "The methods",
      table_html(table) + texts +
          "<p>A method that answers with a mask is shaded light sample by light sample; one that knows only V (scalar) "
          "has "
          "the unshadowed light multiplied by V; one that answers with radiance integrates the light that it sees "
          "itself.</p>\n");
}

std::string machine_html(const ReportInput& in) {
  const Stats& first = in.metrics.methods.empty() ? in.metrics.reference : in.metrics.methods.front().stats;
  const Machine& machine = in.machine;
  std::vector<ReportFact> facts;
  if (!machine.processor.empty()) facts.push_back({"Processor", machine.processor});
  if (machine.threads != 0) facts.push_back({"Hardware threads", std::to_string(machine.threads)});
  if (machine.memory_bytes != 0) facts.push_back({"Memory", bytes_text(machine.memory_bytes)});
  facts.push_back({"Device", first.device});
  if (!machine.operating_system.empty()) facts.push_back({"System", machine.operating_system});
  facts.push_back({"Program", "penumbra " + in.version});
  const auto sampled = std::ranges::find_if(in.metrics.methods,
                                            [](const MethodResult& method) { return method.stats.light_samples != 0; });
  if (sampled != in.metrics.methods.end()) {
    facts.push_back(
        {"Light samples", fmt::format("{}, pattern {}", sampled->stats.light_samples, sampled->stats.sample_pattern)});
  }
  facts.push_back(
      {"Reference", fmt::format("{}, {}", in.metrics.reference.method, samples_of_reference(in, " (the same)"))});
  if (in.sampled_pixels != 0)
    facts.push_back({"Compared pixels", fmt::format("{} chosen ones", count_text(in.sampled_pixels))});
  facts.push_back({"Reading the scene", seconds_text(first.seconds.load)});
  facts.push_back({"View samples", seconds_text(first.seconds.view)});
  return folded_section_html("machine", "Machine and options", facts_html(facts));
}

std::string warnings_html(const ReportInput& in) {
  std::vector<std::string> warnings = in.warnings;
  const auto add = [&](const Stats& stats) {
    warnings.insert(warnings.end(), stats.warnings.begin(), stats.warnings.end());
  };
  add(in.metrics.reference);
  for (const MethodResult& result : in.metrics.methods) add(result.stats);
  // Removes duplicates, in the order of first occurrence: the same remark on the scene comes with every method.
  std::vector<std::string> once;
  for (const std::string& warning : warnings) {
    if (std::find(once.begin(), once.end(), warning) == once.end()) once.push_back(warning);
  }
  if (once.empty()) return {};
  std::string html = "<div class=\"warnings\"><ul>\n";
  for (const std::string& warning : once) html += "<li>" + escape_html(warning) + "</li>\n";
  return folded_section_html("warnings", fmt::format("Warnings: {}", once.size()), html + "</ul></div>\n");
}

}  // namespace

std::string report_html(const ReportInput& in) {
  PENUMBRA_ASSERT(in.methods.size() == in.metrics.methods.size(), "{} entries for {} results", in.methods.size(),
                  in.metrics.methods.size());
  const std::string scene = escape_html(in.metrics.reference.scene);
  const std::size_t count = in.methods.size();
  const std::string warnings = warnings_html(in);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      // The policy forbids any external resource, whatever the page contains: no network, and no text is ever run as a
      // program.
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
      "'unsafe-inline'; script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n";
  html += fmt::format("<title>Soft shadows of {}: {} method{} compared</title>\n<style>", scene, count,
                      count == 1 ? "" : "s");
  html += kReportStyle;
  html += fmt::format(
      "</style>\n</head>\n<body>\n<header>\n<h1>Soft shadows of {}</h1>\n"
      "<p class=\"lead\">How much of the light does each point see? {} method{} answered; {} judged {}.</p>\n",
      scene, count, count == 1 ? "" : "s", escape_html(in.metrics.reference.method), count == 1 ? "it" : "them");
  html += glance_html(in);
  html +=
      "<nav aria-label=\"Sections\"><a href=\"#numbers\">Numbers</a><a href=\"#pictures\">Pictures</a>"
      "<a href=\"#question\">What is asked</a><a href=\"#scene\">The scene</a><a href=\"#methods\">Methods</a>"
      "<a href=\"#machine\">Machine and options</a>";
  if (!warnings.empty()) html += "<a href=\"#warnings\">Warnings</a>";
  html += "<a href=\"#words\">Words</a><a href=\"#again\">Do it again</a></nav>\n</header>\n<main>\n";
  html += first_look_html(in);
  html += "<section id=\"numbers\"><h2>The numbers</h2>\n" + number_tables_html(in) + "</section>\n";
  html += gallery_html(in) + question_html(in) + scene_html(in) + methods_html(in) + machine_html(in) + warnings;
  html += folded_section_html("words", "Words", kReportGlossary);
  html += folded_section_html("again", "Do it again",
                              "<p>In a clone of Penumbra on Debian 12; the first call installs "
                              "what is "
                              "missing and builds:</p>\n<pre>./run.sh " +
                                  escape_html(shell_text(in.arguments)) +
                                  "</pre>\n<p>All numbers of this page, and more, are in <code>metrics.json</code> "
                                  "beside it; the pictures with "
                                  "all "
                                  "their channels in the <code>.exr</code> files.</p>\n");
  html += "</main>\n<footer>Written by penumbra " + escape_html(in.version) + ".</footer>\n";
  if (!report_data_is_empty(in)) html += kReportMarkup;
  html += report_data_html(in) + "<script>\n";
  html += kReportScript;
  return html + "</script>\n</body>\n</html>\n";
}

void write_report(const std::filesystem::path& path, const ReportInput& input) {
  write_file_atomically(path, report_html(input));
}

}  // namespace penumbra::compare
