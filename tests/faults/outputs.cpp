// SPDX-License-Identifier: Apache-2.0
// Tests that no output is written to a file that the command reads, and no two outputs to one file, whatever their
// names: exit code 2 with both names, and every file unchanged.
#include "base/exr.hpp"
#include "tests/faults/child.hpp"

#include <gmock/gmock.h>

#include <functional>

namespace penumbra::tests {
namespace {

using testing::HasSubstr;

using Arguments = std::vector<std::string>;

/// Another name of a file.
struct Alias {
  const char* name;
  std::function<std::string(const std::filesystem::path& file)> make;
};

std::string beside(const std::filesystem::path& file, const std::string& name) {
  return (file.parent_path() / (name + file.extension().string())).string();
}

const std::vector<Alias>& aliases() {
  static const std::vector<Alias> all = {
      {"itself", [](const auto& file) { return file.string(); }},
      {"through its folder",
       [](const auto& file) { return (file.parent_path() / "." / "folder" / ".." / file.filename()).string(); }},
      {"through a linked folder",
       [](const auto& file) { return (file.parent_path() / "linked" / file.filename()).string(); }},
      {"symbolic link",
       [](const auto& file) {
         std::string link = beside(file, "symbolic");
         std::filesystem::remove(link);
         std::filesystem::create_symlink(file, link);
         return link;
       }},
      {"hard link",
       [](const auto& file) {
         std::string link = beside(file, "hard");
         std::filesystem::remove(link);
         std::filesystem::create_hard_link(file, link);
         return link;
       }},
  };
  return all;
}

class OutputFaults : public FaultTest {
 protected:
  OutputFaults() {
    std::filesystem::create_directory(folder_ / "folder");
    std::filesystem::create_directory_symlink(".", folder_ / "linked");
    ExrImage picture;
    picture.width = picture.height = 1;
    const float one = 1;
    for (const char* name : {"R", "G", "B"}) picture.channels.push_back({name, std::span<const float>(&one, 1), 1});
    write_exr(folder_ / "t.exr", picture);
    write("m.obj", "  mtllib m.mtl\nv -1 1 0\nv 1 1 0\nv 0 1 1\nusemtl grey\nf 1 2 3\n");
    write("m.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
    write("p.ply",
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
          "element face 1\nproperty list uchar int vertex_indices\nend_header\n-1 1 0\n1 1 0\n0 1 1\n3 0 1 2\n");
    write("s.json", R"({"format": "penumbra-scene/1", "size": [8, 8],
      "camera": {"eye": [2, 3, 6], "target": [0, 0.5, 0]},
      "meshes": [{"file": "m.obj"}, {"file": "p.ply"}],
      "lights": [{"name": "key", "texture": "t.exr",
                  "rectangle": {"center": [0, 4, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}}]})");
    const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    write("b.bin", std::string(reinterpret_cast<const char*>(corners), sizeof(corners)));
    write("s.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "buffers": [{"uri": "b.bin", "byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                     "min": [0, 0, 0], "max": [1, 1, 0]}]})");
  }

  [[nodiscard]] std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> all;
    for (const std::string& file : files()) all[file] = read(file);
    return all;
  }

  void expect_refused(const Arguments& arguments, const std::string& first, const std::string& second) const {
    const auto before = contents();
    const Ending ending = run_under({.arguments = arguments});
    EXPECT_EQ(ending.code, 2) << testing::PrintToString(arguments) << ": " << ending.err;
    EXPECT_THAT(ending.err, HasSubstr(first));
    EXPECT_THAT(ending.err, HasSubstr(second));
    EXPECT_TRUE(contents() == before) << "a file was changed by " << testing::PrintToString(arguments);
  }

  static Arguments with(Arguments arguments, const Arguments& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
};

TEST_F(OutputFaults, NoTwoOutputsAreOneFile) {
  const Arguments render = {"render", path("s.json"), "-o", path("out.exr")};
  const Arguments wedges = {"wedges", path("s.json"), "--explain", "4,4"};
  struct Pair {
    Arguments before;
    const char *first, *second;
    std::string name;
  };
  const std::vector<Pair> pairs = {
      {{"render", path("s.json")}, "-o", "--stats", "x.exr"},
      {{"render", path("s.json")}, "-o", "--png", "x.exr"},
      {{"render", path("s.json")}, "-o", "--bits", "x.exr"},
      {render, "--stats", "--png", "x"},
      {render, "--stats", "--bits", "x"},
      {render, "--png", "--bits", "x"},
      {wedges, "--json", "--export", "x.obj"},
      {wedges, "--json", "--svg", "x.svg"},
      {{"inspect", path("p.ply")}, "--json", "--export-defects", "x.ply"},
      {{"inspect", path("p.ply")}, "--json", "--repair", "x.ply"},
      {{"inspect", path("p.ply")}, "--export-defects", "--repair", "x.ply"},
  };
  for (const Pair& pair : pairs) {
    for (const bool exists : {false, true}) {
      for (const Alias& alias : aliases()) {
        SCOPED_TRACE(alias.name);
        std::filesystem::remove(folder_ / pair.name);
        if (exists) write(pair.name, "old");
        const bool needs_file = std::string(alias.name).ends_with("link");
        if (needs_file && !exists) continue;
        const std::string other = alias.make(folder_ / pair.name);
        expect_refused(with(pair.before, {pair.first, path(pair.name), pair.second, other}), path(pair.name), other);
      }
    }
  }
  expect_refused({"compare", path("s.json"), "-o", path("dir"), "--stats", path("dir/metrics.json")}, "--stats",
                 path("dir/metrics.json"));
  expect_refused({"compare", path("s.json"), "-o", path("dir"), "--stats", path("dir/reference.exr")}, "--stats",
                 path("dir/reference.exr"));
  // Frames are separate files.
  expect_refused(
      with({"render", path("s.json"), "-o", path("f.exr"), "--frames", "1-3"}, {"--bits", path("f.####.exr")}),
      "--bits", path("f.0001.exr"));
}

TEST_F(OutputFaults, NoInputIsAnOutput) {
  const std::vector<std::string> inputs = {"s.json", "m.obj", "m.mtl", "p.ply", "t.exr"};
  const std::vector<Arguments> outputs = {
      {"render", path("s.json"), "-o", path("out.exr"), "--stats"},
      {"render", path("s.json"), "-o", path("out.exr"), "--png"},
      {"render", path("s.json"), "-o", path("out.exr"), "--bits"},
      {"compare", path("s.json"), "-o", path("dir"), "--stats"},
      {"wedges", path("s.json"), "--json"},
      {"inspect", path("s.json"), "--json"},
  };
  for (const Arguments& output : outputs) {
    for (const std::string& input : inputs) {
      expect_refused(with(output, {path(input)}), path(input), output.back() == "--png" ? "--png" : "input");
    }
  }
  for (const Alias& alias : aliases()) {
    SCOPED_TRACE(alias.name);
    const std::string other = alias.make(folder_ / "m.obj");
    expect_refused(with(outputs.back(), {other}), other, "m.obj");
  }
  std::filesystem::create_symlink(folder_ / "m.obj", folder_ / "m.png");
  expect_refused({"render", path("s.json"), "-o", path("out.exr"), "--png", path("m.png")}, path("m.png"), "m.obj");
  std::filesystem::remove(folder_ / "m.png");
  expect_refused({"render", path("s.json"), "-o", path("t.exr")}, "-o", path("t.exr"));
  expect_refused({"convert", path("s.json"), "-o", path("s.json")}, "-o", path("s.json"));
  expect_refused({"convert", path("s.json"), "-o", path("m.obj")}, "-o", path("m.obj"));
  expect_refused({"wedges", path("s.json"), "--export", path("p.ply")}, "--export", path("p.ply"));
  for (const char* option : {"--export-defects", "--repair"}) {
    expect_refused({"inspect", path("p.ply"), option, path("p.ply")}, option, path("p.ply"));
    expect_refused({"inspect", path("s.json"), option, path("p.ply")}, option, path("p.ply"));
  }
  for (const char* input : {"s.gltf", "b.bin"}) {
    expect_refused({"inspect", path("s.gltf"), "--json", path(input)}, "--json", path(input));
  }
}

TEST_F(OutputFaults, WhatACommandWritesBesideItsOutputCountsToo) {
  // The texture of x.json's first light is written to x-light0.exr.
  std::filesystem::rename(folder_ / "t.exr", folder_ / "x-light0.exr");
  std::string scene = read("s.json");
  write("s.json", scene.replace(scene.find("t.exr"), 5, "x-light0.exr"));
  expect_refused({"convert", path("s.json"), "-o", path("x.json")}, path("x.json").substr(0, path("x.json").size() - 5),
                 "x-light0.exr");
  // compare's folder may be the scene's folder.
  write("metrics.json", read("s.json"));
  expect_refused({"compare", path("metrics.json"), "-o", folder_.string()}, "-o", path("metrics.json"));
  std::filesystem::rename(folder_ / "x-light0.exr", folder_ / "reference.exr");
  scene = read("s.json");
  write("s.json", scene.replace(scene.find("x-light0.exr"), 12, "reference.exr"));
  std::filesystem::remove(folder_ / "metrics.json");
  expect_refused({"compare", path("s.json"), "-o", folder_.string()}, "-o", path("reference.exr"));
}

}  // namespace
}  // namespace penumbra::tests
