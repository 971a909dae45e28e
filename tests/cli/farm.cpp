// SPDX-License-Identifier: Apache-2.0
// Tests `submit`: it renders the same sequence as `render --frames` in several processes, here or by a batch script;
// failures are named, and nothing is rendered twice.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace penumbra::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

class Farm : public ProgramTest {
 protected:
  Farm() { scene_ = moving_scene(); }

  [[nodiscard]] std::vector<std::string> sequence(const std::string& command, const std::string& folder,
                                                  std::vector<std::string> more) const {
    std::filesystem::create_directories(path(folder));
    std::vector<std::string> arguments = {command,    scene_,
                                          "--size",   "24x16",
                                          "--fps",    "10",
                                          "--frames", "0-10x2",
                                          "--output", path(folder + "/s.####.exr"),
                                          "--png",    path(folder + "/s.png")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  Outcome submit(const std::string& folder, const std::vector<std::string>& more,
                 const std::map<std::string, std::string>& environment = {}) const {
    return run(sequence("submit", folder, more), environment);
  }
  /// Expects the pictures in the folder to be those of `render`, and only of these frames.
  void expect_pictures(const std::string& folder,
                       const std::vector<std::string>& frames = {"0000", "0002", "0004", "0006", "0008", "0010"}) {
    if (!std::filesystem::exists(path("whole"))) {
      const Outcome outcome = run(sequence("render", "whole", {"--exposure", "first"}));
      ASSERT_EQ(outcome.code, 0) << outcome.err;
    }
    std::vector<std::string> expected, found;
    for (const std::string& frame : frames) {
      for (const char* extension : {".exr", ".png"}) {
        const std::string name = "s." + frame + extension;
        expected.push_back(name);
        EXPECT_EQ(read(folder + "/" + name), read("whole/" + name)) << name;
      }
    }
    for (const auto& entry : std::filesystem::directory_iterator(path(folder))) {
      if (entry.is_regular_file()) found.push_back(entry.path().filename().string());
    }
    EXPECT_THAT(found, testing::UnorderedElementsAreArray(expected));
  }

  /// Writes programs with the names of Slurm's that do the same at once, one task after the other. If the file `lost`
  /// in the folder names a task, that task does not begin, once.
  std::map<std::string, std::string> fake_slurm() const {
    const auto program = [&](const std::string& name, const std::string& text) {
      std::filesystem::permissions(write("bin/" + name, "#!/bin/bash\n" + text), std::filesystem::perms::owner_all);
    };
    program("scontrol", "echo 'MaxArraySize            = 3'\n");
    program("squeue", "cat \"$FAKE/queue\" 2>/dev/null\n");
    program("sbatch", R"(
job=$(($(cat "$FAKE/job" 2>/dev/null || echo 6) + 1)); echo $job >"$FAKE/job"
printf '%s\n' "$@" >"$FAKE/sbatch.$job"
echo $job
for word in "$@"; do
  if [[ $word == --wrap=* ]]; then (bash -c "${word#--wrap=}") </dev/null >"$FAKE/summary.$job" 2>&1; echo $? >>"$FAKE/summary.$job"; exit 0; fi
done
script=${!#}
last=$(sed -n 's/^#SBATCH --array=0-//p' "$script")
for ((task = 0; task <= last; ++task)); do
  if [[ $(cat "$FAKE/lost" 2>/dev/null) == "$task" ]]; then rm "$FAKE/lost"; continue; fi
  (SLURM_ARRAY_TASK_ID=$task bash "$script") </dev/null >"$FAKE/$job.$task.log" 2>&1
done
exit 0
)");
    return {{"PATH", path("bin") + ":" + std::getenv("PATH")}, {"FAKE", path("bin")}};
  }

  std::string scene_;
};

TEST_F(Farm, WithTwoWorkersHereIsTheSequence) {
  const Outcome outcome = submit("here", {"--jobs", "2"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("all 6 frames exist"));
  for (const char* frame : {"s.0000.exr:", "s.0004.exr:", "s.0010.exr:"}) EXPECT_EQ(count_of(outcome.err, frame), 1u);
  expect_pictures("here");
  const Outcome again = submit("here", {"--jobs", "2"});
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.err, AllOf(HasSubstr("all 6 frames exist"), Not(HasSubstr(".exr:"))));
  for (const char* lost : {"here/s.0002.png", "here/s.0010.exr"}) std::filesystem::remove(path(lost));
  EXPECT_EQ(count_of(submit("here", {"--jobs", "1"}).err, ".exr:"), 2u) << "those between are there";
  expect_pictures("here");
}

/// A folder stands where frame 4 should be written; frame 6 already exists.
TEST_F(Farm, AFrameThatFailsIsNamedAndTheOthersAreDone) {
  ASSERT_EQ(run(sequence("render", "whole", {"--exposure", "first"})).code, 0);
  std::filesystem::create_directories(path("here/s.0004.exr"));
  for (const char* name : {"/s.0006.exr", "/s.0006.png"})
    std::filesystem::copy(path("whole") + name, path("here") + name);
  const auto before = std::filesystem::last_write_time(path("here/s.0006.exr"));
  const Outcome outcome = submit("here", {"--jobs", "2"});
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("error: frame 4: "), HasSubstr("1 of 6 frames failed")));
  EXPECT_EQ(count_of(outcome.err, "tried once more"), 1u);
  std::filesystem::remove(path("here/s.0004.exr"));
  EXPECT_EQ(std::filesystem::last_write_time(path("here/s.0006.exr")), before);
  const Outcome resumed = submit("here", {"--jobs", "2"});
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(count_of(resumed.err, ".exr:"), 1u) << "what was missing, and no more";
  expect_pictures("here");
}

TEST_F(Farm, AScriptOfOddNamesIsRunAsItIs) {
  const std::string odd = "a b'c\"d$(exit 3)`;&%1#é";
  const std::vector<std::string> more = {"--chunk", "4", "--sbatch", "partition=ren der", "--sbatch", "mem=8G"};
  ASSERT_EQ(run(sequence("render", "whole", {"--exposure", "first"})).code, 0);
  std::filesystem::create_directories(path(odd));
  std::filesystem::copy(path("whole/s.0000.exr"), path(odd));
  std::filesystem::copy(path("whole/s.0000.png"), path(odd));
  const Outcome outcome = submit(odd, [&] {
    auto all = more;
    all.emplace_back("--dry-run");
    return all;
  }());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("#SBATCH --array=0-1\n"), HasSubstr("\n  2-4x2\n  6-10x2\n"),
                                 HasSubstr("#SBATCH --partition=\"ren der\"\n"), HasSubstr("#SBATCH --requeue\n")));
  EXPECT_FALSE(std::filesystem::exists(path(odd + "/s.farm"))) << "nothing is written";
  // Runs the script alone as Slurm would: each task by bash, from another folder.
  const std::string script = write("script.sh", outcome.out).string();
  const auto bash = [&](const std::string& command) {
    return std::system(("cd / && " + command + " 2>/dev/null").c_str());
  };
  EXPECT_EQ(bash("bash -n '" + script + "'"), 0);
  EXPECT_EQ(bash("SLURM_ARRAY_TASK_ID=1 bash '" + script + "' >/dev/null"), 0);
  expect_pictures(odd, {"0000", "0006", "0008", "0010"});
  EXPECT_EQ(bash("SLURM_ARRAY_TASK_ID=0 bash '" + script + "' >/dev/null"), 0);
  expect_pictures(odd);
  EXPECT_NE(bash("SLURM_ARRAY_TASK_ID=2 bash '" + script + "' >/dev/null"), 0) << "there is no such task";
  EXPECT_EQ(bash("bash '" + script + "' summary >/dev/null"), 0) << "all are there";
}

/// If the first frame does not exist yet, the script contains the command that renders it.
TEST_F(Farm, ADryRunRendersNothing) {
  const Outcome outcome = submit("dry", {"--dry-run"}, {{"PATH", "/nowhere"}});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("each task has one frame"));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("#SBATCH --array=0-5\n"), HasSubstr("--frames=0-0 --exposure=first"),
                                 HasSubstr("#SBATCH --exclusive\n")));
  EXPECT_TRUE(std::filesystem::is_empty(path("dry")));
}

TEST_F(Farm, AnArrayIsRenderedAndItsSummarySubmitsWhatWasLost) {
  const auto environment = fake_slurm();
  write("bin/lost", "1\n");
  const Outcome outcome = submit("farm", {"--chunk", "1"}, environment);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "7 8\n");
  // An array may have at most 3 tasks; `submit` has rendered the first frame.
  EXPECT_THAT(outcome.err, HasSubstr("5 frames in 3 tasks are job 7, its summary is job 8"));
  EXPECT_THAT(read("bin/summary.8"), HasSubstr("2 frames in 2 tasks are job 9, its summary is job 10"));
  EXPECT_THAT(read("bin/summary.10"), HasSubstr("all 6 frames exist\n0\n"));
  EXPECT_THAT(read("bin/sbatch.8"), HasSubstr("--dependency=afterany:7\n"));
  expect_pictures("farm");
  std::string logs = outcome.err;
  for (const std::string& file : files()) {
    if (file.ends_with(".log") && file.find("/frame-") == std::string::npos) logs += read(file);
  }
  for (const char* frame : {"0000", "0002", "0004", "0006", "0008", "0010"}) {
    EXPECT_EQ(count_of(logs, "s." + std::string(frame) + ".exr: "), 1u) << frame << " is rendered once";
    const std::string own = read("farm/s.farm/frame-" + std::string(frame) + ".log");
    EXPECT_EQ(count_of(own, "s." + std::string(frame) + ".exr: "), 1u) << own;
    EXPECT_EQ(count_of(own, ".exr: "), 1u) << "and no other: " << own;
    EXPECT_THAT(own, testing::StartsWith("frame " + std::to_string(std::stoi(frame)) + " on "));
  }
  EXPECT_THAT(submit("farm", {}, environment).err, HasSubstr("all 6 frames exist"));
}

TEST_F(Farm, WhatFailsInEveryRoundIsReported) {
  const auto environment = fake_slurm();
  std::filesystem::create_directories(path("farm/s.0008.png"));
  const Outcome outcome = submit("farm", {"--sbatch", "partition=slow"}, environment);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("frames per task")) << "the first frame was measured";
  EXPECT_THAT(read("bin/7.0.log"), HasSubstr("error: frame 8: "));
  const std::string own = read("farm/s.farm/frame-0008.log");
  EXPECT_EQ(count_of(own, "frame 8 on "), 4u) << "twice in each of two rounds: " << own;
  EXPECT_EQ(count_of(own, "penumbra: error: "), 4u) << own;
  EXPECT_THAT(read("bin/summary.10"), AllOf(HasSubstr("1 of 6 frames are missing: 8\n"), HasSubstr("\n1\n")));
  EXPECT_THAT(read("bin/sbatch.10"), HasSubstr("--partition=slow\n"));
  write("bin/queue", "9_0 slow penumbra\n");
  const Outcome twice = submit("farm", {}, environment);
  EXPECT_EQ(twice.code, 2);
  EXPECT_THAT(twice.err, HasSubstr("being rendered as job 9"));
}

TEST_F(Farm, WhatCannotBeMeantIsRefused) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> refused = {
      {{"--jobs", "0"}, "--jobs"},
      {{"--jobs", "2", "--dry-run"}, "excludes"},
      {{"--jobs", "2", "--chunk", "3"}, "excludes"},
      {{"--dry-run", "--sbatch", "array=1-3"}, "sets this one itself"},
      {{"--dry-run", "--sbatch", "--mem=3"}, "without its dashes"},
      {{"--dry-run", "--method", "no-such"}, "no-such"},
      {{"--dry-run", "--exposure", "bright"}, "stops from -100 to 100"},
      {{"--jobs", "2", "--camera", "Nobody"}, "Nobody"},
      {{"--dry-run", "--stats", path("a\nb.json")}, "line break"}};
  for (const auto& [options, why] : refused) {
    const Outcome outcome = submit("none", options);
    EXPECT_EQ(outcome.code, 2) << options.back();
    EXPECT_THAT(outcome.err, HasSubstr(why)) << options.back();
  }
  EXPECT_EQ(run({"submit", scene_, "-o", path("o.exr"), "--jobs", "1"}).code, 2) << "no frames";
  const Outcome nowhere = submit("none", {}, {{"PATH", "/nowhere"}});
  EXPECT_EQ(nowhere.code, 4);
  EXPECT_THAT(nowhere.err, AllOf(HasSubstr("scontrol"), HasSubstr("--jobs N")));
  const Outcome missing = submit("none", {"--jobs", "2", "--exposure", path("no.exr")});
  EXPECT_EQ(missing.code, 3);
  EXPECT_THAT(missing.err, HasSubstr("picture does not exist"));
  EXPECT_TRUE(std::filesystem::is_empty(path("none")));
}

TEST_F(Farm, AllCamerasAndNumberedFilesGoWithThem) {
  const Outcome outcome = run({"submit", scene_, "--size", "12x8", "--frames", "1-2", "-o", path("c.exr"), "--stats",
                               path("t.json"), "--camera", "all", "--jobs", "2", "--exposure", "-2.5"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(files(),
              ElementsAre("c.B.2.0001.exr", "c.B.2.0002.exr", "c.Camera.0001.exr", "c.Camera.0002.exr", "scene.glb",
                          "t.B.2.0001.json", "t.B.2.0002.json", "t.Camera.0001.json", "t.Camera.0002.json"));
  EXPECT_EQ(read_exr(path("c.B.2.0002.exr")).attributes.at("penumbra.exposure"), "-2.5");
}

/// --exposure can name another picture, whose exposure is used.
TEST_F(Farm, AnExposureMayBeAnothersPictures) {
  ASSERT_EQ(run({"render", scene_, "-o", path("a.exr"), "--size", "12x8"}).code, 0);
  ASSERT_EQ(
      run({"render", scene_, "-o", path("b.exr"), "--size", "12x8", "--frame", "9", "--exposure", path("a.exr")}).code,
      0);
  EXPECT_EQ(read_exr(path("a.exr")).attributes.at("penumbra.exposure"),
            read_exr(path("b.exr")).attributes.at("penumbra.exposure"));
  write("c.exr", "no picture");
  EXPECT_EQ(run({"render", scene_, "-o", path("d.exr"), "--exposure", path("c.exr")}).code, 3);
}

}  // namespace
}  // namespace penumbra::tests
