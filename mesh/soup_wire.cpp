// SPDX-License-Identifier: Apache-2.0
// The program's end of the wire: decodes the import helper's triangles on all cores.

#include "base/pages.hpp"
#include "base/parallel.hpp"
#include "mesh/import.hpp"
#include "mesh/import_wire.hpp"

#include <glm/vec3.hpp>

#include <atomic>
#include <cmath>
#include <cstring>

namespace penumbra::mesh {
namespace {

template <typename T>
T value_at(std::span<const std::byte> bytes, std::size_t i) {
  T value;
  std::memcpy(&value, &bytes[i * sizeof(T)], sizeof(T));
  return value;
}

/// Reads a list of sent values, each converted by `convert`; throws WireError(`otherwise`) if `is_good` is false for
/// any.
template <typename Sent, typename T, typename IsGood>
void get_checked(WireReader& from, std::vector<T>& list, const IsGood& is_good, const char* otherwise) {
  const std::span<const std::byte> sent = from.get_array_in_place<Sent>();
  resize_on_all_cores(list, sent.size() / sizeof(Sent));
  std::atomic<bool> good = true;
  for_each_index(list.size(), [&](std::size_t i) {
    list[i] = T(value_at<Sent>(sent, i));
    if (!is_good(list[i])) good.store(false, std::memory_order_relaxed);
  });
  if (!good) throw WireError(otherwise);
}

void get_positions(WireReader& from, std::vector<glm::dvec3>& positions) {
  const auto finite = [](const glm::dvec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  constexpr const char* kBad = "a position is not finite";
  if (from.get_bool())
    get_checked<glm::vec3>(from, positions, finite, kBad);
  else
    get_checked<glm::dvec3>(from, positions, finite, kBad);
}

/// Reads one number for each of `triangles` triangles. A run's length is trusted only if it fits that count.
void get_numbers(WireReader& from, std::vector<std::uint32_t>& numbers, std::size_t triangles, std::uint32_t step) {
  constexpr const char* kBad = "the triangle arrays differ in length";
  if (!from.get_bool()) {
    get_checked<std::uint32_t>(
        from, numbers, [](std::uint32_t) { return true; }, kBad);
    if (numbers.size() != triangles) throw WireError(kBad);
    return;
  }
  const auto runs = from.get_array<NumberRun>();
  std::size_t all = 0;
  for (const NumberRun& run : runs) {
    if (run.count > triangles - all) throw WireError(kBad);
    all += run.count;
  }
  if (all != triangles) throw WireError(kBad);
  resize_on_all_cores(numbers, triangles);
  std::size_t at = 0;
  for (const NumberRun& run : runs) {
    for (std::uint32_t i = 0; i < run.count; ++i) numbers[at++] = run.first + step * i;
  }
}

}  // namespace

TriangleSoup get_soup(WireReader& from) {
  TriangleSoup soup;
  get_positions(from, soup.positions);
  const auto in_range = [count = soup.positions.size()](const Triangle& t) {
    return t[0] < count && t[1] < count && t[2] < count;
  };
  get_checked<Triangle>(from, soup.triangles, in_range, "a vertex index is out of range");
  get_numbers(from, soup.object, soup.triangles.size(), 0);
  get_numbers(from, soup.source_face, soup.triangles.size(), 1);
  return soup;
}

ImportedMesh get_mesh(WireReader& from) {
  ImportedMesh mesh;
  mesh.soup = get_soup(from);
  mesh.notes = from.get_strings();
  return mesh;
}

}  // namespace penumbra::mesh
