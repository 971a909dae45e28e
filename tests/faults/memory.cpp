// SPDX-License-Identifier: Apache-2.0
// Tests that the program takes memory in proportion to what it uses, and first checks that there is enough.
#include "base/exr.hpp"
#include "base/memory.hpp"
#include "tests/faults/child.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace penumbra::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class MemoryFaults : public FaultTest {
 protected:
  /// A scene whose light has a picture with this many channels.
  [[nodiscard]] std::string scene_with_picture(int channels) const {
    const std::vector<float> values(std::size_t{512} * 512, 1.0f);
    ExrImage picture;
    picture.width = picture.height = 512;
    for (const char* name : {"R", "G", "B"}) picture.channels.push_back({name, std::span<const float>(values), 1});
    for (int i = 3; i < channels; ++i) {
      picture.channels.push_back({"more." + std::to_string(i), std::span<const float>(values), 1});
    }
    write_exr(folder_ / "t.exr", picture);
    return write("picture.json", R"({"format": "penumbra-scene/1", "camera": {"eye": [0, 0, 5], "target": [0, 0, 0]},
      "meshes": [{"triangles": [[0,0,0, 1,0,0, 0,1,0]]}],
      "lights": [{"texture": "t.exr", "rectangle": {"center": [0,4,0], "halfU": [1,0,0], "halfV": [0,0,1]}}]})");
  }
  [[nodiscard]] std::string scene_of_soups(int count, int triangles) const {
    std::string meshes;
    for (int i = 0; i < count; ++i) {
      meshes += std::string(i == 0 ? "" : ", ") + R"({"shape": {"type": "lattice-soup", "triangles": )" +
                std::to_string(triangles) + "}}";
    }
    return write("soups.json", R"({"format": "penumbra-scene/1", "camera": {"eye": [0, 0, 5], "target": [0, 0, 0]},
      "lights": [{"rectangle": {"center": [0,4,0], "halfU": [1,0,0], "halfV": [0,0,1]}}], "meshes": [)" +
                                   meshes + "]}");
  }
  /// A scene with this many spheres of 960 triangles that share a mesh, and a floor under a light.
  [[nodiscard]] std::string forest(int spheres, const std::string& light, const std::string& shape) const {
    std::string places;
    for (int i = 0; i < spheres; ++i)
      places += fmt::format(R"({}{{"translate": [{}, 1, {}]}})", i == 0 ? "" : ", ", i % 80, i / 80);
    return write("forest.json", R"({"format": "penumbra-scene/1", "size": [24, 16],
      "camera": {"eye": [-3, 3, -3], "target": [9, 0, 9]}, "lights": [{")" +
                                    light + "\": " + shape + R"(}], "meshes": [
      {"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [9, 0, 0], "halfV": [0, 0, -9]}},
      {"shape": {"type": "sphere", "radius": 0.4, "segments": 32}, "instances": [)" +
                                    places + "]}]}");
  }
  [[nodiscard]] Ending convert(const std::string& scene, std::vector<Limit> limits = {}) const {
    return run_under({.arguments = {"convert", scene, "-o", path("out.glb")}, .limits = std::move(limits)});
  }
};

TEST_F(MemoryFaults, APicturesOtherChannelsTakeNone) {
  const Ending few = convert(scene_with_picture(3)), many = convert(scene_with_picture(200));
  ASSERT_EQ(few.code, 0) << few.err;
  ASSERT_EQ(many.code, 0) << many.err;
  // All channels together are 200 MiB. OpenEXR unpacks 16 of the 512 lines at a time, each with all channels.
  constexpr std::uint64_t kLines = std::uint64_t{200} * 512 * 16 * 4;
  EXPECT_LT(many.peak_bytes, few.peak_bytes + 8 * kLines);
}

TEST_F(MemoryFaults, WhatDoesNotFitIsRefusedWithFigures) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer takes terabytes of addresses when it starts";
  constexpr rlim_t kGibi = 1u << 30;
  // Each of the eight meshes would fit. Nothing is built of a scene that does not fit as a whole; a single triangle
  // would take 92 bytes.
  for (const auto& [count, triangles] : {std::pair{1, 20'000'000}, {8, 2'000'000}}) {
    const Ending ending = convert(scene_of_soups(count, triangles), {{RLIMIT_AS, kGibi}});
    EXPECT_EQ(ending.code, 4) << ending.err;
    EXPECT_THAT(ending.err, AllOf(HasSubstr("a scene of " + std::to_string(count * triangles) + " triangles"),
                                  HasSubstr(std::to_string(triangles) + " of them in /meshes/0, the largest of " +
                                            std::to_string(count)),
                                  HasSubstr("needs about"), HasSubstr("ulimit -v"), HasSubstr("/meshes")));
    EXPECT_LT(ending.peak_bytes, 92ull * 2'000'000);
  }
  const Ending image = run_under({.arguments = {"render", small_scene(), "-o", path("out.exr"), "--size", "16000x8000"},
                                  .limits = {{RLIMIT_AS, kGibi}}});
  EXPECT_EQ(image.code, 4);
  EXPECT_THAT(image.err, AllOf(HasSubstr("16000x8000 pixels"), HasSubstr("GiB"), HasSubstr("--size")));
}

/// Exact areas of a dome need a copy of each instance: their memory, with what the method needs, is checked before any
/// is made.
TEST_F(MemoryFaults, CopiesThatDoNotFitAreRefusedBeforeTheyAreMade) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer takes terabytes of addresses when it starts";
  const Ending ending = run_under({.arguments = {"render", forest(4000, "dome", "{}"), "-o", path("out.exr")},
                                   .limits = {{RLIMIT_AS, rlim_t{1} << 30}}});
  EXPECT_EQ(ending.code, 4) << ending.err;
  EXPECT_THAT(ending.err, AllOf(HasSubstr("4000 instances of meshes among them, each as a copy"), HasSubstr("GiB"),
                                HasSubstr("--light-samples"), HasSubstr("\"sampled\"")));
  EXPECT_LT(ending.peak_bytes, 200u << 20) << "3.8 million triangles would take 120 MB alone";
}

/// The copies alone, 32 bytes for each of 9.6 million triangles, would fit into a gibibyte; with what each command
/// needs for them they do not.
TEST_F(MemoryFaults, EveryCommandThatCopiesCountsWhatItNeedsOfCopies) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer takes terabytes of addresses when it starts";
  const std::string scene =
      forest(10'000, "rectangle", R"({"center": [0, 9, 0], "halfU": [1, 0, 0], "halfV": [0, 0, 1]})");
  const std::vector<std::vector<std::string>> commands = {
      {"compare", scene, "--methods", "raytrace", "-o", path("compared")},
      {"sweep", scene, "--methods", "pcss", "--over", "size=64,128", "-o", path("swept")},
      {"bake", scene, "--mesh", "floor", "--size", "8", "-o", path("baked.exr")},
      {"bake", scene, "--mesh", "floor", "--vertices", "-o", path("baked.ply")},
      {"wedges", scene},
      {"inspect", scene},
      {"render", scene, "--floor", "auto", "--camera", "fit", "-o", path("studio.exr")},
      {"convert", scene, "--instances", "copies", "-o", path("copies.glb")},
      {"convert", scene, "--camera", "fit", "-o", path("around.glb")}};
  for (const std::vector<std::string>& command : commands) {
    const Ending ending = run_under({.arguments = command, .limits = {{RLIMIT_AS, rlim_t{1} << 30}}});
    SCOPED_TRACE(command.front() + " … " + command.back());
    EXPECT_EQ(ending.code, 4) << ending.err;
    EXPECT_THAT(ending.err, AllOf(HasSubstr("needs about"), HasSubstr("GiB"), HasSubstr("a copy")));
    EXPECT_LT(ending.peak_bytes, 200u << 20) << "copies would take 320 MB alone";
  }
}

TEST_F(MemoryFaults, ControlGroupsCount) {
  const auto room = [&] { return memory_room(folder_).bytes; };
  write("proc/meminfo", "MemTotal: 9000 kB\nMemFree: 10 kB\nMemAvailable: 8000 kB\n");
  write("proc/self/statm", "100 10 5 1 0 20 0\n");
  EXPECT_EQ(room(), 8000u * 1024);
  // Version 2: the tightest limit from the process's own group to the root counts; pages of files count as free.
  write("proc/self/cgroup", "0::/a/b\n");
  write("sys/fs/cgroup/a/b/memory.max", "max\n");
  write("sys/fs/cgroup/a/b/memory.current", "5000\n");
  EXPECT_EQ(room(), 8000u * 1024);
  write("sys/fs/cgroup/a/memory.max", "1000000\n");
  write("sys/fs/cgroup/a/memory.current", "600000\n");
  EXPECT_EQ(room(), 400'000u);
  write("sys/fs/cgroup/a/memory.stat", "anon 5\ninactive_file 100000\nactive_file 50000\n");
  EXPECT_EQ(room(), 550'000u);
  write("sys/fs/cgroup/a/b/memory.max", "5000\n");
  EXPECT_EQ(room(), 0u);
  EXPECT_THAT(memory_room(folder_).limit, HasSubstr("control group"));
  // Version 1, in a container that does not see its own path.
  write("proc/self/cgroup", "5:cpu:/\n4:memory:/docker/1234\n0::/\n");
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "700000\n");
  write("sys/fs/cgroup/memory/memory.usage_in_bytes", "800000\n");
  write("sys/fs/cgroup/memory/memory.stat", "inactive_file 1\ntotal_inactive_file 300000\n");
  EXPECT_EQ(room(), 200'000u);
}

TEST_F(MemoryFaults, AMessageIsMoreThanBadAlloc) {
  // A header that announces more than any machine has.
  write("bomb.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty double x\nproperty double y\n"
        "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n");
  const Ending ending = run_under({.arguments = {"inspect", path("bomb.ply")}});
  EXPECT_EQ(ending.code, 3) << ending.err;
  EXPECT_THAT(ending.err, Not(HasSubstr("bad_alloc")));
}

}  // namespace
}  // namespace penumbra::tests
