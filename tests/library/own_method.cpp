// SPDX-License-Identifier: Apache-2.0
// Methods of the calling program: the data that they get, and what is done with their answers.

#include <penumbra/penumbra.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

namespace penumbra::tests {
namespace {

using testing::Each;
using testing::HasSubstr;

/// Returns a floor of two triangles under a rectangle light, and between them a mesh that casts no shadow.
Scene floor_under_light() {
  Scene scene;
  const std::array<Vector, 4> corners = {{{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}}};
  const std::array<std::array<std::uint32_t, 3>, 2> faces = {{{0, 1, 2}, {0, 2, 3}}};
  scene.add_mesh("floor", corners, faces);
  const std::array<Vector, 3> flag = {{{0, 1, 0}, {1, 1, 0}, {0, 1, 1}}};
  const std::array<std::array<std::uint32_t, 3>, 1> face = {{{0, 1, 2}}};
  scene.add_mesh("glass", flag, face, {.casts_shadow = false});
  scene.add_light("key", Rectangle{.center = {0, 3, 0}, .half_u = {1, 0, 0}, .half_v = {0, 0, 1}});
  scene.set_camera({.eye = {0, 2, 5}, .target = {0, 0, 0}});
  return scene;
}

/// Checks and keeps the data that it gets; V is constant.
class Constant final : public OwnMethod {
 public:
  explicit Constant(float value) : value_(value) {}

  void set_scene(const MethodScene& scene) override { scene_ = scene; }
  void set_light(const MethodLight& light) override { light_ = light; }
  void set_view(const MethodView& view) override { view_ = view; }
  void visibility(std::span<const std::uint32_t> pixels, std::span<float> visibility) override {
    if (value_ == 7) throw std::logic_error("seven");
    ASSERT_EQ(pixels.size(), visibility.size());
    EXPECT_EQ(light_.kind, "rectangle");
    EXPECT_NEAR(light_.center[1] + scene_.origin[1], 3, 1e-6);
    EXPECT_THAT(light_.u, testing::ElementsAre(1, 0, 0));
    EXPECT_EQ(std::count(scene_.casts.begin(), scene_.casts.end(), 0), 1);
    for (const std::uint32_t pixel : pixels) EXPECT_NE(view_.triangle[pixel], MethodView::kBackground);
    std::ranges::fill(visibility, value_);
  }

 private:
  float value_;
  MethodScene scene_;
  MethodLight light_;
  MethodView view_;
};

/// Sets every bit of its masks, or every second one.
class Striped final : public OwnMethod {
 public:
  explicit Striped(std::uint32_t pattern) : pattern_(pattern) {}
  void set_scene(const MethodScene& /*scene*/) override {}
  void set_light(const MethodLight& light) override { words_ = light.words_per_mask; }
  void set_view(const MethodView& /*view*/) override {}
  void masks(std::span<const std::uint32_t> pixels, std::span<std::uint32_t> masks) override {
    ASSERT_EQ(masks.size(), pixels.size() * words_);
    EXPECT_THAT(std::vector(masks.begin(), masks.end()), Each(0U));
    std::ranges::fill(masks, pattern_);
  }

 private:
  std::uint32_t pattern_, words_ = 0;
};

/// Adds the methods once in each process, since added methods remain.
void add_once() {
  static const bool added = [] {
    add_method(
        {.name = "constant",
         .options = {{.name = "value", .default_value = "0.5", .help = {}, .choices = {}, .least = -9, .most = 9}}},
        [](const auto& options) { return std::make_unique<Constant>(std::stof(options.at("value"))); });
    add_method(
        {.name = "striped",
         .family = "geometry",
         .masks = true,
         .options = {{.name = "bits", .default_value = "all", .help = {}, .choices = {"all", "even"}}}},
        [](const auto& options) { return std::make_unique<Striped>(options.at("bits") == "all" ? ~0U : 0x55555555U); });
    return true;
  }();
  static_cast<void>(added);
}

std::vector<float> on_surfaces(const Picture& picture) {
  std::vector<float> values;
  for (std::size_t i = 0; i < picture.alpha().size(); ++i) {
    if (picture.alpha()[i] == 1)
      values.push_back(picture.visibility()[i]);
    else
      EXPECT_EQ(picture.visibility()[i], 1);
  }
  return values;
}

TEST(OwnMethods, GiveTheVisibilityOfSurfaces) {
  add_once();
  Renderer renderer(floor_under_light());
  EXPECT_THAT(on_surfaces(renderer.render({.width = 24, .height = 16, .method = "constant"})), Each(0.5F));
  const Picture other =
      renderer.render({.width = 24, .height = 16, .method = "constant", .options = {{"value", "0.25"}}});
  EXPECT_THAT(on_surfaces(other), Each(0.25F));
  EXPECT_EQ(other.method(), "constant");
}

TEST(OwnMethods, GiveMasksOfTheLightSamplesThereAre) {
  add_once();
  Renderer renderer(floor_under_light());
  const Picture all = renderer.render({.width = 24, .height = 16, .method = "striped", .light_samples = 36});
  ASSERT_EQ(all.words_per_mask(), 2U);
  EXPECT_THAT(on_surfaces(all), Each(1.0F));
  for (std::size_t i = 0; i < all.masks().size(); i += 2) EXPECT_EQ(all.masks()[i + 1], 0xfU);
  const Picture even = renderer.render(
      {.width = 24, .height = 16, .method = "striped", .options = {{"bits", "even"}}, .light_samples = 36});
  EXPECT_THAT(on_surfaces(even), Each(0.5F));
}

TEST(OwnMethods, AreComparedByNameAndWithTheirFamily) {
  add_once();
  const std::string rows = compare_json(floor_under_light(), {.methods = {"constant", "striped:bits=even"},
                                                              .reference = "exact",
                                                              .width = 16,
                                                              .height = 12,
                                                              .light_samples = 16,
                                                              .runs = 1});
  EXPECT_THAT(rows, HasSubstr("\"method\": \"constant\""));
  EXPECT_THAT(rows, HasSubstr("\"method\": \"striped\""));
  std::vector<std::string> own;
  for (const MethodInfo& method : methods()) {
    if (method.exact_for == "nothing") own.push_back(method.family + " " + method.name + " " + method.output);
  }
  EXPECT_THAT(own, testing::IsSupersetOf({"image constant scalar", "geometry striped mask"}));
}

TEST(OwnMethods, AreNobodysDefault) {
  add_once();
  const auto compared = [](const char* group) {
    return compare_json(
        floor_under_light(),
        {.methods = {group}, .reference = "exact", .width = 8, .height = 6, .light_samples = 4, .runs = 1});
  };
  EXPECT_THAT(compared("default"), testing::Not(HasSubstr("striped")));
  EXPECT_THAT(compared("geometry"), HasSubstr("striped"));
  Renderer renderer(floor_under_light());
  EXPECT_NE(renderer.render({.width = 8, .height = 8}).method(), "striped");
  EXPECT_NE(renderer.render({.width = 8, .height = 8, .light_samples = 16}).method(), "striped");
}

TEST(OwnMethods, FailAlone) {
  add_once();
  Renderer renderer(floor_under_light());
  EXPECT_THROW(renderer.render({.width = 8, .height = 8, .method = "constant", .options = {{"value", "2"}}}),
               ResourceError);
  EXPECT_THROW(renderer.render({.width = 8, .height = 8, .method = "constant", .options = {{"value", "7"}}}),
               std::logic_error);
  EXPECT_THROW(compare_json(floor_under_light(), {.methods = {"constant:value=7"}, .width = 8, .height = 6, .runs = 1}),
               std::logic_error);
  EXPECT_THROW(renderer.render({.width = 8, .height = 8, .method = "constant", .options = {{"value", "x"}}}),
               UsageError);
  EXPECT_THAT(on_surfaces(renderer.render({.width = 8, .height = 8, .method = "constant"})), Each(0.5F));
}

TEST(OwnMethods, MayExceedAllOfTheLightByRounding) {
  add_once();
  Renderer renderer(floor_under_light());
  const auto shown = [&](const char* value) {
    return on_surfaces(renderer.render({.width = 8, .height = 8, .method = "constant", .options = {{"value", value}}}));
  };
  EXPECT_THAT(shown("1.0000001"), Each(1.0F));
  EXPECT_THAT(shown("-0.0000001"), Each(0.0F));
  EXPECT_THROW(shown("1.00001"), ResourceError);
  EXPECT_THROW(shown("-0.00001"), ResourceError);
}

TEST(OwnMethods, WorkInSeveralThreadsWhileOthersAreAdded) {
  add_once();
  std::vector<std::jthread> threads;
  for (int i = 0; i < 2; ++i) {
    threads.emplace_back([] {
      for (int picture = 0; picture < 5; ++picture) {
        Renderer renderer(floor_under_light());
        EXPECT_THAT(on_surfaces(renderer.render({.width = 16, .height = 16, .method = "constant"})), Each(0.5F));
      }
    });
  }
  const auto make = [](const auto&) { return std::make_unique<Constant>(0.0F); };
  for (int i = 0; i < 20; ++i) add_method({.name = "added" + std::to_string(i), .exact_for = "nothing at all"}, make);
}

TEST(OwnMethods, AreRefusedWhereTheyCannotBe) {
  add_once();
  const auto make = [](const auto&) { return std::make_unique<Constant>(0.0F); };
  const auto refused = [&](const OwnMethodInfo& info) {
    EXPECT_THROW(add_method(info, make), UsageError) << info.name;
  };
  refused({.name = "constant"});
  refused({.name = "raytrace"});
  refused({.name = "all"});
  refused({.name = "a b"});
  refused({.name = "new", .family = "reference"});
  refused({.name = "new", .lights = {"moon"}});
  refused({.name = "new",
           .options = {{.name = "n", .default_value = "5", .help = {}, .choices = {}, .least = 0, .most = 4}}});
  refused({.name = "new",
           .options = {{.name = "n", .default_value = "0", .help = {}, .choices = {}, .least = 4, .most = 0}}});
  refused({.name = "new", .options = {{.name = "n", .default_value = "c", .help = {}, .choices = {"a", "b"}}}});
  EXPECT_THROW(add_method({.name = "new"}, nullptr), UsageError);
  add_method({.name = "makes-none", .exact_for = "nothing at all"}, [](const auto&) { return nullptr; });
  Renderer renderer(floor_under_light());
  EXPECT_THROW(renderer.render({.width = 8, .height = 8, .method = "makes-none"}), UsageError);
}

}  // namespace
}  // namespace penumbra::tests
