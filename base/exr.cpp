#include "base/exr.hpp"

#include "base/assert.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <limits>
#include <mutex>
#include <set>
#include <string_view>
#include <thread>

namespace penumbra {
namespace {

/// OpenEXR writes its table of line offsets last, from a destructor that swallows every error: a full disk would
/// leave a broken file and no message. So the file is made in memory, and reaches the disk by our own hands.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : OStream("memory") {}
  void write(const char* bytes, int count) override {
    const auto size = static_cast<std::size_t>(count);
    bytes_.resize(std::max(bytes_.size(), position_ + size));
    std::copy_n(bytes, size, bytes_.begin() + static_cast<std::ptrdiff_t>(position_));
    position_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  [[nodiscard]] std::string_view bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

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

/// OpenEXR's worker threads are the process's; they only compress and uncompress, so they never change the bytes.
void start_worker_threads() {
  static std::once_flag once;
  std::call_once(once, [] { Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency())); });
}

void check_name(const std::filesystem::path& path, const char* what, const std::string& name) {
  constexpr std::size_t kLongestName = 255;  // of an OpenEXR 2.0 file with long names
  if (name.empty() || name.size() > kLongestName || name.find('\0') != std::string::npos) {
    throw InputError(
        "cannot write \"{}\": an OpenEXR {} has 1 to {} bytes and no zero byte, but \"{}\" has {}; use a shorter name",
        path.string(), what, kLongestName, name.c_str(), name.size());
  }
}

/// Where OpenEXR shall find (or put) pixel (0, 0); strides in bytes.
template <typename Value>
Imf::Slice slice_of(Imf::PixelType type, const Value* values, std::size_t stride, std::uint32_t width) {
  // Slice wants a mutable pointer for both directions; writing a file only reads.
  char* base = reinterpret_cast<char*>(const_cast<Value*>(values));
  return {type, base, stride * sizeof(Value), stride * sizeof(Value) * width};
}

/// From what OpenEXR opens: a name, or a stream.
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
    const std::size_t pixel_count = std::size_t{file.width} * file.height;
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
    Imf::FrameBuffer pixels;
    const auto insert = [&](const char* name, Imf::PixelType type, auto& values) {
      values.resize(pixel_count);
      // OpenEXR addresses pixels by their absolute place: shift so that the window's corner is element 0.
      pixels.insert(name, Imf::Slice::Make(type, values.data(), window));
    };
    const std::vector<std::string>& wanted = selection.channels;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
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
    if (pixels.begin() != pixels.end()) {
      input.setFrameBuffer(pixels);
      input.readPixels(window.min.y, window.max.y);
    }
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

void add_vector_channels(ExrImage& image, const std::string& layer, std::span<const glm::vec3> vectors) {
  static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
  if (vectors.empty()) return;
  const float* first = &vectors.front().x;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::span<const float> values(first + axis, 3 * vectors.size() - axis);
    image.channels.push_back({layer + "." + "XYZ"[axis], values, 3});
  }
}

void write_exr(const std::filesystem::path& path, const ExrImage& image) {
  AtomicFile file(path);  // first, so that a place that cannot be written is told before any work
  write_exr(file, image);
  file.commit();
}

void write_exr(AtomicFile& file, const ExrImage& image) {
  const std::filesystem::path& path = file.path();
  if (image.width == 0 || image.height == 0 || image.width > kLargestExrSide || image.height > kLargestExrSide) {
    throw ResourceError("cannot write \"{}\": {}x{} pixels; an OpenEXR image has 1 to {} a side", path.string(),
                        image.width, image.height, kLargestExrSide);
  }
  Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [name, value] : image.attributes) {
    check_name(path, "attribute's name", name);
    header.insert(name, Imf::StringAttribute(value));
  }
  for (const auto& [name, value] : image.vectors) {
    check_name(path, "attribute's name", name);
    header.insert(name, Imf::V3dAttribute(Imath::V3d(value.x, value.y, value.z)));
  }
  for (const auto& [name, value] : image.matrices) {
    check_name(path, "attribute's name", name);
    Imath::M44f matrix;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) matrix[i][j] = value[i][j];
    }
    header.insert(name, Imf::M44fAttribute(matrix));
  }

  Imf::FrameBuffer pixels;
  std::set<std::string> names;
  const std::size_t pixel_count = std::size_t{image.width} * image.height;
  for (const ExrChannel& channel : image.channels) {
    check_name(path, "channel's name", channel.name);
    PENUMBRA_ASSERT(names.insert(channel.name).second, "two channels are called {}", channel.name);
    std::visit(
        [&](auto values) {
          PENUMBRA_ASSERT(values.size() > (pixel_count - 1) * channel.stride,
                          "channel {}: {} values for {} pixels with stride {}", channel.name, values.size(),
                          pixel_count, channel.stride);
          constexpr bool kIsFloat = std::is_same_v<decltype(values), std::span<const float>>;
          constexpr Imf::PixelType kType = kIsFloat ? Imf::FLOAT : Imf::UINT;
          header.channels().insert(channel.name, Imf::Channel(kType));
          pixels.insert(channel.name, slice_of(kType, values.data(), channel.stride, image.width));
        },
        channel.values);
  }

  start_worker_threads();
  MemoryStream stream;
  try {
    Imf::OutputFile output(stream, header);
    output.setFrameBuffer(pixels);
    output.writePixels(static_cast<int>(image.height));
  } catch (const std::exception& error) {
    throw ResourceError("cannot write \"{}\": OpenEXR says: {}", path.string(), error.what());
  }
  file.write(stream.bytes());
}

ExrFile read_exr(const std::filesystem::path& path, const ExrSelection& selection) {
  return read_from(path.string(), selection, path.c_str());
}

ExrFile read_exr(std::span<const std::byte> bytes, const std::string& shown, const ExrSelection& selection) {
  MemoryInput stream(bytes, shown);
  return read_from(shown, selection, stream);
}

}  // namespace penumbra
