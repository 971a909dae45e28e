// SPDX-License-Identifier: Apache-2.0
// Tests that SIGINT and SIGTERM end every command with code 130 within two seconds, whatever it is doing, and that
// nothing is left of what it was writing.
#include "tests/faults/child.hpp"

#include <gmock/gmock.h>

#include <array>
#include <chrono>
#include <fstream>
#include <functional>
#include <thread>

namespace penumbra::tests {
namespace {

using testing::HasSubstr;
using testing::Not;
using Clock = std::chrono::steady_clock;

class SignalFaults : public FaultTest {
 protected:
  /// The documented two seconds; sanitizers make everything slower.
  static constexpr double kSeconds = kSanitized ? 10 : 2;

  /// Sends a signal as soon as `now()`, and expects the end soon after it.
  void interrupt_when(Conditions conditions, int signal, const std::function<bool()>& now) const {
    conditions.environment["PENUMBRA_TEST_NAMED_PARTS"] = "1";
    Running program(conditions);
    const auto start = Clock::now();
    while (!now() && !program.has_ended() && Clock::now() - start < std::chrono::minutes(5))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const auto sent = Clock::now();
    program.send(signal);
    const Ending ending = program.wait();
    EXPECT_EQ(ending.code, 130) << ending.err;
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - sent).count(), kSeconds);
    EXPECT_THAT(ending.err, HasSubstr("interrupted"));
  }
  /// Returns whether a file is being written that does not have its final name yet.
  [[nodiscard]] bool is_writing() const {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
      if (entry.path().filename().string().find(".part") != std::string::npos) return true;
    }
    return false;
  }
  [[nodiscard]] static std::function<bool()> after(double seconds) {
    return [begin = Clock::now(), seconds] {
      return std::chrono::duration<double>(Clock::now() - begin).count() > seconds;
    };
  }
  void expect_nothing_but_inputs(const std::vector<std::string>& inputs) const { EXPECT_EQ(files(), inputs); }

  void interrupt_writing(const std::string& size) const {
    const Conditions conditions = {.arguments = {"render", small_scene(), "-o", path("out.exr"), "--png",
                                                 path("out.png"), "--bits", path("out.bits"), "--stats",
                                                 path("out.json"), "--method", "raytrace", "--light-samples", "1",
                                                 "--size", size}};
    for (const int signal : {SIGINT, SIGTERM}) {
      // The bits are written first, tile by tile; the second file is the picture.
      interrupt_when(conditions, signal, [this] { return is_writing(); });
      expect_nothing_but_inputs({"scene.json"});
      interrupt_when(conditions, signal, [this] {
        std::size_t parts = 0;
        for (const std::string& file : files()) parts += file.find(".part") != std::string::npos ? 1 : 0;
        return parts > 1;
      });
      expect_nothing_but_inputs({"scene.json"});
    }
  }
  /// A grid of `side` squares a side, which takes a while to write as text.
  [[nodiscard]] std::string grid(int side) const {
    std::ofstream mesh(path("grid.obj"));
    for (int y = 0; y <= side; ++y) {
      for (int x = 0; x <= side; ++x) mesh << "v " << x << " 0 " << y << "\n";
    }
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const int a = y * (side + 1) + x + 1, b = a + side + 1;
        mesh << "f " << a << ' ' << b << ' ' << a + 1 << "\nf " << a + 1 << ' ' << b << ' ' << b + 1 << "\n";
      }
    }
    mesh.close();
    return write("grid.json", R"({"format": "penumbra-scene/1", "camera": {"eye": [0, 9, 1], "target": [0, 0, 0]},)"
                              R"( "meshes": [{"name": "grid", "file": "grid.obj"}],)"
                              R"( "lights": [{"disk": {"center": [0, 5, 0], "normal": [0, -1, 0], "radius": 1}}]})");
  }
};

TEST_F(SignalFaults, WhilePicturesAreWritten) {
  interrupt_writing("1024x1024");
}

TEST_F(SignalFaults, WhileConvertWrites) {
  const std::string scene = grid(400);
  for (const char* name : {"out.obj", "out.json", "out.glb"}) {
    interrupt_when({.arguments = {"convert", scene, "-o", path(name)}}, SIGTERM, [this] { return is_writing(); });
    expect_nothing_but_inputs({"grid.json", "grid.obj"});
  }
}

TEST_F(SignalFaults, WhileDevicesAreTested) {
  for (const double seconds : {0.2, 1.0})
    interrupt_when({.arguments = {"devices", "--self-test", "--device", "cpu"}}, SIGINT, after(seconds));
}

TEST_F(SignalFaults, LongWhileLargePicturesAreWritten) {
  interrupt_writing("4096x4096");
}

/// Signals at any time while the program handles a hundred thousand lights.
TEST_F(SignalFaults, LongUnderManyLights) {
  std::ofstream scene(path("many.json"));
  scene << R"({"format": "penumbra-scene/1", "size": [16, 16], "camera": {"eye": [3, 3, 5], "target": [0, 0, 0]},)"
        << R"( "meshes": [{"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [4, 0, 0], "halfV": [0, 0, -4]}}],)"
        << R"( "lights": [)";
  for (int i = 0; i < 100'000; ++i) {
    scene << (i == 0 ? "" : ",") << R"({"name": "l)" << i << R"(", "disk": {"center": [)" << i % 100 << ", 5, "
          << i / 100 % 100 << R"(], "normal": [0, -1, 0], "radius": 0.1}})";
  }
  scene << "]}";
  scene.close();
  for (const double seconds : {0.5, 2.0, 5.0, 10.0, 20.0}) {
    Running program({.arguments = {"render", path("many.json"), "-o", path("out.exr")}});
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    if (program.has_ended()) break;
    const auto sent = Clock::now();
    program.send(SIGTERM);
    const Ending ending = program.wait();
    EXPECT_THAT(ending.code, testing::AnyOf(0, 130)) << ending.err;
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - sent).count(), kSeconds) << seconds;
  }
}

}  // namespace
}  // namespace penumbra::tests
