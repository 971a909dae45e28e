// SPDX-License-Identifier: Apache-2.0
// JPEG through libjpeg, which reports errors by longjmp. longjmp must not skip destructors: no local of `decode_jpeg`
// and `write_jpeg` has one.
#include "base/jpeg.hpp"

#include "base/error.hpp"

#include <array>
#include <cstdio>  // required by jpeglib.h, which does not include it

#include <jpeglib.h>

#include <jerror.h>

#include <algorithm>
#include <csetjmp>
#include <cstdlib>
#include <utility>
#include <vector>

namespace penumbra {
namespace {

constexpr std::size_t kJpegChannels = 3;

/// State of a decoder that outlives a longjmp.
struct JpegDecoder {
  JpegDecoder() = default;
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;
  ~JpegDecoder() { jpeg_destroy_decompress(&jpeg); }

  jpeg_error_mgr errors{};
  jpeg_decompress_struct jpeg{};
  std::jmp_buf escape{};
  std::array<char, JMSG_LENGTH_MAX> message{};
  std::uint32_t width = 0, height = 0, largest_side = 0;
  std::vector<JSAMPLE> row;
  JSAMPROW rows = nullptr;
  RgbaImage image;
};

void jpeg_failed(j_common_ptr jpeg) {
  auto& decoder = *static_cast<JpegDecoder*>(jpeg->client_data);
  jpeg->err->format_message(jpeg, decoder.message.data());
  std::longjmp(decoder.escape, 1);
}

/// Treats libjpeg's warnings as errors: they mean damaged data, which libjpeg would replace by invented pixels. The
/// exception is unused bytes between two parts of the file, which some cameras write.
void jpeg_warned(j_common_ptr jpeg, int level) {
  if (level < 0 && jpeg->err->msg_code != JWRN_EXTRANEOUS_DATA) jpeg_failed(jpeg);
}

/// Returns the colour of four inks without a colour profile: each ink removes its share of one colour, and black
/// removes its share of all three. Adobe's programs store the missing amount of each ink (libjpeg.txt, "Special color
/// spaces"); a marker shows that one of them wrote the file.
std::array<std::uint8_t, 4> color_of_inks(const JSAMPLE* inks, bool adobe) {
  const auto left = [&](std::size_t ink) { return adobe ? unsigned{inks[ink]} : 255U - inks[ink]; };
  const auto part = [&](std::size_t ink) { return static_cast<std::uint8_t>((left(ink) * left(3) + 127) / 255); };
  return {part(0), part(1), part(2), 255};
}

/// Returns false on failure: `message` then has the reason, unless the size is the reason.
bool decode_jpeg(JpegDecoder& decoder, std::span<const std::byte> bytes) {
  if (setjmp(decoder.escape) != 0) return false;
  jpeg_create_decompress(&decoder.jpeg);
  decoder.jpeg.client_data = &decoder;
  jpeg_mem_src(&decoder.jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&decoder.jpeg, TRUE);
  decoder.width = decoder.jpeg.image_width;
  decoder.height = decoder.jpeg.image_height;
  if (std::max(decoder.width, decoder.height) > decoder.largest_side) return false;
  // libjpeg converts YCCK to CMYK, and neither to RGB.
  const bool inks = decoder.jpeg.jpeg_color_space == JCS_CMYK || decoder.jpeg.jpeg_color_space == JCS_YCCK;
  decoder.jpeg.out_color_space = inks ? JCS_CMYK : JCS_RGB;
  const std::size_t channels = inks ? 4 : kJpegChannels;
  jpeg_start_decompress(&decoder.jpeg);
  decoder.row.resize(channels * decoder.width);
  decoder.image.pixels.reserve(std::size_t{decoder.width} * decoder.height);
  decoder.rows = decoder.row.data();
  while (decoder.jpeg.output_scanline < decoder.jpeg.output_height) {
    jpeg_read_scanlines(&decoder.jpeg, &decoder.rows, 1);
    for (std::size_t x = 0; x < decoder.width; ++x) {
      const JSAMPLE* texel = &decoder.row[channels * x];
      decoder.image.pixels.push_back(inks ? color_of_inks(texel, decoder.jpeg.saw_Adobe_marker != 0)
                                          : std::array<std::uint8_t, 4>{texel[0], texel[1], texel[2], 255});
    }
  }
  jpeg_finish_decompress(&decoder.jpeg);
  return true;
}

/// State of an encoder that outlives a longjmp.
struct JpegEncoder {
  JpegEncoder() = default;
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;
  ~JpegEncoder() {
    jpeg_destroy_compress(&jpeg);
    std::free(bytes);
  }

  jpeg_error_mgr errors{};
  jpeg_compress_struct jpeg{};
  std::jmp_buf escape{};
  std::array<char, JMSG_LENGTH_MAX> message{};
  unsigned char* bytes = nullptr;  // allocated by libjpeg with malloc
  unsigned long size = 0;
};

void jpeg_not_written(j_common_ptr jpeg) {
  auto& encoder = *static_cast<JpegEncoder*>(jpeg->client_data);
  jpeg->err->format_message(jpeg, encoder.message.data());
  std::longjmp(encoder.escape, 1);
}

/// Returns false on failure: `message` then has the reason.
bool write_jpeg(JpegEncoder& encoder, const Image8& image, int quality) {
  if (setjmp(encoder.escape) != 0) return false;
  jpeg_create_compress(&encoder.jpeg);
  encoder.jpeg.client_data = &encoder;
  jpeg_mem_dest(&encoder.jpeg, &encoder.bytes, &encoder.size);
  encoder.jpeg.image_width = image.width;
  encoder.jpeg.image_height = image.height;
  encoder.jpeg.input_components = kJpegChannels;
  encoder.jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&encoder.jpeg);
  jpeg_set_quality(&encoder.jpeg, quality, TRUE);
  encoder.jpeg.comp_info[0].h_samp_factor = 1;  // colour at full resolution, not subsampled by 2 x 2
  encoder.jpeg.comp_info[0].v_samp_factor = 1;
  jpeg_start_compress(&encoder.jpeg, TRUE);
  while (encoder.jpeg.next_scanline < encoder.jpeg.image_height) {
    // libjpeg's interface predates const.
    auto* row = const_cast<JSAMPROW>(image.pixels[std::size_t{encoder.jpeg.next_scanline} * image.width].data());
    jpeg_write_scanlines(&encoder.jpeg, &row, 1);
  }
  jpeg_finish_compress(&encoder.jpeg);
  return true;
}

}  // namespace

std::vector<std::byte> encode_jpeg(const Image8& image, int quality) {
  if (image.pixels.empty()) throw ResourceError("cannot make a JPEG of a picture without pixels");
  JpegEncoder encoder;
  encoder.jpeg.err = jpeg_std_error(&encoder.errors);
  encoder.errors.error_exit = jpeg_not_written;
  encoder.jpeg.client_data = &encoder;
  if (!write_jpeg(encoder, image, quality))
    throw ResourceError("cannot make a JPEG of {}x{} pixels: {}", image.width, image.height, encoder.message.data());
  const auto* const bytes = reinterpret_cast<const std::byte*>(encoder.bytes);
  return {bytes, bytes + encoder.size};
}

bool looks_like_jpeg(std::span<const std::byte> bytes) {
  constexpr std::array kBegin{std::byte{0xff}, std::byte{0xd8}, std::byte{0xff}};
  return bytes.size() >= kBegin.size() && std::equal(kBegin.begin(), kBegin.end(), bytes.begin());
}

RgbaImage decode_rgba_jpeg(std::span<const std::byte> bytes, std::uint32_t largest_side) {
  if (!looks_like_jpeg(bytes)) throw InputError("not a JPEG picture");
  JpegDecoder decoder;
  decoder.largest_side = largest_side;
  decoder.jpeg.err = jpeg_std_error(&decoder.errors);
  decoder.errors.error_exit = jpeg_failed;
  decoder.errors.emit_message = jpeg_warned;
  decoder.jpeg.client_data = &decoder;
  if (!decode_jpeg(decoder, bytes)) {
    if (decoder.message[0] == '\0')
      throw InputError("{}x{} pixels; at most {} a side", decoder.width, decoder.height, largest_side);
    throw InputError("a damaged or unusual JPEG picture: {}", decoder.message.data());
  }
  decoder.image.width = decoder.width;
  decoder.image.height = decoder.height;
  return std::move(decoder.image);
}

}  // namespace penumbra
