// SPDX-License-Identifier: Apache-2.0
// Progress functions of the calling program: the values that they get, and that they can end every call that may take
// long.

#include "tests/cli/program.hpp"

#include <penumbra/penumbra.hpp>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::tests {
namespace {

using testing::HasSubstr;
using Clock = std::chrono::steady_clock;

class LibraryEnds : public ProgramTest {
 protected:
  const std::string scene_ = tiny_scene();
};

TEST_F(LibraryEnds, ProgressEndsACall) {
  std::string stages;
  bool goes_on = true;
  std::vector<std::string> messages;
  Renderer renderer(Scene::load(scene_), {.log = [&](LogLevel, std::string_view text) { messages.emplace_back(text); },
                                          .progress =
                                              [&](std::string_view stage, double done) {
                                                EXPECT_GE(done, 0);
                                                EXPECT_LE(done, 1);
                                                stages += std::string(stage) + ";";
                                                return goes_on;
                                              }});
  const auto beauty = [&] {
    const Picture picture = renderer.render();
    return std::vector(picture.beauty().begin(), picture.beauty().end());
  };
  const std::vector<Picture::Float3> before = beauty();
  EXPECT_THAT(stages, HasSubstr("edge-scatter"));
  goes_on = false;
  EXPECT_THROW(renderer.render(), Cancelled);
  goes_on = true;
  EXPECT_EQ(beauty(), before);
  renderer.scene().set_light("key", LightOptions{.radiance = {1, 1, 1}});
  renderer.scene().set_light("key", Rectangle{.center = {0, 4, 0}, .half_u = {0.5, 0, 0}, .half_v = {0, 0, -0.5}});
  static_cast<void>(renderer.render());  // the light shines upward: nothing is lit
  EXPECT_THAT(messages, testing::Contains(HasSubstr("no visible point")));
}

/// The progress function is called several times while one method evaluates one light, and its request to end takes
/// effect there; otherwise the picture is the same as without it.
TEST_F(LibraryEnds, AMethodIsHeardBetweenBands) {
  const RenderOptions large{.width = 512, .height = 512, .method = "edge-scatter", .light_samples = 16};
  int within = 0, most = std::numeric_limits<int>::max();
  const auto count = [&](std::string_view stage, double done) {
    if (stage == "edge-scatter" && done > 0 && done < 1) ++within;
    return within < most;
  };
  Renderer renderer(Scene::load(scene_), {.progress = count});
  const Picture banded = renderer.render(large);
  EXPECT_GE(within, 3) << "512 rows in bands of 128";
  const Picture whole = Renderer(Scene::load(scene_)).render(large);
  EXPECT_TRUE(std::ranges::equal(banded.visibility(0), whole.visibility(0)));
  EXPECT_TRUE(std::ranges::equal(banded.beauty(), whole.beauty()));
  within = 0, most = 1;
  EXPECT_THROW(renderer.render(large), Cancelled);
  EXPECT_EQ(within, 1);

  // Comparisons take 1,024 rays for each pixel as reference: here sixteen rows at once.
  std::set<double> shares;
  const auto note = [&](std::string_view stage, double done) {
    if (stage.starts_with("raytrace")) shares.insert(done);
    return true;
  };
  static_cast<void>(compare_json(
      Scene::load(scene_), {.methods = {"edge-scatter"}, .width = 512, .height = 128, .runs = 1}, {.progress = note}));
  EXPECT_GE(shares.size(), 7U);
}

TEST_F(LibraryEnds, InspectionsEndToo) {
  const std::array<Vector, 3> positions = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  const std::array<std::array<std::uint32_t, 3>, 1> triangle = {{{0, 1, 2}}};
  EXPECT_EQ(nlohmann::json::parse(inspect_json(positions, triangle)).at("triangles"), 1);
  EXPECT_THROW(static_cast<void>(
                   inspect_json(positions, triangle, {}, {.progress = [](std::string_view, double) { return false; }})),
               Cancelled);
}

TEST_F(LibraryEnds, ComparisonsEndToo) {
  int calls = 0;
  const auto end = [&](std::string_view, double) -> bool {
    if (++calls > 5) throw std::logic_error("the host's own");
    return true;
  };
  EXPECT_THROW(
      compare_json(Scene::load(scene_), {.methods = {"edge-scatter", "raytrace"}, .runs = 1}, {.progress = end}),
      std::logic_error);
  EXPECT_EQ(calls, 6);
}

TEST_F(LibraryEnds, Wedges) {
  std::vector<double> told;
  const Scene scene = Scene::load(scene_);
  const auto watched = [&](bool goes_on) {
    return wedges_json(scene, {.validate = true, .progress = [&, goes_on](std::string_view, double done) {
                                 told.push_back(done);
                                 return goes_on || told.size() < 3;
                               }});
  };
  EXPECT_EQ(watched(true), wedges_json(scene, {.validate = true}));
  EXPECT_GT(told.size(), 4U);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  told.clear();
  EXPECT_THROW(static_cast<void>(watched(false)), Cancelled);
  EXPECT_EQ(told.size(), 3U);
}

/// Another process would read the file for minutes: the call ends at once, and so does that process.
TEST_F(LibraryEnds, WhileAnotherProcessReads) {
  const std::string process = path("process");
  write("slow", "#!/bin/sh\necho $$ > " + process + "\nexec sleep 100\n");
  std::filesystem::permissions(path("slow"), std::filesystem::perms::owner_all);
  ::setenv("PENUMBRA_IMPORT_HELPER", path("slow").c_str(), 1);
  const std::string mesh = write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string json = R"({"format": "penumbra-scene/1", "camera": {"eye": [0, 0, 5], "target": [0, 0, 0]},
    "meshes": [{"file": "mesh.obj"}], "lights": [{"sphere": {"center": [0, 4, 0], "radius": 1}}]})";
  const auto runs = [&] {
    std::ifstream file(process);
    pid_t number = 0;
    return file >> number && ::kill(number, 0) == 0;
  };
  const std::function<bool(std::string_view, double)> until_it_runs = [&](std::string_view stage, double) {
    EXPECT_EQ(stage, "reading");
    return !runs();
  };
  const auto expect_end = [&](const auto& call, const char* what) {
    std::filesystem::remove(process);
    const auto begin = Clock::now();
    EXPECT_THROW(call(), Cancelled) << what;
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - begin).count(), 10) << what;
    EXPECT_FALSE(runs()) << what;
  };
  expect_end([&] { Scene::load(mesh, {.progress = until_it_runs}); }, "mesh");
  expect_end([&] { Scene::load(write("scene.json", json), {.progress = until_it_runs}); }, "scene");
  expect_end([&] { Scene::load(write("scene.gltf", "{}"), {.progress = until_it_runs}); }, "glTF");
  expect_end([&] { Scene::parse(json, folder_, {.progress = until_it_runs}); }, "text");
  expect_end([&] { static_cast<void>(inspect_json(mesh, {}, {.progress = until_it_runs})); }, "inspect");
  const auto own = [](std::string_view, double) -> bool { throw std::logic_error("the host's own"); };
  EXPECT_THROW(Scene::load(write("scene.json", json), {.progress = own}), std::logic_error);
  ::unsetenv("PENUMBRA_IMPORT_HELPER");
}

}  // namespace
}  // namespace penumbra::tests
