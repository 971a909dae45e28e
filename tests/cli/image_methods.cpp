// SPDX-License-Identifier: Apache-2.0
// Tests the options of image-based methods by their names on the command line: each is accepted and has its effect. One
// comparison runs them all, and metrics.json is checked.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <vector>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// A ball and an oblique plate over a floor.
constexpr const char* kScene = R"({"format": "penumbra-scene/1", "size": [24, 16],
  "camera": {"eye": [0, 4, 5], "target": [0, 0.2, 0], "up": [0, 1, 0], "verticalFov": 40},
  "meshes": [{"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [3, 0, 0], "halfV": [0, 0, -3]}},
             {"name": "ball", "shape": {"type": "sphere", "center": [0.4, 0.8, 0], "radius": 0.5, "segments": 16}},
             {"name": "plate", "quad": {"center": [-0.5, 1.4, 0.2], "halfU": [0.5, 0.2, 0], "halfV": [0, 0, -0.4]}}],
  "lights": [{"name": "key", "rectangle": {"center": [0, 4, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}}]})";

class ImageMethods : public ProgramTest {
 protected:
  void compare(const std::vector<std::string>& entries) {
    std::string methods;
    for (const std::string& entry : entries) methods += (methods.empty() ? "" : ",") + entry + ":size=64";
    const Outcome outcome = run({"compare", write("scene.json", kScene).string(), "-o", path("out"), "--methods",
                                 methods, "--reference", "exact", "--light-samples", "16", "--runs", "1"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json metrics = json::parse(read("out/metrics.json"));
    ASSERT_EQ(metrics.at("methods").size(), entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
      found_[entries[i]] = metrics["methods"][i];
      EXPECT_TRUE(found_[entries[i]].at("failure").is_null()) << entries[i] << ": " << found_[entries[i]];
    }
  }
  double bias(const std::string& entry) const { return found_.at(entry).at("error").at("bias").get<double>(); }
  double rmse(const std::string& entry) const { return found_.at(entry).at("error").at("rmse").get<double>(); }
  int count(const std::string& entry, const char* what) const {
    return found_.at(entry).at("counters").at(what).get<int>();
  }
  void expect_same(const std::string& a, const std::string& b) const {
    EXPECT_EQ(found_.at(a).at("error"), found_.at(b).at("error")) << a << " and " << b;
  }

  std::map<std::string, json> found_;
};

TEST_F(ImageMethods, OptionsOfPatchesAndOutlinesDoWhatTheySay) {
  compare({"backproject:fill=none",
           "backproject",
           "backproject:fill=diagonal",
           "backproject:search=none",
           "backproject:search=hsm",
           "backproject:search=mssm",
           "backproject:search=ysm",
           "backproject:form=sphere",
           "backproject-peel:layers=1",
           "backproject-peel:layers=3",
           "backproject-peel:samples=9",
           "backproject-peel:depth=second",
           "bitmask",
           "bitmask:occluder=patch",
           "bitmask:occluder=patch:fill=edges",
           "bitmask:occluder=triangle",
           "bitmask:occluder=rect",
           "bitmask:occluder=rect:level=2",
           "bitmask:layers=3",
           "bitmask:search=none",
           "bitmask:search=hsm",
           "bitmask:search=ysm",
           "contour",
           "contour:search=none",
           "contour:search=mssm",
           "contour:search=ysm",
           "contour:traversal=flat",
           "contour:traversal=minmax",
           "packet:packet=1x1",
           "packet:packet=4x2",
           "packet:hierarchy=off",
           "packet:sublights=2"});
  EXPECT_GT(bias("backproject:fill=none"), bias("backproject"));
  EXPECT_GT(bias("backproject"), bias("backproject:fill=diagonal"));
  EXPECT_GT(bias("backproject"), bias("backproject:form=sphere")) << "bounding spheres are larger";
  for (const char* search : {"none", "hsm", "mssm", "ysm"}) {
    expect_same(std::string("backproject:search=") + search, "backproject");
    if (search != std::string("mssm")) expect_same(std::string("bitmask:search=") + search, "bitmask");
    if (search != std::string("hsm")) expect_same(std::string("contour:search=") + search, "contour");
  }
  expect_same("backproject-peel:layers=1", "backproject:fill=none");
  EXPECT_GT(bias("backproject-peel:layers=1"), bias("backproject-peel:layers=3"));
  EXPECT_GT(rmse("backproject-peel:samples=9"), rmse("backproject-peel:layers=3"));
  EXPECT_GT(bias("backproject-peel:depth=second"), bias("backproject-peel:layers=3") + 0.03) << "the plate is open";
  EXPECT_GT(bias("bitmask"), bias("bitmask:occluder=triangle"));
  EXPECT_GT(bias("bitmask"), bias("bitmask:layers=3"));
  EXPECT_GT(bias("bitmask:occluder=patch"), bias("bitmask:occluder=patch:fill=edges"));
  expect_same("bitmask:occluder=rect", "bitmask:occluder=patch");
  EXPECT_GT(bias("bitmask:occluder=rect"), bias("bitmask:occluder=rect:level=2")) << "coarse texels are fatter";
  for (const char* direction : {"contour:traversal=flat", "contour:traversal=minmax", "packet:packet=1x1",
                                "packet:packet=4x2", "packet:hierarchy=off"}) {
    expect_same(direction, "contour");
  }
  EXPECT_GT(count("contour:traversal=flat", "cells"), count("contour:traversal=minmax", "cells"));
  EXPECT_GT(count("contour:traversal=minmax", "cells"), count("contour", "cells"));
  EXPECT_GT(count("packet:packet=1x1", "cells"), count("packet:packet=4x2", "cells"));
  EXPECT_EQ(count("packet:hierarchy=off", "nodes"), 0);
  EXPECT_EQ(count("packet:sublights=2", "maps"), 4);
}

TEST_F(ImageMethods, OptionsOfFiltersListsAndManyMapsDoWhatTheySay) {
  std::vector<std::string> entries{"shadow-map",
                                   "pcf:window=1",
                                   "pcf",
                                   "pcf:window=15",
                                   "soft-shadow-map",
                                   "soft-shadow-map:passes=2",
                                   "soft-shadow-map:precision=fp16",
                                   "adaptive-light:levels=1",
                                   "adaptive-light:epsilon=0",
                                   "adaptive-light:epsilon=0.5",
                                   "adaptive-light:gamma=0.5",
                                   "adaptive-light:compare=light",
                                   "adaptive-light:pcf=off",
                                   "adaptive-light",
                                   "layered-attenuation:epsilon=0.001",
                                   "layered-attenuation:epsilon=0.1",
                                   "deep-penumbra:bound=0",
                                   "deep-penumbra:bound=0.2",
                                   "accumulate",
                                   "accumulate:rasteriser=vulkan",
                                   "occlusion-textures:slices=1",
                                   "occlusion-textures:slices=8",
                                   "convolution",
                                   "layer-rays:layers=2:gap=0:solid=on",
                                   "layer-rays:layers=2",
                                   "penumbra-map:filter=nearest",
                                   "smoothies:width=0.05:filter=nearest",
                                   "smoothies:width=5:filter=nearest",
                                   "brabec-seidel:ids=off:radius=140",
                                   "brabec-seidel:radius=1",
                                   "kirsch-doellner:radius=140",
                                   "parker:falloff=linear:depth=dual",
                                   "parker:falloff=sine:depth=second",
                                   "arvo"};
  for (const char* moments : {"vsm", "lvsm", "evsm", "csm", "esm"}) {
    for (const char* filter : {"sat", "mip", "n-buffer"}) {
      entries.push_back(std::string("vssm:moments=") + moments + ":subdivision=none:filter=" + filter);
    }
  }
  const std::vector<std::string> single{"shadow-map",        "pcf", "pcss", "vssm", "soft-shadow-map", "convolution",
                                        "occlusion-textures"};
  for (const std::string& method : single) {
    for (const char* depth : {"first", "second", "midpoint", "dual"}) entries.push_back(method + ":depth=" + depth);
  }
  compare(entries);
  expect_same("pcf:window=1", "shadow-map");
  EXPECT_LT(rmse("pcf"), rmse("pcf:window=1"));
  EXPECT_LT(rmse("pcf"), rmse("pcf:window=15"));
  EXPECT_EQ(count("soft-shadow-map:passes=2", "patches"), 2 * count("soft-shadow-map", "patches"));
  EXPECT_LT(bias("soft-shadow-map:passes=2"), bias("soft-shadow-map"));
  EXPECT_NE(rmse("soft-shadow-map:precision=fp16"), rmse("soft-shadow-map"));
  EXPECT_EQ(count("adaptive-light:levels=1", "maps"), 9);
  EXPECT_EQ(count("adaptive-light:epsilon=0", "maps"), 81);
  EXPECT_EQ(count("adaptive-light:epsilon=0.5", "maps"), 4);
  EXPECT_EQ(count("adaptive-light:gamma=0.5", "maps"), 4);
  EXPECT_NE(count("adaptive-light:compare=light", "maps"), count("adaptive-light", "maps"));
  EXPECT_NE(rmse("adaptive-light:pcf=off"), rmse("adaptive-light"));
  EXPECT_LT(bias("layered-attenuation:epsilon=0.001"), bias("layered-attenuation:epsilon=0.1")) << "speckle";
  EXPECT_LT(rmse("deep-penumbra:bound=0"), rmse("deep-penumbra:bound=0.2"));
  expect_same("accumulate:rasteriser=vulkan", "accumulate");
  EXPECT_LT(rmse("layer-rays:layers=2"), rmse("shadow-map:depth=first"));
  EXPECT_LT(bias("smoothies:width=5:filter=nearest"), bias("smoothies:width=0.05:filter=nearest"));
  EXPECT_LT(rmse("brabec-seidel:ids=off:radius=140"), rmse("brabec-seidel:radius=1"));
  EXPECT_LT(bias("penumbra-map:filter=nearest"), bias("shadow-map:depth=first"));
  EXPECT_LT(bias("parker:falloff=linear:depth=dual"), bias("parker:falloff=sine:depth=second"));
  EXPECT_GT(bias("kirsch-doellner:radius=140"), bias("shadow-map:depth=first"));
  EXPECT_LT(rmse("arvo"), rmse("shadow-map:depth=first"));
  EXPECT_GT(rmse("occlusion-textures:slices=1"), rmse("occlusion-textures:slices=8"));
  for (const char* moments : {"vsm", "lvsm", "evsm", "csm", "esm"}) {
    const std::string direction = std::string("vssm:moments=") + moments + ":subdivision=none:filter=";
    EXPECT_GT(rmse(direction + "mip"), rmse(direction + "sat")) << "levels are coarse";
    EXPECT_NE(rmse(direction + "n-buffer"), rmse(direction + "sat"));
  }
  for (const std::string& method : single) {
    EXPECT_GT(bias(method + ":depth=second"), bias(method + ":depth=first") + 0.03) << method << ": the plate is open";
    for (const char* depth : {"midpoint", "dual"}) {
      EXPECT_LT(rmse(method + ":depth=" + depth), rmse(method + ":depth=second")) << method << " " << depth;
    }
  }
}

// On casters soft-shadow-map computes only the part of the light above the horizon, which is the paper's limit: the
// user is told so, in messages and in files, unless another method computes these pixels.
TEST_F(ImageMethods, SoftShadowMapSaysWhereItHasNoShadows) {
  const std::string scene = write("scene.json", kScene).string();
  for (const bool answered : {false, true}) {
    const Outcome outcome =
        run({"render", scene, "-o", path("out.exr"), "--stats", path("stats.json"), "--method", "soft-shadow-map",
             "--method-option", "size=32", "--method-option", answered ? "self=backproject" : "self=none"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::string warnings = json::parse(read("stats.json")).at("warnings").dump();
    const testing::Matcher<std::string> said = HasSubstr("self=backproject");
    const testing::Matcher<std::string> is_right = answered ? testing::Matcher<std::string>(testing::Not(said)) : said;
    EXPECT_THAT(outcome.err, is_right);
    EXPECT_THAT(warnings, is_right);
  }
  compare({"soft-shadow-map", "soft-shadow-map:self=backproject"});
  EXPECT_THAT(found_["soft-shadow-map"].at("warnings").dump(), HasSubstr("self=backproject"));
  EXPECT_THAT(found_["soft-shadow-map:self=backproject"].at("warnings"), testing::IsEmpty());
}

// A large light whose plane cuts the floor: the five maps of a hemicube, with kernels that nearly fill one. The pyramid
// over them must be complete, although some drivers cut off loops, and texels beside the light must not be visited.
TEST_F(ImageMethods, ATexturedLightNearTheFloorTakesNoLongerThanItsOutlines) {
  const Outcome outcome =
      run({"render", std::string(PENUMBRA_SCENES) + "/textured-light.json", "-o", path("out.exr"), "--size", "12x12",
           "--method", "packet", "--method-option", "sublights=2", "--stats", path("stats.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json counters = json::parse(read("stats.json")).at("counters");
  EXPECT_EQ(counters.at("mapFaces"), 20);
  EXPECT_LT(counters.at("cells").get<double>(), 1e-3 * counters.at("kernelCells").get<double>());
}

// If the device cannot filter maps of the default size, the options in files are those actually used, with one light
// and with two, and texels are as wide as those of an explicit size.
TEST_F(ImageMethods, OptionsHaveTheSizeOfMapsThatTheDeviceReduced) {
  const std::string entry = "vssm:moments=csm:filter=n-buffer";
  json scene = json::parse(kScene);
  scene["lights"].push_back(scene["lights"][0]);
  scene["lights"][1]["name"] = "other";
  const std::string two_lights = write("two.json", scene.dump()).string();
  const Outcome outcome = run({"render", two_lights, "-o", path("out.exr"), "--method", "vssm", "--method-option",
                               "moments=csm", "--method-option", "filter=n-buffer", "--stats", path("stats.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json stats = json::parse(read("stats.json"));
  const json& options = stats.at("options");
  if (!stats.at("counters").contains("reducedMaps")) {  // the device has large buffers
    EXPECT_FALSE(options.contains("size"));
    return;
  }
  const std::string size = options.at("size");
  EXPECT_LT(std::stoi(size), 1024);
  EXPECT_EQ(stats.at("counters").at("reducedMaps"), 2);
  EXPECT_THAT(outcome.err, HasSubstr(size + " texels a side in place of the default of 1024"));
  for (const json& light : stats.at("lights")) EXPECT_EQ(light.at("options"), options);
  EXPECT_THAT(read_exr(path("out.exr")).attributes.at("penumbra.options"), HasSubstr("size=" + size));

  const std::vector<std::string> entries{entry, entry + ":size=" + size};
  const Outcome compared =
      run({"compare", write("scene.json", kScene).string(), "-o", path("out"), "--methods",
           entries[0] + "," + entries[1], "--reference", "exact", "--light-samples", "16", "--runs", "1"});
  ASSERT_EQ(compared.code, 0) << compared.err;
  const json methods = json::parse(read("out/metrics.json")).at("methods");
  EXPECT_EQ(methods[0].at("options"), methods[1].at("options"));
  const json &reduced = methods[0].at("lights")[0], &given = methods[1].at("lights")[0];
  EXPECT_EQ(reduced.at("error"), given.at("error"));
  EXPECT_EQ(reduced.at("penumbraWidth"), given.at("penumbraWidth"));
  EXPECT_FALSE(reduced.at("penumbraWidth").at("texels").empty());
}

TEST_F(ImageMethods, WhatIsNoValueIsRefusedWithThoseThatAre) {
  for (const auto& [entry, values] : std::map<std::string, std::string>{{"bitmask:occluder=disc", "triangle"},
                                                                        {"vssm:moments=vm", "evsm"},
                                                                        {"contour:traversal=tree", "minmax"},
                                                                        {"pcf:window=0", "64"},
                                                                        {"soft-shadow-map:passes=3", "1"},
                                                                        {"accumulate:depth=second", "rasteriser"}}) {
    const Outcome outcome = run({"compare", tiny_scene(), "-o", path("out"), "--methods", entry});
    EXPECT_EQ(outcome.code, 2) << entry;
    EXPECT_THAT(outcome.err, HasSubstr(values)) << entry;
  }
}

}  // namespace
}  // namespace penumbra::tests
