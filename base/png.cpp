// SPDX-License-Identifier: Apache-2.0
// PNG through libpng's simplified interface, which reports errors as values. (The classic interface needs setjmp, which
// must not skip destructors.)
#include "base/png.hpp"

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/packed.hpp"

#include <png.h>

namespace penumbra {
namespace {

/// Frees libpng's memory, also when an exception is thrown.
struct PngImage {
  PngImage() { image.version = PNG_IMAGE_VERSION; }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
  ~PngImage() { png_image_free(&image); }
  png_image image{};
};

template <typename Picture>
std::vector<std::byte> encode(const Picture& image, png_uint_32 format, png_uint_32 flags = 0) {
  if (image.pixels.empty()) throw ResourceError("cannot make a PNG of a picture without pixels");
  PngImage png;
  png.image.width = image.width;
  png.image.height = image.height;
  png.image.format = format;
  png.image.flags = flags;
  std::vector<std::byte> bytes(PNG_IMAGE_PNG_SIZE_MAX(png.image));
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&png.image, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr) == 0) {
    throw ResourceError("cannot make a PNG of {}x{} pixels: {}", image.width, image.height, png.image.message);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace

std::vector<std::byte> encode_png(const Image8& image) {
  static_assert(sizeof(Color8) == 3, "rows are handed to libpng as they lie");
  return encode(image, PNG_FORMAT_RGB);
}

std::vector<std::byte> encode_png_fast(const Image8& image) {
  return encode(image, PNG_FORMAT_RGB, PNG_IMAGE_FLAG_FAST);
}

std::vector<std::byte> encode_rgba_png(const RgbaImage& image) {
  static_assert(sizeof(image.pixels[0]) == 4, "rows are handed to libpng as they lie");
  return encode(image, PNG_FORMAT_RGBA);
}

void write_png(const std::filesystem::path& path, const Image8& image) {
  write_file_atomically(path, encode_png(image));
}

std::string png_data_uri(const Image8& image) {
  return "data:image/png;base64," + base64(encode_png(image));
}

}  // namespace penumbra
