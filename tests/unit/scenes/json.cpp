// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/scenes/support.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <string>

/// Tests every kind of error in a scene file, and the program's message about it.
namespace penumbra::test {
namespace {

using scenes::read_scene;

struct BadScene {
  const char* name;
  std::string text;
  std::string message;  ///< follows "<file>: "
};

std::ostream& operator<<(std::ostream& stream, const BadScene& bad) {
  return stream << bad.name;
}

class JsonErrors : public testing::TestWithParam<BadScene> {};

TEST_P(JsonErrors, SayWhereAndWhat) {
  const TemporaryFolder folder;
  const auto file = folder.write("scene.json", GetParam().text);
  expect_error(ExitCode::input, file.string() + ": " + GetParam().message, [&] { read_scene(file); });
}

std::string mesh(const std::string& source) {
  return scene_text(R"({"name": "m", )" + source + "}");
}
std::string shape(const std::string& keys) {
  return mesh(R"("shape": {)" + keys + "}");
}
std::string light(const std::string& shape_text) {
  return scene_text(kMesh, R"({"name": "key", )" + shape_text + "}");
}
std::string camera(const std::string& keys) {
  return scene_text(kMesh, kLight, R"("camera": {)" + keys + "}");
}
std::string transform(const std::string& value) {
  return mesh(R"("shape": {"type": "box"}, "transform": )" + value);
}

const BadScene kSyntax[] = {
    {"Empty", "", "line 1, column 1: syntax error"},
    {"Truncated", "{\n  \"format\": \"penumbra-sc", "line 2, column 25: syntax error"},
    {"TrailingComma", "{\n \"a\": 1,\n}", "line 3, column 1: syntax error"},
    {"NotANumber", "{\"size\": [NaN, 1]}", "line 1, column 11: syntax error"},
    {"Infinity", "{\"size\": [Infinity, 1]}", "line 1, column 11: syntax error"},
    {"TextAfterTheEnd", "{} {}", "line 1, column 4: syntax error"},
    {"NotText", "\xff{}", "line 1, column 1: syntax error"},
    {"Utf16LittleEnd", std::string("\xff\xfe{\0}\0", 6), "this is UTF-16; save it as UTF-8"},
    {"Utf16BigEnd", std::string("\xfe\xff\0{\0}", 6), "this is UTF-16; save it as UTF-8"},
    {"Overflow", mesh(R"("triangles": [[0,0,0, 1,0,0, 0,1,0], [0,0,0, 1,1e999,0, 0,1,0]])"),
     "/meshes/0/triangles/1/4: the number 1e999 is beyond the range of double precision"},
    {"NegativeOverflow", camera(R"("eye": [0, -1e400, 0], "target": [0, 0, 0])"),
     "/camera/eye/1: the number -1e400 is beyond"},
    {"KeyTwice", mesh(R"("quad": {"center": [0,0,0], "center": [1,0,0]})"),
     "/meshes/0/quad: the key \"center\" occurs twice"},
    {"ZeroInAString", mesh(R"("file": "floor.off\u0000.png")"),
     "/meshes/0/file: the string holds the character U+0000"},
    {"ZeroInAKey", mesh(R"("a\u0000b": 1)"), "/meshes/0: the key holds the character U+0000"},
    {"AbsurdNesting", std::string(100000, '['), "/0/0/0"},
    {"NotAnObject", "[]", "expected an object, found an array of 0 values"},
};
INSTANTIATE_TEST_SUITE_P(Syntax, JsonErrors, testing::ValuesIn(kSyntax), [](const auto& p) { return p.param.name; });

const BadScene kStructure[] = {
    {"WrongType", mesh(R"("quad": {"center": "x", "halfU": [1,0,0], "halfV": [0,0,1]})"),
     "/meshes/0/quad/center: expected an array of 3 numbers, found a string \"x\""},
    {"WrongLength", mesh(R"("quad": {"center": [1, 2], "halfU": [1,0,0], "halfV": [0,0,1]})"),
     "/meshes/0/quad/center: expected an array of 3 numbers, found an array of 2 values"},
    {"WrongElement", mesh(R"("quad": {"center": [1, 2, null], "halfU": [1,0,0], "halfV": [0,0,1]})"),
     "/meshes/0/quad/center/2: expected a number, found null"},
    {"UnknownKey", mesh(R"("quad": {"center": [0,0,0], "halfU": [1,0,0], "halfV": [0,0,1], "radus": 1})"),
     "/meshes/0/quad: unknown key \"radus\"; known here: \"center\", \"halfU\", \"halfV\""},
    {"UnknownKeyAtTheTop", R"({"format": "penumbra-scene/1", "lamps": []})", "unknown key \"lamps\""},
    {"MissingKey", mesh(R"("quad": {"center": [0,0,0], "halfU": [1,0,0]})"),
     "/meshes/0/quad: missing key \"halfV\": expected an array of 3 numbers"},
    {"OtherVersion", R"({"format": "penumbra-scene/2", "lamps": []})",
     "/format: \"penumbra-scene/2\" is another version of the format; this program reads \"penumbra-scene/1\" alone"},
    {"OtherFormat", R"({"format": "other-scene/2", "camera": {"eye": [0,0,1], "target": [0,0,0]},
                        "meshes": [{"shape": {"type": "box"}}], "lights": [{"sphere": {"center": [0,1,0], "radius": 1}}]})",
     "/format: expected \"penumbra-scene/1\", found a string \"other-scene/2\""},
    {"NoFormat", "{}", "missing key \"format\": expected \"penumbra-scene/1\""},
    {"NoCamera", scene_text(kMesh, kLight, R"("size": [8, 8])"),
     "expected exactly one of the keys \"camera\", \"cameras\", found none, for example {\"eye\":"},
    {"CameraAndCameras", scene_text(kMesh, kLight, std::string(kCamera) + R"(, "cameras": [])"),
     "expected exactly one of the keys \"camera\", \"cameras\", found \"camera\" and \"cameras\""},
    {"NoLights", std::string(R"({"format": "penumbra-scene/1", )") + kCamera + R"(, "meshes": [)" + kMesh + "]}",
     "missing key \"lights\": expected an array of at least 1 light, for example [{"},
    {"EmptyLights", scene_text(kMesh, ""),
     "/lights: expected an array of at least 1 light, found an array of 0 values"},
    {"EmptyMeshes", scene_text(""), "/meshes: expected an array of at least 1 mesh, found an array of 0 values"},
    {"EmptyMesh", mesh(R"("triangles": [])"), "/meshes/0/triangles: expected an array of at least 1 triangle"},
    {"ShortTriangle", mesh(R"("triangles": [[0,0,0, 1,0,0]])"),
     "/meshes/0/triangles/0: expected an array of 9 numbers, found an array of 6 values"},
    {"LaterTriangleHoldsText", mesh(R"("triangles": [[0,0,0, 1,0,0, 0,1,0], [0,0,0, 1,0,"x", 0,1,0]])"),
     "/meshes/0/triangles/1/5: expected a number, found a string \"x\""},
    {"NoSource", mesh(R"("castsShadow": true)"),
     "/meshes/0: expected exactly one of the keys \"file\", \"package\", \"quad\", \"shape\", \"triangles\", found "
     "none"},
    {"TwoSources", mesh(R"("shape": {"type": "box"}, "triangles": [[0,0,0, 1,0,0, 0,1,0]])"),
     "/meshes/0: expected exactly one of the keys \"file\", \"package\", \"quad\", \"shape\", \"triangles\", found "
     "\"shape\" and \"triangles\""},
    {"FitAndTransform", mesh(R"("shape": {"type": "box"}, "fit": {"height": 1}, "transform": {})"),
     R"(/meshes/0: the keys ["fit","transform"] exclude one another)"},
    {"NoLightShape", light(R"("radiance": [1,1,1])"),
     "/lights/0: expected exactly one of the keys \"rectangle\", \"disk\", \"ellipse\", \"polygon\", \"sphere\", "
     "\"sun\", \"dome\", \"pieces\", found none"},
    {"EmptyPieces", light(R"("pieces": [])"), "/lights/0/pieces: expected an array of 1 to 1024 pieces"},
    {"PieceOfTwoShapes",
     light(R"("pieces": [{"sphere": {"center": [0,5,0], "radius": 1}, "polygon": [[0,0,0],[1,0,0],[0,1,0]]}])"),
     "/lights/0/pieces/0: expected exactly one of the keys \"rectangle\", \"polygon\", \"sphere\", found"},
    {"PieceIsASun", light(R"("pieces": [{"sun": {"direction": [0,-1,0], "angle": 1}}])"), "/lights/0/pieces/0:"},
    {"ColorTooBright", mesh(R"("shape": {"type": "box"}, "color": [1, 1, 1.5])"),
     "/meshes/0/color/2: expected a number from 0 to 1, found the number 1.5"},
    {"NegativeRadiance", light(R"("sphere": {"center": [0,5,0], "radius": 1}, "radiance": [-1, 0, 0])"),
     "/lights/0/radiance/0: expected a number from 0 up, found the number -1"},
    {"FlagIsNoBoolean", mesh(R"("shape": {"type": "box"}, "castsShadow": "no")"),
     "/meshes/0/castsShadow: expected true or false, found a string \"no\""},
    {"SizeZero", scene_text(kMesh, kLight, std::string(kCamera) + R"(, "size": [0, 512])"),
     "/size/0: expected an integer from 1 to 32768, found the number 0"},
    {"SizeAbsurd", scene_text(kMesh, kLight, std::string(kCamera) + R"(, "size": [512, 1000000])"),
     "/size/1: expected an integer from 1 to 32768, found the number 1000000"},
    {"SizeFraction", scene_text(kMesh, kLight, std::string(kCamera) + R"(, "size": [512, 2.5])"),
     "/size/1: expected an integer from 1 to 32768, found the number 2.5"},
    {"UnknownShape", shape(R"("type": "teapot")"), "/meshes/0/shape/type: expected one of \"sphere\", \"icosphere\""},
    {"ShapeWithoutType", shape(R"("radius": 1)"), "/meshes/0/shape: missing key \"type\": expected one of \"sphere\""},
    {"ShapeIsNoObject", mesh(R"("shape": "sphere")"),
     "/meshes/0/shape: expected an object with a \"type\", found a string"},
    {"ShapeKeyOfAnother", shape(R"("type": "box", "radius": 1)"), "/meshes/0/shape: unknown key \"radius\""},
    {"ShapeRadiusZero", shape(R"("type": "sphere", "radius": 0)"),
     "/meshes/0/shape/radius: expected a number above 0, found the number 0"},
    {"EmptyName", scene_text(R"({"name": "", "shape": {"type": "box"}})"),
     "/meshes/0/name: expected a string of 1 to 200 characters, found a string \"\""},
};
INSTANTIATE_TEST_SUITE_P(Structure, JsonErrors, testing::ValuesIn(kStructure),
                         [](const auto& p) { return p.param.name; });

const BadScene kMeaning[] = {
    {"NameWithLineBreak", scene_text(R"({"name": "a\nb", "shape": {"type": "box"}})"),
     "/meshes/0/name: the name holds a control character"},
    {"LightsNamedAlike", scene_text(kMesh, std::string(kLight) + ", " + kLight),
     "/lights/1: the name \"key\" is that of light 0 already"},
    {"EmitsNoLight", mesh(R"("shape": {"type": "box"}, "emits": "sun")"),
     "/meshes/0/emits: no light is named \"sun\"; there is: key"},
    {"EmitsADome",
     scene_text(R"({"name": "m", "shape": {"type": "box"}, "emits": "sky"})", R"({"name": "sky", "dome": {}})"),
     "/meshes/0/emits: the light \"sky\" is a dome, infinitely far away, so no mesh is its body; remove \"emits\""},
    {"ScaleZero", transform(R"({"scale": 0})"), "/meshes/0/transform/scale: a scale of 0 would flatten the mesh"},
    {"OneScaleZero", transform(R"({"scale": [1, 0, 1]})"), "/meshes/0/transform/scale: a scale of 0"},
    {"ScaleIsText", transform(R"({"scale": "big"})"),
     "/meshes/0/transform/scale: expected a number or an array of 3 numbers, found a string \"big\""},
    {"ScaleOverflows", transform(R"({"scale": 1e200})"), "/meshes/0/transform: the transform's determinant is inf"},
    {"MatrixSingular", transform("[1,0,0,0, 1,0,0,0, 0,0,1,0, 0,0,0,1]"),
     "/meshes/0/transform: the transform's determinant is 0"},
    {"MatrixPerspective", transform("[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,1,0]"),
     "/meshes/0/transform: the last row is 0 0 1 0; expected 0 0 0 1"},
    {"MatrixTooShort", transform("[1,0,0,0]"),
     "/meshes/0/transform: expected an array of 16 numbers, found an array of 4 values"},
    {"TransformIsNumber", transform("3"),
     "/meshes/0/transform: expected an object or an array of 16 numbers, found the number 3"},
    {"FitFlatMesh",
     scene_text(R"({"quad": {"center": [0,0,0], "halfU": [1,0,0], "halfV": [0,0,1]}, "fit": {"height": 2}})"),
     "/meshes/0/fit: the mesh is flat along Y and cannot be made 2 tall"},
    {"VertexTooFar", mesh(R"("triangles": [[0,0,0, 1,0,0, 0,1e30,0]])"),
     "mesh \"m\": a vertex of face 0 is (0, 1e+30, 0)"},
    {"WindowTooWide", shape(R"("type": "room", "windowWidth": 9)"), "/meshes/0/shape: the window (9 wide"},
    {"ShapeTooFine", shape(R"("type": "torus", "segments": 16384, "sides": 16384)"),
     "/meshes/0/shape: the shape would have 536870912 triangles; at most 50000000"},
    {"RectangleFlat", light(R"("rectangle": {"center": [0,5,0], "halfU": [1,0,0], "halfV": [2,0,0]})"),
     "/lights/0/rectangle: the light has no area: halfU (1, 0, 0) and halfV (2, 0, 0)"},
    {"RectangleZero", light(R"("rectangle": {"center": [0,5,0], "halfU": [0,0,0], "halfV": [0,0,1]})"),
     "/lights/0/rectangle: the light has no area"},
    {"EllipseOfParallelAxes", light(R"("ellipse": {"center": [0,5,0], "halfU": [1,0,0], "halfV": [-2,0,0]})"),
     "/lights/0/ellipse: the light has no area: halfU (1, 0, 0) and halfV (-2, 0, 0) must be neither zero nor "
     "parallel"},
    {"EllipseWithoutAnAxis", light(R"("ellipse": {"center": [0,5,0], "halfU": [1,0,0]})"),
     "/lights/0/ellipse: missing key \"halfV\""},
    {"LitByNobody", mesh(R"("shape": {"type": "box"}, "lights": ["key", "moon"])"),
     "/meshes/0/lights/1: no light is named \"moon\"; there is: key"},
    {"LitByATypingError", mesh(R"("shape": {"type": "box"}, "lights": ["keys"])"),
     "/meshes/0/lights/0: no light is named \"keys\"; there is: key; did you mean key?"},
    {"CasterUnknown", light(R"("sphere": {"center": [0,5,0], "radius": 1}, "casters": {"exclude": ["glass"]})"),
     "/lights/0/casters/exclude/0: no mesh is named \"glass\"; there is: "},
    {"CastersMistyped", light(R"("sphere": {"center": [0,5,0], "radius": 1}, "casters": {"except": ["glass"]})"),
     "/lights/0/casters: unknown key \"except\""},
    {"ConeInsideOut",
     light(R"("sphere": {"center": [0,5,0], "radius": 1, "cone": {"direction": [0,-1,0], "inner": 30, "outer": 20}})"),
     "/lights/0/sphere: the cone reaches from 30 to 20 degrees"},
    {"SunOfHalfTheSky", light(R"("sun": {"direction": [0,-1,0], "angle": 180})"),
     "/lights/0/sun/angle: expected a number from 0 up and below 180, found the number 180"},
    {"SunOfNegativeAngle", light(R"("sun": {"direction": [0,-1,0], "angle": -1})"), "/lights/0/sun/angle: expected"},
    {"SunWithoutAngle", light(R"("sun": {"direction": [0,-1,0]})"), "/lights/0/sun: missing key \"angle\""},
    {"SunWithoutDirection", light(R"("sun": {"direction": [0,0,0], "angle": 1})"),
     "/lights/0/sun: the direction is zero"},
    {"SunSaidTwice", light(R"("sun": {"direction": [0,-1,0], "angle": 1}, "radiance": [1,1,1], "irradiance": [1,1,1])"),
     "/lights/0: "},
    {"IrradianceOfADisk",
     light(R"("disk": {"center": [0,5,0], "normal": [0,-1,0], "radius": 1}, "irradiance": [1,1,1])"),
     "/lights/0/irradiance: only a \"sun\" has an irradiance"},
    {"DiskRadius", light(R"("disk": {"center": [0,5,0], "normal": [0,-1,0], "radius": 0})"),
     "/lights/0/disk/radius: expected a number above 0, found the number 0"},
    {"DiskNormal", light(R"("disk": {"center": [0,5,0], "normal": [0,0,0], "radius": 1})"),
     "/lights/0/disk: the normal is zero"},
    {"SphereRadius", light(R"("sphere": {"center": [0,5,0], "radius": -2})"),
     "/lights/0/sphere/radius: expected a number above 0, found the number -2"},
    {"PolygonOfTwo", light(R"("polygon": [[0,5,0], [1,5,0]])"),
     "/lights/0/polygon: expected an array of 3 to 1024 points, found an array of 2 values"},
    {"PolygonNotFlat", light(R"("polygon": [[0,5,0], [1,5,0], [1,5.2,1], [0,5,1]])"),
     "/lights/0/polygon: the polygon is not flat: vertex 0 (0, 5, 0) lies 0.04"},
    {"PolygonNotConvex", light(R"("polygon": [[0,5,0], [2,5,0], [0.5,5,0.5], [0,5,2]])"),
     "/lights/0/polygon: the polygon is not convex: vertex"},
    {"PolygonPentagram",
     light(R"("polygon": [[1,5,0], [-0.809,5,0.588], [0.309,5,-0.951], [0.309,5,0.951], [-0.809,5,-0.588]])"),
     "/lights/0/polygon: the polygon is not convex: vertex"},
    {"PolygonRepeats", light(R"("polygon": [[0,5,0], [1,5,0], [1,5,0], [0,5,1]])"),
     "/lights/0/polygon: vertices 1 and 2 are the same point (1, 5, 0)"},
    {"PolygonOnALine", light(R"("polygon": [[0,5,0], [1,5,0], [2,5,0]])"), "/lights/0/polygon: the light has no area"},
    {"EyeIsTarget", camera(R"("eye": [1,1,1], "target": [1,1,1])"),
     "/camera: eye and target are the same point (1, 1, 1)"},
    {"UpAlongView", camera(R"("eye": [0,5,0], "target": [0,0,0])"),
     "/camera: up (0, 1, 0) points along the view direction"},
    {"UpZero", camera(R"("eye": [0,5,0], "target": [0,0,0], "up": [0,0,0])"), "/camera: up is zero"},
    {"FieldOfView", camera(R"("eye": [0,0,5], "target": [0,0,0], "verticalFov": 180)"),
     "/camera/verticalFov: expected a number above 0 and below 180, found the number 180"},
};
INSTANTIATE_TEST_SUITE_P(Meaning, JsonErrors, testing::ValuesIn(kMeaning), [](const auto& p) { return p.param.name; });

}  // namespace
}  // namespace penumbra::test
