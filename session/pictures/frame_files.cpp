// SPDX-License-Identifier: Apache-2.0
// Checks whether files of a picture are complete.

#include "session/pictures/frame_files.hpp"

#include "base/exr.hpp"
#include "session/pictures/exposure.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

namespace penumbra::session {
namespace {

enum class State { missing, spoilt, whole };

/// Returns `count` bytes from `offset` on; fewer where the file ends.
std::string read_bytes(const std::filesystem::path& path, std::uint64_t offset, std::size_t count) {
  std::ifstream stream(path, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(offset));
  std::string bytes(count, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  return bytes;
}

/// Returns whether the file's first and last bytes are those of a complete file.
bool has_ends(const std::filesystem::path& path, std::uint64_t size, std::string_view first, std::string_view last) {
  if (size < first.size() + last.size()) return false;
  return read_bytes(path, 0, first.size()) == first && read_bytes(path, size - last.size(), last.size()) == last;
}

/// Checks the format of visibility/masks/bits_file.hpp: all sizes follow from the first line.
bool is_whole_bits(const std::filesystem::path& path, std::uint64_t size) {
  std::istringstream line(read_bytes(path, 0, 64));
  std::string format;
  std::uint64_t width = 0, height = 0, samples = 0;
  line >> format >> width >> height >> samples;
  if (!line || line.get() != '\n' || format != "penumbra-bits/1") return false;
  const auto begin = static_cast<std::uint64_t>(line.tellg()) + 3 * sizeof(double) + samples * 3 * sizeof(float);
  return size == begin + width * height * (3 * sizeof(float) + sizeof(std::int32_t) + (samples + 31) / 32 * 4);
}

State state_of(std::string_view option, const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return State::missing;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error || size == 0) return State::missing;  // an empty file was made by another process, to reserve the name
  using namespace std::string_view_literals;
  const bool whole = option == "-o"      ? is_whole_exr(path, kExposureAttribute)
                     : option == "--png" ? has_ends(path, size, "\x89PNG\r\n\x1a\n"sv, "\0\0\0\0IEND\xae\x42\x60\x82"sv)
                     : option == "--bits" ? is_whole_bits(path, size)
                                          : has_ends(path, size, "{\n", "}\n");
  return whole ? State::whole : State::spoilt;
}

}  // namespace

std::vector<std::pair<const char*, std::filesystem::path>> FrameFiles::all() const {
  std::vector<std::pair<const char*, std::filesystem::path>> files = {
      {"-o", picture}, {"--stats", stats}, {"--png", png}, {"--bits", bits}};
  std::erase_if(files, [](const auto& file) { return file.second.empty(); });
  return files;
}

bool FrameFiles::all_there() const {
  return std::ranges::all_of(all(), [](const auto& file) { return state_of(file.first, file.second) == State::whole; });
}

std::vector<std::filesystem::path> FrameFiles::spoilt() const {
  std::vector<std::filesystem::path> found;
  for (const auto& [option, path] : all()) {
    if (state_of(option, path) == State::spoilt) found.push_back(path);
  }
  return found;
}

}  // namespace penumbra::session
