#include "compare/error_picture.hpp"
#include "compare/report.hpp"
#include "compare/report_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace penumbra::compare {
namespace {

std::size_t occurrences(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

Image8 picture(std::uint8_t value) {
  return {2, 2, std::vector<Color8>(4, {value, value, value})};
}

MethodResult result_of(const std::string& entry) {
  MethodResult result;
  result.entry = entry;
  result.stats.scene = "bunny.json";
  result.stats.method = entry;
  result.stats.device = "llvmpipe";
  result.stats.width = result.stats.height = 512;
  result.stats.light_samples = 256;
  result.stats.sample_pattern = "rows";
  result.stats.seconds.light = 0.5;
  result.stats.seconds.evaluate = 1.5;
  result.stats.passes = {{"test & count", 1234.0}};
  result.stats.counters = {{"candidates", 1234567}};
  result.error = VisibilityError{0.0012, 0.0034, 0.05, 0.5, 0.001, -0.0002};
  return result;
}

ReportInput input_with(std::size_t method_count) {
  ReportInput in;
  in.version = "1.2.3";
  in.arguments = {"compare", "scenes/my scene.json", "-o", "out"};
  in.scene = {{"Triangles", "69 666"}};
  in.metrics.reference = result_of("raytrace").stats;
  in.metrics.reference.seconds.evaluate = 3.5;
  in.metrics.judged_pixels = 200000;
  in.reference.description.name = "raytrace";
  in.reference.beauty = in.reference.visibility = picture(10);
  for (std::size_t i = 0; i < method_count; ++i) {
    in.metrics.methods.push_back(result_of("method-" + std::to_string(i)));
    ReportEntry entry;
    entry.description.name = "method-" + std::to_string(i);
    entry.beauty = entry.visibility = entry.error = picture(static_cast<std::uint8_t>(20 + i));
    in.methods.push_back(entry);
  }
  in.light = "key";
  in.error_limit = 0.5;
  return in;
}

/// The first tag that is not closed where it should be; "" if all are.
std::string unbalanced_tag(const std::string& html) {
  const std::vector<std::string> kVoid{"meta", "img", "input", "br", "!DOCTYPE"};
  std::vector<std::string> open;
  std::size_t at = 0;
  while ((at = html.find('<', at)) != std::string::npos) {
    const std::size_t end = html.find('>', at);
    if (end == std::string::npos) return html.substr(at, 40);
    const bool closing = html[at + 1] == '/';
    const std::size_t first = at + (closing ? 2 : 1);
    const std::string name = html.substr(first, html.find_first_of(" />\n", first) - first);
    const bool alone = html[end - 1] == '/' || std::find(kVoid.begin(), kVoid.end(), name) != kVoid.end();
    if (closing) {
      if (open.empty() || open.back() != name) return "/" + name;
      open.pop_back();
    } else if (!alone) {
      open.push_back(name);
    }
    at = end + 1;
  }
  return open.empty() ? "" : open.back();
}

TEST(Report, IsOneWellFormedPageWithoutScriptsOrNetwork) {
  for (const std::size_t count : {0u, 1u, 2u, 8u}) {
    const std::string html = report_html(input_with(count));
    EXPECT_EQ(unbalanced_tag(html), "") << count;
    EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
    for (const char* word : {"<script", "http:", "https:", "@import", "<link", "<iframe"}) {
      EXPECT_EQ(html.find(word), std::string::npos) << word;
    }
    EXPECT_EQ(occurrences(html, "url("), occurrences(html, "url(#"));
    EXPECT_EQ(occurrences(html, "src=\""), occurrences(html, "src=\"data:image/png;base64,"));
    // Beauty and V of the reference, its beauty once more as the scene's picture, three a method.
    EXPECT_EQ(occurrences(html, "<img "), 3 + 3 * count);
    EXPECT_EQ(occurrences(html, "<img alt=\""), occurrences(html, "<img "));
    EXPECT_EQ(occurrences(html, "<img alt=\"\""), 0u);
    EXPECT_EQ(occurrences(html, "<th>"), 0u) << "each table header says whether it is a row's or a column's";
  }
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
  in.metrics.methods[0].pairs = PairCounts{67108864, 12345678, 37};
  in.metrics.methods[0].verdicts = PairVerdicts{37, 31, 6, 5};
  in.metrics.methods[0].horizon_error = VisibilityError{0.25, 0.3125, 0.5, 0.625, 0.75, 0.0625};
  in.metrics.methods[0].beauty_error = BeautyError{0.0625, 0.03125};
  in.metrics.horizon_pixels = 4321;
  const std::string html = report_html(in);
  for (const char* text : {"<td>0.0012</td>",
                           "0.0034</span></td>",
                           "<td>0.5</td>",
                           "<td>0.1 %</td>",
                           "<td>−0.0002</td>",
                           "<td>6.25 %</td>",  // error
                           "<td>0.25</td>",
                           "<td>+0.0625</td>",
                           "4\u202f321 horizon pixels",  // horizon's row
                           "<td>37</td>",
                           "<td>67\u202f108\u202f864</td>",
                           "<td>12\u202f345\u202f678</td>",
                           "<td>31</td>",            // pairs
                           "<td>2.00× faster</td>",  // 4 s of the reference against 2 s
                           "<td>500 ms</td>",
                           "1.5 s",
                           "<td>1\u202f234\u202f567</td>",
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
  EXPECT_NE(report_html(in).find("another question<small>the reference: 1024 light samples</small>"),
            std::string::npos);
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

TEST(Report, ErrorScaleHasNumbers) {
  const std::string legend = error_legend_html(0.2);
  for (const char* text : {">−0.2<", ">−0.05<", ">−0.0125<", ">0<", ">+0.0125<", ">+0.05<", ">+0.2<"}) {
    EXPECT_NE(legend.find(text), std::string::npos) << text;
  }
  // A quarter of the limit stands half way along its arm.
  EXPECT_NE(legend.find("left:75.0%\">+0.05<"), std::string::npos) << legend;
}

TEST(Report, MissingThingsAreLeftOut) {
  ReportInput in = input_with(2);
  in.reference.beauty.reset();
  in.methods[0].error.reset();
  in.methods[1].beauty.reset();
  in.metrics.methods[0].error.reset();
  in.metrics.methods[1].stats.seconds = {};
  const std::string html = report_html(in);
  EXPECT_EQ(unbalanced_tag(html), "");
  EXPECT_EQ(occurrences(html, "<img "), 1 + 2 + 2u);
  EXPECT_EQ(html.find("id=\"warnings\""), std::string::npos);
  EXPECT_EQ(html.find("Who is right"), std::string::npos);
}

TEST(Report, EscapesEverythingThatCameFromOutside) {
  const std::string evil = "<script>alert(\"1\")</script>'&{}";
  ReportInput in = input_with(1);
  in.version = in.light = evil;
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
  in.metrics.methods[0].horizon_error = VisibilityError{};
  in.metrics.methods[0].pairs = PairCounts{};
  in.metrics.methods[0].verdicts = PairVerdicts{};
  in.methods[0].description.paper = in.methods[0].description.exact_for = evil;
  const std::string html = report_html(in);
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("alert(\""), std::string::npos);
  EXPECT_EQ(unbalanced_tag(html), "");
}

TEST(Report, SaysEachWarningOnce) {
  ReportInput in = input_with(3);
  in.warnings = {"2 faces skipped"};
  for (MethodResult& result : in.metrics.methods) result.stats.warnings = {"2 faces skipped", "of " + result.entry};
  const std::string html = report_html(in);
  EXPECT_EQ(occurrences(html, "2 faces skipped"), 1u);
  EXPECT_EQ(occurrences(html, "<li>"), 4u);
}

TEST(ReportText, Numbers) {
  EXPECT_EQ(count_text(7), "7");
  EXPECT_EQ(count_text(1000), "1\u202f000");
  EXPECT_EQ(count_text(123456), "123\u202f456");
  EXPECT_EQ(seconds_text(std::nullopt), "–");
  EXPECT_EQ(seconds_text(0.0), "0");
  EXPECT_EQ(seconds_text(0.0000123), "12.3 µs");
  EXPECT_EQ(seconds_text(0.0123), "12.3 ms");
  EXPECT_EQ(seconds_text(0.9996), "1 s");
  EXPECT_EQ(seconds_text(1.234), "1.23 s");
  EXPECT_EQ(seconds_text(1234.5), "1234 s");
  EXPECT_EQ(bytes_text(512), "512 bytes");
  EXPECT_EQ(bytes_text(12 * 1024 * 1024 + 300 * 1024), "12.3 MiB");
  EXPECT_EQ(speed_text(1.0, 2.1), "2.10× faster");
  EXPECT_EQ(speed_text(3.0, 1.0), "3.00× slower");
  EXPECT_EQ(speed_text(1.0, 1.0), "as fast");
  EXPECT_EQ(speed_text(0.01, 1.5), "150× faster");
  EXPECT_EQ(speed_text(0.0, 1.0), "–");
  EXPECT_EQ(signed_text(-0.0), "0");
}

TEST(ReportText, ShellQuoting) {
  EXPECT_EQ(shell_text(std::vector<std::string>{"compare", "a b", "it's", "", "k=v", "$x"}),
            R"(compare 'a b' 'it'\''s' '' k=v '$x')");
}

TEST(ReportText, SceneInWords) {
  scenes::Scene scene;
  scene.name = "bunny.json";
  scene.soup.triangles.resize(69668);
  for (int i = 0; i < 10; ++i) scene.objects.emplace_back().name = "o" + std::to_string(i);
  scene.lights = {{"key", scenes::Rectangle{{0.5, 5, 0.5}, {1, 0, 0}, {0, 0, 2}}},
                  {"rim", scenes::Disk{{2, 5, 0}, {0, -1, 0}, 0.4}, {1, 2, 3}, true}};
  scene.cameras = {{"main", {4, 3, 5}, {0, 0.8, 0}, {0, 1, 0}, 45}};
  const auto facts = describe_scene(scene, 0);
  ASSERT_EQ(facts.size(), 7u);
  EXPECT_EQ(facts[1].value, "69\u202f668");
  EXPECT_EQ(facts[2].value, "o0, o1, o2, o3, o4, o5, o6, o7 and 2 more");
  EXPECT_EQ(facts[3].value, "a rectangle of 2 × 4 at (0.5, 5, 0.5), radiance (10, 10, 10)");
  EXPECT_EQ(facts[4].value, "a disk of radius 0.4 at (2, 5, 0), radiance (1, 2, 3), from both sides");
  EXPECT_EQ(facts[5].value, "at (4, 3, 5), looking at (0, 0.8, 0), 45° high");
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
