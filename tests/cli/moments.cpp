// SPDX-License-Identifier: Apache-2.0
// Tests `render --moment`: files of a scene at moments of an open shutter.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Moments : public ProgramTest {
 protected:
  /// Writes the tiny scene with its wedge moved.
  void write_moved(const std::string& name, double x, double y) const {
    write(name, scene_text_with("/meshes/1/triangles",
                                fmt::format("[[{0},{2},-1, {1},{2},-1, {3},{4},1], [{0},{2},-1, {3},{4},1, {0},{5},1]]",
                                            x - 1, x + 1, y + 1, x, y + 1.5, y + 0.25)));
  }
  [[nodiscard]] Outcome render(const std::string& scene, std::vector<std::string> more) const {
    more.insert(more.begin(), {"render", path(scene), "-o", path("o.exr")});
    return run(more);
  }
  [[nodiscard]] ExrFile picture(const std::string& scene, std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--stats", path("s.json")});
    const Outcome outcome = render(scene, more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return read_exr(path("o.exr"));
  }
  [[nodiscard]] std::uint64_t still() const {
    return json::parse(read("s.json")).at("counters").value("viewSamplesStill", std::uint64_t{0});
  }
};

/// The picture is the mean over the files, one of which may be given twice; positions are those of the scene.
TEST_F(Moments, InFilesAreTheirMean) {
  write_moved("now.json", 0, 0);
  write_moved("a.json", 0.5, 0);
  write_moved("b.json", -1, 0);
  for (const std::vector<std::string>& how : {std::vector<std::string>{}, {"--pixel-samples", "4"}}) {
    const ExrFile now = picture("now.json", how), a = picture("a.json", how), b = picture("b.json", how);
    std::vector<std::string> files = how;
    for (const char* file : {"a.json", "b.json", "a.json"}) files.insert(files.end(), {"--moment", path(file)});
    const ExrFile mean = picture("now.json", files);
    EXPECT_EQ(mean.attributes.at("penumbra.motionSamples"), "3");
    EXPECT_EQ(mean.floats.at("P.X"), now.floats.at("P.X"));
    EXPECT_EQ(mean.floats.at("Z"), now.floats.at("Z"));
    std::size_t moving = 0;
    for (const char* channel : {"R", "G", "B", "A", "V", "key.R", "key.V"}) {
      for (std::size_t i = 0; i < mean.floats.at(channel).size(); ++i) {
        const float one = a.floats.at(channel)[i], other = b.floats.at(channel)[i];
        // Sums of values up to 10 are rounded to float32.
        ASSERT_NEAR(mean.floats.at(channel)[i], (2 * double{one} + double{other}) / 3, 1e-5) << channel << " " << i;
        moving += one != other ? 1 : 0;
      }
    }
    EXPECT_GT(moving, 100u);
  }
}

/// The box around all vertices differs between moments. The origin of all moments is the scene's own middle, so that
/// what stands still has the same floats in all of them.
TEST_F(Moments, HaveOneOrigin) {
  write_moved("now.json", 0, 0);
  for (int i = 0; i < 3; ++i) write_moved(fmt::format("{}.json", i), 0.125 * i, 0.125 * i);
  const ExrFile now = picture("now.json");
  const ExrFile mean =
      picture("now.json", {"--moment", path("0.json"), "--moment", path("1.json"), "--moment", path("2.json")});
  EXPECT_GT(still(), 300u) << "of 48 x 32 at two moments";
  EXPECT_EQ(mean.floats.at("Prel.X"), now.floats.at("Prel.X"));
  // The mean over one moment, the scene itself, is its picture.
  const ExrFile same = picture("now.json", {"--moment", path("now.json")});
  for (const char* channel : {"R", "A", "V", "key.V", "P.X", "Z"})
    EXPECT_EQ(same.floats.at(channel), now.floats.at(channel)) << channel;
}

TEST_F(Moments, AreRefusedWhereThereIsNoMean) {
  write_moved("now.json", 0, 0);
  const std::string file = path("now.json");
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{"--frame", "1"}, "the files are the moments"},
      {{"--motion-samples", "2"}, "the files are the moments"},
      {{"--shutter", "1"}, "the files are the moments"},
      {{"--bits", path("x.bits")}, "at one moment"},
      {{"--camera", "all"}, "name one"}};
  for (const auto& [more, why] : wrong) {
    std::vector<std::string> arguments = {"--moment", file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = render("now.json", arguments);
    EXPECT_EQ(outcome.code, 2) << why;
    EXPECT_THAT(outcome.err, HasSubstr(why));
  }
  EXPECT_EQ(run({"render", file, "--moment", path("o.exr"), "-o", path("o.exr")}).code, 2) << "an input as the output";
  const Outcome absent = render("now.json", {"--moment", file, "--moment", path("none.json")});
  EXPECT_EQ(absent.code, 3);
  EXPECT_THAT(absent.err, HasSubstr("none.json"));
  write("small.json", scene_text_with("/size", "[24, 16]"));
  const Outcome other = render("now.json", {"--moment", path("small.json")});
  EXPECT_EQ(other.code, 3);
  EXPECT_THAT(other.err, HasSubstr("a picture of 24x16 pixels, but SCENE's has 48x32; set one size"));
  EXPECT_EQ(render("now.json", {"--moment", path("small.json"), "--size", "12x8"}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("x.bits")));
}

}  // namespace
}  // namespace penumbra::tests
