// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::session {

/// Every `step`-th frame from `first` to `last`.
struct FrameRange {
  std::int64_t first = 0, last = 0, step = 1;
};

/// Parses --fps: frames a second; 24 if not given. Throws UsageError if invalid.
double parse_fps(const std::string& text);

/// Parses --frame: a number, also between frames. Throws UsageError if invalid.
double parse_frame(const std::string& text);

/// Parses "A-B" or "A-BxN", A ≤ B, 1 ≤ N. Throws UsageError, with the expected form, if invalid.
FrameRange parse_frames(std::string_view text);
std::vector<std::int64_t> numbers_of(const FrameRange& range);

/// Returns whether the file's name has a place for a frame's number: "####" (at least as many digits) or "%04d".
bool has_frame_number(const std::filesystem::path& out);
/// Returns the common beginning of the names of all frames, without the separator before the number: OUT.####.exr →
/// OUT. May be empty.
std::string sequence_name(const std::filesystem::path& out);
/// Returns the name with the frame's number in its place, else before its extension: OUT.exr and frame 7 →
/// OUT.0007.exr. Of several such places the last is used.
std::filesystem::path frame_path(const std::filesystem::path& out, std::int64_t frame);
/// Returns the file with the lowest number among the existing ones. Throws InputError if there is none.
std::filesystem::path first_frame_path(const std::filesystem::path& pattern);
/// Returns, for each camera's name, a distinct word for names of files: letters and digits of every script are kept,
/// other ASCII becomes '_', long names are cut, and equal results get a number ("Shot_1", "Shot_1_2").
std::map<std::string, std::string> camera_words(std::span<const std::string> cameras);
/// Returns the name with a camera's word before the frame's number, or else before the extension: OUT.####.exr →
/// OUT.Shot.####.exr.
std::filesystem::path camera_path(const std::filesystem::path& out, std::string_view word);

}  // namespace penumbra::session
