// SPDX-License-Identifier: Apache-2.0
// Converts text in UTF-16 or UTF-32 to UTF-8. The byte order mark names the encoding; surrogates that are not a pair
// are refused.

#include "import/unicode.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace penumbra::import {
namespace {

/// Extensions of formats that are always text, or that are text if they begin with a byte order mark.
constexpr std::array<std::string_view, 33> kTextFormats = {
    ".obj", ".off", ".stl", ".ply", ".amf", ".ac",   ".acc",     ".ac3d",    ".ase",  ".ask", ".dae",
    ".x",   ".x3d", ".wrl", ".xgl", ".nff", ".enff", ".lws",     ".irr",     ".dxf",  ".raw", ".irrmesh",
    ".smd", ".vta", ".3d",  ".uc",  ".csm", ".bvh",  ".md5mesh", ".md5anim", ".ogex", ".cob", ".scn"};

struct Encoding {
  std::string_view name;
  std::string_view mark;
  std::size_t width;  ///< bytes of a unit
  bool big_endian;
};

// Longer marks first: that of UTF-32 begins with that of UTF-16.
using namespace std::string_view_literals;
constexpr std::array<Encoding, 4> kEncodings = {{{"UTF-32", "\xFF\xFE\0\0"sv, 4, false},
                                                 {"UTF-32", "\0\0\xFE\xFF"sv, 4, true},
                                                 {"UTF-16", "\xFF\xFE"sv, 2, false},
                                                 {"UTF-16", "\xFE\xFF"sv, 2, true}}};

void append_utf8(std::string& to, std::uint32_t c) {
  const auto add = [&](std::uint32_t byte) { to.push_back(static_cast<char>(byte)); };
  if (c < 0x80) {
    add(c);
  } else if (c < 0x800) {
    add(0xC0 | c >> 6), add(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    add(0xE0 | c >> 12), add(0x80 | (c >> 6 & 0x3F)), add(0x80 | (c & 0x3F));
  } else {
    add(0xF0 | c >> 18), add(0x80 | (c >> 12 & 0x3F)), add(0x80 | (c >> 6 & 0x3F)), add(0x80 | (c & 0x3F));
  }
}

std::string decode(std::string_view content, const Encoding& encoding, const std::string& file) {
  std::string text;
  text.reserve(content.size());
  const auto fail = [&](std::size_t at) {
    throw InputError("{}: its byte order mark says {}, but byte {} does not fit that", file, encoding.name, at);
  };
  const auto unit = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < encoding.width; ++i) {
      const std::size_t from = encoding.big_endian ? i : encoding.width - 1 - i;
      value = value << 8 | static_cast<unsigned char>(content[at + from]);
    }
    return value;
  };
  if (content.size() % encoding.width != 0) fail(content.size());
  for (std::size_t at = encoding.mark.size(); at < content.size(); at += encoding.width) {
    std::uint32_t c = unit(at);
    const bool high = c >= 0xD800 && c < 0xDC00, low = c >= 0xDC00 && c < 0xE000;
    if (low || c > 0x10FFFF) fail(at);
    if (high) {  // the first half of a surrogate pair
      const std::uint32_t next = encoding.width == 2 && at + 2 < content.size() ? unit(at + 2) : 0;
      if (next < 0xDC00 || next >= 0xE000) fail(at);
      c = 0x10000 + ((c - 0xD800) << 10) + (next - 0xDC00);
      at += 2;
    }
    append_utf8(text, c);
  }
  return text;
}

}  // namespace

std::string utf8_content(std::string content, const std::string& extension, const std::string& file) {
  if (std::ranges::find(kTextFormats, extension) == kTextFormats.end()) return content;
  if (content.starts_with("\xEF\xBB\xBF")) {
    content.erase(0, 3);
    return content;
  }
  const auto encoding =
      std::ranges::find_if(kEncodings, [&](const Encoding& e) { return content.starts_with(e.mark); });
  if (encoding != kEncodings.end()) return decode(content, *encoding, file);
  return content;
}

}  // namespace penumbra::import
