// SPDX-License-Identifier: Apache-2.0
// Places a scene's meshes without copies of instances: builds a tree over each mesh's triangles in the mesh's own space
// and one over all instances, and keeps trees over meshes that have not changed (docs/instances.md).

#include "visibility/seen/placed_meshes.hpp"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace penumbra::visibility {
namespace {

constexpr std::uint32_t kTrianglesOfLeaf = 2, kPartsOfLeaf = 1;

bool same_triangles(const mesh::TriangleSoup& one, const mesh::TriangleSoup& other) {
  return one.triangles == other.triangles && one.positions == other.positions;
}

/// Sets the inverse of the part's matrix, if that is precise enough.
void invert(PlacedMeshes::Part& part) {
  part.to_own = glm::inverse(part.linear);
  const glm::dmat3 rest = part.to_own * part.linear - glm::dmat3(1);
  const auto rows = [](const glm::dmat3& m) { return glm::abs(m[0]) + glm::abs(m[1]) + glm::abs(m[2]); };
  const auto largest = [](const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); };
  part.own_reach = rows(part.to_own);
  // The residual itself is rounded, by less than 2⁻⁵⁰ of the product of both matrices. False for NaN.
  part.has_own = largest(rows(rest)) <= 0x1p-34 && largest(part.own_reach) * largest(rows(part.linear)) <= 0x1p14;
}

/// Finds the largest coordinate along an axis, or the least (`sign` −1), of all positions beyond `best`.
class Extreme {
 public:
  Extreme(int axis, double sign) : axis_(axis), sign_(sign) {}

  void add(double coordinate) { best_ = std::max(best_, sign_ * coordinate); }
  /// Visits only leaves that may hold a better coordinate.
  void add(const PlacedMeshes::Part& part, const scenes::Placement& placement) {
    const auto may_be_beyond = [&](const MiddleBox& own) {
      const MiddleBox box = part.box(own);
      return sign_ * box.middle[axis_] + box.half[axis_] > best_;
    };
    part.tree->walk(may_be_beyond, [&](std::span<const std::uint32_t> triangles) {
      for (const std::uint32_t triangle : triangles) {
        for (const std::uint32_t position : part.soup->triangles[triangle])
          add(placement(part.soup->positions[position])[axis_]);
      }
    });
  }
  [[nodiscard]] double value() const { return sign_ * best_; }

 private:
  int axis_;
  double sign_, best_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

PlacedMeshes::MeshTree PlacedMeshes::tree_of(const mesh::TriangleSoup& soup) {
  std::vector<MiddleBox> boxes;
  boxes.reserve(soup.triangles.size());
  double sides = 0;
  for (const auto& [a, b, c] : soup.triangles) {
    const glm::dvec3 &x = soup.positions[a], &y = soup.positions[b], &z = soup.positions[c];
    const glm::dvec3 lower = glm::min(x, glm::min(y, z)), upper = glm::max(x, glm::max(y, z));
    boxes.push_back({0.5 * (lower + upper), 0.5 * (upper - lower)});
    sides += sum_of_sides(boxes.back().half);
  }
  // Four neighbours cover an area four times as large.
  return {nullptr, {boxes, kTrianglesOfLeaf}, 2 * sides / static_cast<double>(std::max<std::size_t>(boxes.size(), 1))};
}

/// Keeps the trees over meshes that the previous scene had as well, at any index. Meshes at the same index are also
/// compared by content, since readers make new objects for each frame.
void PlacedMeshes::find_trees() {
  std::vector<MeshTree> before = std::exchange(trees_, {});
  trees_.reserve(instances_->meshes.size());
  trees_built_ = 0;
  for (std::size_t i = 0; i < instances_->meshes.size(); ++i) {
    const auto& mesh = instances_->meshes[i];
    const auto is_same = [&](const MeshTree& tree) {
      return tree.mesh && (tree.mesh == mesh || same_triangles(tree.mesh->soup, mesh->soup));
    };
    const auto at_hand = before.begin() + static_cast<std::ptrdiff_t>(std::min(i, before.size()));
    const bool stayed = at_hand != before.end() && is_same(*at_hand);
    const auto same = stayed ? at_hand : std::ranges::find(before, mesh, &MeshTree::mesh);
    if (same != before.end()) {
      trees_.push_back(std::move(*same));
    } else {
      trees_.push_back(tree_of(mesh->soup));
      ++trees_built_;
    }
    trees_.back().mesh = mesh;
  }
}

void PlacedMeshes::place(const scenes::Scene& scene, const scenes::Instances& instances) {
  leave();
  scene_ = &scene;
  instances_ = &instances;
  own_ = tree_of(scene.soup);
  find_trees();
  if (!own_.tree.empty()) {
    parts_.push_back({.soup = &scene.soup, .tree = &own_.tree});
    triangles_ = scene.soup.triangles.size();
  }
  for (const scenes::Instance& instance : instances.all) {
    const mesh::TriangleSoup& soup = instances.meshes[instance.mesh]->soup;
    Part part{.soup = &soup, .tree = &trees_[instance.mesh].tree, .instance = &instance, .first_bit = triangles_};
    part.linear = glm::dmat3(instance.placement.to_world);
    part.wide = glm::dmat3(glm::abs(part.linear[0]), glm::abs(part.linear[1]), glm::abs(part.linear[2]));
    part.offset = glm::dvec3(instance.placement.to_world[3]);
    parts_.push_back(part);
    triangles_ += soup.triangles.size();
  }
  // Measures in the world first: the origin follows from this.
  for (Part& part : parts_) {
    const MiddleBox& root = part.tree->root().box;
    part.room = 0x1p-46 * (sum_of_sides(part.wide * (glm::abs(root.middle) + root.half)) + sum_of_sides(part.offset));
    invert(part);
  }
  measure();
  put_in_world();
}

void PlacedMeshes::leave() {
  scene_ = nullptr;
  instances_ = nullptr;
  own_ = {};
  parts_.clear();
  tree_ = {};
  triangles_ = 0;
}

void PlacedMeshes::measure() {
  for (int axis = 0; axis < 3; ++axis) {
    Extreme least(axis, -1), greatest(axis, 1);
    for (const glm::dvec3& position : scene_->soup.positions) least.add(position[axis]), greatest.add(position[axis]);
    for (const Part& part : parts_) {
      if (part.instance == nullptr) continue;
      least.add(part, part.instance->placement);
      greatest.add(part, part.instance->placement);
    }
    lower_[axis] = least.value();
    upper_[axis] = greatest.value();
  }
  origin_ = scene_->origin.value_or(0.5 * lower_ + 0.5 * upper_);  // as in make_scene_floats
}

void PlacedMeshes::put_in_world() {
  std::vector<MiddleBox> boxes;
  double grains = 0;
  for (Part& part : parts_) {
    part.offset -= origin_;
    // Positions relative to the origin are rounded to float32 once.
    const MiddleBox world = part.box(part.tree->root().box);
    part.room += 0x1p-46 * sum_of_sides(origin_) + 0x1p-22 * sum_of_sides(glm::abs(world.middle) + world.half);
    part.in_world = part.box(part.tree->root().box);
    boxes.push_back(part.in_world);
    const double grain = part.instance != nullptr ? trees_[part.instance->mesh].grain : own_.grain;
    if (part.instance != nullptr || parts_.size() == 1)
      grains += grain * std::cbrt(std::abs(glm::determinant(part.linear)));
  }
  grain_ = grains / static_cast<double>(std::max<std::size_t>(instances_->all.size(), 1));
  tree_ = BoxTree(boxes, kPartsOfLeaf);
}

glm::vec3 PlacedMeshes::position(const Part& part, std::size_t number) const {
  const glm::dvec3& own = part.soup->positions[number];
  const glm::dvec3 world = part.instance != nullptr ? part.instance->placement(own) : own;
  return glm::vec3(world - origin_) + 0.0f;  // as in make_scene_floats
}

std::array<glm::vec3, 3> PlacedMeshes::corners(const Part& part, std::uint32_t triangle) const {
  std::array<glm::vec3, 3> corners;
  const mesh::Triangle& of = part.soup->triangles[triangle];
  for (std::size_t i = 0; i < 3; ++i) corners[i] = position(part, of[i]);
  const auto put_in_order = [](glm::vec3& a, glm::vec3& b) {
    const bool less = b.x != a.x ? b.x < a.x : b.y != a.y ? b.y < a.y : b.z < a.z;
    if (less) std::swap(a, b);
  };
  put_in_order(corners[0], corners[1]);
  put_in_order(corners[1], corners[2]);
  put_in_order(corners[0], corners[1]);
  return corners;
}

std::uint64_t PlacedMeshes::bytes() const {
  std::uint64_t bytes = own_.tree.bytes() + tree_.bytes() + parts_.capacity() * sizeof(Part);
  for (const MeshTree& mesh : trees_) bytes += mesh.tree.bytes();
  return bytes;
}

}  // namespace penumbra::visibility
