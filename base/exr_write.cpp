// SPDX-License-Identifier: Apache-2.0
// Writes OpenEXR files. Scan lines are packed as OpenEXR's ZIP on all cores by libdeflate, which takes half of zlib's
// time for the same size. (DWAA: exr_dwaa.cpp.)
#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/exr.hpp"
#include "base/exr_header.hpp"
#include "base/exr_planes.hpp"

#include <fmt/format.h>
#include <libdeflate.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <new>
#include <string_view>
#include <thread>

namespace penumbra {
namespace {

using exr::Plane;

constexpr int kLevel = 3;  // higher levels take longer for less than 0.5 % of the bytes

/// Returns the number of lines of a block of the file.
std::size_t lines_of(ExrCompression compression) {
  return compression == ExrCompression::zip ? 16 : 1;
}

/// Packs lines as OpenEXR's ZIP does: bytes at even places before those at odd places, each as the difference from its
/// predecessor, then deflated. One packer for each thread.
class Packer {
 public:
  /// Adds the number of values that were too large for 16 bits to `too_large`.
  explicit Packer(std::atomic<std::uint64_t>& too_large)
      : too_large_(too_large), deflate_(libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor) {
    if (!deflate_) throw std::bad_alloc();
  }

  /// Packs `count` lines of `width` pixels from line number `first` on, each line with its planes one after the other.
  std::vector<std::uint8_t> packed(std::span<const Plane> planes, std::size_t width, std::size_t first,
                                   std::size_t count) {
    const std::size_t bytes = count * width * bytes_of_pixel(planes);
    if (bytes == 0) return {};
    split_.resize(bytes);
    line_.resize(4 * width + 2);
    line_[0] = line_[1] = 0;  // the two bytes in front of a line
    std::uint8_t *even = split_.data(), *odd = split_.data() + bytes / 2;
    for (std::size_t y = first; y < first + count; ++y) {
      for (const Plane& plane : planes) {
        const std::size_t line_bytes = width * plane.bytes();
        plane.gather(y * width, width, line_.data() + 2, values_, too_large_);
        for (std::size_t i = 0; i < line_bytes / 2; ++i) {
          even[i] = difference(line_[2 * i + 2], line_[2 * i]);
          odd[i] = difference(line_[2 * i + 3], line_[2 * i + 1]);
        }
        even += line_bytes / 2;
        odd += line_bytes / 2;
        std::memcpy(line_.data(), line_.data() + line_bytes, 2);
      }
    }
    // The first byte is stored as it is. The first byte at an odd place follows the last one at an even place, so it is
    // stored as a difference.
    split_[0] = static_cast<std::uint8_t>(split_[0] - 128);
    split_[bytes / 2] = difference(static_cast<std::uint8_t>(split_[bytes / 2] - 128), line_[0]);

    deflated_.resize(bytes);
    const std::size_t size =
        libdeflate_zlib_compress(deflate_.get(), split_.data(), bytes, deflated_.data(), bytes - 1);
    if (size != 0) return {deflated_.begin(), deflated_.begin() + static_cast<std::ptrdiff_t>(size)};
    // If packing does not make the block smaller, the block is stored unpacked, which readers recognise by its size.
    // Values too large were already counted.
    std::atomic<std::uint64_t> again = 0;
    return plain(planes, width, first, count, again);
  }

  /// Returns the lines that packed() would pack, unpacked.
  std::vector<std::uint8_t> plain(std::span<const Plane> planes, std::size_t width, std::size_t first,
                                  std::size_t count) {
    return plain(planes, width, first, count, too_large_);
  }

 private:
  static std::uint8_t difference(std::uint8_t now, std::uint8_t before) {
    return static_cast<std::uint8_t>(now - before + 128);
  }
  static std::size_t bytes_of_pixel(std::span<const Plane> planes) {
    std::size_t bytes = 0;
    for (const Plane& plane : planes) bytes += plane.bytes();
    return bytes;
  }
  std::vector<std::uint8_t> plain(std::span<const Plane> planes, std::size_t width, std::size_t first,
                                  std::size_t count, std::atomic<std::uint64_t>& too_large) {
    std::vector<std::uint8_t> bytes(count * width * bytes_of_pixel(planes));
    std::uint8_t* to = bytes.data();
    for (std::size_t y = first; y < first + count; ++y) {
      for (const Plane& plane : planes) {
        plane.gather(y * width, width, to, values_, too_large);
        to += width * plane.bytes();
      }
    }
    return bytes;
  }

  std::atomic<std::uint64_t>& too_large_;
  std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> deflate_;
  std::vector<std::uint8_t> split_, line_, deflated_;
  std::vector<float> values_;
};

struct Block {
  std::size_t first_line = 0;
  std::vector<std::uint8_t> bytes;
};

/// Packs blocks of lines on all cores, and writes the blocks in order. Returns the offset of each block.
std::vector<std::uint64_t> write_lines(AtomicFile& file, std::span<const Plane> planes, const ExrImage& image,
                                       std::atomic<std::uint64_t>& too_large) {
  tbb::enumerable_thread_specific<Packer> packers([&] { return Packer(too_large); });
  const std::size_t width = image.width, height = image.height, lines = lines_of(image.compression);
  std::vector<std::uint64_t> places;
  std::size_t next = 0;
  const auto begin = [&](tbb::flow_control& control) {
    if (next >= height) control.stop();
    return std::exchange(next, next + lines);
  };
  const auto pack = [&](std::size_t first) {
    Packer& packer = packers.local();
    const std::size_t count = std::min(lines, height - first);
    return Block{first, image.compression == ExrCompression::none ? packer.plain(planes, width, first, count)
                                                                  : packer.packed(planes, width, first, count)};
  };
  const auto write = [&](const Block& block) {
    places.push_back(file.size());
    ExrBytes begins;
    begins.put(static_cast<std::int32_t>(block.first_line));
    begins.put(static_cast<std::int32_t>(block.bytes.size()));
    file.write(begins.all());
    file.write(std::as_bytes(std::span(block.bytes)));
  };
  constexpr auto kInOrder = tbb::filter_mode::serial_in_order;
  tbb::parallel_pipeline(2 * std::size_t{std::max(1u, std::thread::hardware_concurrency())},
                         tbb::make_filter<void, std::size_t>(kInOrder, begin) &
                             tbb::make_filter<std::size_t, Block>(tbb::filter_mode::parallel, pack) &
                             tbb::make_filter<Block, void>(kInOrder, write));
  return places;
}

}  // namespace

void add_vector_channels(ExrImage& image, const std::string& layer, std::span<const glm::vec3> vectors) {
  static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
  if (vectors.empty()) return;
  const float* first = &vectors.front().x;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::span<const float> values(first + axis, 3 * vectors.size() - axis);
    image.channels.push_back({layer + "." + "XYZ"[axis], values, 3});
  }
}

std::uint64_t write_exr(const std::filesystem::path& path, const ExrImage& image) {
  AtomicFile file(path);  // opened first, so that a place that cannot be written is reported before any work
  const std::uint64_t too_large = write_exr(file, image);
  file.commit();
  return too_large;
}

std::uint64_t write_exr(AtomicFile& file, const ExrImage& image) {
  const std::filesystem::path& path = file.path();
  if (image.width == 0 || image.height == 0 || image.width > kLargestExrSide || image.height > kLargestExrSide) {
    throw ResourceError("cannot write \"{}\": {}x{} pixels; an OpenEXR image has 1 to {} a side", path.string(),
                        image.width, image.height, kLargestExrSide);
  }
  for (const auto& attribute : image.attributes) exr::check_name(path, "attribute's name", attribute.first);
  for (const auto& attribute : image.vectors) exr::check_name(path, "attribute's name", attribute.first);
  for (const auto& attribute : image.matrices) exr::check_name(path, "attribute's name", attribute.first);
  if (image.compression == ExrCompression::dwaa) return exr::write_dwaa(file, image);
  // The file stores channels in byte order of their names.
  std::map<std::string, Plane> planes;
  std::map<std::string, exr::Type> types;
  const std::size_t pixel_count = std::size_t{image.width} * image.height;
  for (const ExrChannel& channel : image.channels) {
    exr::check_name(path, "channel's name", channel.name);
    const auto [place, is_new] = planes.emplace(channel.name, Plane(channel, pixel_count));
    PENUMBRA_ASSERT(is_new, "two channels are called {}", channel.name);
    types.emplace(channel.name, place->second.type());
  }
  const std::uint64_t begin = file.size();
  const std::vector<std::byte> header = exr_header(image, types);
  file.write(header);
  // The table of block offsets precedes the first block, and is filled in afterwards.
  const std::size_t lines = lines_of(image.compression);
  const std::size_t blocks = (image.height + lines - 1) / lines;
  file.write(std::vector<std::byte>(8 * blocks));
  std::vector<Plane> in_order;
  for (const auto& [name, plane] : planes) in_order.push_back(plane);
  std::atomic<std::uint64_t> too_large = 0;
  ExrBytes table;
  for (const std::uint64_t place : write_lines(file, in_order, image, too_large)) table.put(place - begin);
  file.write_at(begin + header.size(), table.all());
  return too_large;
}

}  // namespace penumbra
