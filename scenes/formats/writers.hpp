// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/atomic_file.hpp"
#include "scenes/instances.hpp"
#include "scenes/losses.hpp"
#include "scenes/scene.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Shared by the writers of the three formats. Internal to scenes/.
namespace penumbra::scenes {

using Notes = std::vector<std::string>;

/// These write a scene to a file. What the format cannot hold is added to `losses` for objects and lights, to `notes`
/// otherwise.
void write_json(const Scene& scene, const Instances& instances, AtomicFile& file, Losses& losses, Notes& notes);
void write_glb(const Scene& scene, const Instances& instances, AtomicFile& file, Losses& losses, Notes& notes);
void write_obj(const Scene& scene, AtomicFile& file, Losses& losses, Notes& notes);

/// Returns the path that write_scene gives the texture of a light of the scene in `file`: "room.json" →
/// "room-light0.exr".
std::filesystem::path texture_file(const std::filesystem::path& file, std::size_t light);

/// Triangles first … first + count − 1 of the soup belong to `object`.
struct ObjectRange {
  std::uint32_t object = 0;
  std::size_t first = 0, count = 0;
};

/// Returns the objects' runs of triangles, in the soup's order. An object whose triangles are not contiguous has
/// several.
std::vector<ObjectRange> object_ranges(const mesh::TriangleSoup& soup);

/// Calls take_range(range) for each of the soup's runs of triangles and take_instance(instance) for each instance, in
/// the order of their triangles' numbers.
template <typename TakeRange, typename TakeInstance>
void for_each_mesh(const Scene& scene, const Instances& instances, const TakeRange& take_range,
                   const TakeInstance& take_instance) {
  auto next = instances.all.begin();
  for (const ObjectRange& range : object_ranges(scene.soup)) {
    for (; next != instances.all.end() && next->soup_before <= range.first; ++next) take_instance(*next);
    take_range(range);
  }
  for (; next != instances.all.end(); ++next) take_instance(*next);
}

/// Returns whether two objects are the same to a format, except for their names.
inline bool same_surface(const Object& one, const Object& other) {
  return one.color == other.color && one.casts_shadow == other.casts_shadow &&
         one.receives_shadow == other.receives_shadow && one.emits == other.emits && one.lit_by == other.lit_by &&
         one.material == other.material && one.picture == other.picture && one.alpha == other.alpha;
}

/// Appends the shortest digits that read back as the same double, in a form that JSON readers keep as a double
/// ("-0.0").
void append_number(fmt::memory_buffer& text, double value);

/// Collects text and passes it to the file in large pieces, so that a big scene is never in memory twice.
class TextStream {
 public:
  explicit TextStream(AtomicFile& file) : file_(file) {}

  template <typename... Args>
  TextStream& print(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(buffer_), format, std::forward<Args>(args)...);
    if (buffer_.size() > kPiece) flush();
    return *this;
  }
  TextStream& number(double value);
  TextStream& numbers(const glm::dvec3& v, std::string_view separator);
  /// Writes "[x, y, z]".
  TextStream& array(const glm::dvec3& v);
  void flush();

 private:
  static constexpr std::size_t kPiece = std::size_t{1} << 20;
  AtomicFile& file_;
  fmt::memory_buffer buffer_;
};

}  // namespace penumbra::scenes
