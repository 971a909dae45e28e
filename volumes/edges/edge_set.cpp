#include "volumes/edges/edge_set.hpp"

#include "base/parallel.hpp"
#include "mesh/predicates.hpp"
#include "volumes/edges/plane_normal.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numeric>

namespace penumbra::volumes {
namespace {

using visibility::SceneFloats;

/// Scene triangle's normal in double, of its sorted corners.
glm::dvec3 normal_of(const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 a(corners[0]);
  return glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
}

/// Of exactly coplanar triangles the largest: for each plane number.
std::vector<std::uint32_t> largest_in_planes(const SceneFloats& scene, std::span<const std::uint32_t> triangles) {
  std::vector<double> size(scene.triangles.size(), -1);
  std::vector<std::uint32_t> largest(scene.triangles.size());
  for (const std::uint32_t triangle : triangles) {
    const glm::dvec3 n = normal_of(scene.corners(triangle));
    const std::uint32_t plane = scene.plane[triangle];
    if (const double squared = glm::dot(n, n); squared > size[plane]) {
      size[plane] = squared;
      largest[plane] = triangle;
    }
  }
  return largest;
}

/// Of two coplanar triangles: do they run the same way around? Asked at points off their plane.
bool turned_alike(const SceneFloats& scene, std::uint32_t x, std::uint32_t y) {
  if (x == y) return true;
  const std::array<glm::vec3, 3> a = scene.corners(x), b = scene.corners(y);
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 q = a[0];
    q[axis] += 1 + std::abs(q[axis]);
    const mesh::Side side = mesh::side_of_plane(a[0], a[1], a[2], q);
    if (side != mesh::Side::on) return side == mesh::side_of_plane(b[0], b[1], b[2], q);
  }
  return true;
}

/// The triangle's side for the edge a→b: in front where (a, b, apex) runs counter-clockwise.
EdgeSide side_of(const SceneFloats& scene, const EdgeCasters& casters, std::uint32_t triangle, const glm::vec3& a,
                 const glm::vec3& b) {
  const std::array<glm::vec3, 3> corners = scene.corners(triangle);
  const auto place = [&](const glm::vec3& x) {
    return static_cast<int>(std::find(corners.begin(), corners.end(), x) - corners.begin());
  };
  EdgeSide side = plane_of(scene, casters, triangle);
  if ((place(a) + 1) % 3 != place(b)) side.n = -side.n;
  return side;
}

/// Is k_e 0 for every p: two triangles of one plane, on either side of the edge?
bool is_flat(const EdgeRecord& record) {
  const auto& [s, t] = record.sides;
  return s.plane != SceneFloats::kNoPlane && s.plane == t.plane && glm::dot(s.n, t.n) < 0;
}

}  // namespace

EdgeCasters edge_casters(const SceneFloats& scene, std::int32_t light_index) {
  EdgeCasters casters;
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.casts_shadow[i] == 0 || (light_index >= 0 && scene.emits[i] == light_index)) continue;
    casters.triangle.push_back(i);
    casters.triangles.push_back(scene.triangles[i]);
  }
  casters.positions = mesh::widened(scene.positions);
  casters.graph = mesh::build_edge_graph({casters.positions, casters.triangles});
  casters.largest_in_plane = largest_in_planes(scene, casters.triangle);
  return casters;
}

EdgeSide plane_of(const SceneFloats& scene, const EdgeCasters& casters, std::uint32_t triangle) {
  const std::uint32_t plane = scene.plane[triangle], chosen = casters.largest_in_plane[plane];
  const std::array<glm::vec3, 3> corners = scene.corners(chosen);
  const glm::vec3 n = rounded_normal(corners);
  return {turned_alike(scene, triangle, chosen) ? n : -n, corners[0], plane};
}

namespace {

/// Those of one edge: a record for each two of its triangles.
void add_records(const SceneFloats& scene, const EdgeCasters& casters, std::uint32_t e,
                 std::vector<EdgeRecord>& records) {
  const mesh::Edge& edge = casters.graph.edges[e];
  const glm::vec3 a(casters.positions[edge.a]), b(casters.positions[edge.b]);
  const auto around = casters.graph.around(e);
  for (std::size_t i = 0; i < around.size(); i += 2) {
    EdgeRecord record{a, b, {}};
    for (std::size_t j = i; j < std::min(i + 2, around.size()); ++j) {
      record.sides[j - i] = side_of(scene, casters, casters.triangle[around[j].triangle], a, b);
    }
    if (!is_flat(record)) records.push_back(record);
  }
}

}  // namespace

std::vector<EdgeRecord> edge_records(const SceneFloats& scene, const EdgeCasters& casters) {
  constexpr std::size_t kChunk = 4096;
  const std::size_t edges = casters.graph.edges.size();
  std::vector<std::vector<EdgeRecord>> chunks((edges + kChunk - 1) / kChunk);
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t i) {
    chunks[i].reserve(kChunk);
    for (std::size_t e = i * kChunk; e < std::min((i + 1) * kChunk, edges); ++e)
      add_records(scene, casters, static_cast<std::uint32_t>(e), chunks[i]);
  });
  std::vector<std::size_t> first(chunks.size());
  std::transform_exclusive_scan(chunks.begin(), chunks.end(), first.begin(), std::size_t{0}, std::plus{},
                                [](const auto& chunk) { return chunk.size(); });
  std::vector<EdgeRecord> records(chunks.empty() ? 0 : first.back() + chunks.back().size());
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t i) {
    std::ranges::copy(chunks[i], records.begin() + static_cast<std::ptrdiff_t>(first[i]));
  });
  return records;
}

namespace {

/// Directions within an angle of an axis, up to sign. cosine ≤ 0: all.
struct Cone {
  glm::dvec3 axis{0};
  double cosine = 1;

  [[nodiscard]] bool is_all() const { return cosine <= 0; }
};
constexpr Cone kAllDirections{{0, 0, 0}, 0};
constexpr double kWidest = 1.57;  // radians: cones of nearly a half-space leave nothing out

Cone joined(const Cone& x, Cone y) {
  if (x.is_all() || y.is_all()) return kAllDirections;
  if (glm::dot(x.axis, y.axis) < 0) y.axis = -y.axis;
  const double between = std::acos(std::clamp(glm::dot(x.axis, y.axis), -1.0, 1.0));
  const double rx = std::acos(std::clamp(x.cosine, -1.0, 1.0)), ry = std::acos(std::clamp(y.cosine, -1.0, 1.0));
  if (between + ry <= rx) return x;
  if (between + rx <= ry) return y;
  const double radius = 0.5 * (between + rx + ry);
  if (radius >= kWidest) return kAllDirections;
  // From x's axis towards y's by radius − rx.
  const double turn = between > 0 ? (radius - rx) / between : 0;
  const glm::dvec3 axis = glm::normalize(x.axis * (1 - turn) + y.axis * turn);
  // The chord is not the arc: take the radius that holds both.
  const double to_x = std::acos(std::clamp(glm::dot(axis, x.axis), -1.0, 1.0)) + rx;
  const double to_y = std::acos(std::clamp(glm::dot(axis, y.axis), -1.0, 1.0)) + ry;
  const double reach = std::max(to_x, to_y);
  return reach >= kWidest ? kAllDirections : Cone{axis, std::cos(reach)};
}

/// The record's two normals, the second turned so that k_e = 0 where p is on the same side of both.
Cone cone_of(const EdgeRecord& record) {
  const glm::dvec3 n1(record.sides[0].n), n2(-record.sides[1].n);
  if (n1 == glm::dvec3(0) || n2 == glm::dvec3(0)) return kAllDirections;
  const glm::dvec3 x = glm::normalize(n1), y = glm::normalize(n2);
  const glm::dvec3 sum = x + y;
  if (glm::dot(x, y) < -0.999) return kAllDirections;  // half of 177 degrees and more
  const glm::dvec3 axis = glm::normalize(sum);
  return {axis, std::min(glm::dot(axis, x), glm::dot(axis, y))};
}

using visibility::TriangleTree;

class Cones {
 public:
  Cones(const TriangleTree& tree, std::span<const EdgeRecord> records) : tree_(tree), records_(records) {
    of_child_.resize(tree.nodes.size() * TriangleTree::kWidth);
    of_leaf_.resize(tree.leaves.size());
    mesh::for_each_index(of_leaf_.size(), [&](std::size_t i) { of_leaf_[i] = of_leaf(tree.leaves[i]); });
    if (!tree.nodes.empty()) of_node(0);
  }
  [[nodiscard]] const Cone& of_child(std::size_t node, std::size_t child) const {
    return of_child_[node * TriangleTree::kWidth + child];
  }

 private:
  Cone of_node(std::uint32_t node) {
    std::optional<Cone> all;
    for (std::size_t i = 0; i < TriangleTree::kWidth; ++i) {
      const std::uint32_t reference = tree_.nodes[node][i].reference;
      if (reference == TriangleTree::kNoChild) continue;
      const bool leaf = (reference & TriangleTree::kLeafBit) != 0;
      const Cone cone = leaf ? of_leaf_[reference & ~TriangleTree::kLeafBit] : of_node(reference);
      of_child_[node * TriangleTree::kWidth + i] = cone;
      all = all ? joined(*all, cone) : cone;
    }
    return all.value_or(kAllDirections);
  }
  [[nodiscard]] Cone of_leaf(const TriangleTree::Leaf& leaf) const {
    std::optional<Cone> all;
    for (const std::uint32_t record : leaf) {
      if (record == TriangleTree::kNoTriangle) continue;
      const Cone cone = cone_of(records_[record]);
      all = all ? joined(*all, cone) : cone;
    }
    return all.value_or(kAllDirections);
  }

  const TriangleTree& tree_;
  std::span<const EdgeRecord> records_;
  std::vector<Cone> of_child_, of_leaf_;
};

}  // namespace

EdgeTexels edge_texels(std::span<const EdgeRecord> records, float scale) {
  std::vector<visibility::Bounds> boxes(records.size());
  mesh::for_each_index(boxes.size(), [&](std::size_t i) {
    boxes[i] = {glm::min(records[i].a, records[i].b), glm::max(records[i].a, records[i].b)};
  });
  const TriangleTree tree = visibility::make_tree_over(boxes);
  const Cones cones(tree, records);
  const std::vector<visibility::Texel> boxed = visibility::node_texels(tree, scale);

  EdgeTexels texels;
  texels.depth = tree.depth;
  texels.records = static_cast<std::uint32_t>(records.size());
  texels.nodes.resize(boxed.size() / 2 * 3);
  mesh::for_each_index(boxed.size() / 2, [&](std::size_t child) {
    const Cone& cone = cones.of_child(child / TriangleTree::kWidth, child % TriangleTree::kWidth);
    // A little wider than it is: float32 rounds axis and cosine, by 2⁻²⁴ each; and near 0 an angle is off by the root
    // of what rounds its cosine, 2⁻²⁶, a few times a level, which is less than a tenth of this in 20 levels.
    const auto cosine = static_cast<float>(std::max(cone.cosine - 0x1p-18, 0.0));
    texels.nodes[3 * child] = boxed[2 * child];
    texels.nodes[3 * child + 1] = boxed[2 * child + 1];
    texels.nodes[3 * child + 2] = {glm::vec3(cone.axis), std::bit_cast<std::uint32_t>(cone.is_all() ? 0.0F : cosine)};
  });
  for (auto& list : texels.slots) list.resize(tree.leaves.size() * TriangleTree::kWidth);
  mesh::for_each_index(tree.leaves.size() * TriangleTree::kWidth, [&](std::size_t i) {
    const std::uint32_t number = tree.leaves[i / TriangleTree::kWidth][i % TriangleTree::kWidth];
    const bool used = number != TriangleTree::kNoTriangle;
    const EdgeRecord record = used ? records[number] : EdgeRecord{};
    const auto& [s, t] = record.sides;
    texels.slots[0][i] = {record.a * scale, s.plane};
    texels.slots[1][i] = {record.b * scale, t.plane};
    texels.slots[2][i] = {s.n, used ? 1U : 0U};
    texels.slots[3][i] = {s.anchor * scale, used ? 1U : 0U};
    texels.slots[4][i] = {t.n, used ? 1U : 0U};
    texels.slots[5][i] = {t.anchor * scale, used ? 1 + record.cut : 0U};
  });
  if (texels.nodes.empty()) texels.nodes.emplace_back();  // a buffer is never empty
  for (auto& list : texels.slots) {
    if (list.empty()) list.emplace_back();
  }
  return texels;
}

}  // namespace penumbra::volumes
