// SPDX-License-Identifier: Apache-2.0
// Tests that the helper that reads foreign files ends with the program, which may be killed at any moment, above all
// when it has just started the helper.
#include "tests/faults/child.hpp"

#include <chrono>
#include <random>
#include <thread>

#include <sys/prctl.h>
#include <sys/wait.h>

namespace penumbra::tests {
namespace {

class OrphanFaults : public FaultTest {
 protected:
  OrphanFaults() { ::prctl(PR_SET_CHILD_SUBREAPER, 1); }  // a helper without parent becomes a child of this test
  ~OrphanFaults() override { ::prctl(PR_SET_CHILD_SUBREAPER, 0); }

  struct Counts {
    int runs = 0;
    int orphans = 0;   ///< helpers that were alive when the program was killed
    int finished = 0;  ///< how many of these went on to the end of their work
  };

  Counts kill_while_reading(int runs, int signal) const {
    // This takes long even if the test has to wait for a processor: a helper that is done before the kill shows
    // nothing.
    const std::string scene = slow_scene(1'000'000);
    std::mt19937 random(static_cast<unsigned>(signal));
    Counts counts;
    for (; counts.runs < runs; ++counts.runs) {
      Running program({.arguments = {"convert", scene, "-o", path("out.obj")}});
      const std::optional<pid_t> helper = program.first_child();
      if (!helper) continue;
      std::this_thread::sleep_for(std::chrono::microseconds(random() % 3000));
      program.send(signal);
      (void)program.wait();
      int status = 0;
      if (::waitpid(*helper, &status, 0) != *helper) continue;  // the program had reaped it
      ++counts.orphans;
      // A helper whose parent is gone returns 130; one that continues writes its result to nobody.
      const bool ended_with_it = (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) ||
                                 (WIFEXITED(status) && (WEXITSTATUS(status) == 130 || WEXITSTATUS(status) == 127));
      if (!ended_with_it) ++counts.finished;
    }
    return counts;
  }
  void expect_none(int runs, int signal) const {
    const Counts counts = kill_while_reading(runs, signal);
    RecordProperty("orphans", counts.orphans);
    EXPECT_EQ(counts.finished, 0) << "of " << counts.orphans << " in " << counts.runs << " runs";
    EXPECT_GT(counts.orphans, 0) << "nothing was tried";
  }
};

TEST_F(OrphanFaults, NoneOutlivesAKill) {
  expect_none(40, SIGKILL);
}

TEST_F(OrphanFaults, LongNoneOutlivesAKill) {
  expect_none(500, SIGKILL);
}

TEST_F(OrphanFaults, LongNoneOutlivesATermination) {
  expect_none(200, SIGTERM);
}

}  // namespace
}  // namespace penumbra::tests
