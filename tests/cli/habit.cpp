// SPDX-License-Identifier: Apache-2.0
// Tests commands that users of other command-line tools type first: help, version, one method, completions, manual
// pages, threads.
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

using Habit = ProgramTest;

std::string head(const std::string& text, const std::string& end) {
  return text.substr(0, text.find(end));
}

TEST_F(Habit, HelpAndVersionAreCommandsToo) {
  EXPECT_EQ(run({"help"}).out, run({"--help"}).out);
  EXPECT_EQ(run({"help", "wedges"}).out, run({"wedges", "--help"}).out);
  EXPECT_EQ(run({"version"}).out, run({"--version"}).out);
  EXPECT_EQ(run({"-V"}).out, run({"--version"}).out);
  const Outcome wrong = run({"help", "rendr"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean render?"));
}

TEST_F(Habit, HelpListsOptionsInGroupsWithDefaultsInOneForm) {
  const std::string help = run({"render", "--help"}).out;
  std::size_t last = 0;
  for (const char* group :
       {"\nArguments:\n", "\nInput:\n", "\nLight:\n", "\nPicture:\n", "\nMethod:\n", "\nOutput:\n"}) {
    const std::size_t at = help.find(group);
    ASSERT_NE(at, std::string::npos) << group;
    EXPECT_GT(at, last) << group;
    last = at;
  }
  EXPECT_LT(help.find("--light-samples"), help.find("\nPicture:\n"));
  EXPECT_GT(help.find("--png"), help.find("\nOutput:\n"));
  for (const char* command :
       {"render", "compare", "sweep", "inspect", "convert", "wedges", "submit", "devices", "methods"}) {
    const std::string text = run({"help", command}).out;
    EXPECT_THAT(text, Not(HasSubstr("(default "))) << command << ": the form is (default: X)";
    EXPECT_THAT(text, Not(testing::ContainsRegex("--[a-z-]+ [A-Z|]+=[a-z0-9]"))) << command;
  }
}

TEST_F(Habit, OneMethodIsShownWhole) {
  const Outcome outcome = run({"methods", "pcss"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(testing::StartsWith("pcss\n"), HasSubstr("docs/pcss.md"), HasSubstr("size=8 … 16384"),
                                 HasSubstr("--method pcss")));
  EXPECT_THAT(outcome.out, Not(HasSubstr("edge-scatter")));
  const json two = json::parse(run({"methods", "pcss", "exact", "--json"}).out).at("methods");
  ASSERT_EQ(two.size(), 2u);
  EXPECT_THAT(run({"methods", "pcs"}).err, HasSubstr("pcss"));
  EXPECT_EQ(run({"methods", "pcs"}).code, 2);
}

TEST_F(Habit, EveryMethodHasThePageThatItNames) {
  const json methods = json::parse(run({"methods", "--json"}).out).at("methods");
  for (const json& method : methods) {
    const std::string page = std::string(PENUMBRA_SCENES) + "/../docs/" + method.at("name").get<std::string>() + ".md";
    EXPECT_TRUE(std::filesystem::exists(page)) << page;
  }
}

/// Each shell runs its own script, if it is installed.
TEST_F(Habit, ShellsCompleteCommandsOptionsAndMethods) {
  const Outcome script = run({"completion", "bash"});
  ASSERT_EQ(script.code, 0) << script.err;
  write("bash", script.out + R"(
complete_it() { COMP_WORDS=("$@"); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _penumbra; echo "${COMPREPLY[*]}"; }
complete_it penumbra ren
complete_it penumbra render --light-s
complete_it penumbra render a.obj --method edge-s
complete_it penumbra methods view-sample-p
complete_it penumbra help insp
complete_it penumbra --quiet render --pixel-f
)");
  const std::string command = "bash --norc --noprofile " + path("bash") + " > " + path("out") + " 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << read("out");
  EXPECT_EQ(read("out"), "render\n--light-samples\nedge-scatter\nview-sample-planar\ninspect\n--pixel-filter\n");
  for (const char* shell : {"zsh", "fish"}) {
    const Outcome other = run({"completion", shell});
    ASSERT_EQ(other.code, 0) << other.err;
    EXPECT_THAT(other.out, AllOf(HasSubstr("light-samples"), HasSubstr("edge-scatter"), HasSubstr("inspect")));
    write(shell, other.out);
    const std::string there = std::string("command -v ") + shell + " > /dev/null 2>&1";
    const std::string check = std::string(shell) + " -n " + path(shell) + " > " + path("said") + " 2>&1";
    if (std::system(there.c_str()) == 0) {
      EXPECT_EQ(std::system(check.c_str()), 0) << shell << ": " << read("said");
    }
  }
  EXPECT_EQ(run({"completion", "csh"}).code, 2);
}

TEST_F(Habit, ManualPagesSayWhatHelpSays) {
  const Outcome page = run({"man", "render"});
  ASSERT_EQ(page.code, 0) << page.err;
  EXPECT_THAT(page.out, AllOf(testing::StartsWith(".TH PENUMBRA-RENDER 1"), HasSubstr(".SS Light\n"),
                              HasSubstr("\\fB\\-\\-light\\-samples\\fR \\fIN|LxB\\fR"), HasSubstr(".SH EXIT STATUS")));
  EXPECT_THAT(run({"man"}).out, AllOf(HasSubstr(".SH COMMANDS"), HasSubstr("\\fBinspect\\fR"), HasSubstr("-V")));
  for (const char* const command : {"render", "compare", "inspect", "bake"}) {
    // A line that begins with a dot is a request: only requests of man(7) may occur.
    const std::string text = run({"man", command}).out;
    for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
      if (text[at] == '.') {
        EXPECT_THAT(head(text.substr(at), "\n"), testing::MatchesRegex("\\.(TH|SH|SS|TP|br|nf|fi)( .*)?"));
      }
      if (text.find('\n', at) == std::string::npos) break;
    }
  }
  EXPECT_EQ(run({"man", "nothing"}).code, 2);
}

TEST_F(Habit, ThreadsChangeNoByte) {
  tiny_scene();
  for (const char* threads : {"1", "2"}) {
    const Outcome outcome = run({"--threads", threads, "render", path("scene.json"), "-o",
                                 path(std::string(threads) + ".exr"), "--size", "32x32"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  EXPECT_EQ(read("1.exr"), read("2.exr"));
  EXPECT_EQ(run({"render", path("scene.json"), "-o", path("3.exr"), "--size", "8x8", "--threads", "2"}).code, 0);
  EXPECT_EQ(run({"render", path("scene.json"), "-o", path("4.exr"), "--threads", "0"}).code, 2);
}

TEST_F(Habit, AnExposureMayHaveAPlus) {
  tiny_scene();
  for (const auto& [value, file] : {std::pair{"+1", "plus"}, {"1", "plain"}}) {
    const Outcome outcome = run({"render", path("scene.json"), "-o", path("a.exr"), "--png",
                                 path(std::string(file) + ".png"), "--size", "16x16", "--exposure", value});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  EXPECT_EQ(read("plus.png"), read("plain.png"));
  EXPECT_EQ(run({"render", path("scene.json"), "-o", path("a.exr"), "--exposure", "++1"}).code, 2);
}

TEST_F(Habit, AComparisonHasATableForSpreadsheets) {
  tiny_scene();
  const Outcome outcome =
      run({"compare", path("scene.json"), "-o", path("out"), "--methods", "view-sample,edge-scatter:rows=exact",
           "--reference", "exact", "--size", "16x16", "--light-samples", "16"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string csv = read("out/metrics.csv");
  const json metrics = json::parse(read("out/metrics.json"));
  ASSERT_EQ(std::ranges::count(csv, '\n'), 3);
  EXPECT_THAT(csv, testing::StartsWith("entry,method,options,lightSamples,mean,rmse,"));
  const json& first = metrics.at("methods").at(0);
  std::size_t at = csv.find("\nview-sample,view-sample,");
  ASSERT_NE(at, std::string::npos);
  for (int comma = 0; comma < 5; ++comma) at = csv.find(',', at) + 1;
  EXPECT_EQ(std::stod(csv.substr(at)), first.at("error").at("rmse").get<double>());
  EXPECT_THAT(csv, HasSubstr("\nedge-scatter:rows=exact,edge-scatter,"));
  for (const auto& entry : std::filesystem::directory_iterator(path("out")))
    EXPECT_EQ(entry.path().filename().string().find(':'), std::string::npos) << entry.path();
}

}  // namespace
}  // namespace penumbra::tests
