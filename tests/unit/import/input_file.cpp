// SPDX-License-Identifier: Apache-2.0
// Tests that only files below a folder are opened, whatever names and links say.
#include "mesh/input_file.hpp"

#include "scenes/formats/package_files.hpp"
#include "tests/unit/mesh/import_files.hpp"

#include <gmock/gmock.h>

#include <fcntl.h>
#include <sys/stat.h>

#include <atomic>
#include <cerrno>
#include <thread>

namespace penumbra::mesh {
namespace {

using ::testing::HasSubstr;

class InputFiles : public test::FileTest {
 protected:
  void SetUp() override {
    test::FileTest::SetUp();
    for (const char* name : {"home", "home/sub", "home/sub/deep"}) std::filesystem::create_directory(folder_ / name);
    write("home/a", "inside");
    write("home/sub/b", "inside");
    write("secret", "outside");
    home_ = Descriptor(::open((folder_ / "home").c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  }
  void link(const std::string& target, const std::string& name) const {
    std::filesystem::create_symlink(target, folder_ / "home" / name);
  }
  [[nodiscard]] OpenedBeneath open(const std::string& name) const {
    return open_beneath(home_.get(), name, O_RDONLY | O_NONBLOCK);
  }
  void expect_path(const std::string& name, const std::string& path) const {
    const OpenedBeneath file = open(name);
    EXPECT_EQ(file.error, 0) << name;
    EXPECT_EQ(file.path, path) << name;
    EXPECT_EQ(read_content(file.descriptor.get(), name), "inside") << name;
  }
  void expect_error(const std::string& name, int error) const {
    const OpenedBeneath file = open(name);
    EXPECT_EQ(file.error, error) << name;
    EXPECT_FALSE(file.descriptor.is_open()) << name;
  }
  Descriptor home_;
};

TEST_F(InputFiles, NamesAndLinksThatStayInside) {
  link("a", "to_a");
  link("../a", "sub/to_a");
  link("sub/../sub", "to_sub");
  link("to_sub/deep/../../to_a", "far");
  expect_path("a", "a");
  expect_path("./sub//../a", "a");
  expect_path("sub/b", "sub/b");
  expect_path("to_a", "a");
  expect_path("sub/to_a", "a");
  expect_path("to_sub/b", "sub/b");
  expect_path("far", "a");
}

TEST_F(InputFiles, NamesAndLinksThatLeadOut) {
  link("../secret", "out");
  link("..", "up");
  link((folder_ / "secret").string(), "absolute");
  link((folder_ / "home/a").string(), "absolute_inside");
  link("sub/../../secret", "detour");
  for (const std::string name : {"../secret", "out", "up/secret", "absolute", "absolute_inside", "detour",
                                 "sub/deep/../../../secret", "../home/a", "/etc/passwd", "..", "../nothing"}) {
    expect_error(name, EXDEV);
  }
}

TEST_F(InputFiles, OtherFailures) {
  link("round", "round");
  link("nothing", "dangling");
  expect_error("nothing", ENOENT);
  expect_error("dangling", ENOENT);
  expect_error("", ENOENT);
  expect_error("round", ELOOP);
  expect_error("a/b", ENOTDIR);
  ASSERT_EQ(::mkfifo((folder_ / "home/pipe").c_str(), 0600), 0);
  for (const char* name : {"sub", "pipe"}) {
    EXPECT_NE(test::input_error([&] { (void)open_input_beneath(home_.get(), name, name); }), "") << name;
  }
}

TEST_F(InputFiles, TheRootHasNoOutside) {
  const Descriptor root(::open("/", O_PATH | O_DIRECTORY | O_CLOEXEC));
  const std::string wanted = (std::filesystem::canonical(folder_) / "home/a").string();
  link(wanted, "absolute");
  for (const std::string& name : {wanted, "/.." + wanted, (folder_ / "home/absolute").string()}) {
    const OpenedBeneath file = open_beneath(root.get(), name, O_RDONLY);
    EXPECT_EQ(file.error, 0) << name;
    EXPECT_EQ("/" + file.path, wanted) << name;
  }
}

/// One name is in turn a file and a link to the outside: the file that is opened is never outside.
TEST_F(InputFiles, NobodyCanExchangeANameMeanwhile) {
  std::atomic<bool> done = false;
  std::thread flipping([&] {
    const auto name = folder_ / "home/flip", file = folder_ / "home/file", out = folder_ / "home/out";
    const auto folder = folder_ / "home/turn";
    while (!done) {
      std::filesystem::remove(file);
      std::filesystem::remove(out);
      write("home/file", "inside");
      std::filesystem::create_symlink("../secret", out);
      std::filesystem::rename(file, name);
      std::filesystem::rename(out, name);
      std::filesystem::remove(folder);
      std::filesystem::create_directory_symlink("..", folder);
      std::filesystem::remove(folder);
      std::filesystem::create_directory(folder);
    }
  });
  int read = 0, refused = 0;
  // The loop takes at least twenty thousand turns, and on a busy machine more until both outcomes have been met.
  for (int i = 0; i < 20000 || ((read == 0 || refused == 0) && i < 20'000'000); ++i) {
    for (const char* name : {"flip", "turn/secret"}) {
      const OpenedBeneath file = open(name);
      if (file.error != 0) {
        ++refused;
        continue;
      }
      ++read;
      EXPECT_NE(read_content(file.descriptor.get(), name), "outside") << name;
    }
  }
  done = true;
  flipping.join();
  EXPECT_GT(refused, 0);
  EXPECT_GT(read, 0);
}

TEST_F(InputFiles, PackagesOpenWhatTheyList) {
  const auto canonical = std::filesystem::canonical(folder_);
  link("../secret", "out");
  link("a", "to_a");
  std::filesystem::create_directory(folder_ / "info");
  std::string list;
  for (const char* name : {"home", "home/a", "home/out", "home/to_a"}) list += (canonical / name).string() + "\n";
  write("info/thing.list", list);
  const auto open_listed = [&](const char* name) { return scenes::open_package_file("thing", name, folder_ / "info"); };
  for (const char* name : {"home/a", "home/to_a"}) {
    EXPECT_EQ(read_content(open_listed(name).content.get(), name), "inside") << name;
  }
  EXPECT_THAT(test::input_error([&] { (void)open_listed("home/out"); }),
              HasSubstr("is no file of the package \"thing\""));
  EXPECT_THAT(test::input_error([&] { (void)open_listed("secret"); }), HasSubstr("no file that ends with"));
  EXPECT_THAT(test::input_error([&] { (void)open_listed("home"); }), HasSubstr("folder"));
}

}  // namespace
}  // namespace penumbra::mesh
