// SPDX-License-Identifier: Apache-2.0
// Tests a mesh file as a scene: a studio is put around it, chosen by options.

#include "base/exr.hpp"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

namespace penumbra::tests {
namespace {

using testing::HasSubstr;
using testing::Not;

class StudioCommands : public ProgramTest {
 protected:
  StudioCommands() {
    write("roof.obj",
          "v -1 1 -1\nv 1 1 -1\nv 1 1 1\nv -1 1 1\nv 0 2 0\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n"
          "v 0 0 0\nv 0.05 0 0\nv 0 1 0.05\nf 6 7 8\n");  // a leg under the roof
  }
  [[nodiscard]] Outcome render(std::vector<std::string> more, const std::string& scene = "roof.obj") const {
    more.insert(more.begin(), {"render", path(scene), "-o", path("out.exr"), "--size", "32x24"});
    return run(std::move(more));
  }
  [[nodiscard]] std::vector<float> channel(const std::string& name) const {
    return read_exr(path("out.exr")).floats.at(name);
  }
};

TEST_F(StudioCommands, AMeshRendersAsTheSceneThatConvertWrites) {
  const Outcome outcome = render({});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              HasSubstr("a studio was put around it: one soft rectangle light, a floor below it, a camera"));
  const std::vector<float> visibility = channel("V"), depth = channel("Z");
  EXPECT_GT(std::ranges::count_if(visibility, [](float v) { return v > 0 && v < 1; }), 10);  // a soft shadow
  ASSERT_EQ(run({"convert", path("roof.obj"), "-o", path("roof.json")}).code, 0);
  const Outcome again = render({}, "roof.json");
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, Not(HasSubstr("studio was put")));
  EXPECT_EQ(channel("V"), visibility);
  EXPECT_EQ(channel("Z"), depth);
}

TEST_F(StudioCommands, OptionsChooseIt) {
  // A camera of 90 degrees straight above sees the ground 4 below it from -4 to 4.
  ASSERT_EQ(run({"render", path("roof.obj"), "-o", path("out.exr"), "--size", "64x64", "--floor", "none", "--camera",
                 "0,5,0:0,1,0:90", "--add-light", "sun:0,-1,0:0"})
                .code,
            0);
  EXPECT_EQ(std::ranges::count(channel("A"), 1.0f), 16 * 16);  // only the roof is visible, 2 of 8 units wide
  ASSERT_EQ(render({"--camera", "fit", "--add-light", "sphere:0,4,0:0.2", "--light", "sphere"}).code, 0);
  ASSERT_EQ(run({"compare", path("roof.obj"), "-o", path("compared"), "--size", "8x8", "--methods", "edge-scatter",
                 "--runs", "1"})
                .code,
            0);
  ASSERT_EQ(run({"wedges", path("roof.obj"), "--validate"}).code, 0);
}

TEST_F(StudioCommands, WhatCannotBeMeantIsRefused) {
  for (const char* light : {"cube:0,1,0:1", "rectangle:0,1:1", "sphere:0,1,0:0", "sun:0,0,0:1", "sun:0,-1,0:180",
                            "dome:0,1,0:1", "rectangle:0,1,nan:1"}) {
    const Outcome outcome = render({"--add-light", light});
    EXPECT_EQ(outcome.code, 2) << light;
    EXPECT_THAT(outcome.err, HasSubstr("--add-light")) << light;
  }
  EXPECT_EQ(render({"--floor", "carpet"}).code, 2);
  EXPECT_EQ(render({"--camera", "0,1,0:0,1,0"}).code, 2);
  EXPECT_EQ(render({"--camera", "0,1,0:0,2,0:180"}).code, 2);
  EXPECT_EQ(render({"--studio", "--no-studio"}).code, 2);
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--camera", "fit"}}) {
    std::vector<std::string> arguments = more;
    arguments.emplace_back("--no-studio");
    const Outcome dark = render(arguments);
    EXPECT_EQ(dark.code, 3);
    EXPECT_THAT(dark.err, HasSubstr("there is no light in the scene"));
  }
}

}  // namespace
}  // namespace penumbra::tests
