#pragma once

#include "base/exr.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// What the writers of OpenEXR files share. Inside base/ only.
namespace penumbra::exr {

enum class Type : std::uint8_t { uint32, float32, float16 };

/// The values of one channel, whatever they mean: in memory, or made when they are needed.
class Plane {
 public:
  /// `channel` must outlive it.
  Plane(const ExrChannel& channel, std::size_t pixel_count);

  [[nodiscard]] Type type() const { return type_; }
  /// Of one value in the file.
  [[nodiscard]] std::size_t bytes() const { return type_ == Type::float16 ? 2 : 4; }
  /// Values of lossy colours become 16 bits on the way; here they keep their type, but not what those cannot hold.
  void bound() { bounded_ = true; }
  /// Writes the values of `width` pixels from number `pixel` on as the file has them. `scratch` is the calling
  /// thread's. Counts those that were too large.
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

/// Writes the image with DWAA, by OpenEXR's own library.
std::uint64_t write_dwaa(AtomicFile& file, const ExrImage& image);

}  // namespace penumbra::exr
