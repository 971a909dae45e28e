// SPDX-License-Identifier: Apache-2.0
#include "compare/report.hpp"

#include "tests/report_json.hpp"
#include "tests/unit/compare/report_inputs.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::compare {
namespace {

TEST(Report, IsOneWellFormedPageWithoutNetwork) {
  for (const std::size_t count : {0u, 1u, 8u}) {
    for (const ReportInput& in : {input_with(count), touchable_input(count)}) {
      const std::string html = report_html(in);
      EXPECT_EQ(unbalanced_tag(html), "") << count;
      EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
      for (const char* word : {"https:", "href=\"http", "@import", "<link", "<iframe", " onclick", "eval(", "Function(",
                               "fetch(", "import(", "innerHTML"}) {
        EXPECT_EQ(html.find(word), std::string::npos) << word;
      }
      EXPECT_NE(html.find("default-src 'none'; img-src data:;"), std::string::npos);
      EXPECT_EQ(occurrences(html, "url("), occurrences(html, "url(#"));
      EXPECT_EQ(occurrences(html, "src=\""), 0u);
      // One script runs; the others hold data.
      EXPECT_EQ(occurrences(html, "<script>"), 1u);
      EXPECT_NE(html.find("<noscript>"), std::string::npos);
    }
  }
}

/// The script draws tables and plots from what metrics.json has, to the last digit.
TEST(Report, HasAllOfMetricsJson) {
  ReportInput in = touchable_input(2, 2);
  in.metrics.methods[0].lights[1].same_samples =
      SameSamples{VisibilityError{.rmse = 0.0078125}, {67108864, 12345678, 37}, {37, 31, 6, 5}};
  in.metrics.methods[1].failure = MethodFailure{4, "out of memory"};
  EXPECT_EQ(tests::report_json(report_html(in)).at("metrics"), nlohmann::json(to_json(in.metrics)));
}

/// The page describes the run next to the numbers.
TEST(Report, DescribesSceneMethodsAndMachine) {
  ReportInput in = touchable_input(2);
  in.sampled_pixels = 400;
  in.warnings = {"2 faces skipped"};
  in.machine = {.processor = "a processor", .threads = 2, .memory_bytes = 1U << 30, .operating_system = "a system"};
  in.methods[1].description.paper = "Somebody 2005";
  in.methods[1].description.on_request = true;
  in.methods[1].description.options = {
      {.name = "size", .least = 1, .most = 4096, .whole = true, .default_value = "1024", .help = "texels <across>"}};
  in.methods[1].lights[0].budget_pictures.push_back({"layers", picture(7)});
  const auto data = tests::report_json(report_html(in));
  EXPECT_EQ(data.at("version"), "1.2.3");
  EXPECT_EQ(data.at("command"), "compare 'scenes/my scene.json' -o out");
  EXPECT_EQ(data.at("view"), "view 'scenes/my scene.json'");
  EXPECT_EQ(data.at("scene").dump(), R"([["Triangles","69 666"]])");
  EXPECT_EQ(data.at("machine").dump(),
            R"({"memoryBytes":1073741824,"processor":"a processor","system":"a system","threads":2})");
  EXPECT_EQ(data.at("warnings").dump(), R"(["2 faces skipped"])");
  EXPECT_EQ(data.at("sampledPixels"), 400);
  const auto& method = data.at("methods").at(1);
  EXPECT_EQ(method.at("paper"), "Somebody 2005");
  EXPECT_EQ(method.at("onRequest"), true);
  EXPECT_EQ(method.at("question"), "256 light samples");
  EXPECT_EQ(method.at("options").dump(),
            R"([{"default":"1024","help":"texels <across>","name":"size","values":"1 … 4096"}])");
  EXPECT_EQ(method.at("repairs").at(0).at(0).at("repaired"), "layers");
  EXPECT_TRUE(method["repairs"][0][0].at("png").get<std::string>().starts_with("data:image/png;base64,"));
}

/// The page has the data for its script, by name, for every entry and light, but none for a method that failed.
TEST(Report, CarriesTheNumbersOfEachPicture) {
  ReportInput in = touchable_input(3, 2);
  in.methods[1] = {};
  in.metrics.methods[1].failure = MethodFailure{4, "out of memory"};
  in.methods[2].lights[1].packed_masks.clear();
  const std::string html = report_html(in);
  EXPECT_EQ(unbalanced_tag(html), "");
  const auto data = tests::report_json(html);
  EXPECT_EQ(data.at("width"), 2);
  ASSERT_EQ(data.at("lights").size(), 2u);
  EXPECT_EQ(data["lights"][1].at("name"), "light 1");
  EXPECT_EQ(data["lights"][1].at("samples").dump(), "[[-0.5,-0.5],[0.5,-0.5],[-0.5,0.5],[0.5,0.5]]");
  ASSERT_EQ(data.at("entries").size(), 3u);
  EXPECT_EQ(data["entries"][0].at("role"), "reference");
  EXPECT_EQ(data["entries"][2].at("role"), "method");
  EXPECT_EQ(data["entries"][2].at("method"), 2);
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
}

/// Seconds are compared only between methods that answer the same question as the reference.
TEST(Report, SaysWhichMethodsWereAskedWhatTheReferenceWas) {
  const auto same = [](const ReportInput& in) {
    return tests::report_json(report_html(in)).at("methods").at(0).at("sameQuestion").get<bool>();
  };
  using enum visibility::Output;
  ReportInput in = input_with(1);
  EXPECT_TRUE(same(in));
  in.metrics.reference.light_samples = 1024;
  EXPECT_FALSE(same(in));
  EXPECT_EQ(tests::report_json(report_html(in)).at("reference").at("question"), "1024 light samples");
  in.metrics.reference.light_samples = 256;
  in.metrics.reference.sample_pattern = "sobol";
  EXPECT_FALSE(same(in));
  in.metrics.reference.sample_pattern = "rows";
  for (const visibility::Output output : {scalar, radiance}) {
    in.methods[0].description.output = output;
    EXPECT_FALSE(same(in)) << visibility::name_of(output);
  }
  in.reference.description.output = radiance;  // both give areas: light samples do not matter
  in.metrics.reference.light_samples = 1;
  EXPECT_TRUE(same(in));
  in.sampled_pixels = 2000;  // the reference may be sampled at some pixels only
  EXPECT_FALSE(same(in));
  in.metrics.methods[0].stats.method = in.metrics.reference.method;
  EXPECT_TRUE(same(in));
}

TEST(Report, HasNoPicturesWithoutTheReferences) {
  ReportInput in = touchable_input(2);
  in.reference.lights[0].packed_visibility.clear();
  const std::string html = report_html(in);
  EXPECT_TRUE(tests::report_json(html).at("entries").empty());
  EXPECT_EQ(tests::report_json(html).at("methods").size(), 2u);
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
  EXPECT_EQ(tests::report_json(html).at("lights").at(1).at("name"), evil);
  EXPECT_EQ(tests::report_json(html).at("metrics").at("methods").at(1).at("failure").at("message"), evil);
  // The text is in the title, and outside the JSON nowhere else.
  EXPECT_EQ(occurrences(html, "alert(&quot;1&quot;)"), 1u);
  EXPECT_EQ(unbalanced_tag(html), "");
}

/// A reference that looked at other points than the methods has masks that cannot be compared with theirs.
TEST(Report, LeavesOutTheReferencesMasksWhereRaysHaveTheMethods) {
  ReportInput in = touchable_input(1);
  EXPECT_FALSE(tests::report_json(report_html(in))["entries"][0]["lights"][0]["masks"].is_null());
  in.rays = in.reference;
  in.metrics.same_samples.emplace().lights = in.metrics.methods[0].lights;
  const auto data = tests::report_json(report_html(in));
  EXPECT_TRUE(data["entries"][0]["lights"][0]["masks"].is_null());
  EXPECT_FALSE(data["entries"][1]["lights"][0]["masks"].is_null());
}

/// Exact methods give the same numbers: the page holds them once.
TEST(Report, CarriesEqualNumbersOnce) {
  const std::string html = report_html(touchable_input(3));
  EXPECT_EQ(occurrences(html, ">Vg==<"), 1u);
  const auto data = tests::report_json(html);
  EXPECT_EQ(data["entries"][1]["lights"][0]["v"], data["entries"][3]["lights"][0]["v"]);
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
