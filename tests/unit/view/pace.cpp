// SPDX-License-Identifier: Apache-2.0
// Tests that the quality of quick pictures follows the time that they take.
#include "app/view/live_pace.hpp"

#include <gtest/gtest.h>

namespace penumbra::app {
namespace {

/// Milliseconds for a picture of 512 × 512 pixels on a machine that takes `nanoseconds` for one light sample of a
/// pixel.
double cost(LiveQuality quality, double nanoseconds) {
  return 512.0 * 512.0 / (quality.divisor * quality.divisor) * (20 + quality.light_samples) * nanoseconds * 1e-6;
}

TEST(LivePace, SettlesWherePicturesAreInTime) {
  for (const double nanoseconds : {0.1, 1.0, 5.0, 20.0, 60.0}) {
    LivePace pace;
    int slow = 0;
    for (int i = 0; i < 400; ++i) {
      const double milliseconds = cost(pace.quality(), nanoseconds);
      slow += milliseconds > kPictureTime ? 1 : 0;
      pace.took(milliseconds);
    }
    EXPECT_LE(slow, 10) << nanoseconds;  // slow pictures occur while it looks for a better level
  }
}

TEST(LivePace, AFastMachineGetsTheBest) {
  LivePace pace;
  for (int i = 0; i < 60; ++i) pace.took(5);
  EXPECT_EQ(pace.quality().divisor, 1U);
  EXPECT_EQ(pace.quality().light_samples, 64U);
}

TEST(LivePace, ASlowMachineStaysAtTheLeast) {
  LivePace pace;
  for (int i = 0; i < 60; ++i) pace.took(5000);
  EXPECT_EQ(pace.quality().divisor, 8U);
}

TEST(LivePace, AVerySlowPictureIsFollowedByTheLowestQuality) {
  LivePace pace;
  EXPECT_FALSE(pace.is_lowest());
  pace.took(2000);
  EXPECT_TRUE(pace.is_lowest());
}

TEST(SlowMethods, AreThoseThatAreSlowAtTheLowestQuality) {
  SlowMethods slow;
  slow.took("a", 2000, false);
  slow.took("b", kPictureTime, true);
  EXPECT_FALSE(slow.contains("a") || slow.contains("b"));
  slow.took("a", kPictureTime + 1, true);
  EXPECT_FALSE(slow.contains("a"));  // the first picture may have been slow because the method prepared something
  slow.took("a", kPictureTime, true);
  slow.took("a", kPictureTime + 1, true);
  EXPECT_FALSE(slow.contains("a"));
  slow.took("a", kPictureTime + 1, true);
  EXPECT_TRUE(slow.contains("a"));
  EXPECT_FALSE(slow.contains("b"));
  slow.took_final("a", 2000);
  EXPECT_TRUE(slow.contains("a"));
  slow.took_final("a", 20);  // the machine was slow, not the method
  EXPECT_FALSE(slow.contains("a"));
}

}  // namespace
}  // namespace penumbra::app
