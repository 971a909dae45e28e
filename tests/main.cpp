// SPDX-License-Identifier: Apache-2.0
// main of the test executables: GoogleTest's, with the memory settings of the program, because a suite allocates and
// frees maps of the same sizes again and again.

#include "base/memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

int main(int argc, char** argv) {
  penumbra::keep_freed_memory();
  testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
