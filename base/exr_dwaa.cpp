// SPDX-License-Identifier: Apache-2.0
// Writing of DWAA files by OpenEXR's own library. The library takes channels for colours by the part after the last dot
// of their names (R, G, B, Y, BY, RY: blocks of 8 x 8 in a cosine transform, as 16-bit floats) and keeps all others
// exact: "P.Y" would be treated as a luminance, and the numbers of Cryptomatte as colours. Layers with such exact
// channels are stored in a second part of the file, with ZIP.
#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/exr_planes.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>

#include <algorithm>
#include <exception>
#include <map>
#include <new>
#include <set>
#include <string_view>
#include <vector>

namespace penumbra::exr {
namespace {

class Output : public Imf::OStream {
 public:
  explicit Output(AtomicFile& file) : OStream(file.path().c_str()), file_(file), begin_(file.size()) {}
  void write(const char* bytes, int count) override {
    const auto size = static_cast<std::size_t>(count);
    try {
      file_.write_at(begin_ + place_, {reinterpret_cast<const std::byte*>(bytes), size});
    } catch (...) {
      thrown_ = std::current_exception();  // kept as it is: the library would throw another exception in its place
      throw;
    }
    place_ += size;
  }
  std::uint64_t tellp() override { return place_; }
  void seekp(std::uint64_t place) override { place_ = place; }
  /// Returns the exception that a write threw; null if none did.
  [[nodiscard]] const std::exception_ptr& thrown() const { return thrown_; }

 private:
  AtomicFile& file_;
  std::uint64_t begin_ = 0, place_ = 0;
  std::exception_ptr thrown_;
};

/// Returns the part before the last dot.
std::string layer_of(const std::string& channel) {
  return channel.substr(0, std::min(channel.rfind('.'), channel.size()));
}

bool is_lossy(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  const std::string_view letters = std::string_view(channel).substr(dot == std::string::npos ? 0 : dot + 1);
  constexpr std::string_view kLossy[] = {"R", "G", "B", "Y", "BY", "RY"};
  return std::ranges::find(kLossy, letters) != std::end(kLossy);
}

Imf::PixelType code_of(Type type) {
  return type == Type::uint32 ? Imf::UINT : type == Type::float16 ? Imf::HALF : Imf::FLOAT;
}

/// Planes by name, in byte order of their names, as files store them.
using Planes = std::map<std::string, Plane>;

/// A part of the file that is being written in bands of lines.
class Part {
 public:
  Part(Planes planes, std::size_t width) : planes_(std::move(planes)), width_(width) {}

  [[nodiscard]] Imf::Header header(const ExrImage& image, Imf::Compression compression) const {
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = compression;
    for (const auto& [name, plane] : planes_) header.channels().insert(name, Imf::Channel(code_of(plane.type())));
    for (const auto& [name, value] : image.attributes) header.insert(name, Imf::StringAttribute(value));
    for (const auto& [name, v] : image.vectors) header.insert(name, Imf::V3dAttribute(Imath::V3d(v.x, v.y, v.z)));
    for (const auto& [name, value] : image.matrices) {
      Imath::M44f matrix;
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) matrix[i][j] = value[i][j];
      }
      header.insert(name, Imf::M44fAttribute(matrix));
    }
    return header;
  }

  /// Writes this part to an OutputFile or an OutputPart.
  template <typename File>
  void write(File& file, std::size_t height, std::atomic<std::uint64_t>& too_large) const {
    constexpr std::size_t kBand = 32;  // lines that DWAA packs together
    std::vector<std::vector<std::uint8_t>> lines(planes_.size());
    std::vector<float> scratch;
    for (std::size_t first = 0; first < height; first += kBand) {
      const std::size_t count = std::min(kBand, height - first);
      Imf::FrameBuffer buffer;
      auto band = lines.begin();
      for (const auto& [name, plane] : planes_) {
        const std::size_t line_bytes = width_ * plane.bytes();
        band->resize(count * line_bytes);
        for (std::size_t y = 0; y < count; ++y)
          plane.gather((first + y) * width_, width_, band->data() + y * line_bytes, scratch, too_large);
        const Imath::Box2i window({0, static_cast<int>(first)},
                                  {static_cast<int>(width_) - 1, static_cast<int>(first + count) - 1});
        buffer.insert(name, Imf::Slice::Make(code_of(plane.type()), band->data(), window));
        ++band;
      }
      file.setFrameBuffer(buffer);
      file.writePixels(static_cast<int>(count));
    }
  }

 private:
  Planes planes_;
  std::size_t width_;
};

}  // namespace

std::uint64_t write_dwaa(AtomicFile& file, const ExrImage& image) {
  const std::filesystem::path& path = file.path();
  for (const auto& [name, value] : image.attributes) check_name(path, "attribute's name", name);
  const std::size_t pixel_count = std::size_t{image.width} * image.height;
  std::set<std::string> apart;  // layers of the second part
  for (const ExrChannel& channel : image.channels) {
    check_name(path, "channel's name", channel.name);
    if (channel.exact && is_lossy(channel.name)) apart.insert(layer_of(channel.name));
  }
  Planes packed, exact;
  for (const ExrChannel& channel : image.channels) {
    const bool is_apart = apart.contains(layer_of(channel.name));
    const auto [place, is_new] = (is_apart ? exact : packed).emplace(channel.name, Plane(channel, pixel_count));
    PENUMBRA_ASSERT(is_new, "two channels are called {}", channel.name);
    if (!is_apart && is_lossy(channel.name)) place->second.bound();
  }
  std::atomic<std::uint64_t> too_large = 0;
  Output output(file);
  try {
    if (exact.empty() || packed.empty()) {  // a file of one part
      const Part part(exact.empty() ? std::move(packed) : std::move(exact), image.width);
      Imf::OutputFile to(output, part.header(image, exact.empty() ? Imf::DWAA_COMPRESSION : Imf::ZIP_COMPRESSION), 0);
      part.write(to, image.height, too_large);
    } else {
      const Part parts[] = {{std::move(packed), image.width}, {std::move(exact), image.width}};
      Imf::Header headers[] = {parts[0].header(image, Imf::DWAA_COMPRESSION),
                               parts[1].header(image, Imf::ZIP_COMPRESSION)};
      headers[0].setName("packed");
      headers[1].setName("exact");
      for (Imf::Header& header : headers) header.setType(Imf::SCANLINEIMAGE);
      Imf::MultiPartOutputFile to(output, headers, 2, false, 0);
      for (int i = 0; i < 2; ++i) {
        Imf::OutputPart part(to, i);
        parts[i].write(part, image.height, too_large);
      }
    }
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    if (output.thrown()) std::rethrow_exception(output.thrown());
    throw ResourceError("cannot write \"{}\": OpenEXR says: {}", path.string(), error.what());
  }
  if (output.thrown()) std::rethrow_exception(output.thrown());
  return too_large;
}

}  // namespace penumbra::exr
