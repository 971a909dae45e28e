// SPDX-License-Identifier: Apache-2.0
#include "base/atomic_file.hpp"
#include "tests/unit/scenes/support.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace penumbra::test {
namespace {

/// While this object lives, the disk appears to have room for the given number of bytes only.
class DiskQuota {
 public:
  explicit DiskQuota(const char* bytes) { ::setenv("PENUMBRA_TEST_DISK_QUOTA", bytes, 1); }
  DiskQuota(const DiskQuota&) = delete;
  DiskQuota& operator=(const DiskQuota&) = delete;
  ~DiskQuota() { ::unsetenv("PENUMBRA_TEST_DISK_QUOTA"); }
};

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const TemporaryFolder folder;
  AtomicFile file(folder / "out.txt");
  file.write(std::string_view("half"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out.txt"));
  file.write(std::string_view(" and half"));
  file.commit();
  EXPECT_EQ(read_file(folder / "out.txt"), "half and half");
  EXPECT_EQ(folder.names().size(), 1u);
}

TEST(AtomicFile, WithoutCommitNothingIsLeftAndTheOldFileStays) {
  const TemporaryFolder folder;
  const auto path = folder.write("out.txt", "old");
  {
    AtomicFile file(path);
    file.write(std::string_view("new"));
  }
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(folder.names().size(), 1u);
}

/// While this object lives, files are made as on a file system without nameless files.
class NamedParts {
 public:
  NamedParts() { ::setenv("PENUMBRA_TEST_NAMED_PARTS", "1", 1); }
  NamedParts(const NamedParts&) = delete;
  NamedParts& operator=(const NamedParts&) = delete;
  ~NamedParts() { ::unsetenv("PENUMBRA_TEST_NAMED_PARTS"); }
};

TEST(AtomicFile, HasNoNameUntilItIsWhole) {
  const TemporaryFolder folder;
  const int nameless = ::open(folder.path().c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC,
                              0600);  // some file systems have no nameless files
  if (nameless >= 0) ::close(nameless);
  AtomicFile file(folder / "out.txt");
  file.write(std::string_view("half"));
  EXPECT_EQ(folder.names().empty(), nameless >= 0);
  file.commit();
  EXPECT_EQ(read_file(folder / "out.txt"), "half");
}

TEST(AtomicFile, ReplacesAnOldFileEitherWay) {
  const TemporaryFolder folder;
  const auto path = folder.write("out.txt", "old");
  write_file_atomically(path, std::string_view("new"));
  EXPECT_EQ(read_file(path), "new");
  const NamedParts named;
  write_file_atomically(path, std::string_view("newer"));
  EXPECT_EQ(read_file(path), "newer");
  EXPECT_EQ(folder.names().size(), 1u);
}

/// Runs `body` in a separate process, which ends without any cleaning up.
template <typename Body>
void in_process_that_dies(Body body) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    body();
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
}

TEST(AtomicFile, PartsOfDeadProcessesAreRemovedAndOthersAreNot) {
  const TemporaryFolder folder;
  const NamedParts named;
  in_process_that_dies([&] {
    AtomicFile left(folder / "out.exr");
    left.write(std::string_view("half"));
    ::kill(::getpid(), SIGKILL);
  });
  ASSERT_EQ(folder.names().size(), 1u);
  const std::string orphan = folder.names().front();
  EXPECT_TRUE(orphan.starts_with(".penumbra-") && orphan.ends_with(".part.exr")) << orphan;
  // Temporary files of another machine, or of this one before its last start; and a file that only looks like a
  // temporary one.
  (void)folder.write(".penumbra-00000000-1-0.part.exr", "not ours");
  (void)folder.write(".penumbra-notes.part", "not ours");
  AtomicFile live(folder / "live.exr");
  live.write(std::string_view("at work"));
  EXPECT_EQ(folder.names().size(), 3u);
  in_process_that_dies([&] { write_file_atomically(folder / "other.exr", std::string_view("x")); });
  live.commit();
  EXPECT_EQ(read_file(folder / "live.exr"), "at work");
  EXPECT_EQ(read_file(folder / "other.exr"), "x");
  EXPECT_EQ(folder.names().size(), 4u);
}

TEST(AtomicFile, LongNamesWork) {
  const TemporaryFolder folder;
  const std::string name(255, 'n');
  write_file_atomically(folder / name, std::string_view("x"));
  EXPECT_EQ(read_file(folder / name), "x");
}

TEST(AtomicFile, RefusesWhatIsNoRegularFile) {
  const TemporaryFolder folder;
  const auto write = [](const std::filesystem::path& path) { write_file_atomically(path, std::string_view("x")); };
  expect_error(ExitCode::resource, "it is a folder; only a regular file is ever replaced",
               [&] { write(folder.path()); });
  expect_error(ExitCode::resource, "it names a folder", [&] { write(folder / "sub/"); });
  expect_error(ExitCode::resource, "cannot write \"/dev/null\": it is a device", [&] { write("/dev/null"); });
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  expect_error(ExitCode::resource, "it is a pipe or socket", [&] { write(folder / "pipe"); });
  std::filesystem::create_symlink("nowhere", folder / "dangling");
  expect_error(ExitCode::resource, "a symbolic link that leads nowhere", [&] { write(folder / "dangling"); });
  std::filesystem::create_symlink("/dev/null", folder / "null");
  expect_error(ExitCode::resource, "it is a device", [&] { write(folder / "null"); });
}

TEST(AtomicFile, FollowsALinkToAFile) {
  const TemporaryFolder folder;
  (void)folder.write("target.txt", "old");
  std::filesystem::create_symlink("target.txt", folder / "link.txt");
  write_file_atomically(folder / "link.txt", std::string_view("new"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(read_file(folder / "target.txt"), "new");
}

TEST(AtomicFile, SaysThePathAndTheSystemsReason) {
  const TemporaryFolder folder;
  const auto missing = folder / "no/such/folder/out.txt";
  expect_error(ExitCode::resource, "cannot write \"" + missing.string() + "\": No such file or directory",
               [&] { write_file_atomically(missing, std::string_view("x")); });
  (void)folder.write("file", "x");
  expect_error(ExitCode::resource, "Not a directory",
               [&] { write_file_atomically(folder / "file/out.txt", std::string_view("x")); });
  expect_error(ExitCode::resource, "cannot write \"/proc/penumbra.exr\"",
               [&] { write_file_atomically("/proc/penumbra.exr", std::string_view("x")); });
}

TEST(AtomicFile, DiskFullLeavesNothing) {
  const TemporaryFolder folder;
  const auto path = folder.write("out.txt", "old");
  const DiskQuota quota("10");
  expect_error(ExitCode::resource, "cannot write \"" + path.string() + "\": No space left on device",
               [&] { write_file_atomically(path, std::string_view("eleven byte")); });
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(folder.names().size(), 1u);
  write_file_atomically(path, std::string_view("ten bytes!"));
  EXPECT_EQ(read_file(path), "ten bytes!");
}

}  // namespace
}  // namespace penumbra::test
