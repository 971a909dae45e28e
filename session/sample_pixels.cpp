// SPDX-License-Identifier: Apache-2.0
// Chooses the pixels of --sample-pixels: evenly spaced among the judged pixels (docs/definitions.md), or by their
// coordinates.

#include "session/sample_pixels.hpp"

#include "base/error.hpp"
#include "session/parse.hpp"

#include <algorithm>
#include <iterator>

namespace penumbra::session {
namespace {

[[noreturn]] void refuse(const std::string& choice) {
  throw UsageError("--sample-pixels {}: expected all, a number of pixels, or a list such as \"10,20;30,40\"", choice);
}

std::vector<std::uint32_t> parse_list(const std::string& choice, std::uint32_t width, std::uint32_t height) {
  std::vector<std::uint32_t> wanted;
  for (const std::string_view part : split(choice, ';')) {
    const auto coordinates = split(part, ',');
    if (coordinates.size() != 2) refuse(choice);
    const auto x = parse_integer<std::uint32_t>(coordinates[0]);
    const auto y = parse_integer<std::uint32_t>(coordinates[1]);
    if (!x || !y) refuse(choice);
    if (*x >= width || *y >= height) {
      throw UsageError("--sample-pixels {}: pixel {},{} is outside the image of {}x{}", choice, *x, *y, width, height);
    }
    wanted.push_back(*y * width + *x);
  }
  return wanted;
}

}  // namespace

std::vector<std::uint32_t> sample_pixels(const std::vector<std::uint32_t>& pixels, const std::string& choice,
                                         std::uint32_t width, std::uint32_t height) {
  if (choice == "all") return pixels;
  if (choice.find(',') != std::string::npos) {
    std::vector<std::uint32_t> wanted = parse_list(choice, width, height);
    std::ranges::sort(wanted);
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    std::vector<std::uint32_t> chosen;
    std::ranges::set_intersection(pixels, wanted, std::back_inserter(chosen));
    return chosen;
  }
  const auto count = parse_integer<std::uint32_t>(choice);
  if (!count || *count == 0) refuse(choice);
  if (*count >= pixels.size()) return pixels;
  std::vector<std::uint32_t> chosen;
  for (std::uint64_t i = 0; i < *count; ++i) chosen.push_back(pixels[i * pixels.size() / *count]);
  return chosen;
}

}  // namespace penumbra::session
