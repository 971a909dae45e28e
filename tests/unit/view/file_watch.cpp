// SPDX-License-Identifier: Apache-2.0
// Tests that a file counts as changed only after it has been the same at two checks.
#include "app/view/file_watch.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace penumbra::app {
namespace {

class FileWatchTest : public testing::Test {
 protected:
  FileWatchTest() : folder_((std::filesystem::temp_directory_path() / "penumbra-watch-XXXXXX").string()) {
    if (mkdtemp(folder_.data()) == nullptr) throw std::runtime_error("no folder");
  }
  ~FileWatchTest() override { std::filesystem::remove_all(folder_); }
  [[nodiscard]] std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(std::filesystem::path(folder_) / name) << text;
    return std::filesystem::path(folder_) / name;
  }
  std::string folder_;
};

TEST_F(FileWatchTest, AChangeIsToldOnceItHasSettled) {
  const auto scene = write("a", "1"), mesh = write("b", "1");
  FileWatch watch({scene, mesh});
  EXPECT_FALSE(watch.changed());
  static_cast<void>(write("b", "12"));
  EXPECT_FALSE(watch.changed());  // perhaps it is still being written
  static_cast<void>(write("b", "123"));
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
  EXPECT_FALSE(watch.changed());
}

TEST_F(FileWatchTest, FilesThatGoAndComeBack) {
  const auto scene = write("a", "1");
  FileWatch watch({scene});
  std::filesystem::remove(scene);
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
  static_cast<void>(write("a", "2"));
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
}

TEST_F(FileWatchTest, MoreFilesFromNowOn) {
  const auto scene = write("a", "1"), mesh = write("b", "1");
  FileWatch watch({scene});
  watch.look_at({scene, mesh});
  EXPECT_FALSE(watch.changed());
  EXPECT_FALSE(watch.changed());
  static_cast<void>(write("b", "12"));
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
}

}  // namespace
}  // namespace penumbra::app
