// SPDX-License-Identifier: Apache-2.0
// Fuzzes repair of any small soup, with CGAL's own checks enabled: it ends, the result is a soup, and triangles without
// area are removed or mentioned.
#include "base/assert.hpp"
#include "mesh/diagnosis/diagnosis.hpp"
#include "repair/run_repair.hpp"
#include "tests/fuzz/bytes.hpp"

#include <cmath>

namespace {

using namespace penumbra::mesh;
using penumbra::fuzz::Bytes;

/// Makes a soup with corners on a lattice of four steps along each side, so that many coincide; a few are moved off it.
TriangleSoup make_soup(Bytes& bytes) {
  TriangleSoup soup;
  const std::uint32_t positions = 3 + bytes.take<std::uint8_t>() % 10u;
  const auto nudged = bytes.take<std::uint32_t>();
  for (std::uint32_t i = 0; i < positions; ++i) {
    const auto packed = bytes.take<std::uint8_t>();
    glm::dvec3 p(packed & 3, (packed >> 2) & 3, (packed >> 4) & 3);
    if ((nudged >> i & 1) != 0) p += glm::dvec3(0.1, 0.3, 1e-9);
    soup.positions.push_back(p);
  }
  constexpr std::size_t kMostTriangles = 14;  // exact constructions are slow
  while (!bytes.empty() && soup.triangles.size() < kMostTriangles) {
    Triangle triangle{};
    for (std::uint32_t& corner : triangle) corner = bytes.take<std::uint8_t>() % positions;
    soup.source_face.push_back(static_cast<std::uint32_t>(soup.triangles.size()));
    soup.object.push_back(soup.triangles.size() % 3 == 2 ? 1 : 0);
    soup.triangles.push_back(triangle);
  }
  return soup;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes({data, size});
  const auto head = bytes.take<std::uint8_t>();
  RepairOptions options;
  options.weld = (head & 1) != 0 ? 0.5 : 0;
  options.fill_holes_up_to = (head >> 1) & 7;
  options.resolve_self_intersections = (head & 16) != 0;
  const TriangleSoup soup = make_soup(bytes);
  if (soup.triangles.empty()) return 0;
  const Repaired repaired = penumbra::repair::run_repair(soup, options);
  const TriangleSoup& after = repaired.soup;
  PENUMBRA_ASSERT(after.object.size() == after.triangles.size() && after.source_face.size() == after.triangles.size(),
                  "{} triangles, {} objects, {} faces", after.triangles.size(), after.object.size(),
                  after.source_face.size());
  for (std::size_t t = 0; t < after.triangles.size(); ++t) {
    PENUMBRA_ASSERT(after.object[t] <= 1, "triangle {} is of object {}", t, after.object[t]);
    for (const std::uint32_t corner : after.triangles[t]) {
      PENUMBRA_ASSERT(corner < after.positions.size(), "triangle {} names vertex {}", t, corner);
    }
  }
  for (const glm::dvec3& p : after.positions) {
    PENUMBRA_ASSERT(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "({}, {}, {})", p.x, p.y, p.z);
  }
  if (after.triangles.empty()) return 0;
  const Diagnosis diagnosis = diagnose({after.positions, after.triangles}, {});
  PENUMBRA_ASSERT(diagnosis.zero_area_triangles.count == 0 || !repaired.left.empty(),
                  "{} zero-area triangles left, and not a word of them", diagnosis.zero_area_triangles.count);
  return 0;
}
