// SPDX-License-Identifier: Apache-2.0
// Writes masks of visible light samples as a file of packed bits.

#include "visibility/masks/bits_file.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <bit>
#include <type_traits>

namespace penumbra::visibility {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they lie in memory");
static_assert(sizeof(glm::vec3) == 12 && sizeof(glm::dvec3) == 24);

template <typename Value>
void put(std::vector<std::byte>& bytes, const Value& value) {
  static_assert(std::is_trivially_copyable_v<Value>);
  const auto* first = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof(Value));
}

const std::filesystem::path& refuse_sphere(const std::filesystem::path& path, const Light& light) {
  if (is_body(light.kind)) {
    throw UsageError(
        "cannot write \"{}\": light \"{}\" is a {}, whose light samples differ from pixel to pixel; "
        "--bits needs a light of another kind (choose one with --light)",
        path.string(), light.name, name_of(light.kind));
  }
  return path;
}

}  // namespace

BitsWriter::BitsWriter(const std::filesystem::path& path, const glm::dvec3& origin, const ViewSamples& samples,
                       const Light& light)
    : samples_(samples), words_per_mask_(light.words_per_mask()), file_(refuse_sphere(path, light)) {
  PENUMBRA_ASSERT(light.points.size() == light.sample_count(), "{} points for {} samples", light.points.size(),
                  light.sample_count());
  file_.write(fmt::format("penumbra-bits/1 {} {} {}\n", samples.width, samples.height, light.sample_count()));
  std::vector<std::byte> bytes;
  put(bytes, origin);
  for (const glm::vec3& point : light.points) put(bytes, point);
  file_.write(bytes);
}

void BitsWriter::append(std::span<const std::uint32_t> masks) {
  const std::size_t count = masks.size() / words_per_mask_;
  PENUMBRA_ASSERT(masks.size() % words_per_mask_ == 0 && next_pixel_ + count <= samples_.size(),
                  "{} words after pixel {} of {}", masks.size(), next_pixel_, samples_.size());
  constexpr std::size_t kChunk = 4096;  // pixels written by one system call
  std::vector<std::byte> bytes;
  for (std::size_t done = 0; done < count;) {
    bytes.clear();
    for (const std::size_t end = std::min(count, done + kChunk); done < end; ++done, ++next_pixel_) {
      put(bytes, samples_.p[next_pixel_]);
      put(bytes, samples_.triangle[next_pixel_]);
      const auto words = std::as_bytes(masks.subspan(done * words_per_mask_, words_per_mask_));
      bytes.insert(bytes.end(), words.begin(), words.end());
    }
    file_.write(bytes);
  }
}

void BitsWriter::settle() {
  file_.settle();
}

void BitsWriter::commit() {
  PENUMBRA_ASSERT(next_pixel_ == samples_.size(), "masks of {} pixels, but there are {}", next_pixel_, samples_.size());
  file_.commit();
}

}  // namespace penumbra::visibility
