// SPDX-License-Identifier: Apache-2.0
// Writes STL and OFF files.

#include "mesh/soup_files.hpp"

#include "base/atomic_file.hpp"
#include "base/error.hpp"

#include <glm/geometric.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace penumbra::mesh {
namespace {

static_assert(std::endian::native == std::endian::little, "the bytes are written as they lie in memory");

constexpr std::size_t kStlHeader = 80, kStlTriangle = 50;
constexpr std::size_t kPiece = std::size_t{1} << 20;

/// Writes 12 floats and two unused bytes.
void put_stl_triangle(std::byte* to, const std::array<glm::dvec3, 3>& corners) {
  glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double length = glm::length(normal);
  normal = length > 0 && std::isfinite(length) ? normal / length : glm::dvec3(0);
  for (const glm::dvec3& v : {normal, corners[0], corners[1], corners[2]}) {
    const std::array<float, 3> rounded = {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    std::memcpy(to, rounded.data(), sizeof rounded);
    to += sizeof rounded;
  }
}

}  // namespace

void write_stl(const std::filesystem::path& path, const TriangleSoup& soup) {
  if (soup.triangles.size() > std::numeric_limits<std::uint32_t>::max())
    throw ResourceError("{}: an STL file has room for 2^32 - 1 triangles; there are {}", path.string(),
                        soup.triangles.size());
  std::vector<std::byte> bytes(kStlHeader + 4 + kStlTriangle * soup.triangles.size());
  constexpr std::string_view kName = "Penumbra";  // must not begin with "solid", which readers take for a text file
  std::memcpy(bytes.data(), kName.data(), kName.size());
  const auto count = static_cast<std::uint32_t>(soup.triangles.size());
  std::memcpy(bytes.data() + kStlHeader, &count, sizeof count);
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    const Triangle& t = soup.triangles[i];
    put_stl_triangle(bytes.data() + kStlHeader + 4 + kStlTriangle * i,
                     {soup.positions[t[0]], soup.positions[t[1]], soup.positions[t[2]]});
  }
  write_file_atomically(path, std::span<const std::byte>(bytes));
}

void write_off(const std::filesystem::path& path, const TriangleSoup& soup) {
  AtomicFile file(path);
  fmt::memory_buffer text;
  const auto flush = [&](std::size_t from) {
    if (text.size() <= from) return;
    file.write(std::string_view(text.data(), text.size()));
    text.clear();
  };
  const auto to = std::back_inserter(text);
  fmt::format_to(to, "OFF\n{} {} 0\n", soup.positions.size(), soup.triangles.size());
  for (const glm::dvec3& p : soup.positions) {
    fmt::format_to(to, "{} {} {}\n", p.x, p.y, p.z);
    flush(kPiece);
  }
  for (const auto& [a, b, c] : soup.triangles) {
    fmt::format_to(to, "3 {} {} {}\n", a, b, c);
    flush(kPiece);
  }
  flush(0);
  file.commit();
}

}  // namespace penumbra::mesh
