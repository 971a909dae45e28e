// SPDX-License-Identifier: Apache-2.0
// Places one part for each defect in rows on a lattice, and maps the lattice to space without rounding: the step is a
// power of two, and the centre a multiple of it.

#include "mesh/shapes/broken_meshes.hpp"

#include "base/assert.hpp"
#include "mesh/shapes/broken_lattice.hpp"
#include "mesh/shapes/shape_builder.hpp"

#include <fmt/ranges.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace penumbra::mesh {
namespace {

using broken::LatticeMesh;
using broken::Lift;

/// Maps the lattice to space: center + step · (place − middle), without any rounding.
class Placement {
 public:
  /// Maps the box from `low` to `high`, as large as fits within `half_extent` with a step that is a power of two.
  Placement(const glm::dvec3& low, const glm::dvec3& high, const glm::dvec3& center, double half_extent)
      : middle_((low + high) / 2.0) {
    const glm::dvec3 half = (high - low) / 2.0;
    step_ = std::exp2(std::floor(std::log2(half_extent / std::max({half.x, half.y, half.z}))));
    center_ = glm::round(center / step_) * step_;
    const glm::dvec3 far = glm::abs(center_) + half * step_;
    far_ = std::max({far.x, far.y, far.z});
  }

  [[nodiscard]] glm::dvec3 of(const glm::dvec3& place) const { return center_ + step_ * (place - middle_); }

  /// Returns a step that is representable next to every coordinate of the whole mesh.
  [[nodiscard]] double smallest_step(Lift lift) const {
    if (lift == Lift::none) return 0;
    return std::exp2(std::ilogb(far_) - (lift == Lift::float_step ? 23 : 52));
  }

 private:
  glm::dvec3 middle_, center_{0};
  double step_ = 1, far_ = 1;
};

std::vector<broken::Defect> all_defects() {
  std::vector<broken::Defect> all;
  for (const auto group : {broken::surface_defects(), broken::sheet_defects(), broken::joint_defects()}) {
    all.insert(all.end(), group.begin(), group.end());
  }
  return all;
}

const std::vector<broken::Defect>& defects() {
  static const std::vector<broken::Defect> all = all_defects();
  return all;
}

const broken::Defect& find_defect(std::string_view name) {
  const auto found = std::find_if(defects().begin(), defects().end(), [&](const auto& d) { return d.name == name; });
  if (found != defects().end()) return *found;
  std::vector<std::string_view> names;
  for (const broken::Defect& defect : defects()) names.push_back(defect.name);
  throw InputError("there is no defect \"{}\"; there are {}", name, fmt::join(names, ", "));
}

/// Returns the counts of the whole mesh. Throws InputError for an invalid shape, before memory is allocated.
KnownDiagnosis known_of(const BrokenShape& shape) {
  if (shape.defects.empty()) throw InputError("a broken mesh needs at least one defect (\"none\" is one)");
  if (shape.size == 0 || shape.size > kMaxBrokenSize) {
    throw InputError("a broken mesh of size {}: from 1 to {} cells along an edge", shape.size, kMaxBrokenSize);
  }
  KnownDiagnosis known;
  for (const std::string& name : shape.defects) {
    broken::add(known, find_defect(name).known(shape.size));
    builder::checked({known.triangles, known.vertices});  // checked after each part, so that no sum overflows
  }
  return known;
}

struct Box {
  glm::ivec3 low{0}, high{0};
};
Box bounds_of(const LatticeMesh& mesh) {
  Box box{mesh.positions.at(0), mesh.positions.at(0)};
  for (const glm::ivec3& place : mesh.positions) box = {glm::min(box.low, place), glm::max(box.high, place)};
  return box;
}

/// A part, and the place of its lattice's zero on the lattice of the whole mesh.
struct Part {
  LatticeMesh mesh;
  Box box;
  glm::dvec3 at{0};
};

/// Places parts in rows along X, rows one behind the other along −Z, all on the same ground, one cell apart.
void set_beside_each_other(std::vector<Part>& parts) {
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(parts.size()))));
  glm::ivec3 widest(0);
  for (const Part& part : parts) widest = glm::max(widest, part.box.high - part.box.low);
  const glm::dvec3 pitch = glm::dvec3(widest) + double(broken::kCell);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t column = i % columns, row = i / columns;
    parts[i].at = glm::dvec3(static_cast<double>(column) * pitch.x, 0, -static_cast<double>(row) * pitch.z) -
                  glm::dvec3(parts[i].box.low);
  }
}

void append(TriangleSoup& soup, const Part& part, const Placement& placement) {
  const auto first = static_cast<std::uint32_t>(soup.positions.size());
  for (std::size_t i = 0; i < part.mesh.positions.size(); ++i) {
    glm::dvec3 position = placement.of(part.at + glm::dvec3(part.mesh.positions[i]));
    if (i >= part.mesh.lifted_from) position.y += placement.smallest_step(part.mesh.lift);
    for (int axis = 0; axis < 3 && part.mesh.signed_zeros && i % 2 == 1; ++axis) {
      if (position[axis] == 0) position[axis] = -0.0;
    }
    soup.positions.push_back(position);
  }
  for (const Triangle& t : part.mesh.triangles) soup.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

}  // namespace

std::span<const DefectName> broken_defects() {
  static const std::vector<DefectName> names = [] {
    std::vector<DefectName> result;
    for (const broken::Defect& defect : defects()) result.push_back({defect.name, defect.what});
    return result;
  }();
  return names;
}

ShapeSize shape_size(const BrokenShape& shape) {
  const KnownDiagnosis known = known_of(shape);
  return {known.triangles, known.vertices};
}

BrokenMesh make_broken_mesh(const BrokenShape& shape) {
  builder::require_room(shape_size(shape));
  BrokenMesh result;
  result.known = known_of(shape);
  std::vector<Part> parts(shape.defects.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    find_defect(shape.defects[i]).build(parts[i].mesh, static_cast<int>(shape.size));
    parts[i].box = bounds_of(parts[i].mesh);
  }
  set_beside_each_other(parts);

  glm::dvec3 low(parts[0].at + glm::dvec3(parts[0].box.low)), high(low);
  for (const Part& part : parts) {
    low = glm::min(low, part.at + glm::dvec3(part.box.low));
    high = glm::max(high, part.at + glm::dvec3(part.box.high));
  }
  const Placement placement(low, high, shape.center, shape.half_extent);
  for (const Part& part : parts) append(result.soup, part, placement);
  result.soup = builder::finish(std::move(result.soup));
  PENUMBRA_ASSERT(result.soup.triangles.size() == result.known.triangles, "{} triangles, {} by formula",
                  result.soup.triangles.size(), result.known.triangles);
  return result;
}

ShapeSize shape_size(const LatticeSoup& soup) {
  return builder::checked({soup.triangles, 3ull * soup.triangles});
}

TriangleSoup make_lattice_soup(const LatticeSoup& soup) {
  builder::require_room(shape_size(soup));
  if (soup.cells == 0) throw InputError("a lattice soup needs at least 1 cell");
  const Placement placement(glm::dvec3(0), glm::dvec3(soup.cells), soup.center, soup.half_extent);
  std::mt19937 random(soup.seed);
  const auto coordinate = [&] { return static_cast<double>(random() % (std::uint64_t{soup.cells} + 1)); };
  TriangleSoup result;
  result.positions.reserve(std::size_t{3} * soup.triangles);  // exactly the checked size, not the next power of two
  result.triangles.reserve(soup.triangles);
  for (std::uint32_t i = 0; i < soup.triangles; ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      const double x = coordinate(), y = coordinate(), z = coordinate();
      builder::add_vertex(result, placement.of({x, y, z}));
    }
    result.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return builder::finish(std::move(result));
}

}  // namespace penumbra::mesh
