// SPDX-License-Identifier: Apache-2.0
// Tests that buffers keep their data, and that impossible sizes are refused before they reach the device.

#include "tests/agreement/support.hpp"

#include "render/buffer.hpp"

#include <numeric>

namespace penumbra::render {
namespace {

using BufferTest = tests::DeviceTest;

std::vector<std::uint32_t> numbers(std::size_t count, std::uint32_t first) {
  std::vector<std::uint32_t> values(count);
  std::iota(values.begin(), values.end(), first);
  return values;
}

TEST_F(BufferTest, KeepsWhatIsWritten) {
  for (const BufferUse use : {BufferUse::storage, BufferUse::texels}) {
    for (const std::size_t count : {4U, 1024U, 1000000U}) {
      const std::vector<std::uint32_t> values = numbers(count, 7);
      Buffer buffer(device(), "numbers", count * 4, use);
      EXPECT_EQ(buffer.bytes(), count * 4);
      EXPECT_EQ(buffer.name(), "numbers");
      buffer.write(std::span<const std::uint32_t>(values));
      std::vector<std::uint32_t> back(count);
      buffer.read(std::span(back));
      EXPECT_EQ(back, values);
    }
  }
}

TEST_F(BufferTest, WritesAndReadsAtOffsets) {
  std::vector<std::uint32_t> values = numbers(100, 0);
  Buffer buffer = make_buffer<std::uint32_t>(device(), "numbers", values);
  const std::vector<std::uint32_t> patch{900, 901, 902};
  buffer.write(std::span<const std::uint32_t>(patch), 50 * sizeof(std::uint32_t));
  std::copy(patch.begin(), patch.end(), values.begin() + 50);
  std::vector<std::uint32_t> back(60);
  buffer.read(std::span(back), 40 * sizeof(std::uint32_t));
  EXPECT_TRUE(std::equal(back.begin(), back.end(), values.begin() + 40));
}

TEST_F(BufferTest, MovesAndGrows) {
  auto buffer = std::make_unique<Buffer>(make_buffer<std::uint32_t>(device(), "numbers", numbers(8, 1)));
  Buffer moved = std::move(*buffer);
  std::vector<std::uint32_t> back(8);
  moved.read(std::span(back));
  EXPECT_EQ(back, numbers(8, 1));
  buffer.reset();
  EXPECT_TRUE(grow(device(), buffer, "growing", 64));
  EXPECT_FALSE(grow(device(), buffer, "growing", 64));
  EXPECT_FALSE(grow(device(), buffer, "growing", 10));
  EXPECT_TRUE(grow(device(), buffer, "growing", 100000));
  EXPECT_GE(buffer->bytes(), 100000U);
  EXPECT_EQ(make_buffer<std::uint32_t>(device(), "empty", {}).bytes(), 4U);
}

TEST_F(BufferTest, CountsItsMemory) {
  const std::uint64_t before = device().allocated_bytes();
  {
    const Buffer buffer(device(), "a megabyte", 1U << 20U);
    EXPECT_GE(device().allocated_bytes(), before + (1U << 20U));
  }
  EXPECT_EQ(device().allocated_bytes(), before);
  EXPECT_GE(device().peak_bytes(), before + (1U << 20U));
}

TEST_F(BufferTest, TooLargeIsAnErrorThatNamesIt) {
  const std::uint64_t before = device().allocated_bytes();
  for (const std::uint64_t bytes :
       {device().limits().max_storage_buffer_range + 4, std::uint64_t{1} << 50U, ~std::uint64_t{0}}) {
    try {
      const Buffer buffer(device(), "far too large", bytes);
      ADD_FAILURE() << bytes << " bytes were given";
    } catch (const ResourceError& error) {
      EXPECT_NE(std::string(error.what()).find("far too large"), std::string::npos) << error.what();
    }
  }
  const std::uint64_t texels = std::uint64_t{device().limits().max_texel_buffer_elements} + 1;
  if (texels * 16 <= device().limits().max_storage_buffer_range) {
    EXPECT_THROW(Buffer(device(), "too many texels", texels * 16, BufferUse::texels), ResourceError);
  }
  EXPECT_EQ(device().allocated_bytes(), before);
}

}  // namespace
}  // namespace penumbra::render
