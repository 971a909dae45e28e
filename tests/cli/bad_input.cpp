// SPDX-License-Identifier: Apache-2.0
// Tests that each kind of wrong input gives a message that says what is wrong and where, and the right exit code (2
// wrong usage, 3 bad input, 4 device or resource), and never a crash or a file left behind.
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace penumbra::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

struct BadScene {
  const char* name;
  std::string text;                       ///< contents of scene.json
  std::vector<const char*> said;          ///< what stderr must say
  std::string mesh_name = {}, mesh = {};  ///< a further file next to it
};

std::ostream& operator<<(std::ostream& stream, const BadScene& scene) {
  return stream << scene.name;
}

std::string with_mesh(const std::string& file) {
  return scene_text_with("/meshes/1", R"({"name": "m", "file": ")" + file + "\"}");
}

/// A binary STL that announces 100 triangles and contains half of one.
std::string truncated_stl() {
  std::string text(80, ' ');
  text += std::string("\x64\0\0\0", 4);
  return text + std::string(25, '\0');
}

std::vector<BadScene> bad_scenes() {
  return {
      {"NoJson", "{ \"format\": ", {"scene.json"}},
      {"Utf16", std::string("\xFF\xFE{\0\"\0", 6), {"scene.json: this is UTF-16; save it as UTF-8"}},
      {"StrayByte", "{ \"format\": \xC0", {"scene.json: line 1", "\\xc0'"}},
      {"WrongFormat", scene_text_with("/format", "\"other/1\""), {"/format", "penumbra-scene/1"}},
      {"WrongType", scene_text_with("/camera/eye", "\"here\""), {"/camera/eye"}},
      {"WrongTypeInList", scene_text_with("/meshes/0/color/1", "\"red\""), {"/meshes/0/color/1"}},
      {"UnknownKey", scene_text_with("/lights/0/radianze", "[1, 1, 1]"), {"/lights/0", "radianze"}},
      {"InfiniteVertex", scene_text_with("/meshes/1/triangles/0/3", "1e999"), {"scene.json"}},
      {"VertexBeyondFloat", scene_text_with("/meshes/1/triangles/0/3", "1e300"), {"1e+300", "beyond 1e+12"}},
      {"EmptyMesh", scene_text_with("/meshes/1/triangles", "[]"), {"/meshes/1"}},
      {"NoLight", scene_text_with("/lights", "[]"), {"/lights"}},
      {"LightOfZeroArea", scene_text_with("/lights/0/rectangle/halfU", "[0, 0, 0]"), {"/lights/0/rectangle", "area"}},
      {"LightOfNegativeRadius",
       scene_text_with("/lights/0", R"({"name": "b", "sphere": {"center": [0,4,0], "radius": -1}})"),
       {"/lights/0"}},
      {"CameraInItsTarget", scene_text_with("/camera/target", "[2, 3, 6]"), {"target"}},
      {"MeshMissing", with_mesh("nowhere.obj"), {"nowhere.obj"}},
      {"PathEscape", with_mesh("../outside.obj"), {"../outside.obj", "--allow-outside"}},
      {"AbsolutePathEscape", with_mesh("/etc/passwd"), {"/etc/passwd", "--allow-outside"}},
      {"NanVertex", with_mesh("m.obj"), {"m.obj"}, "m.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"IndexOutOfRange", with_mesh("m.obj"), {"m.obj"}, "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"},
      {"MeshWithoutFaces", with_mesh("m.obj"), {"m.obj"}, "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"},
      {"EmptyFile", with_mesh("m.obj"), {"m.obj"}, "m.obj", ""},
      {"TruncatedPly",
       with_mesh("m.ply"),
       {"m.ply"},
       "m.ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
       "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n"},
      {"TruncatedStl", with_mesh("m.stl"), {"m.stl"}, "m.stl", truncated_stl()},
      {"TruncatedOff", with_mesh("m.off"), {"m.off"}, "m.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n"},
      {"Garbage", with_mesh("m.3ds"), {"m.3ds"}, "m.3ds", "this is no mesh at all"},
  };
}

class BadSceneTest : public ProgramTest, public testing::WithParamInterface<BadScene> {};

TEST_P(BadSceneTest, CostsAMessageAndExitCode3) {
  const BadScene& bad = GetParam();
  write("scene.json", bad.text);
  if (!bad.mesh_name.empty()) write(bad.mesh_name, bad.mesh);
  const Outcome outcome = run({"render", path("scene.json"), "-o", path("out.exr"), "--method", "raytrace"});
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  for (const char* said : bad.said) EXPECT_THAT(outcome.err, HasSubstr(said));
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("internal")));
  EXPECT_TRUE(outcome.out.empty()) << outcome.out;
  EXPECT_FALSE(std::filesystem::exists(path("out.exr")));
}

INSTANTIATE_TEST_SUITE_P(All, BadSceneTest, testing::ValuesIn(bad_scenes()),
                         [](const auto& test) { return std::string(test.param.name); });

using BadInput = ProgramTest;

TEST_F(BadInput, MissingSceneFile) {
  const Outcome outcome = run({"render", path("nowhere.json"), "-o", path("out.exr")});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("nowhere.json"));
}

TEST_F(BadInput, BlendersOwnFiles) {
  write("a.blend", "BLENDER-v304");
  const Outcome outcome = run({"render", path("a.blend"), "-o", path("out.exr")});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("export it as glTF"));
}

TEST_F(BadInput, TruncatedGltf) {
  write("a.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{"nodes")");
  write("b.glb", std::string("glTF\x02\0\0\0\xff\0\0\0", 12) + "abc");
  write("c.gltf", R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "gone.bin", "byteLength": 36}]})");
  for (const char* name : {"a.gltf", "b.glb", "c.gltf"}) {
    const Outcome outcome = run({"render", path(name), "-o", path("out.exr"), "--method", "raytrace"});
    EXPECT_EQ(outcome.code, 3) << name << ": " << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(name));
  }
}

struct BadUsage {
  const char* name;
  std::vector<std::string> arguments;  ///< "SCENE" and "OUT" stand for files of the test
  int code;
  std::vector<const char*> said;
};

std::ostream& operator<<(std::ostream& stream, const BadUsage& usage) {
  return stream << usage.name;
}

std::vector<BadUsage> bad_usages() {
  const std::vector<std::string> render = {"render", "SCENE", "-o", "OUT"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = render;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  return {
      {"NoCommand", {}, 2, {"--help"}},
      {"UnknownCommand", {"rendr"}, 2, {"no command \"rendr\"", "did you mean render?"}},
      {"UnknownCommandFarFromAny", {"--quiet", "fry", "SCENE"}, 2, {"\"fry\"", "render, compare"}},
      {"UnknownCommandAskedForHelp", {"rendr", "--help"}, 2, {"no command \"rendr\""}},
      {"UnknownOption", with({"--colour"}), 2, {"render has no option --colour"}},
      {"MisspeltOption", with({"--metod=pcss"}), 2, {"render has no option --metod; did you mean --method?"}},
      {"MisspeltGlobalOption", with({"--verbos"}), 2, {"did you mean --verbose?"}},
      {"OneWordTooMany", with({"more"}), 2, {"render does not expect more"}},
      {"PngOfAnotherKind", with({"--png", "picture.jpg"}), 2, {"--png picture.jpg", ".png"}},
      {"NoOutput", {"render", "SCENE"}, 2, {"--output"}},
      {"OutputOfAnotherKind", {"render", "SCENE", "-o", "picture.jpg"}, 2, {".exr"}},
      {"QuietAndVerbose", with({"--quiet", "--verbose"}), 2, {"--quiet"}},
      {"NoLightSamples", with({"--light-samples", "0"}), 2, {"--light-samples 0"}},
      {"TooManyLightSamples", with({"--light-samples", "4097"}), 2, {"4096"}},
      {"TooManyRowsAndColumns", with({"--light-samples", "100x100"}), 2, {"10000"}},
      {"OverflowingProduct", with({"--light-samples", "65536x65536"}), 2, {"--light-samples"}},
      {"NegativeLightSamples", with({"--light-samples=-4"}), 2, {"--light-samples"}},
      {"LightSamplesInWords", with({"--light-samples", "many"}), 2, {"many"}},
      {"UnknownPattern", with({"--sample-pattern", "spiral"}), 2, {"spiral", "sobol"}},
      {"EmptySize", with({"--size", "0x0"}), 2, {"--size 0x0"}},
      {"AbsurdSize", with({"--size", "100000x100000"}), 2, {"--size"}},
      {"OverflowingSize", with({"--size", "99999999999x1"}), 2, {"--size"}},
      {"SizeInWords", with({"--size", "big"}), 2, {"WxH"}},
      {"UnknownMethod", with({"--method", "magic"}), 2, {"magic", "raytrace"}},
      {"MisspeltMethod", with({"--method", "edge-scater"}), 2, {"did you mean edge-scatter?"}},
      {"UnknownMethodOption", with({"--method", "raytrace", "--method-option", "speed=high"}), 2, {"speed"}},
      {"MethodOptionWithoutValue", with({"--method", "raytrace", "--method-option", "speed"}), 2, {"KEY=VALUE"}},
      {"UnknownLight", with({"--method", "raytrace", "--light", "moon"}), 2, {"moon", "key"}},
      {"MisspeltLight", with({"--light", "kay"}), 2, {"it has: key; did you mean key?"}},
      {"UnknownCamera", with({"--method", "raytrace", "--camera", "drone"}), 2, {"drone"}},
      {"FramesBackwards", with({"--frames", "9-3"}), 2, {"9-3"}},
      {"ExplainNoPixel", {"wedges", "SCENE", "--explain", "1;1"}, 2, {"--explain 1;1", "X,Y"}},
      {"ExplainPixelOffTheImage", {"wedges", "SCENE", "--explain", "1,32"}, 2, {"1,32", "48x32"}},
      {"ReferenceThatIsNoJudge",
       {"compare", "SCENE", "-o", "DIR", "--reference", "pcss"},
       2,
       {"raytrace, exact, or one method"}},
      {"ReferenceThatIsNone",
       {"compare", "SCENE", "-o", "DIR", "--reference", "magic"},
       2,
       {"--reference magic: expected raytrace, exact, or any method"}},
      {"ComparePattern",
       {"compare", "SCENE", "-o", "DIR", "--sample-pattern", "x"},
       2,
       {"--sample-pattern x: expected"}},
      {"ReferenceSamples",
       {"compare", "SCENE", "-o", "DIR", "--methods", "raytrace", "--reference-samples", "0"},
       2,
       {"--reference-samples 0"}},
      {"SamplePixels",
       {"compare", "SCENE", "-o", "DIR", "--methods", "raytrace", "--sample-pixels", "1,2,3"},
       2,
       {"--sample-pixels"}},
      {"SamplePixelOffTheImage",
       {"compare", "SCENE", "-o", "DIR", "--methods", "raytrace", "--sample-pixels", "48,0"},
       2,
       {"48,0"}},
      {"ConvertToAnotherKind", {"convert", "SCENE", "-o", "scene.fbx"}, 2, {".glb"}},
      {"UnknownDevice", with({"--device", "no-such-device"}), 4, {"no-such-device"}},
      {"OutputInNoFolder", {"render", "SCENE", "-o", "/nowhere/at/all/out.exr"}, 4, {"/nowhere/at/all/out.exr"}},
      {"OutputIsNoRegularFile", {"render", "SCENE", "-o", "OUT", "--png", "/dev/null"}, 4, {"/dev/null"}},
      {"OutputOnReadOnlySystem", {"render", "SCENE", "-o", "/proc/out.exr"}, 4, {"/proc/out.exr"}},
      {"FolderInTheWay", {"compare", "SCENE", "-o", "SCENE", "--methods", "raytrace"}, 4, {"folder"}},
  };
}

class BadUsageTest : public ProgramTest, public testing::WithParamInterface<BadUsage> {};

TEST_P(BadUsageTest, CostsAMessageAndTheRightExitCode) {
  const BadUsage& bad = GetParam();
  tiny_scene();
  std::vector<std::string> arguments = bad.arguments;
  for (std::string& argument : arguments) {
    if (argument == "SCENE") argument = path("scene.json");
    if (argument == "OUT") argument = path("out.exr");
    if (argument == "DIR") argument = path("dir");
  }
  const Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.code, bad.code) << outcome.err;
  for (const char* said : bad.said) EXPECT_THAT(outcome.err, HasSubstr(said));
  EXPECT_TRUE(outcome.out.empty()) << outcome.out;
  EXPECT_THAT(files(), ElementsAre("scene.json"));
}

INSTANTIATE_TEST_SUITE_P(All, BadUsageTest, testing::ValuesIn(bad_usages()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_F(BadInput, DiskFullLeavesNothing) {
  const std::string scene = tiny_scene();
  for (const char* quota : {"0", "1", "5000"}) {
    const Outcome outcome =
        run({"render", scene, "-o", path("out.exr"), "--method", "raytrace"}, {{"PENUMBRA_TEST_DISK_QUOTA", quota}});
    EXPECT_EQ(outcome.code, 4) << quota << ": " << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("out.exr"), HasSubstr("space")));
    EXPECT_THAT(files(), ElementsAre("scene.json"));
  }
}

TEST_F(BadInput, DiskFullKeepsWhatStoodThere) {
  const std::string scene = tiny_scene();
  write("out.exr", "precious");
  const Outcome outcome =
      run({"render", scene, "-o", path("out.exr"), "--method", "raytrace"}, {{"PENUMBRA_TEST_DISK_QUOTA", "1000"}});
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_EQ(read("out.exr"), "precious");
}

TEST_F(BadInput, FullDevice) {
  // Results on stdout are output, too.
  const std::string command = std::string("'") + PENUMBRA_PROGRAM + "' methods >/dev/full 2>/dev/null";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 4);
}

}  // namespace
}  // namespace penumbra::tests
