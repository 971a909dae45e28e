// SPDX-License-Identifier: Apache-2.0
// Radiance pictures (G. Ward, "Real pixels", Graphics Gems II, 1991, and the Radiance file format): a header of lines,
// an empty line, a line with the size, and scan lines of four bytes a pixel, which may be run-length encoded in one of
// two formats.
#include "base/rgbe.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace penumbra {
namespace {

using Pixel = std::array<std::uint8_t, 4>;

/// The bytes that were not read yet.
class Bytes {
 public:
  explicit Bytes(std::span<const std::byte> bytes) : left_(bytes) {}

  std::uint8_t next() {
    if (left_.empty()) throw InputError("the Radiance picture ends in the middle of its scan lines");
    const auto value = std::to_integer<std::uint8_t>(left_.front());
    left_ = left_.subspan(1);
    return value;
  }
  [[nodiscard]] std::span<const std::byte> rest() const { return left_; }
  /// Returns the text up to the next end of line, and skips that.
  std::string_view line() {
    const std::string_view text(reinterpret_cast<const char*>(left_.data()), left_.size());
    const std::size_t end = text.substr(0, kLongestLine).find('\n');
    if (end == std::string_view::npos) throw InputError("the Radiance picture's header does not end");
    left_ = left_.subspan(end + 1);
    return text.substr(0, end > 0 && text[end - 1] == '\r' ? end - 1 : end);
  }

 private:
  static constexpr std::size_t kLongestLine = 65536;
  std::span<const std::byte> left_;
};

template <typename Number>
std::optional<Number> number_of(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

/// "-Y 512 +X 1024": rows run downward, pixels to the right.
struct Size {
  std::uint32_t width = 0, height = 0;
  bool upward = false, leftward = false;
};
Size size_of(std::string_view line, std::uint32_t largest_side) {
  Size size;
  const std::size_t x = line.find('X');
  const bool rows_first = line.size() > 3 && line[1] == 'Y' && x != std::string_view::npos && x >= 5;
  const auto height = rows_first ? number_of<std::uint32_t>(line.substr(2, x - 3)) : std::nullopt;
  const auto width = rows_first ? number_of<std::uint32_t>(line.substr(x + 1)) : std::nullopt;
  if (!height || !width)
    throw InputError("the Radiance picture's size is \"{}\"; expected one such as -Y 512 +X 1024", line.substr(0, 80));
  size = {*width, *height, line[0] == '+', line[x - 1] == '-'};
  if (size.width == 0 || size.height == 0 || std::max(size.width, size.height) > largest_side)
    throw InputError("{}x{} pixels; a picture has from 1 to {} a side", size.width, size.height, largest_side);
  return size;
}

/// Reads a scan line by channels: all reds, then all greens, blues and exponents, each in runs.
void read_planes(Bytes& from, std::span<Pixel> line) {
  for (std::size_t channel = 0; channel < 4; ++channel) {
    for (std::size_t x = 0; x < line.size();) {
      const std::uint8_t code = from.next();
      const bool is_run = code > 128;
      const std::size_t count = is_run ? code - 128U : code;
      if (count == 0 || count > line.size() - x) throw InputError("a run of the Radiance picture leaves its scan line");
      std::uint8_t value = is_run ? from.next() : 0;
      for (std::size_t end = x + count; x < end; ++x) {
        if (!is_run) value = from.next();
        line[x][channel] = value;
      }
    }
  }
}

/// Reads a scan line pixel by pixel. A pixel of mantissas 1, 1, 1 repeats the previous pixel as many times as its
/// exponent says; if a second one follows, its exponent counts 256 times as much.
void read_pixels(Bytes& from, Pixel first, std::span<Pixel> line) {
  std::uint32_t shift = 0;
  Pixel last{};
  for (std::size_t x = 0; x < line.size();) {
    const Pixel pixel = x == 0 && shift == 0 ? first : Pixel{from.next(), from.next(), from.next(), from.next()};
    if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
      const std::uint64_t count = shift < 32 ? std::uint64_t{pixel[3]} << shift : line.size() + 1;
      if (x == 0 || count > line.size() - x) throw InputError("a run of the Radiance picture leaves its scan line");
      std::fill_n(line.begin() + static_cast<std::ptrdiff_t>(x), count, last);
      x += count;
      shift += 8;
    } else {
      line[x++] = last = pixel;
      shift = 0;
    }
  }
}

void read_line(Bytes& from, std::span<Pixel> line) {
  const Pixel first{from.next(), from.next(), from.next(), from.next()};
  const bool in_planes = line.size() >= 8 && line.size() < 32768 && first[0] == 2 && first[1] == 2 && first[2] < 128;
  if (!in_planes) return read_pixels(from, first, line);
  if ((std::size_t{first[2]} << 8U | first[3]) != line.size())
    throw InputError("a scan line of the Radiance picture is {} pixels long, and the picture {} wide",
                     std::size_t{first[2]} << 8U | first[3], line.size());
  read_planes(from, line);
}

}  // namespace

bool is_rgbe(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.starts_with("#?RADIANCE") || text.starts_with("#?RGBE");
}

LinearImage decode_rgbe(std::span<const std::byte> bytes, std::uint32_t largest_side) {
  Bytes from(bytes);
  double exposure = 1;
  for (std::string_view line = from.line(); !line.empty(); line = from.line()) {
    if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
      throw InputError("the Radiance picture says {}; expected FORMAT=32-bit_rle_rgbe", line.substr(0, 80));
    if (!line.starts_with("EXPOSURE=")) continue;
    exposure *= number_of<double>(line.substr(9)).value_or(0);
    if (!(exposure > 0 && std::isfinite(exposure)))
      throw InputError("the Radiance picture says {}; expected a number above 0", line.substr(0, 80));
  }
  const Size size = size_of(from.line(), largest_side);
  LinearImage image{size.width, size.height, {}};
  // A line of 32,767 pixels takes no fewer than 1,040 bytes, a short one four: memory is not allocated for lines that
  // cannot be in the file.
  if (from.rest().size() < size.height * std::max<std::uint64_t>(4, size.width / 32))
    throw InputError("the Radiance picture ends in the middle of its scan lines");
  image.pixels.resize(std::size_t{size.width} * size.height);
  std::vector<Pixel> line(size.width);
  for (std::uint32_t row = 0; row < size.height; ++row) {
    read_line(from, line);
    glm::vec3* const to = &image.pixels[std::size_t{size.upward ? size.height - 1 - row : row} * size.width];
    for (std::uint32_t x = 0; x < size.width; ++x) {
      const auto& [r, g, b, e] = line[x];
      const double unit = e == 0 ? 0 : std::ldexp(1 / exposure, e - 136);
      to[size.leftward ? size.width - 1 - x : x] = glm::vec3(glm::dvec3(r, g, b) * unit);
    }
  }
  return image;
}

}  // namespace penumbra
