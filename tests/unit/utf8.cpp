// SPDX-License-Identifier: Apache-2.0
#include "base/utf8.hpp"

#include <gtest/gtest.h>

#include <string>

namespace penumbra {
namespace {

TEST(Utf8, LengthsOfSequences) {
  EXPECT_EQ(utf8_length("a"), 1u);
  EXPECT_EQ(utf8_length("\xC3\xA9"), 2u);
  EXPECT_EQ(utf8_length("\xE2\x82\xAC"), 3u);
  EXPECT_EQ(utf8_length("\xF0\x9F\x92\xA1"), 4u);
  // Alone, cut off, overlong, a surrogate, beyond U+10FFFF.
  for (const char* bad : {"\x80", "\xC3", "\xC3(", "\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF0\x80\x80\x80",
                          "\xF4\x90\x80\x80", "\xF8\x88\x80\x80\x80"})
    EXPECT_EQ(utf8_length(bad), 0u) << bad;
}

TEST(Utf8, BytesOfNamesAreShown) {
  EXPECT_EQ(as_utf8("caf\xC3\xA9\n.obj"), "caf\xC3\xA9\n.obj");
  EXPECT_EQ(as_utf8("caf\xE9.obj"), "caf\\xe9.obj");
  EXPECT_EQ(as_utf8(std::string("\xED\xA0\x80 \xC3")), "\\xed\\xa0\\x80 \\xc3");
  EXPECT_EQ(on_one_line("a\nb\tc\rd\x1b[31m\x7f\xC2\x85\xE9.obj"), "a\\nb\\tc\\rd\\x1b[31m\\x7f\\xc2\\x85\\xe9.obj");
  EXPECT_EQ(on_one_line("\xC2\xA0\xE2\x82\xAC"), "\xC2\xA0\xE2\x82\xAC");
  EXPECT_EQ(on_one_line(""), "");
}

}  // namespace
}  // namespace penumbra
