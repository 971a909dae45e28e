// SPDX-License-Identifier: Apache-2.0
// Tests packets for tev byte by byte against its protocol.
#include "base/error.hpp"
#include "network/tev_client.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace penumbra::network {
namespace {

std::string bytes_of(std::initializer_list<int> values) {
  std::string bytes;
  for (const int value : values) bytes += static_cast<char>(value);
  return bytes;
}

TEST(TevPackets, OnePixel) {
  const float red = 1.0F, v = -2.0F;  // 0x3f800000, 0xc0000000
  const auto packets = tev_packets({"a", 1, 1, {{"R", {&red, 1}}, {"V", {&v, 1}}}});
  ASSERT_EQ(packets.size(), 2U);
  EXPECT_EQ(packets[0], bytes_of({24, 0, 0, 0, 4, 1, 'a', 0, 1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 'R', 0, 'V', 0}));
  EXPECT_EQ(packets[1],
            bytes_of({72, 0, 0,    0,    6, 0, 'a', 0,   2, 0, 0, 0, 'R', 0, 'V', 0,  //
                      0,  0, 0,    0,    0, 0, 0,   0,   1, 0, 0, 0, 1,   0, 0,   0,  // x, y, width, height
                      0,  0, 0,    0,    0, 0, 0,   0,   1, 0, 0, 0, 0,   0, 0,   0,  // offsets of the channels
                      1,  0, 0,    0,    0, 0, 0,   0,   1, 0, 0, 0, 0,   0, 0,   0,  // strides of the channels
                      0,  0, 0x80, 0x3f, 0, 0, 0,   0xc0}));
}

TEST(TevPackets, LargePicturesComeInStripes) {
  const std::uint32_t width = 3000, height = 1000;
  std::vector<float> values(std::size_t{width} * height);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  const auto packets = tev_packets({"large", width, height, {{"V", values}}});
  ASSERT_GT(packets.size(), 2U);
  std::size_t row = 0;
  for (std::size_t i = 1; i < packets.size(); ++i) {
    std::int32_t place[4];  // after length, type, focus, name, count and the channel's name
    std::memcpy(place, packets[i].data() + 4 + 1 + 1 + 6 + 4 + 2, sizeof(place));
    EXPECT_EQ(place[0], 0);
    EXPECT_EQ(place[1], static_cast<std::int32_t>(row));
    float first = -1;
    std::memcpy(&first, packets[i].data() + 4 + 1 + 1 + 6 + 4 + 2 + sizeof(place) + 16, sizeof(first));
    EXPECT_EQ(first, static_cast<float>(row * width));
    row += static_cast<std::size_t>(place[3]);
  }
  EXPECT_EQ(row, height);
}

TEST(TevPackets, Addresses) {
  EXPECT_EQ(split_tev_address("127.0.0.1:14158"), std::pair(std::string("127.0.0.1"), std::string("14158")));
  EXPECT_EQ(split_tev_address("[::1]:80").first, "::1");
  for (const char* wrong : {"", "tev", ":1", "a:", "a:0", "a:65536", "a:1x", "a:123456"})
    EXPECT_THROW(split_tev_address(wrong), UsageError) << wrong;
}

}  // namespace
}  // namespace penumbra::network
