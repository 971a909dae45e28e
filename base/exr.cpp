// SPDX-License-Identifier: Apache-2.0
// Reading of OpenEXR files through OpenEXR's own library, from a path or from memory.

#include "base/exr.hpp"

#include "base/error.hpp"

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <OpenEXR/ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <limits>
#include <string_view>

namespace penumbra {
namespace {

class MemoryInput : public Imf::IStream {
 public:
  MemoryInput(std::span<const std::byte> bytes, const std::string& shown) : IStream(shown.c_str()), bytes_(bytes) {}
  bool read(char* to, int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (position_ > bytes_.size() || size > bytes_.size() - position_) {
      throw Iex::InputExc(fmt::format("the file ends too early, after {} bytes", bytes_.size()));
    }
    std::memcpy(to, bytes_.data() + position_, size);
    position_ += size;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
};

/// Reads the channels of an InputFile or InputPart that `file` does not have yet.
template <typename Input>
void read_channels(Input& input, const std::string& shown, const ExrSelection& selection, ExrFile& file) {
  const Imf::Header& header = input.header();
  const Imath::Box2i window = header.dataWindow();
  Imf::FrameBuffer pixels;
  const auto insert = [&](const char* name, Imf::PixelType type, auto& values) {
    values.resize(std::size_t{file.width} * file.height);
    // OpenEXR addresses pixels by their absolute place: shift so that the window's corner is element 0.
    pixels.insert(name, Imf::Slice::Make(type, values.data(), window));
  };
  const std::vector<std::string>& wanted = selection.channels;
  const std::vector<std::string> before = file.channel_names;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    if (std::ranges::find(before, channel.name()) != before.end()) continue;
    file.channel_names.emplace_back(channel.name());
    if (!wanted.empty() && std::ranges::find(wanted, channel.name()) == wanted.end()) continue;
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) {
      throw InputError("\"{}\": channel {} is subsampled, which is not supported", shown, channel.name());
    }
    if (channel.channel().type == Imf::UINT) {
      insert(channel.name(), Imf::UINT, file.integers[channel.name()]);
    } else {
      insert(channel.name(), Imf::FLOAT, file.floats[channel.name()]);
    }
  }
  if (pixels.begin() == pixels.end()) return;
  input.setFrameBuffer(pixels);
  input.readPixels(window.min.y, window.max.y);
}

void rewind(const char* /*path*/) {}
void rewind(MemoryInput& stream) {
  stream.seekg(0);
}

template <typename Source>
void read_other_parts(Source& source, const Imath::Box2i& window, const std::string& shown,
                      const ExrSelection& selection, ExrFile& file) {
  rewind(source);
  Imf::MultiPartInputFile parts(source);
  for (int i = 1; i < parts.parts(); ++i) {
    const Imf::Header& header = parts.header(i);
    if (header.dataWindow() != window || Imf::isDeepData(header.type())) continue;
    Imf::InputPart part(parts, i);
    read_channels(part, shown, selection, file);
  }
}

/// Reads an image from `source`, a file name or a stream that OpenEXR opens.
template <typename Source>
ExrFile read_from(const std::string& shown, const ExrSelection& selection, Source&& source) {
  try {
    Imf::InputFile input(source);
    const Imf::Header& header = input.header();
    const Imath::Box2i window = header.dataWindow();
    if (window.isEmpty()) throw InputError("\"{}\": an image without pixels", shown);
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    if (std::max(width, height) > selection.largest_side) {
      throw InputError("\"{}\": {}x{} pixels; at most {} a side", shown, width, height, selection.largest_side);
    }
    ExrFile file;
    file.width = static_cast<std::uint32_t>(width);
    file.height = static_cast<std::uint32_t>(height);
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute())) {
        file.attributes[attribute.name()] = text->value();
      } else if (const auto* vector = dynamic_cast<const Imf::V3dAttribute*>(&attribute.attribute())) {
        const Imath::V3d& v = vector->value();
        file.vectors[attribute.name()] = {v.x, v.y, v.z};
      } else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&attribute.attribute())) {
        glm::mat4& to = file.matrices[attribute.name()];
        for (int i = 0; i < 4; ++i) {
          for (int j = 0; j < 4; ++j) to[i][j] = matrix->value()[i][j];
        }
      }
    }
    read_channels(input, shown, selection, file);
    if (Imf::isMultiPart(input.version())) read_other_parts(source, window, shown, selection, file);
    return file;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError("\"{}\" is no readable OpenEXR image: {}", shown, error.what());
  }
}

}  // namespace

bool is_whole_exr(const std::filesystem::path& path, const std::string& attribute) {
  try {
    Imf::InputFile input(path.c_str());
    const Imf::Header& header = input.header();
    if (header.findTypedAttribute<Imf::StringAttribute>(attribute) == nullptr) return false;
    if (!input.isComplete() || header.channels().begin() == header.channels().end()) return false;
    // Lines are written in order: if the last line exists, all exist.
    const Imath::Box2i window = header.dataWindow();
    std::vector<float> line(static_cast<std::size_t>(window.max.x - window.min.x) + 1);
    Imf::FrameBuffer pixels;
    pixels.insert(header.channels().begin().name(),
                  Imf::Slice::Make(Imf::FLOAT, line.data(), {{window.min.x, window.max.y}, window.max}));
    input.setFrameBuffer(pixels);
    input.readPixels(window.max.y);
    return true;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return false;
  }
}

ExrFile read_exr(const std::filesystem::path& path, const ExrSelection& selection) {
  return read_from(path.string(), selection, path.c_str());
}

ExrFile read_exr(std::span<const std::byte> bytes, const std::string& shown, const ExrSelection& selection) {
  MemoryInput stream(bytes, shown);
  return read_from(shown, selection, stream);
}

}  // namespace penumbra
