// SPDX-License-Identifier: Apache-2.0
#include "mesh/input_file.hpp"
#include "scenes/formats/package_files.hpp"
#include "tests/unit/scenes/support.hpp"

#include <gtest/gtest.h>

#include <string>

#include <sys/resource.h>
#include <sys/stat.h>

/// Tests which files a scene may name, and the messages about those that it may not.
namespace penumbra::test {
namespace {

using scenes::find_package_file;
using scenes::read_scene;

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

std::string scene_with_file(const std::string& name) {
  return scene_text(R"({"file": ")" + name + R"("})");
}

TEST(SceneFiles, MissingSceneFolderAndOtherKinds) {
  const TemporaryFolder folder;
  expect_error(ExitCode::input, "none.json: no such file", [&] { read_scene(folder / "none.json"); });
  expect_error(ExitCode::input, "none.xyz: No such file", [&] { read_scene(folder / "none.xyz"); });
  expect_error(ExitCode::input, "a file of Blender's own", [&] { read_scene(folder.write("mesh.blend", "BLENDER")); });
  std::filesystem::create_directory(folder / "folder.json");
  expect_error(ExitCode::input, "this is a folder; expected a file", [&] { read_scene(folder / "folder.json"); });
  ASSERT_EQ(::mkfifo((folder / "pipe.json").c_str(), 0600), 0);
  expect_error(ExitCode::input, "not a regular file", [&] { read_scene(folder / "pipe.json"); });
}

/// While this object lives no file can be opened: every descriptor is beyond the limit.
class NoDescriptors {
 public:
  NoDescriptors() {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit none{0, before_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &none);
  }
  NoDescriptors(const NoDescriptors&) = delete;
  NoDescriptors& operator=(const NoDescriptors&) = delete;
  ~NoDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before_); }

 private:
  rlimit before_{};
};

TEST(SceneFiles, WhatTheMachineLacksIsNoBadInput) {
  const TemporaryFolder folder;
  const auto scene = folder.write("scene.json", scene_text());
  const auto mesh = folder.write("mesh.obj", kTriangle);
  (void)folder.write("dpkg/one.list", "/usr/share/mesh.obj\n");
  const NoDescriptors none;
  const std::string reason = ": Too many open files";
  expect_error(ExitCode::resource, scene.string() + ": cannot be read" + reason, [&] { read_scene(scene); });
  expect_error(ExitCode::resource, mesh.string() + reason, [&] { mesh::open_input(mesh); });
  expect_error(ExitCode::resource, (folder / "dpkg").string() + reason,
               [&] { find_package_file("one", "mesh.obj", folder / "dpkg"); });
}

TEST(SceneFiles, MeshBesideTheSceneIsRead) {
  const TemporaryFolder folder;
  (void)folder.write("meshes/a.obj", kTriangle);
  const auto file = folder.write("scene.json", scene_with_file("meshes/../meshes/a.obj"));
  EXPECT_EQ(read_scene(file).soup.triangles.size(), 1u);
}

TEST(SceneFiles, MissingMesh) {
  const TemporaryFolder folder;
  const auto file = folder.write("scene.json", scene_with_file("statue.obj"));
  expect_error(ExitCode::input, file.string() + ": /meshes/0/file: no such file \"statue.obj\"",
               [&] { read_scene(file); });
}

TEST(SceneFiles, DamagedMeshNamesBothFiles) {
  const TemporaryFolder folder;
  (void)folder.write("statue.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
  const auto file = folder.write("scene.json", scene_with_file("statue.ply"));
  const std::string message =
      expect_error(ExitCode::input, file.string() + ": /meshes/0/file: ", [&] { read_scene(file); });
  EXPECT_NE(message.find("statue.ply"), std::string::npos) << message;
}

TEST(SceneFiles, NothingOutsideTheFolder) {
  const TemporaryFolder folder;
  const auto outside = folder.write("outside.obj", kTriangle);
  std::filesystem::create_directory(folder / "scene");
  std::filesystem::create_symlink("../outside.obj", folder / "scene/link.obj");
  std::filesystem::create_directory_symlink("..", folder / "scene/up");
  for (const std::string& name :
       {std::string("../outside.obj"), outside.string(), std::string("link.obj"), std::string("up/outside.obj"),
        std::string("../../none.obj"), std::string("/etc/passwd")}) {
    const auto file = folder.write("scene/scene.json", scene_with_file(name));
    expect_error(ExitCode::input, "/meshes/0/file: \"" + name + "\" leads outside the scene's folder",
                 [&] { read_scene(file); });
  }
  // A folder whose name begins with the scene's folder's name is not inside it.
  (void)folder.write("scene2/a.obj", kTriangle);
  const auto sibling = folder.write("scene/scene.json", scene_with_file("../scene2/a.obj"));
  expect_error(ExitCode::input, "leads outside", [&] { read_scene(sibling); });
  for (const std::string& name : {std::string("../outside.obj"), outside.string(), std::string("link.obj")}) {
    const auto file = folder.write("scene/scene.json", scene_with_file(name));
    EXPECT_EQ(read_scene(file, {.allow_outside = true}).soup.triangles.size(), 1u) << name;
  }
}

TEST(SceneFiles, SceneInTheCurrentFolder) {
  const TemporaryFolder folder;
  (void)folder.write("a.obj", kTriangle);
  (void)folder.write("scene.json", scene_with_file("a.obj"));
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  EXPECT_NO_THROW(read_scene("scene.json"));
  std::filesystem::current_path(before);
}

TEST(SceneFiles, UnusedVerticesAreLeftOutAndSaid) {
  const TemporaryFolder folder;
  (void)folder.write("a.obj", std::string("v 99 99 99\n") + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n");
  const auto scene = read_scene(folder.write("scene.json", scene_with_file("a.obj")));
  for (const glm::dvec3& position : scene.soup.positions) EXPECT_LE(position.x, 1);
}

TEST(PackageFiles, FindsWhatAPackageInstalled) {
  const auto bunny = find_package_file("glmark2-data", "models/bunny.obj");
  EXPECT_TRUE(std::filesystem::exists(bunny)) << bunny;
}

TEST(PackageFiles, SaysHowToInstall) {
  expect_error(ExitCode::input, "install it with: apt-get install no-such-package",
               [] { find_package_file("no-such-package", "a.obj"); });
  const TemporaryFolder folder;
  const auto file =
      folder.write("scene.json", scene_text(R"({"package": {"name": "no-such-package", "file": "a.obj"}})"));
  expect_error(ExitCode::input, "/meshes/0/package: the Debian package \"no-such-package\" is not installed",
               [&] { read_scene(file); });
}

TEST(PackageFiles, NamesThatAreNone) {
  for (const char* name : {"../../etc", "Upper", "a b", "x"}) {
    expect_error(ExitCode::input, "is not the name of a Debian package", [&] { find_package_file(name, "a.obj"); });
  }
}

TEST(PackageFiles, WholePathPartsAndAllArchitectures) {
  const TemporaryFolder info;
  (void)info.write("one.list", "/.\n/usr/share/one/bunny.obj\n/usr/share/one/dark-bunny.obj\n");
  (void)info.write("two:amd64.list", "/usr/share/two/a/m.obj\n/usr/share/two/b/m.obj\n");
  (void)info.write("two-more.list", "/usr/share/two-more/only-here.obj\n");
  EXPECT_EQ(find_package_file("one", "bunny.obj", info.path()), "/usr/share/one/bunny.obj");
  EXPECT_EQ(find_package_file("two", "a/m.obj", info.path()), "/usr/share/two/a/m.obj");
  expect_error(ExitCode::input, "several files that end with \"/m.obj\"",
               [&] { find_package_file("two", "m.obj", info.path()); });
  expect_error(ExitCode::input, "has no file that ends with \"/only-here.obj\"; see: dpkg -L two",
               [&] { find_package_file("two", "only-here.obj", info.path()); });
}

}  // namespace
}  // namespace penumbra::test
