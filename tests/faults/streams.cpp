// SPDX-License-Identifier: Apache-2.0
// Tests standard streams that are closed, full, or not read: a documented exit code, and output files as usual.
#include "tests/faults/child.hpp"

#include <gmock/gmock.h>

namespace penumbra::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class StreamFaults : public FaultTest {};

TEST_F(StreamFaults, ResultsThatGoNowhereAre4) {
  for (const Stream out : {Stream::full, Stream::broken_pipe, Stream::closed}) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"methods"}, {"methods", "--json"}, {"--help"}, {"--version"}}) {
      const Ending ending = run_under({.arguments = arguments, .out = out});
      EXPECT_EQ(ending.code, 4) << arguments.front() << ": " << ending.err;
      EXPECT_THAT(ending.err, AllOf(HasSubstr("cannot write to stdout"), Not(HasSubstr("internal"))));
    }
  }
}

TEST_F(StreamFaults, MessagesThatGoNowhereChangeNoExitCode) {
  const std::string scene = small_scene();
  struct Case {
    std::vector<std::string> arguments;
    int code;
  };
  const std::vector<Case> cases = {{{"render", path("nowhere.json"), "-o", path("out.exr")}, 3},
                                   {{"render", scene, "-o", "/nowhere/at/all/out.exr"}, 4},
                                   {{"render", scene}, 2},
                                   {{}, 2},
                                   {{"convert", scene, "-o", path("copy.obj")}, 0}};
  for (const Stream err : {Stream::full, Stream::broken_pipe, Stream::closed}) {
    for (const Case& one : cases) {
      EXPECT_EQ(run_under({.arguments = one.arguments, .err = err}).code, one.code)
          << testing::PrintToString(one.arguments);
    }
  }
}

TEST_F(StreamFaults, AFileNeverGetsTheNumberOfAClosedStream) {
  const std::string scene = small_scene();
  ASSERT_EQ(run_under({.arguments = {"render", scene, "-o", path("right.exr")}}).code, 0);
  ASSERT_EQ(run_under({.arguments = {"inspect", scene, "--json", path("right.json")}}).code, 0);
  for (int closed = 1; closed < 8; ++closed) {
    const auto stream = [&](int bit) { return (closed & bit) != 0 ? Stream::closed : Stream::captured; };
    const auto run = [&](std::vector<std::string> arguments) {
      return run_under({.arguments = std::move(arguments), .in = stream(1), .out = stream(2), .err = stream(4)});
    };
    EXPECT_EQ(run({"render", scene, "-o", path("out.exr")}).code, 0);
    EXPECT_EQ(read("out.exr"), read("right.exr")) << "closed streams: " << closed;
    // The table goes to stdout, the file does not.
    EXPECT_EQ(run({"inspect", scene, "--json", path("out.json")}).code, (closed & 2) != 0 ? 4 : 0);
    if ((closed & 2) == 0) {
      EXPECT_EQ(read("out.json"), read("right.json")) << "closed streams: " << closed;
    }
  }
}

}  // namespace
}  // namespace penumbra::tests
