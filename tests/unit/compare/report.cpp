#include "compare/report.hpp"

#include "tests/unit/compare/report_inputs.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::compare {
namespace {

TEST(Report, IsOneWellFormedPageWithoutNetwork) {
  for (const std::size_t count : {0u, 1u, 2u, 8u}) {
    for (const ReportInput& in : {input_with(count), touchable_input(count)}) {
      const std::string html = report_html(in);
      EXPECT_EQ(unbalanced_tag(html), "") << count;
      EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
      for (const char* word :
           {"http:", "https:", "@import", "<link", "<iframe", " onclick", "eval(", "Function(", "fetch(", "import("}) {
        EXPECT_EQ(html.find(word), std::string::npos) << word;
      }
      EXPECT_NE(html.find("default-src 'none'; img-src data:;"), std::string::npos);
      EXPECT_EQ(occurrences(html, "url("), occurrences(html, "url(#"));
      EXPECT_EQ(occurrences(html, "src=\""), occurrences(html, "src=\"data:image/png;base64,"));
      // Beauty and V of the reference, its beauty once more as the scene's picture, three a method. What the script has
      // the numbers of it paints, and the wipe at the beginning.
      const bool has_numbers = html.find("id=\"report-data\"") != std::string::npos;
      EXPECT_EQ(occurrences(html, "<img "), has_numbers ? 1 : 3 + 3 * count);
      EXPECT_EQ(occurrences(html, "<canvas width="), has_numbers ? 2 + 3 * count + (count > 0 ? 1 : 0) : 0);
      EXPECT_EQ(occurrences(html, "<img alt=\""), occurrences(html, "<img "));
      EXPECT_EQ(occurrences(html, "<img alt=\"\""), 0u);
      EXPECT_EQ(occurrences(html, "<th>"), 0u) << "each table header says whether it is a row's or a column's";
      // One script that runs; the others are data.
      EXPECT_EQ(occurrences(html, "<script>"), 1u);
    }
  }
}

/// What the script works on is there, by name, for every entry and light; a method that failed is not among them.
TEST(Report, CarriesTheNumbersOfEachPicture) {
  ReportInput in = touchable_input(3, 2);
  in.methods[1] = {};
  in.metrics.methods[1].failure = MethodFailure{4, "out of memory"};
  in.methods[2].lights[1].packed_masks.clear();
  const std::string html = report_html(in);
  EXPECT_EQ(unbalanced_tag(html), "");
  const auto data = data_of(html);
  EXPECT_EQ(data.at("width"), 2);
  ASSERT_EQ(data.at("lights").size(), 2u);
  EXPECT_EQ(data["lights"][1].at("name"), "light 1");
  EXPECT_EQ(data["lights"][1].at("samples").dump(), "[[-0.5,-0.5],[0.5,-0.5],[-0.5,0.5],[0.5,0.5]]");
  ASSERT_EQ(data.at("entries").size(), 3u);
  EXPECT_EQ(data["entries"][2].at("label"), "method-2");
  EXPECT_TRUE(data["entries"][2].at("lights").at(1).at("masks").is_null());
  const auto blob = [&](const nlohmann::json& name) {
    const std::string begin = "<script type=\"text/plain\" id=\"" + name.get<std::string>() + "\">";
    EXPECT_EQ(occurrences(html, begin), 1u);
    const std::size_t first = html.find(begin) + begin.size();
    return html.substr(first, html.find('<', first) - first);
  };
  EXPECT_EQ(blob(data["entries"][1]["lights"][1]["v"]), "Vg==");
  EXPECT_EQ(blob(data["entries"][1]["beauty"]), "QkVBVVRZ");
  EXPECT_EQ(blob(data["lights"][0]["classes"]), "Q0xBU1M=");
  // The figure of the last method opens the last entry.
  EXPECT_EQ(occurrences(html, "data-layer=\"error\" data-entry=\"2\" data-light=\"1\""), 1u);
  EXPECT_EQ(occurrences(html, "data-entry=\"3\""), 0u);
}

TEST(Report, JudgesEachLight) {
  ReportInput in = touchable_input(1, 2);
  in.metrics.methods[0].lights[1].error->rmse = 0.0625;
  in.metrics.methods[0].all_lights_error->rmse = 0.0375;
  const std::string html = report_html(in);
  for (const char* text : {"under all lights together", "under light “light 0”", "under light “light 1”", ">0.0625<",
                           ">0.0375<", "each of the scene’s 2 lights is judged by itself"}) {
    EXPECT_NE(html.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(occurrences(html, "<figure>"), 2 + 2 + 5u) << "V of each light, and its error";
}

/// What looks the same is not called better.
TEST(Report, ShowsTiesAsTies) {
  ReportInput in = input_with(3);
  in.metrics.methods[1].all_lights_error->rmse = in.metrics.methods[1].lights[0].error->rmse = 0.00340001;
  in.metrics.methods[2].all_lights_error->rmse = in.metrics.methods[2].lights[0].error->rmse = 0.0035;
  const std::string html = report_html(in);
  EXPECT_NE(html.find("<b>method-0, method-1</b><br>a tie: V is off by"), std::string::npos);
  EXPECT_EQ(occurrences(html, "<span class=\"best\">0.0034</span>"), 2u);
  EXPECT_NE(html.find("<b>method-0, method-1, method-2</b><br>a tie: 2 s for the shadow"), std::string::npos);
}

TEST(Report, DrawsErrorAgainstTimeAndTheBudget) {
  ReportInput in = input_with(2);
  EXPECT_NE(report_html(in).find("Error against time"), std::string::npos);
  EXPECT_EQ(report_html(in).find("Error budget"), std::string::npos) << "nobody asked for it";
  in.metrics.methods[1].all_lights_error->rmse = 0;
  ErrorBudget& budget = in.metrics.methods[0].lights[0].error_budget.emplace();
  budget.rmse = 0.01;
  for (const visibility::ErrorCause cause : visibility::kErrorCauses) budget.parts.push_back({.cause = cause});
  budget.parts[1].rmse = 0.01125;
  budget.parts[2].rmse = 0.0075;
  budget.parts[3].words = "added & not joined";
  budget.together.rmse = 0.005;
  in.methods[0].lights[0].budget_pictures.push_back({"layers", *in.reference.beauty});
  const std::string html = report_html(in);
  EXPECT_EQ(unbalanced_tag(html), "");
  // Half as long as the longest, to the right of the line in the middle.
  EXPECT_NE(html.find(">+0.00125<svg"), std::string::npos);
  EXPECT_NE(html.find("class=\"worse\" x=\"40.0\" y=\"2\" width=\"19.0\""), std::string::npos);
  EXPECT_NE(html.find("class=\"better\" x=\"2.0\" y=\"2\" width=\"38.0\""), std::string::npos);
  EXPECT_NE(html.find("added &amp; not joined"), std::string::npos);
  EXPECT_NE(html.find("<b>layers</b><span>RMSE −0.0025"), std::string::npos);
  EXPECT_NE(html.find("<th scope=\"col\">gaps</th>"), std::string::npos);
  for (MethodResult& result : in.metrics.methods) result.stats.seconds = {};
  EXPECT_EQ(report_html(in).find("Error against time"), std::string::npos);
}

/// Names stay in the drawing, and do not lie on what the light samples cost.
TEST(Report, NamesInErrorAgainstTimeFindAPlace) {
  ReportInput in = input_with(2);
  in.metrics.methods[1].stats.seconds.evaluate = 50;  // so that the first is on the left
  EXPECT_EQ(report_html(in).find("<text text-anchor=\"end\" x="), std::string::npos);
  in.metrics.methods[1].entry = "bitmask:size=128:occluder=patch:fill=diagonal";
  EXPECT_NE(report_html(in).find("<text text-anchor=\"end\" x="), std::string::npos);
}

/// A method that is right to a float's last digit does not push all others into a corner.
TEST(Report, DrawsErrorsBelowAFloatsLastDigitAsNone) {
  ReportInput in = input_with(2);
  in.metrics.methods[1].all_lights_error->rmse = 2.5e-10;
  std::string html = report_html(in);
  EXPECT_NE(html.find("\">0</text>"), std::string::npos);
  EXPECT_EQ(html.find("1e-1"), std::string::npos);
  in.metrics.methods[1].all_lights_error->rmse = 2e-6;
  html = report_html(in);
  EXPECT_EQ(html.find("\">0</text>"), std::string::npos);
  EXPECT_NE(html.find("\">1e-6</text>"), std::string::npos);
  EXPECT_EQ(html.find("0.00000"), std::string::npos);
}

TEST(Report, LinksLeadSomewhere) {
  ReportInput in = input_with(2);
  in.warnings = {"w"};
  const std::string html = report_html(in);
  for (std::size_t at = html.find("href=\"#"); at != std::string::npos; at = html.find("href=\"#", at + 1)) {
    const std::size_t first = at + 7;
    const std::string target = html.substr(first, html.find('"', first) - first);
    EXPECT_EQ(occurrences(html, "id=\"" + target + "\""), 1u) << target;
  }
}

TEST(Report, SaysTheNumbers) {
  ReportInput in = input_with(1);
  in.metrics.methods[0].lights[0].same_samples =
      SameSamples{VisibilityError{.rmse = 0.0078125}, {67108864, 12345678, 37}, {37, 31, 6, 5}};
  in.metrics.methods[0].lights[0].horizon_error = VisibilityError{0.25, 0.3125, 0.5, 0.625, 0.75, 0.0625};
  in.metrics.methods[0].lights[0].horizon_pixels = 4321;
  in.metrics.methods[0].beauty_error = BeautyError{0.0625, 0.03125};
  const std::string html = report_html(in);
  for (const char* text : {">0.0012</td>",
                           "0.0034</span></td>",
                           ">0.5</td>",
                           ">0.1 %</td>",
                           ">−0.0002</td>",
                           ">6.25 %</td>",  // error
                           ">0.25</td>",
                           ">+0.0625</td>",
                           "4\u202f321 horizon pixels",  // horizon's table
                           "<td data-value=\"37\">37</td>",
                           ">67\u202f108\u202f864</td>",
                           ">12\u202f345\u202f678</td>",
                           ">31</td>",
                           ">0.00781</td>",
                           "37 of 67\u202f108\u202f864 answers differ",  // pairs
                           "<td data-value=\"2\">2.00× faster</td>",     // 4 s of the reference against 2 s
                           "<td data-value=\"0.5\">500 ms</td>",
                           "1.5 s",
                           ">1\u202f234\u202f567</td>",
                           "test &amp; count",
                           "./run.sh compare &#39;scenes/my scene.json&#39; -o out",
                           "penumbra 1.2.3"}) {
    EXPECT_NE(html.find(text), std::string::npos) << text;
  }
}

/// The reference took 4 s, the method 2 s: what this says about speed depends on what each was asked.
TEST(Report, GivesASpeedOnlyBetweenAnswersToTheSameQuestion) {
  const auto says_faster = [](const ReportInput& in) {
    const std::string html = report_html(in);
    EXPECT_EQ(unbalanced_tag(html), "");
    // Both in the table and at a glance, or in neither.
    EXPECT_EQ(occurrences(html, "2.00× faster</td>"), occurrences(html, "2.00× faster than the reference"));
    EXPECT_EQ(occurrences(html, "× faster"), 2 * occurrences(html, "× faster</td>"));
    EXPECT_NE(occurrences(html, "× faster</td>"), occurrences(html, "another question"));
    return html.find("× faster") != std::string::npos;
  };
  using enum visibility::Output;
  ReportInput in = input_with(1);
  EXPECT_TRUE(says_faster(in));
  in.metrics.reference.light_samples = 1024;
  EXPECT_FALSE(says_faster(in));
  EXPECT_NE(report_html(in).find("another question: 1024 light samples."), std::string::npos);
  in.metrics.reference.light_samples = 256;
  in.metrics.reference.sample_pattern = "sobol";
  EXPECT_FALSE(says_faster(in));
  in.metrics.reference.sample_pattern = "rows";
  for (const visibility::Output output : {scalar, radiance}) {
    in.methods[0].description.output = output;
    EXPECT_FALSE(says_faster(in)) << visibility::name_of(output);
  }
  in.reference.description.output = radiance;  // both areas: light samples do not matter
  in.metrics.reference.light_samples = 1;
  EXPECT_TRUE(says_faster(in));
  in.sampled_pixels = 2000;  // perhaps only of the reference
  EXPECT_FALSE(says_faster(in));
  in.metrics.methods[0].stats.method = in.metrics.reference.method;
  EXPECT_TRUE(says_faster(in));
}

TEST(Report, MissingThingsAreLeftOut) {
  ReportInput in = input_with(2);
  in.reference.beauty.reset();
  in.methods[0].lights[0].error.reset();
  in.methods[1].beauty.reset();
  in.metrics.methods[0].lights[0].error.reset();
  in.metrics.methods[0].all_lights_error.reset();
  in.metrics.methods[1].stats.seconds = {};
  const std::string html = report_html(in);
  EXPECT_EQ(unbalanced_tag(html), "");
  EXPECT_EQ(occurrences(html, "<img "), 1 + 2 + 2u);
  EXPECT_EQ(html.find("id=\"warnings\""), std::string::npos);
  EXPECT_EQ(html.find("Who is right"), std::string::npos);
}

TEST(Report, EscapesEverythingThatCameFromOutside) {
  const std::string evil = "<script>alert(\"1\")</script>'&{}";
  ReportInput in = touchable_input(2, 2);
  const std::size_t scripts = occurrences(report_html(in), "<script");
  in.version = in.lights[0].name = in.lights[1].name = evil;
  in.arguments = {evil};
  in.scene = {{evil, evil}};
  in.warnings = {evil};
  in.machine.processor = in.machine.operating_system = evil;
  for (Stats* stats : {&in.metrics.reference, &in.metrics.methods[0].stats}) {
    stats->scene = stats->device = stats->method = stats->sample_pattern = evil;
    stats->options = {{evil, evil}};
    stats->passes = {{evil, 1}};
    stats->counters = {{evil, 1}};
    stats->warnings = {evil};
  }
  in.metrics.methods[0].entry = evil;
  in.metrics.methods[0].lights[0].horizon_error = VisibilityError{};
  in.metrics.methods[0].lights[0].horizon_pixels = 1;
  in.metrics.methods[0].lights[0].same_samples = SameSamples{.pairs = {1, 1, 1}, .verdicts = {1, 1, 0, 0}};
  in.metrics.methods[1].failure = MethodFailure{4, evil};
  in.metrics.methods[0].lights[0].error_budget.emplace().parts.push_back(
      {.words = evil, .runs = {{{evil, {{evil, evil}}}, std::nullopt, evil}}});
  in.methods[0].description.paper = in.methods[0].description.exact_for = evil;
  const std::string html = report_html(in);
  EXPECT_EQ(occurrences(html, "<script"), scripts);
  EXPECT_EQ(data_of(html).at("lights").at(1).at("name"), evil);
  EXPECT_EQ(html.find("alert(\""), std::string::npos);
  EXPECT_EQ(unbalanced_tag(html), "");
}

/// Masks of a reference that looked at other points than the methods did are held against none.
TEST(Report, LeavesOutTheReferencesMasksWhereRaysHaveTheMethods) {
  ReportInput in = touchable_input(1);
  EXPECT_FALSE(data_of(report_html(in))["entries"][0]["lights"][0]["masks"].is_null());
  in.rays = in.reference;
  in.metrics.same_samples.emplace().lights = in.metrics.methods[0].lights;
  const auto data = data_of(report_html(in));
  EXPECT_TRUE(data["entries"][0]["lights"][0]["masks"].is_null());
  EXPECT_FALSE(data["entries"][1]["lights"][0]["masks"].is_null());
}

/// Exact methods have the same numbers: the page carries them once.
TEST(Report, CarriesEqualNumbersOnce) {
  const std::string html = report_html(touchable_input(3));
  EXPECT_EQ(occurrences(html, ">Vg==<"), 1u);
  const auto data = data_of(html);
  EXPECT_EQ(data["entries"][1]["lights"][0]["v"], data["entries"][3]["lights"][0]["v"]);
}

/// The page begins with the largest error beside the smallest, whichever way round the methods were asked for.
TEST(Report, BeginsWithTheWorstBesideTheBest) {
  ReportInput in = touchable_input(3);
  in.metrics.methods[1].lights[0].error->rmse = 0.001;
  in.metrics.methods[2].lights[0].error->rmse = 0.25;
  const std::string html = report_html(in);
  EXPECT_NE(html.find("data-left=\"3\" data-right=\"2\""), std::string::npos);
  EXPECT_LT(html.find("id=\"look\""), html.find("id=\"numbers\""));
  EXPECT_LT(html.find("id=\"numbers\""), html.find("id=\"pictures\""));
  EXPECT_NE(html.find("<b>method-2</b>, RMSE 0.25"), std::string::npos);
  // One method alone is beside the reference.
  EXPECT_NE(report_html(touchable_input(1)).find("data-left=\"1\" data-right=\"0\""), std::string::npos);
  EXPECT_EQ(report_html(touchable_input(0)).find("id=\"look\""), std::string::npos);
}

/// A method's name in the table of errors leads to what the method is.
TEST(Report, TellsWhatEachMethodIs) {
  ReportInput in = touchable_input(2);
  in.metrics.methods[0].stats.method = in.metrics.methods[1].stats.method = "pcss";
  in.metrics.methods[1].entry = "pcss:size=64";
  in.methods[0].description.options = {
      {.name = "size", .least = 1, .most = 4096, .whole = true, .default_value = "1024", .help = "texels <across>"}};
  const std::string html = report_html(in);
  EXPECT_EQ(occurrences(html, "id=\"method-pcss\""), 1u);
  EXPECT_NE(html.find("<a href=\"#method-pcss\">pcss:size=64</a>"), std::string::npos);
  EXPECT_NE(html.find("texels &lt;across&gt;"), std::string::npos);
}

TEST(Report, SaysEachWarningOnce) {
  ReportInput in = input_with(3);
  in.warnings = {"2 faces skipped"};
  for (MethodResult& result : in.metrics.methods) result.stats.warnings = {"2 faces skipped", "of " + result.entry};
  const std::string html = report_html(in);
  EXPECT_EQ(occurrences(html, "2 faces skipped"), 1u);
  EXPECT_EQ(occurrences(html, "<li>"), 4u);
}

TEST(Report, FileIsTheWholePage) {
  const auto path = std::filesystem::path(testing::TempDir()) / "penumbra_report_test.html";
  const ReportInput in = input_with(1);
  write_report(path, in);
  EXPECT_EQ(std::filesystem::file_size(path), report_html(in).size());
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace penumbra::compare
