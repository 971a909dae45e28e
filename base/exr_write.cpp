// Lines are packed as OpenEXR's ZIP has them, by libdeflate, which takes half of zlib's time for as many bytes, on all
// cores.
#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/exr.hpp"
#include "base/exr_header.hpp"

#include <fmt/format.h>
#include <libdeflate.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <new>
#include <string_view>
#include <thread>

namespace penumbra {
namespace {

constexpr std::size_t kLines = 16;  // that ZIP packs together
constexpr int kLevel = 3;           // larger ones take longer for less than 0.5 % of the bytes

void check_name(const std::filesystem::path& path, const char* what, const std::string& name) {
  constexpr std::size_t kLongestName = 255;  // of an OpenEXR 2.0 file with long names
  if (name.empty() || name.size() > kLongestName || name.find('\0') != std::string::npos) {
    throw InputError(
        "cannot write \"{}\": an OpenEXR {} has 1 to {} bytes and no zero byte, but \"{}\" has {}; use a shorter name",
        path.string(), what, kLongestName, name.c_str(), name.size());
  }
}

/// 32-bit values of pixels, whatever they mean: in memory, or written when they are needed.
struct Plane {
  const std::byte* first = nullptr;
  std::size_t stride = 0;  ///< bytes
  const ExrValues* values = nullptr;
};

/// Packs lines as OpenEXR's ZIP does: bytes of even places before those of odd ones, each as its difference from the
/// one before, deflated. One for each thread.
class Packer {
 public:
  Packer() : deflate_(libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor) {
    if (!deflate_) throw std::bad_alloc();
  }

  /// `count` lines of `width` pixels from number `first` on, each with all its planes one after the other.
  std::vector<std::uint8_t> packed(std::span<const Plane> planes, std::size_t width, std::size_t first,
                                   std::size_t count) {
    const std::size_t line_bytes = width * 4, bytes = count * planes.size() * line_bytes;
    if (bytes == 0) return {};
    split_.resize(bytes);
    line_.resize(line_bytes + 2);
    line_[0] = line_[1] = 0;  // the two bytes before a line
    std::uint8_t *even = split_.data(), *odd = split_.data() + bytes / 2;
    for (std::size_t y = first; y < first + count; ++y) {
      for (const Plane& plane : planes) {
        gather(plane, y * width, width, line_.data() + 2);
        for (std::size_t i = 0; i < line_bytes / 2; ++i) {
          even[i] = difference(line_[2 * i + 2], line_[2 * i]);
          odd[i] = difference(line_[2 * i + 3], line_[2 * i + 1]);
        }
        even += line_bytes / 2;
        odd += line_bytes / 2;
        std::memcpy(line_.data(), line_.data() + line_bytes, 2);
      }
    }
    // The first byte is itself; the first of an odd place comes after the last of an even one, not after none.
    split_[0] = static_cast<std::uint8_t>(split_[0] - 128);
    split_[bytes / 2] = difference(static_cast<std::uint8_t>(split_[bytes / 2] - 128), line_[0]);

    deflated_.resize(bytes);
    const std::size_t size =
        libdeflate_zlib_compress(deflate_.get(), split_.data(), bytes, deflated_.data(), bytes - 1);
    if (size != 0) return {deflated_.begin(), deflated_.begin() + static_cast<std::ptrdiff_t>(size)};
    // No smaller: as it is, which readers know by its size.
    std::uint8_t* to = deflated_.data();
    for (std::size_t y = first; y < first + count; ++y) {
      for (const Plane& plane : planes) {
        gather(plane, y * width, width, to);
        to += line_bytes;
      }
    }
    return deflated_;
  }

 private:
  static std::uint8_t difference(std::uint8_t now, std::uint8_t before) {
    return static_cast<std::uint8_t>(now - before + 128);
  }
  void gather(const Plane& plane, std::size_t pixel, std::size_t width, std::uint8_t* to) {
    static_assert(std::endian::native == std::endian::little, "OpenEXR's order of bytes");
    if (plane.values != nullptr) {
      values_.resize(width);
      (*plane.values)(pixel, values_);
      std::memcpy(to, values_.data(), 4 * width);
      return;
    }
    const std::byte* from = plane.first + pixel * plane.stride;
    if (plane.stride == 4) {
      std::memcpy(to, from, 4 * width);
      return;
    }
    for (std::size_t x = 0; x < width; ++x) std::memcpy(to + 4 * x, from + x * plane.stride, 4);
  }

  std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> deflate_;
  std::vector<std::uint8_t> split_, line_, deflated_;
  std::vector<float> values_;
};

/// `channel` must outlive it.
Plane plane_of(const ExrChannel& channel, std::size_t pixel_count) {
  return std::visit(
      [&](const auto& values) -> Plane {
        if constexpr (std::is_same_v<decltype(values), const ExrValues&>) {
          return {.values = &values};
        } else {
          PENUMBRA_ASSERT(values.size() > (pixel_count - 1) * channel.stride,
                          "channel {}: {} values for {} pixels with stride {}", channel.name, values.size(),
                          pixel_count, channel.stride);
          return {reinterpret_cast<const std::byte*>(values.data()), channel.stride * sizeof(values[0])};
        }
      },
      channel.values);
}

struct Block {
  std::size_t first_line = 0;
  std::vector<std::uint8_t> bytes;
};

/// Packs blocks of lines on all cores, and writes each when all before it are written. Returns where each begins.
std::vector<std::uint64_t> write_lines(AtomicFile& file, std::span<const Plane> planes, std::size_t width,
                                       std::size_t height) {
  tbb::enumerable_thread_specific<Packer> packers;
  std::vector<std::uint64_t> places;
  std::size_t next = 0;
  const auto begin = [&](tbb::flow_control& control) {
    if (next >= height) control.stop();
    return std::exchange(next, next + kLines);
  };
  const auto pack = [&](std::size_t first) {
    return Block{first, packers.local().packed(planes, width, first, std::min(kLines, height - first))};
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

void write_exr(const std::filesystem::path& path, const ExrImage& image) {
  AtomicFile file(path);  // first, so that a place that cannot be written is told before any work
  write_exr(file, image);
  file.commit();
}

void write_exr(AtomicFile& file, const ExrImage& image) {
  const std::filesystem::path& path = file.path();
  if (image.width == 0 || image.height == 0 || image.width > kLargestExrSide || image.height > kLargestExrSide) {
    throw ResourceError("cannot write \"{}\": {}x{} pixels; an OpenEXR image has 1 to {} a side", path.string(),
                        image.width, image.height, kLargestExrSide);
  }
  for (const auto& attribute : image.attributes) check_name(path, "attribute's name", attribute.first);
  for (const auto& attribute : image.vectors) check_name(path, "attribute's name", attribute.first);
  for (const auto& attribute : image.matrices) check_name(path, "attribute's name", attribute.first);
  // In the file, channels stand in the order of their names' bytes.
  std::map<std::string, Plane> planes;
  std::map<std::string, bool> kinds;
  const std::size_t pixel_count = std::size_t{image.width} * image.height;
  for (const ExrChannel& channel : image.channels) {
    check_name(path, "channel's name", channel.name);
    const bool is_new = planes.emplace(channel.name, plane_of(channel, pixel_count)).second;
    PENUMBRA_ASSERT(is_new, "two channels are called {}", channel.name);
    kinds.emplace(channel.name, !std::holds_alternative<std::span<const std::uint32_t>>(channel.values));
  }
  const std::uint64_t begin = file.size();
  const std::vector<std::byte> header = exr_header(image, kinds);
  file.write(header);
  // A table of where each block of lines begins comes before the first of them, and is filled in afterwards.
  const std::size_t blocks = (image.height + kLines - 1) / kLines;
  file.write(std::vector<std::byte>(8 * blocks));
  std::vector<Plane> in_order;
  for (const auto& [name, plane] : planes) in_order.push_back(plane);
  ExrBytes table;
  for (const std::uint64_t place : write_lines(file, in_order, image.width, image.height)) table.put(place - begin);
  file.write_at(begin + header.size(), table.all());
}

}  // namespace penumbra
