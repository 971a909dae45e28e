// SPDX-License-Identifier: Apache-2.0
// The header of the "OpenEXR File Layout": magic number, version, and attributes, each a name, a type, a size and a
// value.

#include "base/exr_header.hpp"

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>

namespace penumbra {
namespace {

constexpr std::int32_t kMagic = 20000630;
constexpr std::int32_t kVersion = 2;
constexpr std::int32_t kLongNames = 0x400;  // names of up to 255 bytes, not 31
constexpr std::uint8_t kNone = 0, kZips = 2, kZip = 3;
constexpr std::uint8_t kIncreasing = 0;  // line order: increasing y
constexpr std::int32_t kUint = 0, kHalf = 1, kFloat = 2;

class Header {
 public:
  Header() {
    bytes_.put(kMagic);
    bytes_.put(kVersion | kLongNames);
  }

  template <typename Value>
  void add(std::string_view name, std::string_view type, const Value& value) {
    begin(name, type, sizeof value);
    bytes_.put(value);
  }
  void add_text(std::string_view name, std::string_view text) {
    begin(name, "string", text.size());
    bytes_.put_characters(text);
  }
  void add_channels(const std::map<std::string, exr::Type>& types) {
    ExrBytes channels;
    for (const auto& [name, type] : types) {
      channels.put_text(name);
      channels.put(type == exr::Type::uint32 ? kUint : type == exr::Type::float16 ? kHalf : kFloat);
      channels.put(std::int32_t{0});                               // pLinear, and three reserved bytes
      channels.put(std::array{std::int32_t{1}, std::int32_t{1}});  // sampling: a value for every pixel in x and y
    }
    channels.put('\0');
    begin("channels", "chlist", channels.all().size());
    for (const std::byte byte : channels.all()) bytes_.put(byte);
  }
  [[nodiscard]] std::vector<std::byte> take() {
    bytes_.put('\0');
    return bytes_.take();
  }

 private:
  void begin(std::string_view name, std::string_view type, std::size_t size) {
    bytes_.put_text(name);
    bytes_.put_text(type);
    bytes_.put(static_cast<std::int32_t>(size));
  }

  ExrBytes bytes_;
};

}  // namespace

std::vector<std::byte> exr_header(const ExrImage& image, const std::map<std::string, exr::Type>& types) {
  Header header;
  const std::array<std::int32_t, 4> window = {0, 0, static_cast<std::int32_t>(image.width) - 1,
                                              static_cast<std::int32_t>(image.height) - 1};
  header.add_text("type", "scanlineimage");
  header.add("compression", "compression",
             image.compression == ExrCompression::none   ? kNone
             : image.compression == ExrCompression::zips ? kZips
                                                         : kZip);
  header.add("dataWindow", "box2i", window);
  header.add("displayWindow", "box2i", window);
  header.add("lineOrder", "lineOrder", kIncreasing);
  header.add("pixelAspectRatio", "float", 1.0F);
  header.add("screenWindowCenter", "v2f", glm::vec2(0));
  header.add("screenWindowWidth", "float", 1.0F);
  for (const auto& [name, value] : image.attributes) header.add_text(name, value);
  for (const auto& [name, value] : image.vectors) header.add(name, "v3d", value);
  for (const auto& [name, value] : image.matrices) header.add(name, "m44f", value);
  header.add_channels(types);
  return header.take();
}

}  // namespace penumbra
