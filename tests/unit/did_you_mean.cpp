// SPDX-License-Identifier: Apache-2.0
// Tests which known name is suggested for a misspelt one.

#include "base/did_you_mean.hpp"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

TEST(DidYouMean, TheNearestNameIfAThirdOfItsLettersDifferAtMost) {
  const std::vector<std::string> names = {"render", "compare", "key"};
  EXPECT_EQ(did_you_mean("rendr", names), "; did you mean render?");      // one letter is missing
  EXPECT_EQ(did_you_mean("comparee", names), "; did you mean compare?");  // one letter too many
  EXPECT_EQ(did_you_mean("remdet", names), "; did you mean render?");     // two of six differ
  EXPECT_EQ(did_you_mean("kay", names), "; did you mean key?");           // one of three differs
  EXPECT_EQ(did_you_mean("remdex", {"rendering"}), "");                   // four of nine differ
  EXPECT_EQ(did_you_mean("ka", names), "");
  EXPECT_EQ(did_you_mean("", names), "");
  EXPECT_EQ(did_you_mean("render", {}), "");
}

TEST(DidYouMean, LettersMayBeLargeOrExchanged) {
  EXPECT_EQ(did_you_mean("panle", {"Floor", "Panel"}), "; did you mean Panel?");
  EXPECT_EQ(did_you_mean("PCSS", {"pcf", "pcss"}), "; did you mean pcss?");
  EXPECT_EQ(did_you_mean("kye", {"key"}), "; did you mean key?");
  EXPECT_EQ(did_you_mean("eyk", {"key"}), "") << "two of three letters differ: no suggestion";
}

TEST(DidYouMean, LastWordsAreNearerThanLetters) {
  const std::vector<std::string> names = {"--sample-seed", "--light-samples", "--pixel-samples", "--samples-of"};
  EXPECT_EQ(did_you_mean("--samples", names), "; did you mean --light-samples?");
  EXPECT_EQ(did_you_mean("--sample-sed", names), "; did you mean --sample-seed?");
  EXPECT_EQ(did_you_mean("--bits", {"--superrabbits"}), "") << "a part of another word is no suggestion";
}

TEST(DidYouMean, OfTwoAsNearTheFirst) {
  EXPECT_EQ(did_you_mean("lights", {"light", "light."}), "; did you mean light?");
}

}  // namespace
}  // namespace penumbra
