// SPDX-License-Identifier: Apache-2.0
// Compares the library with the program: the same numbers, also with kept data, from several threads, and after errors.

#include "base/exr.hpp"
#include "tests/cli/program.hpp"
#include "tests/library/picture_bytes.hpp"

#include <penumbra/penumbra.hpp>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <thread>

namespace penumbra::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Returns all numbers of a picture.
std::string all_bytes(const Picture& picture) {
  std::string bytes = bytes_of(picture.beauty()) + bytes_of(picture.alpha()) + bytes_of(picture.positions()) +
                      bytes_of(picture.relative_positions()) + bytes_of(picture.normals()) + bytes_of(picture.depth()) +
                      bytes_of(picture.ids());
  for (std::size_t light = 0; light < picture.lights().size(); ++light)
    bytes += bytes_of(picture.visibility(light)) + bytes_of(picture.beauty(light)) + bytes_of(picture.masks(light));
  return bytes;
}

std::vector<float> component(std::span<const Picture::Float3> values, std::size_t axis) {
  std::vector<float> one;
  for (const Picture::Float3& value : values) one.push_back(value[axis]);
  return one;
}

class Library : public ProgramTest {
 protected:
  /// Renders with the program, and compares every channel.
  void expect_same(const Picture& picture, std::vector<std::string> arguments, const std::string& what) const {
    arguments.insert(arguments.begin(), {"--quiet", "render", scene_, "-o", path("out.exr")});
    const Outcome outcome = run(std::move(arguments));
    ASSERT_EQ(outcome.code, 0) << what << ": " << outcome.err;
    const ExrFile file = read_exr(path("out.exr"));
    const auto channel = [&](const std::string& name) { return file.floats.at(name); };
    const auto equal = [&](const std::vector<float>& values, const std::string& name) {
      EXPECT_EQ(bytes_of(std::span<const float>(values)), bytes_of(std::span<const float>(channel(name))))
          << what << ": " << name;
    };
    const auto list = [](std::span<const float> values) { return std::vector(values.begin(), values.end()); };
    equal(list(picture.visibility()), "V");
    equal(list(picture.visibility(0)), picture.lights()[0] + ".V");
    equal(list(picture.alpha()), "A");
    equal(list(picture.depth()), "Z");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      equal(component(picture.beauty(), axis), std::string(1, "RGB"[axis]));
      equal(component(picture.beauty(0), axis), picture.lights()[0] + "." + "RGB"[axis]);
      equal(component(picture.positions(), axis), std::string("P.") + "XYZ"[axis]);
      equal(component(picture.relative_positions(), axis), std::string("Prel.") + "XYZ"[axis]);
      equal(component(picture.normals(), axis), std::string("N.") + "XYZ"[axis]);
    }
  }

  const std::string scene_ = tiny_scene();
};

TEST_F(Library, TheProgramsNumbers) {
  Renderer renderer(Scene::load(scene_));
  expect_same(renderer.render({.width = 40, .height = 30}), {"--size", "40x30"}, "exact");
  for (const char* method : {"edge-scatter", "view-sample", "depth-complexity", "raytrace", "pcf"}) {
    const bool counts = std::string(method) != "pcf";
    RenderOptions options{.width = 24, .height = 16, .method = method};
    std::vector<std::string> arguments = {"--size", "24x16", "--method", method};
    if (counts) {
      options.light_samples = 64;
      arguments.insert(arguments.end(), {"--light-samples", "64"});
    } else {
      options.options = {{"size", "64"}, {"window", "5"}};
      arguments.insert(arguments.end(), {"--method-option", "size=64", "--method-option", "window=5"});
    }
    expect_same(renderer.render(options), arguments, method);
  }
  expect_same(renderer.render({.width = 12, .height = 8, .pixel_samples = 4}),
              {"--size", "12x8", "--pixel-samples", "4"}, "four view samples a pixel");
}

TEST_F(Library, OptionsStandBehindAMethodsName) {
  Renderer renderer(Scene::load(scene_));
  const Picture apart = renderer.render({.method = "soft-volume", .options = {{"split", "2"}}});
  const Picture behind = renderer.render({.method = "soft-volume:split=2"});
  EXPECT_TRUE(all_bytes(behind) == all_bytes(apart));
  EXPECT_EQ(nlohmann::json::parse(behind.stats_json()).at("options"), nlohmann::json({{"split", "2"}}));
  expect_same(behind, {"--method", "soft-volume:split=2"}, "soft-volume:split=2");
  EXPECT_THROW(renderer.render({.method = "soft-volume:split=2", .options = {{"split", "1"}}}), UsageError);
  EXPECT_EQ(
      run({"render", scene_, "-o", path("two.exr"), "--method", "soft-volume:split=2", "--method-option", "split=2"})
          .code,
      2);
}

TEST_F(Library, MasksAreTheBitsOfTheProgram) {
  Renderer renderer(Scene::load(scene_));
  const Picture picture = renderer.render({.width = 24, .height = 16, .method = "edge-scatter", .light_samples = 100});
  ASSERT_EQ(run({"--quiet", "render", scene_, "-o", path("out.exr"), "--size", "24x16", "--method", "edge-scatter",
                 "--light-samples", "100", "--bits", path("out.bits")})
                .code,
            0);
  const std::string bits = read("out.bits");
  const std::size_t pixels = std::size_t{24} * 16, words = 4;
  ASSERT_EQ(picture.words_per_mask(), words);
  EXPECT_EQ(picture.light_samples(), 100U);
  ASSERT_EQ(picture.masks().size(), pixels * words);
  // After the first line, three doubles and the light points, each pixel has p, its triangle and its words.
  std::size_t at = bits.find('\n') + 1 + 3 * sizeof(double) + 100 * sizeof(Picture::Float3);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    at += 12 + 4;
    EXPECT_EQ(bits.substr(at, words * 4), bytes_of(picture.masks().subspan(pixel * words, words))) << pixel;
    at += words * 4;
  }
  EXPECT_EQ(at, bits.size());
  EXPECT_THAT(renderer.render({.method = "edge-scatter", .light_samples = 100, .masks = false}).masks(), IsEmpty());
}

/// Data that the renderer keeps must not show: every picture equals that of a new renderer.
TEST_F(Library, KeepsNothingThatChanged) {
  Renderer renderer(Scene::load(scene_));
  const auto expect_fresh = [&](const RenderOptions& options, const char* what) {
    EXPECT_EQ(all_bytes(renderer.render(options)), all_bytes(Renderer(renderer.scene()).render(options))) << what;
  };
  const RenderOptions exact{.width = 24, .height = 16};
  expect_fresh(exact, "first");
  expect_fresh(exact, "again");
  renderer.scene().set_light("key", Sphere{.center = {0, 4, 0}, .radius = 0.5});
  expect_fresh(exact, "light");
  expect_fresh({.width = 24, .height = 16, .method = "edge-scatter", .light_samples = 64}, "samples");
  expect_fresh({.width = 32, .height = 8}, "size");
  renderer.scene().set_camera({.eye = {3, 3, 3}, .target = {0, 0, 0}});
  expect_fresh(exact, "camera");
  const MeshId wedge = renderer.scene().mesh("wedge");
  renderer.scene().set_transform(wedge, {1, 0, 0, 0.5, 0, 0.8, 0, 0.1, 0, 0, 1, 0, 0, 0, 0, 1});
  expect_fresh(exact, "moved");
  renderer.scene().set_transform(wedge, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  expect_fresh({.width = 24, .height = 16, .method = "view-sample", .light_samples = 64}, "moved back");
  expect_fresh({.width = 12, .height = 8, .pixel_samples = 4}, "four view samples a pixel");
  expect_fresh({.width = 12, .height = 8, .light_cutoff = 1}, "no light");
  expect_fresh({.width = 12, .height = 8, .light_samples = 16, .pixel_samples = 4}, "with light samples");
  expect_fresh({.width = 12, .height = 8, .light_samples = 64, .sample_pattern = "sobol", .pixel_samples = 4},
               "others");
  expect_fresh(exact, "one again");
  renderer.scene().add_light("rim", Rectangle{.center = {2, 2, 0}, .half_u = {0, 0.5, 0}, .half_v = {0, 0, -0.5}});
  expect_fresh(exact, "second light");
  renderer.scene().remove_light("key");
  expect_fresh(exact, "first light removed");
}

TEST_F(Library, StaysUsableAfterErrors) {
  Renderer renderer(Scene::load(scene_));
  const std::string before = all_bytes(renderer.render());
  EXPECT_THROW(renderer.render({.method = "no-such-method"}), UsageError);
  EXPECT_THROW(renderer.render({.method = "edge-scatter", .options = {{"colour", "red"}}}), UsageError);
  EXPECT_THROW(renderer.render({.light_samples = 100000}), UsageError);
  EXPECT_THROW(renderer.render({.sample_pattern = "rings"}), UsageError);
  EXPECT_THROW(renderer.render({.lights = {"moon"}}), UsageError);
  EXPECT_THROW(renderer.render({.camera = "side"}), UsageError);
  EXPECT_THROW(renderer.render({.pixel_samples = 3}), UsageError);
  EXPECT_THROW(renderer.render({.light_cutoff = 1.5}), UsageError);
  EXPECT_THROW(renderer.render({.width = 10}), UsageError);
  EXPECT_EQ(all_bytes(renderer.render()), before);
  Scene& scene = renderer.scene();
  EXPECT_THROW(scene.set_light("moon", Sphere{{0, 1, 0}, 1}), UsageError);
  EXPECT_THROW(scene.set_light("key", Sphere{{0, 1, 0}, -1}), InputError);
  EXPECT_THROW(scene.add_light("key", Sphere{{0, 1, 0}, 1}), UsageError);
  EXPECT_THROW(scene.set_light("key", Dome{.image = "none.hdr"}), InputError);
  EXPECT_THROW(scene.set_light("key", Dome{.up = {0, 0, 0}}), InputError);
  EXPECT_THROW(scene.set_camera({.eye = {0, 0, 0}, .target = {0, 0, 0}}), InputError);
  EXPECT_THROW(scene.set_transform(scene.mesh("wedge"), {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1}), InputError);
  const std::array<Vector, 3> corners = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  const std::array<std::array<std::uint32_t, 3>, 1> beyond = {{{0, 1, 3}}};
  EXPECT_THROW(scene.add_mesh("bad", corners, beyond), InputError);
  EXPECT_EQ(all_bytes(renderer.render()), before);
  try {
    static_cast<void>(Scene::load(path("nowhere.json")));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("nowhere.json"));
    EXPECT_EQ(error.code(), ExitCode::input);
  }
  EXPECT_THROW(Renderer(Scene()).render(), InputError);
}

/// Many pictures made on two threads at once, with methods that keep buffers for each thread, equal those made alone.
TEST_F(Library, RenderersOnTwoThreadsDoNotMeet) {
  const auto pictures = [this](const char* method, bool sphere) {
    Renderer renderer(Scene::load(scene_));
    if (sphere) renderer.scene().set_light("key", Sphere{.center = {0, 4, 0}, .radius = 0.4});
    std::string all;
    for (int i = 0; i < 12; ++i) {
      renderer.scene().set_camera({.eye = {2, 2.0 + 0.1 * i, 3}, .target = {0, 0.5, 0}});
      all += all_bytes(renderer.render({.width = 96, .height = 64, .method = method, .light_samples = 64}));
      all += all_bytes(renderer.render({.width = 96, .height = 64}));
    }
    return all;
  };
  const std::string first = pictures("edge-scatter", true), second = pictures("view-sample", true);
  std::string first_at_once, second_at_once;
  std::thread other([&] { first_at_once = pictures("edge-scatter", true); });
  second_at_once = pictures("view-sample", true);
  other.join();
  EXPECT_EQ(first_at_once, first);
  EXPECT_EQ(second_at_once, second);
}

TEST_F(Library, OneCallAtATime) {
  Renderer* self = nullptr;
  int refused = 0;
  Renderer renderer(Scene::load(scene_), {.progress = [&](std::string_view, double) {
                      try {
                        static_cast<void>(self->render());
                      } catch (const UsageError&) {
                        ++refused;
                      }
                      EXPECT_THROW(static_cast<void>(self->scene()), UsageError);
                      return true;
                    }});
  self = &renderer;
  static_cast<void>(renderer.render());
  EXPECT_GT(refused, 0);
  EXPECT_NO_THROW(static_cast<void>(renderer.scene()));
}

TEST_F(Library, MeshesMoveFromWhereTheyWere) {
  Scene scene = Scene::load(scene_);
  const RenderOptions options{.width = 24, .height = 16};
  const std::string before = all_bytes(Renderer(scene).render(options));
  const Matrix away = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1},
               home = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  scene.set_transform(scene.mesh("wedge"), away);
  EXPECT_NE(all_bytes(Renderer(scene).render(options)), before);
  const std::array<Vector, 4> floor = {{{-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}}};
  const std::array<std::array<std::uint32_t, 3>, 2> two = {{{0, 1, 2}, {0, 2, 3}}};
  scene.set_mesh(scene.mesh("floor"), floor, two);
  scene.set_transform(scene.mesh("wedge"), home);
  const std::string back = all_bytes(Renderer(scene).render(options));
  scene.set_transform(scene.mesh("wedge"), away);
  scene.set_transform(scene.mesh("wedge"), home);
  EXPECT_EQ(all_bytes(Renderer(scene).render(options)), back);
}

/// A scene that was moved from is empty, and can be filled again.
TEST_F(Library, ScenesThatWereMovedFromAreAsNew) {
  const std::array<Vector, 3> corners = {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}};
  const std::array<std::array<std::uint32_t, 3>, 1> face = {{{0, 1, 2}}};
  Scene scene;
  scene.add_mesh("leaf", corners, face);
  Scene other = std::move(scene);
  EXPECT_EQ(other.triangle_count(), 1U);
  EXPECT_EQ(scene.triangle_count(), 0U);  // NOLINT(bugprone-use-after-move): what a program may do
  scene.add_mesh("other leaf", corners, face);
  other = std::move(scene);
  EXPECT_EQ(scene.triangle_count(), 0U);  // NOLINT(bugprone-use-after-move)
  EXPECT_EQ(other.triangle_count(), 1U);
}

TEST_F(Library, UnusedVerticesAreNoPartOfAScene) {
  const std::array<Vector, 5> board = {{{9, 9, 9}, {-1, 1, -1}, {1, 1, -1}, {5, 5, 5}, {0, 1.5, 1}}};
  const std::array<std::array<std::uint32_t, 3>, 1> one = {{{1, 2, 4}}};
  const std::array<Vector, 3> used = {board[1], board[2], board[4]};
  const std::array<std::array<std::uint32_t, 3>, 1> all = {{{0, 1, 2}}};
  const RenderOptions options{.width = 24, .height = 16};
  Scene loose = Scene::load(scene_), tight = loose;
  const MeshId mesh = loose.add_mesh("board", board, one);
  tight.add_mesh("board", used, all);
  EXPECT_THAT(loose.warnings(), testing::Contains(HasSubstr("left out 2 vertices")));
  EXPECT_TRUE(all_bytes(Renderer(loose).render(options)) == all_bytes(Renderer(tight).render(options)));
  std::array<Vector, 5> higher = board;
  for (Vector& p : higher) p[1] += 0.5;
  const std::array<Vector, 3> higher_used = {higher[1], higher[2], higher[4]};
  EXPECT_THROW(loose.set_positions(mesh, higher_used), InputError);
  loose.set_positions(mesh, higher);
  tight.set_positions(tight.mesh("board"), higher_used);
  EXPECT_TRUE(all_bytes(Renderer(loose).render(options)) == all_bytes(Renderer(tight).render(options)));
}

/// If a mesh with vertex normals is transformed and then given its positions again, it has the normals that were read.
TEST_F(Library, PositionsTakeTheTransformBack) {
  // Three positions, then three normals, in float.
  write("roof.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
    "extensionsUsed": ["KHR_lights_punctual"],
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "name": "key", "intensity": 100, "extras": {"radius": 0.3}}]}},
    "nodes": [{"mesh": 0, "name": "roof"}, {"camera": 0, "translation": [0, 4, 0], "rotation": [-0.70710678, 0, 0, 0.70710678]},
              {"translation": [1, 3, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1, "aspectRatio": 1.5}}],
    "meshes": [{"name": "roof", "primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, 0, -1], "max": [1, 0, 1]},
                  {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 36}],
    "buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64,AACAvwAAAAAAAIA/AACAPwAAAAAAAIA/AAAAAAAAAAAAAIC/mpkZP83MTD8AAAAAAAAAAM3MTD+amRk/mpkZv83MTD8AAAAA"}]})");
  Scene scene = Scene::load(path("roof.gltf"));
  const RenderOptions options{.width = 24, .height = 16};
  const std::string before = all_bytes(Renderer(scene).render(options));
  EXPECT_FALSE(all_bytes(Renderer(scene).render({.width = 24, .height = 16, .shading_normals = false})) == before);
  const std::array<Vector, 3> corners = {{{-1, 0, 1}, {1, 0, 1}, {0, 0, -1}}};
  scene.set_transform(scene.mesh("roof"), {0.8, -0.6, 0, 0, 0.6, 0.8, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  EXPECT_FALSE(all_bytes(Renderer(scene).render(options)) == before);
  scene.set_positions(scene.mesh("roof"), corners);
  EXPECT_TRUE(all_bytes(Renderer(scene).render(options)) == before);
}

/// Options that a method does not have are reported before anything is dropped: the next picture uses the kept
/// hierarchies.
TEST_F(Library, WrongOptionsDropNothing) {
  Renderer renderer(Scene::load(scene_));
  const RenderOptions options{.method = "edge-scatter", .light_samples = 16};
  static_cast<void>(renderer.render(options));
  EXPECT_THROW(renderer.render({.method = "edge-scatter", .options = {{"colour", "red"}}}), UsageError);
  EXPECT_THROW(renderer.render({.method = "no-such-method"}), UsageError);
  const auto stats = nlohmann::json::parse(renderer.render(options).stats_json());
  EXPECT_EQ(stats.at("counters").at("meshesKept"), 1);
}

TEST_F(Library, BuildsWhatAFileSays) {
  Scene made;
  const std::array<Vector, 4> floor = {{{-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}}};
  const std::array<std::array<std::uint32_t, 3>, 2> two = {{{0, 1, 2}, {0, 2, 3}}};
  made.add_mesh("floor", floor, two, {.color = {0.5, 0.5, 0.5}});
  const std::array<Vector, 3> board = {{{-1, 1, -1}, {1, 1, -1}, {0, 1.5, 1}}};
  const std::array<std::array<std::uint32_t, 3>, 1> one = {{{0, 1, 2}}};
  made.add_mesh("board", board, one);
  made.add_light("key", Disk{.center = {0, 4, 0}, .normal = {0, -2, 0}, .radius = 0.5}, {.radiance = {5, 6, 7}});
  made.set_camera({.eye = {0, 3, 6}, .target = {0, 0.5, 0}, .vertical_fov = 40});
  EXPECT_THAT(made.save(path("made.json")), IsEmpty());
  EXPECT_THAT(made.lights(), ElementsAre("key"));
  EXPECT_EQ(made.triangle_count(), 3U);
  const RenderOptions options{.width = 32, .height = 24};
  EXPECT_EQ(all_bytes(Renderer(made).render(options)),
            all_bytes(Renderer(Scene::load(path("made.json"))).render(options)));
}

TEST_F(Library, SaysWhatTheProgramSays) {
  // Methods that tests in this process added come last.
  const auto program = nlohmann::ordered_json::parse(run({"methods", "--json"}).out);
  auto library = nlohmann::ordered_json::parse(methods_json());
  ASSERT_GE(library.at("methods").size(), program.at("methods").size());
  library.at("methods").erase(library.at("methods").begin() + static_cast<std::ptrdiff_t>(program.at("methods").size()),
                              library.at("methods").end());
  EXPECT_EQ(library, program);
  EXPECT_EQ(methods().front().name, nlohmann::json::parse(methods_json()).at("methods").at(0).at("name"));
  ASSERT_EQ(run({"wedges", scene_, "--light", "key", "--validate", "--json", path("w.json")}).code, 0);
  EXPECT_EQ(wedges_json(Scene::load(scene_), {.light = "key", .validate = true}), read("w.json"));
  const std::array<Vector, 3> corners = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  const std::array<std::array<std::uint32_t, 3>, 1> face = {{{0, 1, 2}}};
  EXPECT_EQ(nlohmann::json::parse(inspect_json(corners, face)).at("boundaryEdges"), 3);
  const auto metrics =
      nlohmann::json::parse(compare_json(Scene::load(scene_), {.methods = {"edge-scatter", "edge-scatter:rows=exact"},
                                                               .reference = "exact",
                                                               .width = 24,
                                                               .height = 16,
                                                               .light_samples = 16,
                                                               .runs = 1}));
  EXPECT_LT(metrics.at("methods").at(1).at("error").at("rmse"), 1e-6);
  EXPECT_GT(metrics.at("methods").at(0).at("error").at("rmse"), 1e-6);
  EXPECT_THAT(files(), ElementsAre("scene.json", "w.json"));
}

}  // namespace
}  // namespace penumbra::tests
