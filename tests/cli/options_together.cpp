// SPDX-License-Identifier: Apache-2.0
// Tests options in combination: a covering array of all options of `render` and `compare`, and of all methods with
// their own options. Other tests try each option alone; here any two (quick tests) or three (full tests) are combined.
// In the quick tests `compare` combines two options of one method, or one of them and one of the command (three of four
// such pairs); `render` tries each method with each option of the command, and each value of a method's options once.
// Options of two methods are combined in the full tests only. The program itself lists its methods and options, so that
// a new one is tried without a change here.

#include "tests/cli/options_together.hpp"

#include "base/error.hpp"
#include "session/comparison/comparison_files.hpp"
#include "session/options.hpp"

#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <utility>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

// The rows are divided among this many tests, so that processes run them in parallel (SHARDS in cli.cmake). Each
// process computes the rows once.
constexpr std::size_t kParts = 8, kCompareParts = 4;
// This many rows contain three of four pairs.
constexpr std::size_t kQuickCompareRows = 12;
const char* const kOn = "on";

class OptionsTogether : public ProgramTest {
 protected:
  OptionsTogether() : table_(json::parse(run({"methods", "--json"}).out).at("methods")) {}

  /// Adds options that both commands have.
  void add_common_factors() {
    Factor scene{"scene", {}};
    for (const LitScene& one : scenes_) scene.values.push_back(one.name);
    factors_.push_back(scene);
    factors_.push_back({"pattern", {"rows", "grid", "sobol", "jittered", "rgss"}});
    factors_.push_back({"light-samples", {"1", "16", "5x7"}});
    factors_.push_back({"seed", {"", "7"}});
    factors_.push_back({"size", {"12x8", "5x7"}});
    factors_.push_back({"light", {"", "second"}});
    factors_.push_back({"device", {"", "cpu"}});
    for (const char* flag : {"bits", "png", "stats", "verbose"}) factors_.push_back({flag, {"", kOn}});
  }

  /// `group_of` gives the group of a factor (Factor::group); `default_by_name` is passed to values_to_try.
  void add_options_of(const json& method, std::optional<std::pair<std::size_t, std::size_t>> only_if,
                      const std::function<std::string(const std::string& factor)>& group_of, bool default_by_name) {
    for (const json& option : method.at("options")) {
      const std::string factor = method.at("name").get<std::string>() + "." + option.at("name").get<std::string>();
      factors_.push_back({factor, values_to_try(option, default_by_name), only_if, group_of(factor)});
    }
  }

  [[nodiscard]] const LitScene& scene_of(const Row& row) const {
    return *std::ranges::find(scenes_, row["scene"], &LitScene::name);
  }

  /// Returns whether a method can render any of the scenes; methods for domes only can render none.
  [[nodiscard]] bool does_some_scene(const json& method) const {
    return std::ranges::any_of(scenes_, [&](const LitScene& scene) { return table_.can_do(method, scene, "rows"); });
  }

  /// Returns all lights' names, the second one first.
  [[nodiscard]] std::vector<std::string> lights_from_second(const LitScene& scene) const {
    std::vector<std::string> names;
    const json whole = json::parse(read(scene.name + ".json"));
    for (const json& light : whole.at("lights")) names.push_back(light.at("name"));
    std::swap(names.at(0), names.at(1));
    return names;
  }

  /// Returns the arguments that both commands get.
  [[nodiscard]] std::vector<std::string> common_arguments(const Row& row) const {
    const LitScene& scene = scene_of(row);
    std::vector<std::string> arguments = {scene.file};
    const auto add = [&](const char* option, const std::string& value) {
      if (!value.empty()) arguments.insert(arguments.end(), {option, value});
    };
    add("--sample-pattern", row["pattern"]);
    add("--light-samples", row["light-samples"]);
    add("--sample-seed", row["seed"]);
    add("--size", row["size"]);
    add("--device", row["device"]);
    if (!row["light"].empty()) {
      for (const std::string& name : lights_from_second(scene)) add("--light", name);
    }
    if (!row["verbose"].empty()) arguments.emplace_back("--verbose");
    return arguments;
  }

  static std::string text_of(const std::vector<std::string>& arguments) {
    std::string text = "penumbra";
    for (const std::string& argument : arguments) text += " " + argument;
    return text;
  }

  void expect_exit(const Outcome& outcome, const testing::Matcher<int>& code) const {
    EXPECT_THAT(outcome.code, code) << outcome.err;
    EXPECT_THAT(outcome.err, Not(HasSubstr("internal")));
    if (outcome.code > 1) {
      EXPECT_THAT(outcome.err, HasSubstr("error: "));
    }
    for (const std::string& name : files()) EXPECT_THAT(name, Not(HasSubstr(".part"))) << "left behind";
  }

  /// Returns the covering array of the factors, with `most` rows at most. It is kept in `found`, by strength, because
  /// computing it takes seconds.
  const std::vector<Choices>& rows_of(std::map<std::size_t, CoveringArray>& found, std::size_t strength,
                                      const Allowed& allowed, std::size_t most = SIZE_MAX) {
    if (!found.contains(strength)) found.emplace(strength, covering_array(factors_, strength, allowed, most));
    const CoveringArray& array = found.at(strength);
    if (most == SIZE_MAX) {
      EXPECT_EQ(array.left, 0U);
    } else {
      EXPECT_LT(array.left, array.combinations / 4);
    }
    RecordProperty("rows", static_cast<int>(array.rows.size()));
    RecordProperty("combinations", static_cast<int>(array.combinations));
    RecordProperty("left", static_cast<int>(array.left));
    return array.rows;
  }

  MethodTable table_;
  std::vector<LitScene> scenes_;
  std::vector<Factor> factors_;
};

class RenderTogether : public OptionsTogether, public testing::WithParamInterface<std::size_t> {
 protected:
  void run_rows(std::size_t strength, bool many) {
    scenes_ = write_lit_scenes(folder_, many);
    add_common_factors();
    if (strength == 2) {
      for (Factor& factor : factors_) factor.group = "command";  // combined with methods, but not with methods' options
    }
    Factor method{"method", {""}};
    std::vector<json> methods;
    for (const json& one : table_.all()) {
      if (!does_some_scene(one)) continue;
      methods.push_back(one);
      method.values.push_back(one.at("name"));
    }
    factors_.push_back(method);
    const std::size_t of_method = factors_.size() - 1;
    const auto group_of = [&](const std::string& factor) { return strength == 2 ? factor : std::string(); };
    for (std::size_t i = 0; i < methods.size(); ++i) add_options_of(methods[i], {{of_method, i + 1}}, group_of, true);
    const Allowed allowed = [&](const Choices& choices) { return can_be(Row(factors_, choices)); };
    static std::map<std::size_t, CoveringArray> found;
    const std::vector<Choices>& rows = rows_of(found, strength, allowed);
    for (std::size_t i = GetParam(); i < rows.size(); i += kParts) render(Row(factors_, rows[i]));
  }

 private:
  [[nodiscard]] const json* method_of(const Row& row) const {
    for (const json& one : table_.all()) {
      if (one.at("name") == row["method"]) return &one;
    }
    return nullptr;
  }

  [[nodiscard]] bool can_be(const Row& row) const {
    const json* method = method_of(row);
    const bool has_scene = row.has("scene");
    const LitScene any{"", "", {}};
    const LitScene& scene = has_scene ? scene_of(row) : any;
    if (!row["bits"].empty()) {
      if (method != nullptr && method->at("output") != "mask") return false;
      if (row["edge-scatter.rows"] == "exact") return false;
      if (has_scene && scene.lights.front() == "sphere") return false;
    }
    if (method == nullptr) return true;  // some method can
    return table_.can_do(*method, scene, row["pattern"]) &&
           !options_exclude(row["method"], options_of(row, *method), scene, row);
  }

  void render(const Row& row) {
    std::filesystem::remove_all(path("out"));
    std::filesystem::create_directories(path("out"));
    std::vector<std::string> arguments = common_arguments(row);
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"-o", path("out/a.exr")});
    for (const char* output : {"bits", "png", "stats"}) {
      if (!row[output].empty())
        arguments.insert(arguments.end(), {std::string("--") + output, path("out/a.") + output});
    }
    if (const json* method = method_of(row)) {
      arguments.insert(arguments.end(), {"--method", row["method"]});
      for (const auto& [key, value] : options_of(row, *method)) {
        arguments.insert(arguments.end(), {"--method-option", key + "=" + value});
      }
    }
    SCOPED_TRACE(text_of(arguments));
    const Outcome outcome = run(arguments);
    expect_exit(outcome, 0);
    if (outcome.code != 0) return;
    expect_whole_picture(path("out/a.exr"), true);
    if (!row["png"].empty()) expect_whole_png(path("out/a.png"));
    if (!row["bits"].empty()) expect_whole_bits(path("out/a.bits"));
    if (!row["stats"].empty()) expect_sane_stats(json::parse(read("out/a.stats")));
  }
};

class CompareTogether : public OptionsTogether, public testing::WithParamInterface<std::size_t> {
 protected:
  void run_rows(std::size_t strength, bool many) {
    scenes_ = write_lit_scenes(folder_, many);
    add_common_factors();
    factors_.push_back({"reference", {"raytrace", "exact"}});
    factors_.push_back({"reference-samples", {"same", "64"}});
    factors_.push_back({"sample-pixels", {"all", "3", "2,3;4,5"}});
    factors_.push_back({"max-rmse", {"", "0", "2"}});
    factors_.push_back({"runs", {"1", "2"}});
    factors_.push_back({"twice", {"", kOn}});
    for (const json& method : table_.all()) {
      if (!does_some_scene(method)) continue;
      const std::string name = method.at("name");
      std::string group = strength == 2 ? name : "";
      if (!group.empty()) factors_.push_back({name, {kOn}, {}, group});
      add_options_of(
          method, {}, [&](const std::string& /*factor*/) -> const std::string& { return group; }, strength > 2);
    }
    const Allowed allowed = [&](const Choices& choices) { return can_be(Row(factors_, choices)); };
    static std::map<std::size_t, CoveringArray> found;
    // The full tests use all rows.
    const std::vector<Choices>& rows = rows_of(found, strength, allowed, strength == 2 ? kQuickCompareRows : SIZE_MAX);
    // A method is left out of a row that contains nothing new for it.
    const std::vector<std::set<std::string>> news = groups_with_news(factors_, strength, rows);
    for (std::size_t i = GetParam(); i < rows.size(); i += kCompareParts) {
      const Row row(factors_, rows[i]);
      std::set<std::string> methods = news[i];
      if (strength > 2) {
        for (const json& method : table_.all()) {
          if (table_.can_do(method, scene_of(row), row["pattern"])) methods.insert(method.at("name"));
        }
      }
      if (methods.empty()) methods = {"raytrace"};
      compare(row, methods);
    }
  }

 private:
  /// Options of a method that cannot render the scene stay open.
  [[nodiscard]] bool can_be(const Row& row) const {
    if (!row["bits"].empty() && row.has("scene") && scene_of(row).lights.front() == "sphere") return false;
    for (const json& method : table_.all()) {
      const auto name = method.at("name").get<std::string>();
      const auto has_option = [&](const json& option) {
        return row.has(name + "." + option.at("name").get<std::string>());
      };
      if (!row.has(name) && !std::ranges::any_of(method.at("options"), has_option)) continue;
      const LitScene any{"", "", {}};
      const LitScene& scene = row.has("scene") ? scene_of(row) : any;
      if (!table_.can_do(method, scene, row["pattern"])) return false;
      if (options_exclude(name, options_of(row, method), scene, row)) return false;
    }
    return true;
  }

  [[nodiscard]] std::string entries_of(const Row& row, const std::set<std::string>& methods) const {
    std::vector<std::string> entries;
    for (const json& method : table_.all()) {
      auto entry = method.at("name").get<std::string>();
      if (!methods.contains(entry)) continue;
      for (const auto& [key, value] : options_of(row, method)) entry += fmt::format(":{}={}", key, value);
      entries.push_back(entry);
    }
    if (!row["twice"].empty()) entries.push_back(entries.front());
    return fmt::format("{}", fmt::join(entries, ","));
  }

  void compare(const Row& row, const std::set<std::string>& methods) {
    std::filesystem::remove_all(path("out"));
    std::vector<std::string> arguments = common_arguments(row);
    arguments.insert(arguments.begin(), "compare");
    arguments.insert(arguments.end(), {"-o", path("out"), "--methods", entries_of(row, methods)});
    for (const char* option : {"reference", "reference-samples", "sample-pixels", "max-rmse", "runs"}) {
      if (!row[option].empty()) arguments.insert(arguments.end(), {std::string("--") + option, row[option]});
    }
    for (const char* flag : {"bits", "png"}) {
      if (!row[flag].empty()) arguments.emplace_back(std::string("--") + flag);
    }
    if (!row["stats"].empty()) arguments.insert(arguments.end(), {"--stats", path("out/again.json")});
    SCOPED_TRACE(text_of(arguments));
    const Outcome outcome = run(arguments);
    expect_exit(outcome, row["max-rmse"].empty() ? testing::Matcher<int>(0) : testing::Matcher<int>(AnyOf(0, 1)));
    if (outcome.code > 1) return;
    const json metrics = json::parse(read("out/metrics.json"));
    expect_sane_metrics(metrics);
    if (!row["stats"].empty()) {
      EXPECT_EQ(read("out/again.json"), read("out/metrics.json"));
    }
    const std::string report = read("out/report.html");
    EXPECT_NE(report.rfind("</html>"), std::string::npos);
    std::vector<std::string> names = {"reference"};
    for (const json& method : metrics.at("methods")) names.push_back(session::file_stem(method.at("entry")));
    for (const std::string& name : names) {
      expect_whole_picture(path("out/" + name + ".exr"), row["sample-pixels"] == "all");
      if (!row["png"].empty()) expect_whole_png(path("out/" + name + ".png"));
      if (std::filesystem::exists(path("out/" + name + ".bits"))) expect_whole_bits(path("out/" + name + ".bits"));
    }
    for (std::size_t i = 1; i < names.size(); ++i) expect_whole_png(path("out/" + names[i] + "-error.png"));
  }
};

TEST_P(RenderTogether, EveryPair) {
  run_rows(2, false);
}
TEST_P(CompareTogether, EveryPair) {
  run_rows(2, false);
}
INSTANTIATE_TEST_SUITE_P(Part, RenderTogether, testing::Range<std::size_t>(0, kParts));
INSTANTIATE_TEST_SUITE_P(Part, CompareTogether, testing::Range<std::size_t>(0, kCompareParts));

using RenderThree = RenderTogether;
using CompareThree = CompareTogether;
TEST_P(RenderThree, EveryTriple) {
  run_rows(3, true);
}
TEST_P(CompareThree, EveryTriple) {
  run_rows(3, true);
}
INSTANTIATE_TEST_SUITE_P(Part, RenderThree, testing::Range<std::size_t>(0, kParts));
INSTANTIATE_TEST_SUITE_P(Part, CompareThree, testing::Range<std::size_t>(0, kCompareParts));

class Refusals : public OptionsTogether {
 protected:
  /// Renders impossible combinations (scenes that a method cannot handle, or masks of a method that has none) with each
  /// scene, or with one scene per method: they are refused with a documented exit code and a reason.
  void expect_scenes_refused(bool every_scene) {
    scenes_ = write_lit_scenes(folder_, false);
    std::size_t number = 0, refused = 0;
    for (const json& method : table_.all()) {
      std::vector<const LitScene*> impossible;
      for (const LitScene& scene : scenes_) {
        if (!can_have_masks(method, scene)) impossible.push_back(&scene);
      }
      // One scene per method: each method gets another kind of light.
      if (!every_scene && !impossible.empty()) impossible = {impossible[number++ % impossible.size()]};
      for (const LitScene* scene : impossible) expect_refused(method, *scene);
      refused += impossible.size();
    }
    EXPECT_GT(refused, table_.all().size() / 2);
  }
  /// Gives wrong values of each option to the parser, and one of each option, or of each method, to the program.
  void expect_values_refused(bool every_option) {
    scenes_ = write_lit_scenes(folder_, false);
    const std::vector<std::string> wrong = {"", "no such value", "-1", "1e400", "nan"};
    std::size_t tried = 0;
    for (const json& method : table_.all()) {
      bool given = false;
      for (const json& option : method.at("options")) {
        const std::string key = option.at("name");
        for (const std::string& value : wrong) {
          const std::string entry = fmt::format("{}:{}={}", method.at("name").get<std::string>(), key, value);
          EXPECT_THAT([&] { session::parse_methods(entry); }, ThrowsMessage<UsageError>(HasSubstr(key))) << entry;
          if (value != wrong[tried % wrong.size()] || (given && !every_option)) continue;
          given = true;
          const std::vector<std::string> arguments = {"compare",   scenes_[0].file, "-o",
                                                      path("out"), "--methods",     entry};
          SCOPED_TRACE(text_of(arguments));
          const Outcome outcome = run(arguments);
          expect_exit(outcome, 2);
          EXPECT_THAT(outcome.err, HasSubstr(key));
        }
        ++tried;
      }
    }
    EXPECT_GT(tried, 100U);
  }

 private:
  [[nodiscard]] bool can_have_masks(const json& method, const LitScene& scene) const {
    return table_.can_do(method, scene, "sobol") && method.at("output") == "mask" && scene.lights.front() != "sphere";
  }
  void expect_refused(const json& method, const LitScene& scene) {
    const auto name = method.at("name").get<std::string>();
    const std::vector<std::string> arguments = {"render", scene.file, "-o",           path("a.exr"),      "--method",
                                                name,     "--bits",   path("a.bits"), "--sample-pattern", "sobol"};
    SCOPED_TRACE(text_of(arguments));
    const bool can = table_.can_do(method, scene, "sobol");
    expect_exit(run(arguments), can ? testing::Matcher<int>(2) : testing::Matcher<int>(AnyOf(2, 3)));
    EXPECT_FALSE(std::filesystem::exists(path("a.exr")));
  }
};

TEST_F(Refusals, OfScenesAMethodCannotDo) {
  expect_scenes_refused(false);
}
TEST_F(Refusals, OfWrongValues) {
  expect_values_refused(false);
}
TEST_F(Refusals, OfEverySceneAndOptionFull) {
  expect_scenes_refused(true);
  expect_values_refused(true);
}

TEST(CoveringArray, HasEveryAllowedCombination) {
  const std::vector<Factor> factors = {{"a", {"0", "1", "2"}},
                                       {"b", {"0", "1"}},
                                       {"c", {"0", "1", "2", "3"}, {{0, 2}}},  // only if a is 2
                                       {"d", {"0", "1"}},
                                       {"e", {"0", "1", "2"}}};
  const Allowed allowed = [](const Choices& row) { return !(row[1] == 1U && row[3] == 1U); };
  for (const std::size_t strength : {2U, 3U}) {
    const std::vector<Choices> rows = covering_array(factors, strength, allowed).rows;
    EXPECT_EQ(uncovered_combinations(factors, strength, allowed, rows), 0U);
    EXPECT_LT(rows.size(), strength == 2 ? 25U : 60U) << "all rows: 3 · 2 · 2 · 3 · 1.5 and more";
    for (const Choices& row : rows) {
      EXPECT_TRUE(allowed(row));
      EXPECT_EQ(row[2].has_value(), row[0] == 2U);
    }
    // The check itself can fail.
    EXPECT_GT(uncovered_combinations(factors, strength, allowed, {rows.begin(), rows.end() - 1}), 0U);
  }
}

// Two groups of two factors, and one factor that goes with both: all nine pairs of each group and six with `all`, in as
// many rows as one group needs. A group whose combinations have all occurred has no news.
TEST(CoveringArray, LeavesCombinationsOfTwoGroupsOut) {
  std::vector<Factor> factors = {{"all", {"0", "1"}}};
  for (const char* group : {"one", "two"}) {
    for (const char* name : {"x", "y"}) factors.push_back({std::string(group) + name, {"0", "1", "2"}, {}, group});
  }
  factors.push_back({"alone", {"0", "1"}, {}, "three"});
  const Allowed any = [](const Choices& /*row*/) { return true; };
  const std::vector<Choices> rows = covering_array(factors, 2, any).rows;
  EXPECT_EQ(uncovered_combinations(factors, 2, any, rows), 0U);
  EXPECT_LT(rows.size(), 13U);
  const auto news = groups_with_news(factors, 2, rows);
  std::map<std::string, std::set<std::pair<std::size_t, std::size_t>>> seen;
  std::size_t third = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (news[i].contains("one")) seen["one"].emplace(*rows[i][1], *rows[i][2]);
    if (news[i].contains("two")) seen["two"].emplace(*rows[i][3], *rows[i][4]);
    third += news[i].contains("three") ? 1 : 0;
  }
  EXPECT_EQ(seen["one"].size(), 9U);
  EXPECT_EQ(seen["two"].size(), 9U);
  EXPECT_EQ(third, 4U) << "2 x 2 with `all`";
}

}  // namespace
}  // namespace penumbra::tests
