// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/scene.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <unistd.h>

namespace penumbra::test {

/// A folder for one test, deleted afterwards.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    static std::atomic<int> serial{0};
    path_ = std::filesystem::temp_directory_path() / fmt::format("penumbra_test_{}_{}", ::getpid(), serial++);
    std::filesystem::create_directories(path_);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  [[nodiscard]] std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) names.push_back(entry.path().filename());
    return names;
  }

 private:
  std::filesystem::path path_;
};

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs `action`, which must throw Error with this code and with `fragment` in its message; returns the message.
template <typename Action>
std::string expect_error(ExitCode code, const std::string& fragment, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(code)) << error.what();
    EXPECT_NE(std::string(error.what()).find(fragment), std::string::npos)
        << "expected: " << fragment << "\n   found: " << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error; expected: " << fragment;
  return {};
}

inline constexpr const char* kCamera = R"("camera": {"eye": [0, 2, 6], "target": [0, 1, 0]})";
inline constexpr const char* kMesh =
    R"({"name": "floor", "quad": {"center": [0,0,0], "halfU": [4,0,0], "halfV": [0,0,-4]}})";
inline constexpr const char* kLight =
    R"({"name": "key", "rectangle": {"center": [0,5,0], "halfU": [1,0,0], "halfV": [0,0,1]}})";

/// Returns the text of a complete scene; its mesh, light or camera may be replaced.
inline std::string scene_text(const std::string& mesh = kMesh, const std::string& light = kLight,
                              const std::string& camera = kCamera) {
  return fmt::format(R"({{"format": "penumbra-scene/1", {}, "meshes": [{}], "lights": [{}]}})", camera, mesh, light);
}

/// Scene for tests of writers: shapes and lights of every kind, and numbers that are hard to write.
inline constexpr const char* kEverything = R"({ "format": "penumbra-scene/1", "size": [640, 360],
  "cameras": [{"name": "main", "eye": [0.1, 2, 6.3], "target": [0, 1, 0], "verticalFov": 37.7}, {"eye": [1, 2, 3], "target": [0, 0, 0], "up": [1, 0, 0.2], "shift": [0.3, -0.1], "aperture": 0.07, "focusDistance": 2.3}],
  "meshes": [
    {"name": "a \"quoted\" näme", "shape": {"type": "blob", "subdivisions": 2}, "transform": {"rotate": [13, 29, 71], "scale": [1.1, 0.9, -0.7], "translate": [1e-9, 0.3, -1e5]}, "color": [0.1, 0.2, 0.3]},
    {"shape": {"type": "hair", "strands": 20}, "castsShadow": false},
    {"quad": {"center": [0, -0.0, 0], "halfU": [4, 0, 0], "halfV": [0, 0, -4]}, "receivesShadow": false, "lights": ["key", "sun"]},
    {"name": "lamp", "triangles": [[0,5,0, 1,5,0, 0,5,1]], "emits": "poly"}],
  "lights": [
    {"name": "key", "rectangle": {"center": [0, 5, 0], "halfU": [0.1, 0, 0], "halfV": [0, 0, 0.3]}, "radiance": [1.5, 0, 1e-7], "twoSided": true},
    {"name": "rim", "disk": {"center": [2, 5, 0], "normal": [0.3, -1, 0.1], "radius": 0.4}},
    {"name": "poly", "polygon": [[0,5,0],[1,5,0],[0,5,1]]},
    {"name": "oval", "ellipse": {"center": [0, 5, 0.1], "halfU": [0.6, 0, 0], "halfV": [0, 0.1, 0.3]}},
    {"name": "sun", "sun": {"direction": [-0.35, -0.87, -0.35], "angle": 0.53}, "irradiance": [3, 2.9, 2.5]},
    {"name": "point", "sun": {"direction": [0.1, -0.87, -0.35], "angle": 0}, "irradiance": [0.1, 0.2, 0.3]},
    {"name": "spot", "sphere": {"center": [0, 4, -2], "radius": 0.1, "cone": {"direction": [0.1, -1, 0.2], "inner": 10, "outer": 25, "smooth": true}}},
    {"name": "bulb", "sphere": {"center": [0, 4, 2], "radius": 0.2}, "casters": {"include": ["lamp", "a \"quoted\" näme"]}}] })";

inline scenes::Scene read_text(const std::string& text) {
  const TemporaryFolder folder;
  return scenes::read_scene(folder.write("scene.json", text));
}

}  // namespace penumbra::test
