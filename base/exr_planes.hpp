// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/exr.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Shared by the writers of OpenEXR files. Inside base/ only.
namespace penumbra::exr {

enum class Type : std::uint8_t { uint32, float32, float16 };

/// The values of one channel, either in memory or computed on demand.
class Plane {
 public:
  /// `channel` must outlive this object.
  Plane(const ExrChannel& channel, std::size_t pixel_count);

  [[nodiscard]] Type type() const { return type_; }
  /// Returns the size of one value in the file.
  [[nodiscard]] std::size_t bytes() const { return type_ == Type::float16 ? 2 : 4; }
  /// Clamps values to the range of 16 bits: the lossy compression stores 16 bits, although the channel keeps its type.
  void bound() { bounded_ = true; }
  /// Writes the values of `width` pixels from number `pixel` on in the file's format. `scratch` belongs to the calling
  /// thread. Adds the number of values that were too large to `too_large`.
  void gather(std::size_t pixel, std::size_t width, std::uint8_t* to, std::vector<float>& scratch,
              std::atomic<std::uint64_t>& too_large) const;

 private:
  void gather_words(std::size_t pixel, std::size_t width, std::byte* to, std::vector<float>& scratch) const;

  const std::byte* first_ = nullptr;
  std::size_t stride_ = 0;  // bytes
  const ExrValues* values_ = nullptr;
  Type type_ = Type::float32;
  bool bounded_ = false;
};

/// Throws InputError for a name that OpenEXR cannot hold.
void check_name(const std::filesystem::path& path, const char* what, const std::string& name);

/// Writes the image with DWAA, through OpenEXR's own library.
std::uint64_t write_dwaa(AtomicFile& file, const ExrImage& image);

}  // namespace penumbra::exr
