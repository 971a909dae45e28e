// SPDX-License-Identifier: Apache-2.0
// Decoding of PNG with the file's own values. libpng's simplified interface (png.cpp) obeys gAMA chunks and takes 16
// bits without one as linear light, using a power of 2.2 instead of sRGB's curve; the classic interface returns the
// stored bits. The classic interface reports errors by longjmp, which must not skip destructors: no local of `decode`
// has one.
#include "base/error.hpp"
#include "base/png.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <limits>

namespace penumbra {
namespace {

constexpr std::size_t kChannels = 4;  // red green blue alpha, regardless of the file's channels

/// State of a decoder that outlives a longjmp.
struct Decoder {
  Decoder(std::span<const std::byte> file, std::uint32_t most) : bytes(file), largest_side(most) {}
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  ~Decoder() { png_destroy_read_struct(&png, &info, nullptr); }

  std::span<const std::byte> bytes;  ///< bytes not read yet
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::array<char, 200> message{};
  std::uint32_t width = 0, height = 0, largest_side;
  std::vector<std::uint16_t> values;
  std::vector<png_bytep> rows;
};

void fail(png_structp png, png_const_charp message) {
  auto& decoder = *static_cast<Decoder*>(png_get_error_ptr(png));
  std::strncpy(decoder.message.data(), message, decoder.message.size() - 1);
  png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

void read(png_structp png, png_bytep out, std::size_t count) {
  auto& decoder = *static_cast<Decoder*>(png_get_io_ptr(png));
  if (count > decoder.bytes.size()) png_error(png, "the file ends too early");
  std::memcpy(out, decoder.bytes.data(), count);
  decoder.bytes = decoder.bytes.subspan(count);
}

/// Fills `values`. Returns false on failure: `message` then has the reason, unless the size is the reason.
bool decode(Decoder& decoder) {
  if (setjmp(png_jmpbuf(decoder.png)) != 0) return false;
  png_set_read_fn(decoder.png, &decoder, read);
  png_read_info(decoder.png, decoder.info);
  decoder.width = png_get_image_width(decoder.png, decoder.info);
  decoder.height = png_get_image_height(decoder.png, decoder.info);
  if (std::max(decoder.width, decoder.height) > decoder.largest_side) return false;

  png_set_expand_16(decoder.png);  // v becomes 257 v: the same fraction of the largest value
  png_set_gray_to_rgb(decoder.png);
  png_set_add_alpha(decoder.png, 0xffff, PNG_FILLER_AFTER);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(decoder.png);
  png_set_interlace_handling(decoder.png);
  png_read_update_info(decoder.png, decoder.info);
  if (png_get_rowbytes(decoder.png, decoder.info) != decoder.width * kChannels * sizeof(std::uint16_t)) {
    png_error(decoder.png, "a kind of PNG that libpng does not expand");
  }
  decoder.values.resize(decoder.width * kChannels * decoder.height);
  for (std::uint32_t y = 0; y < decoder.height; ++y) {
    decoder.rows.push_back(reinterpret_cast<png_bytep>(&decoder.values[std::size_t{y} * decoder.width * kChannels]));
  }
  png_read_image(decoder.png, decoder.rows.data());
  png_read_end(decoder.png, nullptr);
  return true;
}

/// Throws InputError for bytes that cannot be decoded, or for a picture larger than the decoder allows.
void decode_or_throw(Decoder& decoder) {
  decoder.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &decoder, fail, ignore);
  if (decoder.png != nullptr) decoder.info = png_create_info_struct(decoder.png);
  if (decoder.info == nullptr) throw ResourceError("libpng does not start; is memory short?");
  if (!decode(decoder)) {
    if (decoder.message[0] != '\0') throw InputError("no readable PNG picture: {}", decoder.message.data());
    throw InputError("{}x{} pixels; at most {} a side", decoder.width, decoder.height, decoder.largest_side);
  }
}

}  // namespace

RgbaImage decode_rgba_png(std::span<const std::byte> bytes, std::uint32_t largest_side) {
  Decoder decoder(bytes, largest_side);
  decode_or_throw(decoder);
  RgbaImage image{decoder.width, decoder.height, {}};
  image.pixels.reserve(std::size_t{image.width} * image.height);
  for (std::size_t i = 0; i < decoder.values.size(); i += kChannels) {
    // A byte v was expanded to 257 v, and is reduced to v again.
    const auto byte = [&](std::size_t channel) {
      return static_cast<std::uint8_t>((decoder.values[i + channel] + 128u) / 257u);
    };
    image.pixels.push_back({byte(0), byte(1), byte(2), byte(3)});
  }
  return image;
}

LinearImage decode_linear_png(std::span<const std::byte> bytes, std::uint32_t largest_side) {
  Decoder decoder(bytes, largest_side);
  decode_or_throw(decoder);
  constexpr double kLargest = std::numeric_limits<std::uint16_t>::max();
  LinearImage image{decoder.width, decoder.height, {}};
  image.pixels.reserve(std::size_t{image.width} * image.height);
  for (std::size_t i = 0; i < decoder.values.size(); i += kChannels) {
    const auto share = [&](std::size_t channel) { return decoder.values[i + channel] / kLargest; };
    const auto linear = [&](std::size_t channel) {
      return static_cast<float>(linear_of_srgb(share(channel)) * share(3));
    };
    image.pixels.emplace_back(linear(0), linear(1), linear(2));
  }
  return image;
}

}  // namespace penumbra
