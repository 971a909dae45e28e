// SPDX-License-Identifier: Apache-2.0
// Parses frame ranges and forms names of frames' files.

#include "session/pictures/frames.hpp"

#include "base/error.hpp"
#include "session/parse.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>

namespace penumbra::session {
namespace {

constexpr std::int64_t kMostFrames = 100'000;

/// Position of a number in a name: the replaced characters, and the least number of digits.
struct NumberPlace {
  std::size_t at = 0, size = 0;
  int digits = 1;
};

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

std::optional<NumberPlace> number_place(std::string_view name) {
  std::optional<NumberPlace> last;
  for (std::size_t i = 0; i < name.size(); ++i) {
    std::size_t end = i;
    if (name[i] == '#') {
      while (end < name.size() && name[end] == '#') ++end;
      last = NumberPlace{i, end - i, static_cast<int>(end - i)};
      i = end - 1;
    } else if (name[i] == '%') {
      ++end;
      while (end < name.size() && is_digit(name[end])) ++end;
      const auto digits = parse_integer<int>(name.substr(i + 1, end - i - 1));
      if (end < name.size() && name[end] == 'd' && digits.value_or(1) <= 20)
        last = NumberPlace{i, end + 1 - i, digits.value_or(1)};
    }
  }
  return last;
}

}  // namespace

FrameRange parse_frames(std::string_view text) {
  std::string_view frames = text;
  std::optional<std::int64_t> step = 1;
  if (const auto x = text.find('x'); x != std::string_view::npos) {
    step = parse_integer<std::int64_t>(text.substr(x + 1));
    frames = text.substr(0, x);
  }
  const auto dash = frames.find('-', 1);  // from 1: the first frame may be negative
  if (dash != std::string_view::npos && step && *step >= 1) {
    const auto first = parse_integer<std::int64_t>(frames.substr(0, dash));
    const auto last = parse_integer<std::int64_t>(frames.substr(dash + 1));
    constexpr std::int64_t kFar = 1'000'000'000;
    const bool near = first && last && *first >= -kFar && *last <= kFar && *first <= *last;
    if (near && (*last - *first) / *step < kMostFrames) return {*first, *last, *step};
  }
  throw UsageError(
      "--frames {}: expected A-B or A-BxN (every N-th) with A not above B and at most {} frames, such as "
      "1-24 or 1-240x10",
      text, kMostFrames);
}

double parse_frame(const std::string& text) {
  const auto frame = parse_number(text);
  constexpr double kFar = 1e9;
  if (!frame || std::abs(*frame) > kFar)
    throw UsageError("--frame {}: expected a frame's number, such as 12, or 12.5 for the moment halfway to the next",
                     text);
  return *frame + 0.0;  // avoids −0
}

double parse_fps(const std::string& text) {
  if (text.empty()) return 24;
  const auto fps = parse_number(text);
  if (!fps || !(*fps > 0)) throw UsageError("--fps {}: expected a number above 0, such as 24 or 29.97", text);
  return *fps;
}

std::vector<std::int64_t> numbers_of(const FrameRange& range) {
  std::vector<std::int64_t> numbers;
  for (std::int64_t frame = range.first; frame <= range.last; frame += range.step) numbers.push_back(frame);
  return numbers;
}

bool has_frame_number(const std::filesystem::path& out) {
  return number_place(out.filename().string()).has_value();
}

std::string sequence_name(const std::filesystem::path& out) {
  std::string name = out.filename().string();
  const auto place = number_place(name);
  if (!place) return out.stem().string();
  name.erase(place->at);
  return name.erase(name.find_last_not_of("._-") + 1);
}

std::filesystem::path frame_path(const std::filesystem::path& out, std::int64_t frame) {
  std::string name = out.filename().string();
  if (const auto place = number_place(name))
    name.replace(place->at, place->size, fmt::format("{:0{}}", frame, place->digits));
  else
    name = fmt::format("{}.{:04}{}", out.stem().string(), frame, out.extension().string());
  return out.parent_path() / name;
}

std::filesystem::path first_frame_path(const std::filesystem::path& pattern) {
  const std::string name = pattern.filename().string();
  const auto place = number_place(name);
  const std::filesystem::path folder = pattern.has_parent_path() ? pattern.parent_path() : ".";
  std::optional<std::int64_t> least;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string other = entry.path().filename().string();
    if (!place || other.size() < name.size() - place->size) continue;
    const std::string_view digits =
        std::string_view(other).substr(place->at, other.size() - (name.size() - place->size));
    std::int64_t number = 0;
    const auto [end, bad] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (bad != std::errc() || end != digits.data() + digits.size()) continue;
    if (frame_path(pattern, number).filename() == other) least = std::min(least.value_or(number), number);
  }
  if (!least) throw InputError("{}: no file of such a name is there", pattern.string());
  return frame_path(pattern, *least);
}

std::map<std::string, std::string> camera_words(std::span<const std::string> cameras) {
  constexpr std::size_t kLongest = 100;  // bytes: file systems limit a whole name to 255
  std::map<std::string, std::string> words;
  std::set<std::string> taken;
  for (const std::string& camera : cameras) {
    std::string word = camera.substr(0, kLongest);
    // continuation byte of UTF-8
    const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
    if (camera.size() > kLongest && continues(camera[kLongest])) {
      while (continues(word.back())) word.pop_back();
      word.pop_back();
    }
    std::ranges::replace_if(
        word,
        [](unsigned char c) {
          return c < 0x80 && std::isalnum(c) == 0 &&
                 std::string_view("-_.=+").find(static_cast<char>(c)) == std::string_view::npos;
        },
        '_');
    const std::string plain = word;
    for (int number = 2; !taken.insert(word).second; ++number) word = fmt::format("{}_{}", plain, number);
    words.emplace(camera, word);
  }
  return words;
}

std::filesystem::path camera_path(const std::filesystem::path& out, std::string_view word) {
  std::string name = out.filename().string();
  const auto place = number_place(name);
  std::size_t at = place ? place->at : out.stem().string().size();
  if (place && at > 0 && name[at - 1] == '.') --at;
  return out.parent_path() / name.insert(at, "." + std::string(word));
}

}  // namespace penumbra::session
