#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::app {

/// Every `step`-th frame from `first` to `last`.
struct FrameRange {
  std::int64_t first = 0, last = 0, step = 1;
};

/// --fps: frames a second; 24 if nobody asked for any. Throws UsageError.
double parse_fps(const std::string& text);

/// --frame: a number, between frames too. Throws UsageError.
double parse_frame(const std::string& text);

/// "A-B" or "A-BxN", A ≤ B, 1 ≤ N. Throws UsageError that says what would be right.
FrameRange parse_frames(std::string_view text);
std::vector<std::int64_t> numbers_of(const FrameRange& range);

/// Does the file's name say where a frame's number goes: "####" (at least so many digits) or "%04d"?
bool has_frame_number(const std::filesystem::path& out);
/// What the names of all frames begin with, without what parts it from the number: OUT.####.exr → OUT. May be empty.
std::string sequence_name(const std::filesystem::path& out);
/// The name with the frame's number there, else before its extension: OUT.exr and frame 7 → OUT.0007.exr. Of several
/// such places it is the last.
std::filesystem::path frame_path(const std::filesystem::path& out, std::int64_t frame);
/// For each camera's name what stands for it in names of files, each another: letters and digits of every script stay,
/// other ASCII becomes '_', long names are cut, and names that come to the same get a number ("Shot_1", "Shot_1_2").
std::map<std::string, std::string> camera_words(std::span<const std::string> cameras);
/// The name with a camera's word before the frame's number, or else before the extension: OUT.####.exr →
/// OUT.Shot.####.exr.
std::filesystem::path camera_path(const std::filesystem::path& out, std::string_view word);

}  // namespace penumbra::app
