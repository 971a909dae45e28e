#include "visibility/masks/bits_file.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <type_traits>

namespace penumbra::visibility {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they lie in memory");
static_assert(sizeof(glm::vec3) == 12 && sizeof(glm::dvec3) == 24);

template <typename Value>
void put(std::vector<std::byte>& bytes, const Value& value) {
  static_assert(std::is_trivially_copyable_v<Value>);
  const auto* first = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof(Value));
}

/// Takes value after value from the front; the caller has checked that they are there.
class Reader {
 public:
  explicit Reader(std::span<const char> bytes) : bytes_(bytes) {}
  template <typename Value>
  void take(Value& value) {
    PENUMBRA_ASSERT(bytes_.size() >= sizeof(Value), "{} bytes left", bytes_.size());
    std::memcpy(&value, bytes_.data(), sizeof(Value));
    bytes_ = bytes_.subspan(sizeof(Value));
  }

 private:
  std::span<const char> bytes_;
};

const std::filesystem::path& refuse_sphere(const std::filesystem::path& path, const Light& light) {
  if (light.kind == LightKind::sphere) {
    throw UsageError(
        "cannot write \"{}\": light \"{}\" is a sphere, whose light samples differ from pixel to pixel; "
        "--bits needs a light of another kind (choose one with --light)",
        path.string(), light.name);
  }
  return path;
}

}  // namespace

BitsWriter::BitsWriter(const std::filesystem::path& path, const glm::dvec3& origin, const ViewSamples& samples,
                       const Light& light)
    : samples_(samples), words_per_mask_(light.words_per_mask()), file_(refuse_sphere(path, light)) {
  PENUMBRA_ASSERT(light.points.size() == light.sample_count(), "{} points for {} samples", light.points.size(),
                  light.sample_count());
  file_.write(fmt::format("penumbra-bits/1 {} {} {}\n", samples.width, samples.height, light.sample_count()));
  std::vector<std::byte> bytes;
  put(bytes, origin);
  for (const glm::vec3& point : light.points) put(bytes, point);
  file_.write(bytes);
}

void BitsWriter::append(std::span<const std::uint32_t> masks) {
  const std::size_t count = masks.size() / words_per_mask_;
  PENUMBRA_ASSERT(masks.size() % words_per_mask_ == 0 && next_pixel_ + count <= samples_.size(),
                  "{} words after pixel {} of {}", masks.size(), next_pixel_, samples_.size());
  constexpr std::size_t kChunk = 4096;  // pixels a system call
  std::vector<std::byte> bytes;
  for (std::size_t done = 0; done < count;) {
    bytes.clear();
    for (const std::size_t end = std::min(count, done + kChunk); done < end; ++done, ++next_pixel_) {
      put(bytes, samples_.p[next_pixel_]);
      put(bytes, samples_.triangle[next_pixel_]);
      const auto words = std::as_bytes(masks.subspan(done * words_per_mask_, words_per_mask_));
      bytes.insert(bytes.end(), words.begin(), words.end());
    }
    file_.write(bytes);
  }
}

void BitsWriter::commit() {
  PENUMBRA_ASSERT(next_pixel_ == samples_.size(), "masks of {} pixels, but there are {}", next_pixel_, samples_.size());
  file_.commit();
}

void write_bits(const std::filesystem::path& path, const glm::dvec3& origin, const ViewSamples& samples,
                const Light& light, std::span<const std::uint32_t> masks) {
  BitsWriter writer(path, origin, samples, light);
  writer.append(masks);
  writer.commit();
}

BitsFile read_bits(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError("cannot read \"{}\"", path.string());
  const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  BitsFile file;
  const std::string line = bytes.substr(0, std::min(bytes.find('\n'), std::size_t{100}));
  char rest = 0;
  const int found =
      std::sscanf(line.c_str(), "penumbra-bits/1 %9u %9u %4u%c", &file.width, &file.height, &file.sample_count, &rest);
  if (found != 3 || file.sample_count == 0) {
    throw InputError("\"{}\" does not begin with a line \"penumbra-bits/1 W H N\"", path.string());
  }
  const std::size_t pixel_count = std::size_t{file.width} * file.height;
  const std::size_t pixel_bytes = 16 + 4 * std::size_t{file.words_per_mask()};
  const std::size_t expected = line.size() + 1 + 24 + 12 * std::size_t{file.sample_count} + pixel_count * pixel_bytes;
  if (bytes.size() != expected) {
    throw InputError("\"{}\" has {} bytes, but {}x{} pixels and {} light samples take {}", path.string(), bytes.size(),
                     file.width, file.height, file.sample_count, expected);
  }
  Reader reader(std::span<const char>(bytes).subspan(line.size() + 1));
  reader.take(file.origin);
  file.light_points.resize(file.sample_count);
  for (glm::vec3& point : file.light_points) reader.take(point);
  file.p.resize(pixel_count);
  file.triangle.resize(pixel_count);
  file.masks.resize(pixel_count * file.words_per_mask());
  for (std::size_t i = 0; i < pixel_count; ++i) {
    reader.take(file.p[i]);
    reader.take(file.triangle[i]);
    for (std::size_t w = 0; w < file.words_per_mask(); ++w) reader.take(file.masks[i * file.words_per_mask() + w]);
  }
  return file;
}

}  // namespace penumbra::visibility
