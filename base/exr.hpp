// SPDX-License-Identifier: Apache-2.0
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

/// Writes the values of values.size() pixels, starting at pixel number `first`, into `values`. Called from several
/// threads at once.
using ExrValues = std::function<void(std::size_t first, std::span<float> values)>;

/// One channel to write. If the channel is an array, pixel i's value is values[i · stride], so that a component of
/// interleaved data (an array of vec3) needs no copy: {"P.Y", {&p[0].y, 3 · pixels − 1}, 3}.
struct ExrChannel {
  std::string name;
  std::variant<std::span<const float>, std::span<const std::uint32_t>, ExrValues> values;
  std::size_t stride = 1;
  bool half = false;   ///< floats are written as 16 bits, rounded to nearest; beyond ±65504 clamped to that
  bool exact = false;  ///< no lossy compression may change this channel, nor the others of its layer
};

/// Compressions, by the names that the file's header uses. DWAA is lossy for channels that it takes for colours by
/// their names (R, G, B and Y of any layer), and lossless, as ZIP is, for all others.
enum class ExrCompression { zip, zips, dwaa, none };

/// Content of an OpenEXR file. Names of channels are unique; dots make layers ("P.X").
struct ExrImage {
  std::uint32_t width = 0, height = 0;
  std::vector<ExrChannel> channels;
  std::map<std::string, std::string> attributes;  ///< header attributes of type string, by full name ("penumbra.scene")
  std::map<std::string, glm::dvec3> vectors;      ///< header attributes of three doubles ("penumbra.origin")
  /// Header attributes of 4 x 4 floats ("worldToCamera"). OpenEXR multiplies row vectors from the left, and stores the
  /// matrix by rows; glm multiplies column vectors from the right, and stores the matrix by columns: both store the
  /// same 16 numbers.
  std::map<std::string, glm::mat4> matrices = {};
  ExrCompression compression = ExrCompression::zip;
};

/// Adds the three components "<layer>.X", ".Y", ".Z" of an array of vectors. `vectors` must outlive `image`.
void add_vector_channels(ExrImage& image, const std::string& layer, std::span<const glm::vec3> vectors);

/// Writes scan lines, whole or not at all. The bytes depend on the image alone: no date, no owner. Where DWAA would
/// change a channel that is `exact`, its layer is stored in a second part of the file, "exact", with ZIP. Throws
/// InputError for a name that OpenEXR cannot hold (empty, over 255 bytes, with a zero byte), and ResourceError for a
/// file that cannot be written. Returns the number of values that were too large for 16 bits.
std::uint64_t write_exr(const std::filesystem::path& path, const ExrImage& image);
/// Appends the image to `file`, which the caller commits.
std::uint64_t write_exr(AtomicFile& file, const ExrImage& image);

/// An OpenEXR file in memory: FLOAT (and HALF) channels as floats, UINT channels as integers. If a file has several
/// parts, the flat images with the first part's data window are read; a channel name that occurs in several parts is
/// read from the first of them.
struct ExrFile {
  std::uint32_t width = 0, height = 0;
  std::vector<std::string> channel_names;  ///< all channels of the file, read or not
  std::map<std::string, std::vector<float>> floats;
  std::map<std::string, std::vector<std::uint32_t>> integers;
  std::map<std::string, std::string> attributes;
  std::map<std::string, glm::dvec3> vectors;
  std::map<std::string, glm::mat4> matrices;
};

struct ExrSelection {
  std::uint32_t largest_side = kLargestExrSide;
  std::vector<std::string> channels;  ///< channels to read, if the file has them; empty: all
};

/// Returns whether the file is an OpenEXR file whose header has the string attribute `attribute` and whose last lines
/// exist, which recognises truncated files and files of other programs. Returns false for a file that cannot be read.
bool is_whole_exr(const std::filesystem::path& path, const std::string& attribute);

/// Reads the data window of a scan-line or tiled image. Throws InputError for a file that is not such an image, or that
/// has a side of more than `largest_side` pixels, which is checked before anything is decoded. Channels that are not
/// selected take no memory.
ExrFile read_exr(const std::filesystem::path& path, const ExrSelection& selection = {});
/// Reads an image from memory; messages call it `shown`.
ExrFile read_exr(std::span<const std::byte> bytes, const std::string& shown, const ExrSelection& selection = {});

}  // namespace penumbra
