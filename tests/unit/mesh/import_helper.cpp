// SPDX-License-Identifier: Apache-2.0
// Tests what the program does when the import helper crashes, hangs, floods its streams or lies. The helpers here are
// shell scripts that do so on purpose.
#include "mesh/import_helper.hpp"

#include "tests/unit/mesh/import_files.hpp"
#include "mesh/import_wire.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>

namespace penumbra::mesh {
namespace {

using ::testing::HasSubstr;

class ImportHelper : public test::FileTest {
 protected:
  void TearDown() override {
    unsetenv("PENUMBRA_IMPORT_HELPER");
    test::FileTest::TearDown();
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child is left behind";
    EXPECT_EQ(errno, ECHILD);
  }
  void use_helper(const std::string& script) const {
    const auto path = write("helper", "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    setenv("PENUMBRA_IMPORT_HELPER", path.c_str(), 1);
  }
  [[nodiscard]] std::string refusal(const ImportLimits& limits = {}) const {
    const auto file = write("mesh.obj", "v 0 0 0\n");
    return test::input_error([&] { import_mesh(file, limits); });
  }
  static std::size_t open_files() {
    const std::filesystem::directory_iterator all("/proc/self/fd");
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }
};

TEST_F(ImportHelper, CrashCostsAMessage) {
  use_helper("echo 'something broke' >&2; kill -SEGV $$");
  EXPECT_THAT(refusal(), HasSubstr("the importer crashed on it (signal 11), which is the importer's fault"));
  EXPECT_THAT(refusal(), HasSubstr("it said: something broke"));
  use_helper("exit 7");
  EXPECT_THAT(refusal(), HasSubstr("exit code 7"));
}

TEST_F(ImportHelper, HangIsEnded) {
  ImportLimits limits;
  limits.time = std::chrono::milliseconds(300);
  const auto start = std::chrono::steady_clock::now();
  use_helper("exec sleep 60");
  EXPECT_THAT(refusal(limits), HasSubstr("took longer than 0.3 s"));
  use_helper("exec sleep 60 >&- 2>&-");  // closes its streams, and then hangs
  EXPECT_THAT(refusal(limits), HasSubstr("took longer than 0.3 s"));
  use_helper("exec >&- 2>&-; while :; do :; done");
  EXPECT_THAT(refusal(limits), HasSubstr("took longer than 0.3 s"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST_F(ImportHelper, FloodIsCutOff) {
  ImportLimits limits;
  limits.output_bytes = 1 << 20;
  use_helper("exec yes");
  EXPECT_THAT(refusal(limits), HasSubstr("more than 1 MiB"));
  use_helper("yes | head -c 100000000 >&2; exit 9");  // much output on stderr is no reason for an error, but is not
                                                      // kept either
  EXPECT_LT(refusal(limits).size(), 8000u);
}

TEST_F(ImportHelper, LiesAreFoundOut) {
  use_helper("echo hello");
  EXPECT_THAT(refusal(), HasSubstr("answer is damaged"));
  use_helper("printf PNBRIMP1");
  EXPECT_THAT(refusal(), HasSubstr("ends too early"));
  use_helper(R"(printf 'PNBRIMP1\011')");
  EXPECT_THAT(refusal(), HasSubstr("status is unknown"));
  use_helper(R"(printf 'PNBRIMP1\002')");
  EXPECT_THAT(refusal(), HasSubstr("needs more than 4 GiB of memory"));
  use_helper(R"(printf 'PNBRIMP1\000\377\377\377\377\377\377\377\177')");  // claims that 2^63 files were opened
  EXPECT_THAT(refusal(), HasSubstr("longer than the answer"));
  // Claims no files, and 2^63 positions, in double and in single precision.
  for (const char* precision : {"000", "001"}) {
    use_helper(std::string(R"(printf 'PNBRIMP1\000\000\000\000\000\000\000\000\000\)") + precision +
               R"(\377\377\377\377\377\377\377\177')");
    EXPECT_THAT(refusal(), HasSubstr("longer than the answer"));
  }
  use_helper(R"(printf 'PNBRIMP1\001\004\000\000\000\000\000\000\000a\033[m')");  // contains an escape sequence that
                                                                                  // would control the terminal
  EXPECT_EQ(refusal(), "a\\x1b[m");
}

TEST_F(ImportHelper, AnswersAreChecked) {
  ImportedMesh mesh;
  mesh.soup.positions.assign(3, glm::dvec3(0));
  mesh.soup.triangles = {{0, 1, 2}};
  mesh.soup.object = {0};
  mesh.soup.source_face = {0};
  const auto read_back = [](const ImportedMesh& sent) {
    WireWriter to;
    put_mesh(to, sent);
    const std::vector<std::byte> bytes = to.bytes();
    WireReader from(bytes);
    return get_mesh(from);
  };
  EXPECT_EQ(read_back(mesh).soup.triangles, mesh.soup.triangles);
  ImportedMesh bad = mesh;
  bad.soup.triangles[0][2] = 3;
  EXPECT_THROW(read_back(bad), WireError);
  bad = mesh;
  bad.soup.positions[1].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(read_back(bad), WireError);
  bad = mesh;
  bad.soup.object.clear();
  EXPECT_THROW(read_back(bad), WireError);
  // Runs of numbers that are more or fewer than the triangles, or whose sum wraps around.
  for (const std::uint32_t count : {0U, 1U, 2U, 0xffffffffU}) {
    WireWriter to;
    to.put<std::uint8_t>(0), to.put_array(std::span<const glm::dvec3>(mesh.soup.positions));
    to.put_array(std::span<const Triangle>(mesh.soup.triangles));
    const std::vector<NumberRun> runs = {{7, 0}, {8, count}};
    for (int list = 0; list < 2; ++list) to.put<std::uint8_t>(1), to.put_array(std::span<const NumberRun>(runs));
    const std::vector<std::byte> bytes = to.bytes();
    WireReader from(bytes);
    if (count == 1) {
      EXPECT_EQ(get_soup(from).object, std::vector<std::uint32_t>{8});
    } else {
      EXPECT_THROW(get_soup(from), WireError);
    }
  }
  EXPECT_EQ(printable("a\tb\x7f\xc3\xa4\xff\xc2\x9b\xed\xa0\x80"), "a\\tb\\x7f\xc3\xa4\\xff\\xc2\\x9b\\xed\\xa0\\x80");
}

TEST_F(ImportHelper, SoupsArriveAsTheyWereSent) {
  for (int kind = 0; kind < 8; ++kind) {
    TriangleSoup soup;
    for (std::uint32_t i = 0; i < 3000; ++i) {
      soup.positions.emplace_back(i, -0.0,
                                  (kind & 1) != 0 && i == 2999 ? 0.1 : 0.5);  // 0.1 is not exact in single precision
      soup.triangles.push_back({i, (i * 7) % 3000, 2999 - i});
      soup.object.push_back((kind & 2) != 0 ? i * 2654435761U : i / 1000);
      soup.source_face.push_back((kind & 4) != 0 ? i / 2 : i < 10 ? i : 0xfffffff0U + i);  // counts past 2^32
    }
    WireWriter to;
    put_soup(to, soup);
    const std::vector<std::byte> bytes = to.bytes();
    WireReader from(bytes);
    const TriangleSoup got = get_soup(from);
    from.expect_end();
    EXPECT_EQ(got.positions, soup.positions);
    EXPECT_TRUE(std::ranges::all_of(got.positions, [](const glm::dvec3& p) { return std::signbit(p.y); }));
    EXPECT_EQ(got.triangles, soup.triangles);
    EXPECT_EQ(got.object, soup.object);
    EXPECT_EQ(got.source_face, soup.source_face);
    if (kind == 0) {
      EXPECT_LT(bytes.size(), 3000 * (sizeof(glm::vec3) + sizeof(Triangle)) + 200);
    }
  }
}

TEST_F(ImportHelper, MissingHelperIsAResourceError) {
  setenv("PENUMBRA_IMPORT_HELPER", (folder_ / "nowhere").c_str(), 1);
  const auto file = write("mesh.obj", "v 0 0 0\n");
  EXPECT_THROW(import_mesh(file), ResourceError);
}

TEST_F(ImportHelper, LeaksNoDescriptors) {
  const auto good = write("good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  import_mesh(good);
  const std::size_t before = open_files();
  for (int i = 0; i < 5; ++i) import_mesh(good);
  use_helper("kill -ABRT $$");
  for (int i = 0; i < 5; ++i) EXPECT_THAT(refusal(), HasSubstr("signal 6"));
  setenv("PENUMBRA_IMPORT_HELPER", (folder_ / "nowhere").c_str(), 1);
  for (int i = 0; i < 5; ++i) EXPECT_THROW(import_mesh(good), ResourceError);
  EXPECT_EQ(open_files(), before);
}

TEST_F(ImportHelper, WorksWithoutStandardStreams) {
  // A daemon's standard streams may be closed; then the pipes get the numbers 0 to 2.
  const auto good = write("good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EXIT(
      {
        for (const int fd : {0, 1, 2}) close(fd);
        _exit(import_mesh(good).soup.triangles.size() == 1 ? 42 : 1);
      },
      ::testing::ExitedWithCode(42), "");
}

}  // namespace
}  // namespace penumbra::mesh
