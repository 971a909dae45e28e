// SPDX-License-Identifier: Apache-2.0
// Reads zip archives: the list of entries at the end, and entries packed by deflate or stored (APPNOTE.TXT of PKWARE,
// 4.3 to 4.5). Sizes and offsets of 64 bits are in an entry's extra field wherever the plain field has all bits set,
// which several writers do for small entries, too.

#include "import/zip_archive.hpp"

#include "base/error.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <optional>

namespace penumbra::import {
namespace {

/// Deflate reduces data by a factor of 1032 at most: an entry that claims more is invalid, and must not be allocated.
constexpr std::uint64_t kLargestRatio = 1032;

constexpr std::size_t kLocal = 30, kListed = 46, kEnd = 22, kEnd64 = 56, kLocator64 = 20;  ///< bytes of the records
constexpr std::uint64_t kAllBits = 0xffffffff;

/// Returns the little-endian number of `width` bytes.
std::uint64_t number(std::string_view bytes, std::uint64_t at, std::size_t width) {
  std::uint64_t value = 0;
  for (std::size_t i = width; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

bool has(std::string_view content, std::uint64_t at, std::size_t size, std::string_view signature) {
  return at <= content.size() && size <= content.size() - at && content.substr(at).starts_with(signature);
}

/// Offset and length of the list of entries.
struct List {
  std::uint64_t at = 0, count = 0;
};

std::optional<List> find_list(std::string_view content) {
  // The last record may be followed by a comment of up to 64 KiB.
  const std::size_t end = content.rfind("PK\x05\x06");
  if (end == std::string_view::npos || !has(content, end, kEnd, "PK")) return std::nullopt;
  List list{number(content, end + 16, 4), number(content, end + 10, 2)};
  if (list.at != kAllBits && list.count != 0xffff) return list;
  const std::uint64_t locator = end - kLocator64;
  if (end < kLocator64 || !has(content, locator, kLocator64, "PK\x06\x07")) return list;
  const std::uint64_t end64 = number(content, locator + 8, 8);
  if (!has(content, end64, kEnd64, "PK\x06\x06")) return std::nullopt;
  return List{number(content, end64 + 48, 8), number(content, end64 + 32, 8)};
}

}  // namespace

ZipArchive::ZipArchive(std::string_view content, std::string file) : content_(content), file_(std::move(file)) {
  const auto list = find_list(content_);
  if (!list) throw InputError("{}: the zip archive has no list of entries; it is truncated or damaged", file_);
  std::uint64_t at = list->at;
  for (std::uint64_t i = 0; i < list->count; ++i) {
    const auto damaged = [&] { throw InputError("{}: the zip archive's list of entries is damaged", file_); };
    if (!has(content_, at, kListed, "PK\x01\x02")) damaged();
    Entry entry{number(content_, at + 42, 4),
                number(content_, at + 20, 4),
                number(content_, at + 24, 4),
                static_cast<std::uint32_t>(number(content_, at + 16, 4)),
                static_cast<std::uint32_t>(number(content_, at + 10, 2)),
                (number(content_, at + 8, 2) & 1) != 0};
    const std::uint64_t name = number(content_, at + 28, 2), extra = number(content_, at + 30, 2),
                        comment = number(content_, at + 32, 2);
    if (name + extra + comment > content_.size() - at - kListed) damaged();
    names_.emplace_back(content_.substr(at + kListed, name));
    take_sizes(content_.substr(at + kListed + name, extra), entry);
    entries_.push_back(entry);
    at += kListed + name + extra + comment;
  }
}

void ZipArchive::take_sizes(std::string_view extra, Entry& entry) {
  while (extra.size() >= 4) {
    const std::uint64_t id = number(extra, 0, 2), size = std::min<std::uint64_t>(number(extra, 2, 2), extra.size() - 4);
    std::string_view field = extra.substr(4, size);
    extra.remove_prefix(4 + size);
    if (id != 1) continue;
    for (std::uint64_t* value :
         {&entry.size, &entry.packed, &entry.at}) {  // only the values that did not fit, in this order
      if (*value != kAllBits || field.size() < 8) continue;
      *value = number(field, 0, 8);
      field.remove_prefix(8);
    }
  }
}

bool ZipArchive::contains(std::string_view name) const {
  return std::ranges::find(names_, name) != names_.end();
}

std::string ZipArchive::read(std::string_view name) const {
  const auto fail = [&](std::string_view what) { throw InputError("{}: {}: {}", file_, name, what); };
  const auto found = std::ranges::find(names_, name);
  if (found == names_.end()) fail("no such entry");
  const Entry& entry = entries_[static_cast<std::size_t>(found - names_.begin())];
  if (entry.encrypted) fail("the entry is encrypted");
  constexpr std::uint32_t kStored = 0, kDeflated = 8;
  if (entry.method != kStored && entry.method != kDeflated) {
    fail(fmt::format("the entry is packed by method {}; expected deflate (8) or none (0)", entry.method));
  }
  if (!has(content_, entry.at, kLocal, "PK\x03\x04"))
    fail("there is no entry where the list says; the archive is damaged");
  const std::uint64_t begin =
      entry.at + kLocal + number(content_, entry.at + 26, 2) + number(content_, entry.at + 28, 2);
  if (begin > content_.size() || entry.packed > content_.size() - begin)
    fail("the entry is cut off; the archive is truncated");
  if (entry.size / kLargestRatio > entry.packed) {
    fail(fmt::format("it promises {} bytes from an entry of {}", entry.size, entry.packed));
  }
  const std::string_view packed = content_.substr(begin, entry.packed);
  std::string content = entry.method == kStored ? std::string(packed) : inflated(packed, entry.size);
  if (content.size() != entry.size) fail("it cannot be unpacked; the archive is damaged");
  if (crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size()) != entry.checksum) {
    fail("its checksum is wrong; the archive is damaged");
  }
  return content;
}

/// Inflates `packed`; the result is shorter than `size` on failure.
std::string ZipArchive::inflated(std::string_view packed, std::uint64_t size) {
  std::string content(size, '\0');
  z_stream stream{};
  constexpr int kWithoutHeader = -MAX_WBITS;
  if (inflateInit2(&stream, kWithoutHeader) != Z_OK) throw std::bad_alloc();
  std::uint64_t from = 0, to = 0;
  int state = Z_OK;
  while (state == Z_OK) {  // zlib's counters have 32 bits
    constexpr std::uint64_t kMost = std::uint64_t{1} << 30;
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + from));
    stream.avail_in = static_cast<uInt>(std::min(packed.size() - from, kMost));
    stream.next_out = reinterpret_cast<Bytef*>(content.data() + to);
    stream.avail_out = static_cast<uInt>(std::min(size - to, kMost));
    const uInt in = stream.avail_in, out = stream.avail_out;
    state = inflate(&stream, Z_NO_FLUSH);
    from += in - stream.avail_in;
    to += out - stream.avail_out;
    if (in == stream.avail_in && out == stream.avail_out) break;
  }
  inflateEnd(&stream);
  if (state != Z_STREAM_END) content.clear();
  if (to != size) content.clear();
  return content;
}

}  // namespace penumbra::import
