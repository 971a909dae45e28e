#pragma once

#include "base/atomic_file.hpp"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace penumbra {

inline constexpr std::uint32_t kLargestExrSide = 1u << 24;  ///< pixels

/// Writes the values of so many pixels from number `first` on, which need not be in memory. All cores call it.
using ExrValues = std::function<void(std::size_t first, std::span<float> values)>;

/// One channel to write. Of arrays pixel i's value is values[i · stride], so that a component of interleaved data (an
/// array of vec3) needs no copy: {"P.Y", {&p[0].y, 3 · pixels − 1}, 3}.
struct ExrChannel {
  std::string name;
  std::variant<std::span<const float>, std::span<const std::uint32_t>, ExrValues> values;
  std::size_t stride = 1;
  bool half = false;   ///< floats are written as 16 bits, rounded to nearest; beyond ±65504 as that
  bool exact = false;  ///< no lossy compression may touch it, nor the others of its layer
};

/// Compressions, by the names that the file's header uses. DWAA is lossy for channels that it takes for colours by
/// their names (R, G, B and Y of any layer), and as exact as ZIP for all others.
enum class ExrCompression { zip, zips, dwaa, none };

/// What goes into an OpenEXR file. Names of channels are unique; dots make layers ("P.X").
struct ExrImage {
  std::uint32_t width = 0, height = 0;
  std::vector<ExrChannel> channels;
  std::map<std::string, std::string> attributes;  ///< header attributes of type string, by full name ("penumbra.scene")
  std::map<std::string, glm::dvec3> vectors;      ///< header attributes of three doubles ("penumbra.origin")
  /// Header attributes of 4 x 4 floats ("worldToCamera"). OpenEXR's row vectors stand on the left of a matrix whose
  /// rows follow each other in memory; glm's column vectors stand on the right of one whose columns do: the same 16
  /// numbers.
  std::map<std::string, glm::mat4> matrices = {};
  ExrCompression compression = ExrCompression::zip;
};

/// The three components "<layer>.X", ".Y", ".Z" of an array of vectors, which must outlive them.
void add_vector_channels(ExrImage& image, const std::string& layer, std::span<const glm::vec3> vectors);

/// Writes scan lines, whole or not at all. Nothing but the image decides the bytes: no date, no owner. Where DWAA would
/// change a channel that is `exact`, its layer stands in a second part of the file, "exact", with ZIP. A name that
/// OpenEXR cannot hold (empty, over 255 bytes, with a zero byte) is an InputError, a file that cannot be written a
/// ResourceError. Returns how many values were too large for 16 bits.
std::uint64_t write_exr(const std::filesystem::path& path, const ExrImage& image);
/// Appends it to a file that the caller commits.
std::uint64_t write_exr(AtomicFile& file, const ExrImage& image);

/// An OpenEXR file in memory: FLOAT (and HALF) channels as floats, UINT channels as integers; of several parts those of
/// flat images with the first one's data window, each name from the first part that has it.
struct ExrFile {
  std::uint32_t width = 0, height = 0;
  std::vector<std::string> channel_names;  ///< all that are in the file, read or not
  std::map<std::string, std::vector<float>> floats;
  std::map<std::string, std::vector<std::uint32_t>> integers;
  std::map<std::string, std::string> attributes;
  std::map<std::string, glm::dvec3> vectors;
  std::map<std::string, glm::mat4> matrices;
};

struct ExrSelection {
  std::uint32_t largest_side = kLargestExrSide;
  std::vector<std::string> channels;  ///< these alone, where the file has them; none: all
};

/// Is this an OpenEXR file whose header has that string attribute, and whose last lines are there? So one that was cut
/// off, or that something else wrote, can be told. False for what cannot be read.
bool is_whole_exr(const std::filesystem::path& path, const std::string& attribute);

/// Reads a scan-line or tiled image: its data window. Throws InputError for what is none, or has a side of more than
/// `largest_side` pixels, which is found out before anything is decoded. Channels that are not selected take no memory.
ExrFile read_exr(const std::filesystem::path& path, const ExrSelection& selection = {});
/// The same from memory; messages call it `shown`.
ExrFile read_exr(std::span<const std::byte> bytes, const std::string& shown, const ExrSelection& selection = {});

}  // namespace penumbra
