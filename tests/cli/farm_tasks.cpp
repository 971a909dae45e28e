// SPDX-License-Identifier: Apache-2.0
// Tests the arithmetic of `submit` (which frames go into which task, and how many), and the quoting of words for a
// shell.
#include "tests/cli/program.hpp"

#include "app/farm/batch_script.hpp"
#include "app/farm/slurm.hpp"
#include "app/farm/tasks.hpp"
#include "app/process/child_program.hpp"
#include "base/error.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

namespace penumbra::tests {
namespace {

using session::FrameRange;
using testing::AllOf;
using testing::Contains;

/// Tries every way in which up to nine frames of a sequence may be missing.
TEST(FarmTasks, HaveEachMissingFrameOnce) {
  constexpr std::int64_t kFirst = -3, kStep = 4;
  for (std::uint32_t set = 0; set < 512; ++set) {
    std::vector<std::int64_t> missing;
    for (std::int64_t i = 0; i < 9; ++i) {
      if ((set >> i & 1) != 0) missing.push_back(kFirst + kStep * i);
    }
    for (std::size_t size = 1; size <= 10; ++size) {
      for (std::size_t most = 1; most <= 10; ++most) {
        SCOPED_TRACE("set " + std::to_string(set) + " size " + std::to_string(size) + " most " + std::to_string(most));
        const std::vector<FrameRange> tasks = app::cut_into_tasks(missing, kStep, size, most);
        ASSERT_EQ(tasks.size(), std::min(most, (missing.size() + size - 1) / size));
        std::vector<std::int64_t> found;
        std::size_t least = missing.size(), greatest = 0;
        for (const FrameRange& task : tasks) {
          ASSERT_EQ(task.step, kStep);
          ASSERT_THAT(missing, AllOf(Contains(task.first), Contains(task.last)));
          const std::size_t before = found.size();
          for (const std::int64_t frame : session::numbers_of(task)) {
            if (std::ranges::binary_search(missing, frame)) found.push_back(frame);
          }
          least = std::min(least, found.size() - before);
          greatest = std::max(greatest, found.size() - before);
        }
        ASSERT_EQ(found, missing) << "each once, in order";
        ASSERT_LE(greatest, std::max(least + 1, greatest == least ? greatest : 0));
        if (tasks.size() < most) {
          ASSERT_LE(greatest, size);
        }
      }
    }
  }
}

/// A task has n frames of f seconds and takes b seconds to begin: n is the smallest with n·f + b ≥ 60 and b ≤ n·f / 10.
TEST(FarmTasks, AreLargeEnoughAndNoLarger) {
  for (const double begin : {0.0, 0.125, 1.0, 8.0, 59.0, 60.0, 64.0}) {
    for (const double frame : {0.0078125, 0.5, 1.0, 3.0, 60.0, 1000.0}) {
      const auto enough = [&](std::size_t n) {
        const double work = static_cast<double>(n) * frame;
        return n >= 1 && work + begin >= 60 && work >= 10 * begin;
      };
      const std::size_t n = app::frames_per_task({begin, frame});
      EXPECT_TRUE(enough(n)) << begin << " " << frame << " " << n;
      EXPECT_FALSE(enough(n - 1)) << begin << " " << frame << " " << n;
    }
  }
  EXPECT_EQ(app::frames_per_task({0, 0}), 100'000u);
  EXPECT_EQ(app::frames_per_task({70, 1000}), 1u);
}

TEST(FarmTasks, AreWords) {
  EXPECT_EQ(app::text_of(FrameRange{-3, 9, 4}), "-3-9x4");
  EXPECT_EQ(session::parse_frames(app::text_of(FrameRange{-9, -3, 2})).last, -3);
  const std::vector<std::int64_t> frames = {1, 3, 5, 9, 11, 20};
  EXPECT_EQ(app::list_of(frames, 2), "1-5, 9-11, 20");
  EXPECT_EQ(app::list_of(frames, 1), "1, 3, 5, 9, 11, 20");
  EXPECT_EQ(session::sequence_name("shot10.####.exr"), "shot10");
  EXPECT_EQ(session::sequence_name("a/shot_%04d.exr"), "shot");
  EXPECT_EQ(session::sequence_name("shot.v2.exr"), "shot.v2");
  EXPECT_EQ(session::sequence_name("####.exr"), "");
}

TEST(FarmTasks, SlurmSaysHowManyThereMayBe) {
  EXPECT_EQ(app::most_tasks("Configuration data\nMaxArraySize            = 11\nMaxJobCount = 10000\n"), 11u);
  EXPECT_EQ(app::most_tasks("MaxJobCount = 10000\n"), 1001u);
  EXPECT_THROW((void)app::most_tasks("MaxArraySize = 0\n"), ResourceError);
  EXPECT_EQ(app::job_number("12\n"), "12");
  EXPECT_EQ(app::job_number("welcome\n12;cluster\n"), "12");
  EXPECT_THROW((void)app::job_number("no partition\n"), ResourceError);
  EXPECT_THROW((void)app::run_slurm({"no-such-program-of-slurm"}), ResourceError);
}

/// Words of any content reach the shell unchanged, and the shell runs nothing in them.
TEST(ShellWords, AreWhatTheyWere) {
  std::mt19937 random(17);
  const std::string hard = " \t'\"\\$`!*?[]{}()<>|&;#~%=-aZ0\x80\xc3\xbc\x01";
  std::vector<std::string> words = {"", "'", "''", "a'b", "$(exit 3)", "-n", "\\", "é"};
  while (words.size() < 500) {
    std::string& word = words.emplace_back();
    for (std::size_t i = random() % 12; i > 0; --i) word += hard[random() % hard.size()];
  }
  std::string script = "printf '%s\\0'", expected;
  for (const std::string& word : words) {
    script += " " + app::shell_word(word);
    expected += word + '\0';
  }
  const app::ProgramEnding ending = app::run_program({"bash", "-c", script});
  EXPECT_EQ(ending.code, 0) << ending.errors;
  EXPECT_EQ(ending.output, expected);
  EXPECT_EQ(ending.errors, "");
}

TEST(ChildPrograms, SayHowTheyEnded) {
  const app::ProgramEnding both = app::run_program({"sh", "-c", "echo out; echo err >&2; exit 7"});
  EXPECT_EQ(both.code, 7);
  EXPECT_EQ(both.output, "out\n");
  EXPECT_EQ(both.errors, "err\n");
  EXPECT_EQ(app::run_program({"sh", "-c", "kill -9 $$"}).code, 137);
  EXPECT_EQ(app::run_program({"sh", "-c", "head -c 300000 /dev/zero"}).output.size(), 300'000u)
      << "more than a pipe has";
  EXPECT_EQ(app::run_program({"no-such-program"}).code, 127);
}

}  // namespace
}  // namespace penumbra::tests
