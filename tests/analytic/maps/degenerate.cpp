// SPDX-License-Identifier: Apache-2.0
// Tests every method of the family with degenerate input: V is always a share of the light, is 1 where nothing casts,
// and is the same to the bit however large the scene is.

#include "base/error.hpp"
#include "tests/analytic/maps/map_variants.hpp"
#include "tests/unit/textured_lights_support.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace penumbra::tests {
namespace {

/// The family's methods, with options that select different code.
constexpr const char* kDegenerateVariants[] = {"shadow-map",
                                               "shadow-map:bias=0:receiverPlane=off:depth=midpoint",
                                               "shadow-map:test=id",
                                               "pcf",
                                               "pcf:window=4:receiverPlane=off:bias=0",
                                               "pcss",
                                               "pcss:depth=dual:bias=0",
                                               "vssm",
                                               "vssm:moments=lvsm:filter=n-buffer:bias=0",
                                               "vssm:moments=evsm:filter=mip:depth=second",
                                               "vssm:moments=csm:terms=3",
                                               "vssm:moments=esm:depth=midpoint",
                                               "convolution",
                                               "convolution:depth=second:bias=0",
                                               "occlusion-textures",
                                               "occlusion-textures:filter=n-buffer:slices=16:depth=dual",
                                               "soft-shadow-map",
                                               "soft-shadow-map:passes=2:precision=fp16:bias=0",
                                               "soft-shadow-map:form=scatter:self=backproject",
                                               "backproject",
                                               "backproject:form=sphere:search=none:bias=0",
                                               "backproject:fill=diagonal:search=ysm:depth=second",
                                               "backproject-peel",
                                               "backproject-peel:layers=2:samples=9:depth=dual:bias=0",
                                               "bitmask",
                                               "bitmask:occluder=patch:fill=edges:layers=3:bias=0",
                                               "bitmask:occluder=triangle:search=none:depth=midpoint",
                                               "bitmask:occluder=rect:level=2:budget=20",
                                               "bitmask:subsample=2:subsampleBy=grid",
                                               "silhouette-map",
                                               "forward-map",
                                               "forward-map:splat=spline:depth=midpoint:bias=0",
                                               "shadow-map:projection=paraboloid",
                                               "pcf:projection=cube:bias=0",
                                               "layer-rays",
                                               "layer-rays:layers=3:solid=on:gap=1e6:bias=0",
                                               "penumbra-map",
                                               "smoothies:width=3:bias=0",
                                               "brabec-seidel",
                                               "brabec-seidel:ids=off:radius=3:bias=0",
                                               "kirsch-doellner",
                                               "parker",
                                               "arvo",
                                               "contour",
                                               "contour:traversal=flat:search=none:bias=0",
                                               "contour:traversal=minmax:depth=second:subsample=3",
                                               "packet",
                                               "packet:packet=3x5:sublights=2:hierarchy=off:bias=0",
                                               "accumulate",
                                               "accumulate:bias=0",
                                               "adaptive-light:levels=1",
                                               "adaptive-light:levels=1:compare=light:pcf=off:bias=0",
                                               "layered-attenuation",
                                               "layered-attenuation:epsilon=0.001:bias=0",
                                               "deep-penumbra",
                                               "deep-penumbra:bound=0:bias=0"};

struct Given {
  std::string name;
  Stage stage;
};

class MapsDegenerate : public MapsTest {
 protected:
  static void TearDownTestSuite() {
    methods_.clear();
    MapsTest::TearDownTestSuite();
  }
  /// Methods are made once, because pipelines take longer than small pictures; maps have the smallest allowed size.
  static visibility::Method& method(const std::string& words) {
    auto& made = methods_[words];
    visibility::MethodOptions smallest{{"size", "8"}};
    if (words.starts_with("soft-shadow-map")) smallest["receiverSize"] = "8";
    if (!made) made = MapVariant(words).with(smallest).make(device());
    return *made;
  }
  static bool can(const visibility::Method& method, const visibility::Light& light) {
    const visibility::MethodDescription& description = method.description();
    return description.lights.contains(light.kind) && (description.textures || !light.texture);
  }

  template <typename Add>
  static Given given(const std::string& name, const scenes::AreaLight& light, const Add& add, double scale = 1) {
    scenes::Scene scene;
    add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
    add(scene);
    scene.lights.push_back(light);
    for (glm::dvec3& x : scene.soup.positions) x *= scale;
    auto& rectangle = scene.lights.front().shape;
    if (auto* shape = std::get_if<scenes::Rectangle>(&rectangle)) {
      shape->center *= scale;
      shape->half_u *= scale;
      shape->half_v *= scale;
    }
    scene.cameras.push_back(camera(scale * glm::dvec3(0.3, 3, 4), scale * glm::dvec3(0, 0.5, 0)));
    return {name, Stage(scene, 7, 6, light_samples(3))};
  }
  static void solids(scenes::Scene& scene) {
    add_object(scene, "sphere", sphere({0.2, 0.7, 0.1}, 0.4, 4));
    add_quad(scene, {-0.6, 0.9, 0}, {0.3, 0.2, 0}, {0, 0, 0.4});
  }

 private:
  static inline std::map<std::string, std::unique_ptr<visibility::Method>> methods_;
};

TEST_F(MapsDegenerate, EveryMethodGivesAShareOfTheLight) {
  const auto nothing = [](scenes::Scene& /*scene*/) {};
  const auto through_the_light = [](scenes::Scene& scene) {
    add_object(scene, "needle", {{glm::dvec3(-0.3, 0, 0), glm::dvec3(0.1, 3, 0.2), glm::dvec3(0.4, 0.2, -0.5)}});
    add_quad(scene, {0, 2, 0}, {0.3, 0, 0}, {0, 0, 0.3});  // in the light's own plane
  };
  const auto around_the_light = [](scenes::Scene& scene) { add_object(scene, "shell", sphere({0, 2, 0}, 0.7, 4)); };
  const auto on_the_floor = [](scenes::Scene& scene) {
    add_quad(scene, {0.3, 0, 0}, {0.8, 0, 0}, {0, 0, 0.8});  // p is on this quad and on the floor
    add_quad(scene, {-0.9, 1e-7, 0}, {0.5, 0, 0}, {0, 0, 0.5});
  };
  const auto beside_the_window = [](scenes::Scene& scene) {
    add_quad(scene, {5, 1, 0}, {2, 0, 0}, {0, 0, 2}).receives_shadow = false;
  };
  const auto a_wall = [](scenes::Scene& scene) { add_quad(scene, {1.5, 2, 0}, {0, 2, 0}, {0, 0, 2}); };
  const auto less_than_a_texel = [](scenes::Scene& scene) {
    add_quad(scene, {0, 0, 0}, {300, 0, 0}, {0, 0, -300});
    add_quad(scene, {0, 0.5, 0}, {0.2, 0, 0}, {0, 0, 0.2});
  };
  const auto no_area = [](scenes::Scene& scene) {
    add_object(scene, "point", {{glm::dvec3(0, 1, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 1, 0)}});
    add_object(scene, "line", {{glm::dvec3(-1, 1, 0), glm::dvec3(0, 1, 0), glm::dvec3(1, 1, 0)}});
  };
  scenes::AreaLight two_sided = ceiling_light(2, 0.5), disk = two_sided, polygon = ceiling_light(2, 0.5),
                    textured = ceiling_light(2, 0.5);
  two_sided.two_sided = true;
  disk.shape = scenes::Disk{{0, 2, 0}, {0.1, -1, 0}, 0.5};
  polygon.shape = scenes::Polygon{{{-0.5, 2, -0.2}, {0.5, 2, -0.2}, {0.1, 2, 0.6}}};
  textured.texture = texture_of(3, 2, [](std::uint32_t x, std::uint32_t y) { return glm::vec3(x == y ? 1.0F : 0.0F); });
  const std::vector<Given> all{given("no caster but the floor", two_sided, nothing),
                               given("through the light's plane", ceiling_light(2, 0.5), through_the_light),
                               given("through both sides", two_sided, through_the_light),
                               given("the light within a shell", two_sided, around_the_light),
                               given("p on two casters", ceiling_light(2, 0.5), on_the_floor),
                               given("beside the window", ceiling_light(2, 0.5), beside_the_window),
                               given("a hemicube", ceiling_light(2, 0.5), a_wall),
                               given("a caster of a part of a texel", ceiling_light(2, 0.5), less_than_a_texel),
                               given("triangles without area", ceiling_light(2, 0.5), no_area),
                               given("a point", ceiling_light(2, 1e-6), solids),
                               given("a light larger than the scene", ceiling_light(2, 50), solids),
                               given("a disk", disk, solids),
                               given("a polygon", polygon, through_the_light),
                               given("a texture that is half black", textured, solids),
                               given("a million across", ceiling_light(2, 0.5), solids, 1e6),
                               given("a millionth across", ceiling_light(2, 0.5), solids, 1e-6)};
  for (const char* words : kDegenerateVariants) {
    for (const Given& one : all) {
      if (!can(method(words), one.stage.light)) continue;
      const Masks found = run(method(words), one.stage);
      // V is in [0, 1]; a NaN would fail this.
      EXPECT_TRUE(std::ranges::all_of(found.visibility, [](float v) { return v >= 0 && v <= 1; }))
          << words << ", " << one.name;
    }
  }
}

TEST_F(MapsDegenerate, WhereNothingCastsAllIsLit) {
  scenes::AreaLight two_sided = ceiling_light(2, 0.5);
  two_sided.two_sided = true;
  const Given empty = given("", two_sided, [](scenes::Scene& scene) { scene.objects.front().casts_shadow = false; });
  for (const char* words : kDegenerateVariants) {
    const Masks found = run(method(words), empty.stage);
    EXPECT_TRUE(std::ranges::all_of(found.visibility, [](float v) { return v == 1.0F; })) << words;
  }
}

// A floor that casts no shadow receives the same shadow as one that casts. Methods that compare heights see the floor
// only if it casts: they are left out. layered-attenuation joins surfaces by the depths of neighbouring texels, which
// differ next to the plate.
TEST_F(MapsDegenerate, WhatCastsNoShadowReceivesIt) {
  const auto plate = [](scenes::Scene& scene) {
    add_quad(scene, {0, 1, 0}, {0.4, 0, 0}, {0, 0, 0.4}).receives_shadow = false;
  };
  const auto plate_alone = [&](scenes::Scene& scene) {
    plate(scene);
    scene.objects.front().casts_shadow = false;
  };
  const Given both = given("", ceiling_light(2, 0.2), plate), one = given("", ceiling_light(2, 0.2), plate_alone);
  for (const char* words :
       {"shadow-map", "pcf", "silhouette-map", "forward-map:splat=box", "pcf:projection=paraboloid", "backproject",
        "bitmask", "penumbra-map", "smoothies", "brabec-seidel", "parker", "arvo", "layer-rays", "contour", "packet",
        "accumulate", "adaptive-light:levels=1", "deep-penumbra", "layered-attenuation"}) {
    const MapVariant variant = MapVariant(words).with({{"size", "64"}});
    const Masks expected = run(*variant.make(device()), both.stage), found = run(*variant.make(device()), one.stage);
    EXPECT_LT(*std::ranges::min_element(expected.visibility), 0.5F) << words;
    const double off = rmse(
        one.stage, [](std::size_t) { return true; },
        [&](std::size_t i) { return static_cast<double>(found.visibility[i] - expected.visibility[i]); });
    EXPECT_LE(off, variant.method == "layered-attenuation" ? 0.1 : 0.0) << words;
  }
}

// Multiplying positions by a power of two rounds nothing.
TEST_F(MapsDegenerate, TheScaleOfTheSceneChangesNoByte) {
  const Given one = given("", ceiling_light(2, 0.5), solids),
              large = given("", ceiling_light(2, 0.5), solids, std::ldexp(1.0, 24)),
              small = given("", ceiling_light(2, 0.5), solids, std::ldexp(1.0, -24));
  for (const char* words : kDegenerateVariants) {
    const Masks found = run(method(words), one.stage);
    EXPECT_EQ(run(method(words), large.stage).visibility, found.visibility) << words;
    EXPECT_EQ(run(method(words), small.stage).visibility, found.visibility) << words;
  }
}

TEST_F(MapsDegenerate, NoMapIsSmallerThanEightTexels) {
  for (const char* words : {"shadow-map",
                            "pcf",
                            "pcss",
                            "vssm",
                            "convolution",
                            "occlusion-textures",
                            "soft-shadow-map",
                            "backproject",
                            "backproject-peel",
                            "bitmask",
                            "penumbra-map",
                            "smoothies",
                            "brabec-seidel",
                            "kirsch-doellner",
                            "parker",
                            "arvo",
                            "layer-rays",
                            "silhouette-map",
                            "forward-map",
                            "contour",
                            "packet",
                            "accumulate",
                            "adaptive-light",
                            "layered-attenuation",
                            "deep-penumbra"}) {
    for (const char* size : {"0", "1", "7", "-8", "8.5", "1000000"}) {
      EXPECT_THROW(std::ignore = MapVariant(words).with({{"size", size}}).make(device()), UsageError)
          << words << " " << size;
    }
  }
}

}  // namespace
}  // namespace penumbra::tests
