#pragma once

#include <cstdint>
#include <filesystem>
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
/// The name with a camera's before the frame's number, or else before the extension: OUT.####.exr → OUT.Shot.####.exr.
/// What does not suit a file's name in it becomes '_'.
std::filesystem::path camera_path(const std::filesystem::path& out, std::string_view camera);

}  // namespace penumbra::app
