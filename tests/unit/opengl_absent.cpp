// SPDX-License-Identifier: Apache-2.0
// Tests the errors of a build without OpenGL.

#include "base/error.hpp"
#include "render/opengl/context.hpp"

#include <gmock/gmock.h>

namespace penumbra::render::opengl {
namespace {

TEST(OpenGlAbsent, SaysWhatIsMissing) {
  const std::vector<ContextInfo> list = list_contexts();
  ASSERT_EQ(list.size(), 1U);
  EXPECT_FALSE(list.front().usable());
  EXPECT_THAT(list.front().refusals.front(), testing::HasSubstr("libegl-dev"));
  try {
    const Context context(true);
    ADD_FAILURE() << "a context without OpenGL";
  } catch (const ResourceError& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("no OpenGL"), testing::HasSubstr("libopengl-dev")));
    EXPECT_EQ(error.code(), ExitCode::resource);
  }
}

}  // namespace
}  // namespace penumbra::render::opengl
