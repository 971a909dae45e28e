#include "import/zip_archive.hpp"

#include "base/error.hpp"

#include <minizip/unzip.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace penumbra::mesh {
namespace {

/// Deflate makes nothing more than 1032 times smaller: an entry that promises more lies, and must not be allocated.
constexpr std::uint64_t kLargestRatio = 1032;

}  // namespace

ZipArchive::ZipArchive(std::string_view content, std::string file)
    : file_(std::move(file)), cursor_(std::make_unique<Cursor>(Cursor{content, 0})) {
  zlib_filefunc64_def functions{};
  functions.opaque = cursor_.get();
  functions.zopen64_file = [](void* opaque, const void*, int) -> void* { return opaque; };
  functions.zread_file = [](void* opaque, void*, void* to, uLong size) -> uLong {
    Cursor& from = *static_cast<Cursor*>(opaque);
    const std::uint64_t left = from.content.size() - std::min<std::uint64_t>(from.at, from.content.size());
    const auto count = static_cast<uLong>(std::min<std::uint64_t>(size, left));
    if (count > 0) std::memcpy(to, from.content.data() + from.at, count);
    from.at += count;
    return count;
  };
  functions.zwrite_file = [](void*, void*, const void*, uLong) -> uLong { return 0; };
  functions.ztell64_file = [](void* opaque, void*) -> ZPOS64_T { return static_cast<Cursor*>(opaque)->at; };
  functions.zseek64_file = [](void* opaque, void*, ZPOS64_T offset, int origin) -> long {
    Cursor& cursor = *static_cast<Cursor*>(opaque);
    const std::uint64_t start = origin == ZLIB_FILEFUNC_SEEK_CUR   ? cursor.at
                                : origin == ZLIB_FILEFUNC_SEEK_END ? cursor.content.size()
                                                                   : 0;
    if (offset > cursor.content.size() - std::min<std::uint64_t>(start, cursor.content.size())) return -1;
    cursor.at = start + offset;
    return 0;
  };
  functions.zclose_file = [](void*, void*) { return 0; };
  functions.zerror_file = [](void*, void*) { return 0; };
  archive_.reset(unzOpen2_64(file_.c_str(), &functions));
  if (!archive_) throw InputError("{}: the zip archive has no list of its entries; it is truncated or damaged", file_);
  std::array<char, 1024> name{};
  for (int status = unzGoToFirstFile(archive_.get()); status == UNZ_OK; status = unzGoToNextFile(archive_.get())) {
    unz_file_info64 info{};
    if (unzGetCurrentFileInfo64(archive_.get(), &info, name.data(), name.size() - 1, nullptr, 0, nullptr, 0) != UNZ_OK)
      throw InputError("{}: the zip archive's list of entries is damaged", file_);
    names_.emplace_back(name.data());
  }
}

void ZipArchive::Close::operator()(void* archive) const {
  unzClose(archive);
}

bool ZipArchive::contains(std::string_view name) const {
  return std::ranges::find(names_, name) != names_.end();
}

std::string ZipArchive::read(std::string_view name) const {
  const auto fail = [&](std::string_view what) { throw InputError("{}: {}: {}", file_, name, what); };
  constexpr int kCaseSensitive = 1;
  if (unzLocateFile(archive_.get(), std::string(name).c_str(), kCaseSensitive) != UNZ_OK) fail("no such entry");
  unz_file_info64 info{};
  if (unzGetCurrentFileInfo64(archive_.get(), &info, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK ||
      unzOpenCurrentFile(archive_.get()) != UNZ_OK) {
    fail("the entry is damaged, encrypted or packed in an unknown way");
  }
  if (info.uncompressed_size / kLargestRatio > cursor_->content.size()) {
    fail(fmt::format("it promises {} bytes from an archive of {}", info.uncompressed_size, cursor_->content.size()));
  }
  std::string content(info.uncompressed_size, '\0');
  std::size_t at = 0;
  while (at < content.size()) {
    const auto wanted = static_cast<unsigned>(std::min<std::size_t>(content.size() - at, std::size_t{1} << 30));
    const int count = unzReadCurrentFile(archive_.get(), content.data() + at, wanted);
    if (count <= 0) fail("it cannot be unpacked; the archive is damaged");
    at += static_cast<std::size_t>(count);
  }
  if (unzCloseCurrentFile(archive_.get()) == UNZ_CRCERROR) fail("its checksum is wrong; the archive is damaged");
  return content;
}

}  // namespace penumbra::mesh
