// SPDX-License-Identifier: Apache-2.0
// Tests mesh::repair, which runs run_repair in another process: the answer is the same, and if that process is missing,
// crashes or sends a damaged answer, the error says what went wrong and where.

#include "base/error.hpp"
#include "mesh/repair.hpp"
#include "mesh/shapes/shapes.hpp"
#include "repair/run_repair.hpp"
#include "tests/unit/mesh/import_files.hpp"
#include "tests/unit/mesh/soups.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>

namespace penumbra::repair {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace test = mesh::test;

class RepairHelper : public penumbra::test::FileTest {
 protected:
  void TearDown() override {
    unsetenv("PENUMBRA_REPAIR_HELPER");
    FileTest::TearDown();
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child is left behind";
    EXPECT_EQ(errno, ECHILD);
  }
  void use_helper(const std::string& script) const {
    const auto path = write("helper", "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    setenv("PENUMBRA_REPAIR_HELPER", path.c_str(), 1);
  }
  static std::string refusal() {
    try {
      mesh::repair(test::box(), {});
    } catch (const ResourceError& error) {
      return error.what();
    }
    return "no ResourceError";
  }
};

void expect_same(const mesh::Repaired& a, const mesh::Repaired& b) {
  EXPECT_EQ(a.soup.positions, b.soup.positions);
  EXPECT_EQ(a.soup.triangles, b.soup.triangles);
  EXPECT_EQ(a.soup.object, b.soup.object);
  EXPECT_EQ(a.soup.source_face, b.soup.source_face);
  EXPECT_EQ(a.left, b.left);
  EXPECT_TRUE(std::ranges::equal(a.done, b.done, [](const mesh::RepairStep& x, const mesh::RepairStep& y) {
    return x.what == y.what && x.count == y.count;
  }));
}

TEST_F(RepairHelper, AnswersAsTheWorkInThisProcess) {
  mesh::TriangleSoup holed = test::shattered(mesh::make_torus({}));
  holed.triangles.resize(holed.triangles.size() - 5);
  holed.object.resize(holed.triangles.size());
  holed.source_face.resize(holed.triangles.size());
  holed.positions[0].x += 1e-9;
  for (const mesh::TriangleSoup& soup : {test::box(), holed, mesh::TriangleSoup{}}) {
    for (const mesh::RepairOptions& options :
         {mesh::RepairOptions{}, mesh::RepairOptions{.weld = 0.001},
          mesh::RepairOptions{.weld = 0.001, .fill_holes_up_to = 40, .resolve_self_intersections = true}}) {
      expect_same(mesh::repair(soup, options), run_repair(soup, options));
    }
  }
}

TEST_F(RepairHelper, MissingIsAResourceErrorThatSaysWhere) {
  const std::string nowhere = (folder_ / "nowhere").string();
  setenv("PENUMBRA_REPAIR_HELPER", nowhere.c_str(), 1);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("cannot start the repair helper " + nowhere),
                               HasSubstr("PENUMBRA_WITH_CGAL_GPL=OFF"), HasSubstr("PENUMBRA_REPAIR_HELPER")));
  EXPECT_THROW(mesh::require_repair(), ResourceError);
  unsetenv("PENUMBRA_REPAIR_HELPER");
  EXPECT_NO_THROW(mesh::require_repair());
}

TEST_F(RepairHelper, CrashesAndLiesAreResourceErrors) {
  use_helper("echo 'something broke' >&2; kill -SEGV $$");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("crashed (signal 11)"), HasSubstr("it said: something broke")));
  use_helper("exit 7");
  EXPECT_THAT(refusal(), HasSubstr("gave up (exit code 7)"));
  use_helper("echo hello");
  EXPECT_THAT(refusal(), HasSubstr("is damaged"));
  use_helper(R"(printf 'PNBRIMP1\000\000\377\377\377\377\377\377\377\177')");  // claims 2^63 positions
  EXPECT_THAT(refusal(), HasSubstr("longer than the answer"));
  use_helper(R"(printf 'PNBRIMP1\001\004\000\000\000\000\000\000\000oops')");
  EXPECT_THAT(refusal(), HasSubstr("the repair helper: oops"));
  use_helper(R"(printf 'PNBRIMP1\002')");
  EXPECT_THROW(mesh::repair(test::box(), {}), std::bad_alloc);
}

TEST_F(RepairHelper, NumbersThatCannotBeMeantAreUsageErrors) {
  EXPECT_THROW(mesh::repair(test::box(), {.weld = -1}), UsageError);
}

}  // namespace
}  // namespace penumbra::repair
