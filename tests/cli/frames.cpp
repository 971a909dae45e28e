// SPDX-License-Identifier: Apache-2.0
// Tests `render` of animated scenes: which frames and files it writes, and that a frame of a sequence equals the frame
// rendered alone.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"
#include "session/pictures/frame_render.hpp"
#include "tests/unit/import/gltf_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <span>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Frames : public ProgramTest {
 protected:
  Frames() { (void)moving_scene(); }
  Outcome render(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"render", path("scene.glb"), "--size", "24x16"};
    if (std::ranges::find(more, "--fps") == more.end()) more.insert(more.end(), {"--fps", "10"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(Frames, OfASequenceEqualThoseRenderedAlone) {
  const Outcome outcome = render({"--frames", "0-8x4", "-o", path("s.####.exr"), "--png", path("s.png"), "--stats",
                                  path("t%02d.json"), "--bits", path("s.####.bits")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, Not(HasSubstr("animation")));
  EXPECT_THAT(files(),
              ElementsAre("s.0000.bits", "s.0000.exr", "s.0000.png", "s.0004.bits", "s.0004.exr", "s.0004.png",
                          "s.0008.bits", "s.0008.exr", "s.0008.png", "scene.glb", "t00.json", "t04.json", "t08.json"));
  std::set<std::string> different;
  for (const char* frame : {"0", "4", "8"}) {
    ASSERT_EQ(render({"--frame", frame, "-o", path("one.exr"), "--bits", path("one.bits")}).code, 0);
    const std::string number = std::string("s.000") + frame;
    EXPECT_EQ(read("one.exr"), read(number + ".exr")) << frame;
    EXPECT_EQ(read("one.bits"), read(number + ".bits")) << frame;
    EXPECT_EQ(read_exr(path("one.exr")).attributes.at("penumbra.frame"), frame);
    EXPECT_EQ(json::parse(read(std::string("t0") + frame + ".json")).at("size"), json::array({24, 16}));
    different.insert(read("one.bits"));
  }
  EXPECT_EQ(different.size(), 3u) << "it moves";
}

/// Frame F is at time F / fps. The camera is between 4 and 3 units above the floor; pixels next to the middle see the
/// floor, or the body a unit above it.
TEST_F(Frames, AreAtTheirTime) {
  ASSERT_EQ(render({"--frame", "5", "-o", path("f.##.exr")}).code, 0);
  const ExrFile image = read_exr(path("f.05.exr"));
  const float z = image.floats.at("Z")[23];  // at a corner, which shows the floor
  EXPECT_FLOAT_EQ(z, 3.5f);
  ASSERT_EQ(render({"--frame", "5", "--fps", "20", "-o", path("g.exr")}).code, 0);
  EXPECT_FLOAT_EQ(read_exr(path("g.exr")).floats.at("Z")[23], 3.75f);
  for (const char* wrong : {"0", "-24", "x", "nan"})
    EXPECT_EQ(render({"--frame", "5", "--fps", wrong, "-o", path("h.exr")}).code, 2) << wrong;
}

/// With reproject=on V depends on earlier frames of the same run only: the run's first frame, and the first one after
/// frames made by another run, equal those rendered alone. `compare` renders the same frames.
TEST_F(Frames, ReprojectedDependOnTheSameRunOnly) {
  const std::string method = "shadow-map:size=24:reproject=on";
  const std::vector<std::string> sequence = {"--frames", "1-3", "--method", method, "-o", path("s.exr")};
  std::vector<std::string> counted = sequence;
  counted.insert(counted.end(), {"--stats", path("t.json")});
  ASSERT_EQ(render(counted).code, 0);
  const auto alone = [&](const char* frame) {
    EXPECT_EQ(render({"--frame", frame, "--method", method, "-o", path("one.exr")}).code, 0);
    return read("one.exr");
  };
  const std::string second = read("s.0002.exr"), third = read("s.0003.exr");
  EXPECT_EQ(read("s.0001.exr"), alone("1"));
  EXPECT_NE(second, alone("2"));
  EXPECT_NE(third, alone("3"));
  const auto reprojected = [&](const char* file) {
    return json::parse(read(file)).at("counters").at("reprojectedPixels").get<std::uint64_t>();
  };
  EXPECT_EQ(reprojected("t.0001.json"), 0U);
  EXPECT_GT(reprojected("t.0002.json"), 200U);  // of 384
  std::vector<std::string> rest = sequence;
  rest.emplace_back("--skip-existing");
  std::filesystem::remove(path("s.0001.exr"));
  std::filesystem::remove(path("s.0003.exr"));
  ASSERT_EQ(render(rest).code, 0);
  EXPECT_EQ(read("s.0002.exr"), second);
  EXPECT_EQ(read("s.0003.exr"), alone("3"));
  ASSERT_EQ(run({"compare", path("scene.glb"), "--size", "24x16", "--fps", "10", "--methods", method,
                 "--reference-samples", "16", "--frames", "1-3", "-o", path("dir")})
                .code,
            0);
  ASSERT_EQ(render(sequence).code, 0);
  EXPECT_EQ(read("s.0003.exr"), third);
  EXPECT_EQ(read_exr(path("dir/shadow-map,size=24,reproject=on.exr")).floats.at("V"),
            read_exr(path("s.0003.exr")).floats.at("V"));
}

TEST_F(Frames, ThatAreThereAreSkipped) {
  const std::vector<std::string> sequence = {"--frames",    "1-3",        "-o",    path("s.exr"),    "--png",
                                             path("s.png"), "--exposure", "first", "--skip-existing"};
  ASSERT_EQ(render(sequence).code, 0);
  const std::string second = read("s.0002.exr"), third = read("s.0003.exr"), picture = read("s.0003.png");
  write("s.0003.exr", "");  // an empty placeholder, or what a full disk left
  const auto before = std::filesystem::last_write_time(path("s.0002.exr"));
  const Outcome again = render(sequence);
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(std::filesystem::last_write_time(path("s.0002.exr")), before);
  EXPECT_EQ(read("s.0002.exr"), second);
  EXPECT_EQ(read("s.0003.exr"), third);
  EXPECT_EQ(read("s.0003.png"), picture) << "exposed as the first was";
  EXPECT_EQ(read_exr(path("s.0003.exr")).attributes.at("penumbra.exposure"),
            read_exr(path("s.0001.exr")).attributes.at("penumbra.exposure"));
  EXPECT_THAT(again.err, Not(HasSubstr("cut off")));
  EXPECT_THAT(render(sequence).err, HasSubstr("all 3 pictures already exist"));
}

/// A file that was cut off, or that another program wrote, counts as missing: it is named, and made again with the same
/// bytes.
TEST_F(Frames, ThatAreTornOrForeignAreMadeAgain) {
  const std::vector<std::string> sequence = {
      "--frames",     "1-2",    "-o",           path("s.exr"), "--png", path("s.png"),    "--stats",
      path("s.json"), "--bits", path("s.bits"), "--exposure",  "first", "--skip-existing"};
  ASSERT_EQ(render(sequence).code, 0);
  write_exr(path("foreign.exr"),
            {24, 16, {{"V", [](std::size_t, std::span<float> v) { std::ranges::fill(v, 1.0F); }}}, {}, {}});
  const std::string foreign = read("foreign.exr");
  std::filesystem::remove(path("foreign.exr"));
  std::map<std::string, std::string> whole;
  for (const char* name : {"s.0001.exr", "s.0001.png", "s.0001.bits", "s.0001.json", "s.0002.exr"})
    whole[name] = read(name);
  for (const auto& [name, bytes] : whole) {
    std::vector<std::string> wrong = {"a text", bytes.substr(0, bytes.size() - 1), bytes.substr(0, bytes.size() / 2)};
    if (name.ends_with(".exr")) wrong.push_back(foreign);
    for (const std::string& text : wrong) {
      write(name, text);
      const Outcome again = render(sequence);
      ASSERT_EQ(again.code, 0) << again.err;
      EXPECT_THAT(again.err, HasSubstr(name + " is incomplete, or was not written by this command")) << text.size();
      if (name.ends_with(".json")) continue;  // it contains times
      EXPECT_EQ(read(name), bytes) << name << ": made again over " << text.size() << " bytes, exposed as the first";
    }
  }
}

/// `--frame` accepts moments between frames: at 5.5 the camera has moved for half a frame since frame 5.
TEST_F(Frames, MayBeMoments) {
  ASSERT_EQ(render({"--frame", "5.5", "-o", path("f.exr")}).code, 0);
  const ExrFile image = read_exr(path("f.exr"));
  EXPECT_FLOAT_EQ(image.floats.at("Z")[23], 3.45f);
  EXPECT_EQ(image.attributes.at("penumbra.frame"), "5.5");
  const Outcome numbered = render({"--frame", "5.5", "-o", path("f.####.exr")});
  EXPECT_EQ(numbered.code, 2);
  EXPECT_THAT(numbered.err, HasSubstr("is between two frames"));
  for (const char* wrong : {"x", "1e10", "nan", ""})
    EXPECT_EQ(render({"--frame", wrong, "-o", path("g.exr")}).code, 2) << wrong;
  EXPECT_THAT(files(), ElementsAre("f.exr", "scene.glb"));
}

/// `compare` evaluates the same frame as `render`.
TEST_F(Frames, OfComparisonsAreAtTheirTime) {
  const auto compare = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"compare", path("scene.glb"), "--size",    "12x8",        "--runs", "1",
                                          "-o",      path("dir"),       "--methods", "edge-scatter"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  const Outcome outcome = compare({"--frame", "5", "--fps", "10", "--pixel-samples", "1", "--exposure", "-2", "--png",
                                   "--light-samples", "16", "--reference-samples", "16"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, Not(HasSubstr("animation")));
  EXPECT_FLOAT_EQ(read_exr(path("dir/edge-scatter.exr")).floats.at("Z")[11], 3.5f);
  const std::vector<std::pair<std::vector<std::string>, std::string>> refused = {
      {{"--pixel-samples", "4"}, "one view sample each"},
      {{"--motion-samples", "2"}, "at one moment"},
      {{"--pixel-filter", "blackman-harris"}, "without weights of a filter"},
      {{"--max-rmse", "-1"}, "--max-rmse -1: expected a number of 0 or more, such as 0.01"},
      {{"--shutter", "1"}, "not over an open shutter"},
      {{"--aperture", "0.1"}, "through the lens's middle"},
      {{"--focus-distance", "2"}, "through the lens's middle"},
      {{"--frames", "1-2", "--sample-pixels", "5"}, "at the same pixels"},
      {{"--instances", "shared"}, "which all methods support; expected auto or copies"},
      {{"--light-cutoff", "0.01"}, "every light's V is compared"},
      {{"--skip-existing"}, "earlier results are not kept"},
      {{"--camera", "all"}, "name one"},
      {{"--exposure", "bright"}, "stops from -100 to 100"},
      {{"--fps", "0"}, "a number above 0"}};
  for (const auto& [options, why] : refused) {
    const Outcome one = compare(options);
    EXPECT_EQ(one.code, 2) << options.front();
    EXPECT_THAT(one.err, HasSubstr(why)) << options.front();
  }
}

TEST_F(Frames, ExposuresAreStops) {
  const auto png = [&](const std::string& exposure) {
    EXPECT_EQ(render({"--frame", "1", "-o", path("e.exr"), "--png", path("e.png"), "--exposure", exposure}).code, 0);
    return read("e.png");
  };
  const std::string automatic = png("auto");
  const std::string stops = read_exr(path("e.exr")).attributes.at("penumbra.exposure");
  EXPECT_EQ(png(stops), automatic) << "what the header says is what was done";
  EXPECT_NE(png("-3"), png("-4"));
  for (const char* wrong : {"bright", "1e9", "nan", "101"})
    EXPECT_EQ(render({"--frame", "1", "-o", path("e.exr"), "--exposure", wrong}).code, 2) << wrong;
}

/// R G B A and V are means over blocks of a larger picture; everything else is taken at the pixel's centre.
TEST_F(Frames, PixelSamplesAreMeans) {
  ASSERT_EQ(render({"--frame", "3", "-o", path("one.exr")}).code, 0);
  ASSERT_EQ(render({"--frame", "3", "-o", path("four.exr"), "--pixel-samples", "4", "--pixel-tolerance", "0"}).code, 0);
  ASSERT_EQ(
      run({"render", path("scene.glb"), "--size", "48x32", "--fps", "10", "--frame", "3", "-o", path("large.exr")})
          .code,
      0);
  const ExrFile one = read_exr(path("one.exr")), four = read_exr(path("four.exr")), large = read_exr(path("large.exr"));
  ASSERT_EQ(four.width, 24u);
  std::size_t between = 0;
  for (const auto& [name, values] : four.floats) {
    const bool is_mean =
        name == "R" || name == "G" || name == "B" || name == "A" || name == "V" || name.starts_with("Lamp");
    if (!is_mean && !name.starts_with("Crypto")) {  // mattes are shares of all view samples
      EXPECT_EQ(values, one.floats.at(name)) << name;
    }
    for (std::size_t i = 0; is_mean && i < values.size(); ++i) {
      const auto& source = large.floats.at(name);
      const std::size_t first = 2 * (i / 24) * 48 + 2 * (i % 24);
      const double sum =
          double{source[first]} + double{source[first + 1]} + double{source[first + 48]} + double{source[first + 49]};
      ASSERT_EQ(values[i], static_cast<float>(sum / 4)) << name << " " << i;
      between += name == "V" && values[i] != one.floats.at(name)[i] ? 1 : 0;
    }
  }
  EXPECT_GT(between, 5u);
  EXPECT_EQ(four.integers.at("id"), one.integers.at("id"));
}

/// A lamp that an animation hides stays a light, but dark; means over a shutter match lights by their names.
TEST_F(Frames, OfALampThatIsHidden) {
  test::Gltf gltf;
  gltf.at("/nodes/0")["rotation"] = {-0.70710678, 0, 0, 0.70710678};
  gltf.at("/nodes/1")["rotation"] = {1, 0, 0, 0};
  gltf.at("/nodes/1")["translation"] = {-2, 5, 0};
  gltf.at("/nodes/2") = {
      {"name", "Camera"}, {"camera", 0}, {"translation", {0, 4, 0}}, {"rotation", {-0.70710678, 0, 0, 0.70710678}}};
  gltf.at("/nodes").push_back({{"name", "B"}, {"mesh", 1}, {"translation", {2, 5, 0}}, {"rotation", {1, 0, 0, 0}}});
  gltf.at("/scenes/0/nodes") = {0, 1, 2, 3};
  gltf.animate(1, "scale", {0, 1}, {1, 1, 1, 0, 0, 0}, "STEP");
  write("scene.glb", gltf.glb());
  const Outcome outcome = render({"--frames", "5-15x5", "-o", path("s.##.exr"), "--light", "Lamp", "--light", "B"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("'Lamp' is scaled to zero"));
  const ExrFile shown = read_exr(path("s.05.exr")), hidden = read_exr(path("s.15.exr"));
  const auto greatest = [](const std::vector<float>& all) { return *std::ranges::max_element(all); };
  ASSERT_EQ(shown.floats.size(), hidden.floats.size());
  EXPECT_GT(greatest(shown.floats.at("Lamp.R")), 0.1f);
  EXPECT_EQ(greatest(hidden.floats.at("Lamp.R")), 0);
  for (std::size_t i = 0; i < shown.floats.at("B.R").size(); ++i)
    EXPECT_FLOAT_EQ(hidden.floats.at("B.R")[i], shown.floats.at("B.R")[i]);
  // The moments are half a frame and one and a half frames before and after the key.
  const Outcome mean = render({"--frame", "10", "--motion-samples", "4", "--shutter", "4", "-o", path("m.exr")});
  ASSERT_EQ(mean.code, 0) << mean.err;
  const ExrFile blurred = read_exr(path("m.exr"));
  for (std::size_t i = 0; i < blurred.floats.at("R").size(); ++i) {
    EXPECT_FLOAT_EQ(blurred.floats.at("Lamp.R")[i], shown.floats.at("Lamp.R")[i] / 2);
    EXPECT_FLOAT_EQ(blurred.floats.at("B.R")[i], shown.floats.at("B.R")[i]);
  }
}

TEST(PictureMean, KnowsLightsByTheirNames) {
  const std::vector<float> alpha = {1};
  session::PictureMean mean(1, 1);
  using Values = std::vector<std::vector<float>>;
  using Colors = std::vector<std::vector<glm::vec3>>;
  mean.add(alpha, {"A", "B"}, Values{{1}, {0.5f}}, Colors{{glm::vec3(4)}, {glm::vec3(2)}}, 1, {{0, 1}, 0});
  mean.add(alpha, {"B", "C"}, Values{{0.25f}, {1}}, Colors{{glm::vec3(1)}, {glm::vec3(8)}}, 1, {{0, 1}, 0});
  EXPECT_THAT(mean.lights(), ElementsAre("A", "B", "C"));
  const std::vector<std::string> asked = {"C", "B", "A", "D"};
  EXPECT_EQ(mean.take_visibility(asked), (Values{{0.5f}, {0.375f}, {0.5f}, {0}}));
  EXPECT_EQ(mean.take_beauty(asked), (Colors{{glm::vec3(4)}, {glm::vec3(1.5f)}, {glm::vec3(2)}, {glm::vec3(0)}}));
}

/// Two moments of a shutter that is open for 0.4 frames: 0.1 frames before and after the frame.
TEST_F(Frames, MotionSamplesAreMeansOfMoments) {
  ASSERT_EQ(render({"--frame", "5", "-o", path("m.exr"), "--motion-samples", "2", "--shutter", "0.4"}).code, 0);
  ASSERT_EQ(render({"--frame", "5", "-o", path("now.exr")}).code, 0);
  ASSERT_EQ(render({"--frame", "49", "--fps", "100", "-o", path("a.exr")}).code, 0);
  ASSERT_EQ(render({"--frame", "51", "--fps", "100", "-o", path("b.exr")}).code, 0);
  const ExrFile mean = read_exr(path("m.exr")), now = read_exr(path("now.exr")), a = read_exr(path("a.exr")),
                b = read_exr(path("b.exr"));
  EXPECT_EQ(mean.floats.at("Z"), now.floats.at("Z"));
  EXPECT_NE(mean.floats.at("V"), now.floats.at("V"));
  for (const char* name : {"R", "V", "A", "Lamp.V"}) {
    for (std::size_t i = 0; i < mean.floats.at(name).size(); ++i) {
      // The two times are computed in different orders and may differ by one rounding of a double; radiance goes up to
      // 20.
      EXPECT_NEAR(mean.floats.at(name)[i], (a.floats.at(name)[i] + b.floats.at(name)[i]) / 2, 2e-5) << name << i;
    }
  }
}

TEST_F(Frames, PixelSamplesAreRoundedToSquaresAndRefusedWithBits) {
  const auto code = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"-o", path("x.exr")});
    return render(more).code;
  };
  for (const char* wrong : {"0", "-4", "65", "x"}) EXPECT_EQ(code({"--pixel-samples", wrong}), 2) << wrong;
  EXPECT_EQ(code({"--pixel-samples", "4", "--bits", path("x.bits")}), 2);
  EXPECT_EQ(code({"--motion-samples", "4"}), 2) << "motion samples need --frame or --frames";
  EXPECT_EQ(code({"--frame", "1", "--motion-samples", "0"}), 2);
  EXPECT_EQ(code({"--frame", "1", "--motion-samples", "2", "--shutter", "-1"}), 2);
  const Outcome rounded = render({"--pixel-samples", "3", "-o", path("three.exr")});
  EXPECT_EQ(rounded.code, 0);
  EXPECT_THAT(rounded.err, HasSubstr("--pixel-samples 3: 4, the next square number"));
  EXPECT_THAT(render({"--pixel-samples", "4", "-o", path("four.exr")}).err, Not(HasSubstr("square")));
  EXPECT_EQ(read_exr(path("three.exr")).floats, read_exr(path("four.exr")).floats);
}

TEST_F(Frames, OfAllCameras) {
  ASSERT_EQ(render({"--camera", "all", "--frames", "2-3", "-o", path("o.####.exr")}).code, 0);
  EXPECT_THAT(files(),
              ElementsAre("o.B.2.0002.exr", "o.B.2.0003.exr", "o.Camera.0002.exr", "o.Camera.0003.exr", "scene.glb"));
  const Outcome first = render({"--frames", "2-4", "-o", path("p.####.exr")});
  const auto said = first.err.find("the first of 2");
  EXPECT_NE(said, std::string::npos) << first.err;
  EXPECT_EQ(first.err.find("the first of 2", said + 1), std::string::npos) << "once a sequence: " << first.err;
  ASSERT_EQ(render({"--camera", "B.2", "--frame", "3", "-o", path("one.exr")}).code, 0);
  EXPECT_EQ(read("one.exr"), read("o.B.2.0003.exr"));
}

/// One file per frame, of meshes without light or camera: the studio is that of the file with the lowest number.
TEST_F(Frames, MayBeAFileEach) {
  for (int frame = 2; frame <= 5; ++frame) {
    write(
        fmt::format("m.{:03}.obj", frame),
        fmt::format("v 0 {0} 0\nv 1 {0} 0\nv 0 {0} -1\nv -3 0 3\nv 3 0 3\nv 0 0 -3\nf 1 2 3\nf 4 5 6\n", 0.2 * frame));
  }
  write("m.x.obj", "not of the sequence");
  const auto frames = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", path("m.###.obj"), "--size", "24x16"});
    return run(more);
  };
  ASSERT_EQ(frames({"--frames", "2-5", "-o", path("s.####.exr")}).code, 0)
      << frames({"--frames", "2-5", "-o", path("s.####.exr")}).err;
  const ExrFile first = read_exr(path("s.0002.exr")), last = read_exr(path("s.0005.exr"));
  std::size_t same = 0;  // pixels that show the ground, at the studio floor's height, in both: the studio does not move
  for (std::size_t i = 0; i < first.floats.at("P.Y").size(); ++i) {
    const auto on_ground = [i](const ExrFile& exr) { return std::abs(exr.floats.at("P.Y")[i]) < 1e-5F; };
    if (first.floats.at("A")[i] == 0 || !on_ground(first) || !on_ground(last)) continue;
    EXPECT_NEAR(first.floats.at("P.X")[i], last.floats.at("P.X")[i], 1e-5);
    ++same;
  }
  EXPECT_GT(same, 100u);
  EXPECT_NE(first.floats.at("V"), last.floats.at("V")) << "it moves";
  ASSERT_EQ(frames({"--frame", "5", "-o", path("alone.exr")}).code, 0);
  EXPECT_EQ(read("alone.exr"), read("s.0005.exr"));
  // The first frame equals the picture of its file rendered alone.
  ASSERT_EQ(run({"render", path("m.002.obj"), "--size", "24x16", "-o", path("still.exr")}).code, 0);
  EXPECT_EQ(read_exr(path("still.exr")).floats.at("V"), first.floats.at("V"));
  EXPECT_THAT(frames({"-o", path("a.exr")}).err,
              HasSubstr("m.###.obj is one file per frame: --frame or --frames must select whole frames"));
  EXPECT_EQ(frames({"--frame", "2.5", "-o", path("a.exr")}).code, 2);
  EXPECT_EQ(frames({"--frame", "2", "--motion-samples", "4", "-o", path("a.exr")}).code, 2);
  EXPECT_THAT(frames({"--frame", "9", "-o", path("a.exr")}).err, HasSubstr("m.009.obj"));
  EXPECT_THAT(run({"render", path("none.##.obj"), "--frame", "1", "-o", path("a.exr")}).err,
              HasSubstr("no file of such a name is there"));
}

}  // namespace
}  // namespace penumbra::tests
