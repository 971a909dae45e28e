// SPDX-License-Identifier: Apache-2.0
// Tests how the report's page writes numbers, times and scenes.

#include "compare/report.hpp"
#include "compare/report_text.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace penumbra::compare {
namespace {

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
  ASSERT_EQ(facts.size(), 6u);
  EXPECT_EQ(facts[1].value, "69\u202f668");
  EXPECT_EQ(facts[2].value, "o0, o1, o2, o3, o4, o5, o6, o7 and 2 more");
  EXPECT_EQ(facts[3].value, "a rectangle of 2 × 4 at (0.5, 5, 0.5), radiance (10, 10, 10)");
  EXPECT_EQ(facts[4].value, "a disk of radius 0.4 at (2, 5, 0), radiance (1, 2, 3), from both sides");
  EXPECT_EQ(facts[5].value, "at (4, 3, 5), looking at (0, 0.8, 0), 45° high");
}

}  // namespace
}  // namespace penumbra::compare
