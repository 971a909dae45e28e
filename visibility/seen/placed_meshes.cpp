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

constexpr std::uint32_t kTrianglesOfLeaf = 4, kPartsOfLeaf = 1;

BoxTree tree_of(const mesh::TriangleSoup& soup) {
  std::vector<MiddleBox> boxes;
  boxes.reserve(soup.triangles.size());
  for (const auto& [a, b, c] : soup.triangles) {
    const glm::dvec3 &x = soup.positions[a], &y = soup.positions[b], &z = soup.positions[c];
    const glm::dvec3 lower = glm::min(x, glm::min(y, z)), upper = glm::max(x, glm::max(y, z));
    boxes.push_back({0.5 * (lower + upper), 0.5 * (upper - lower)});
  }
  return {boxes, kTrianglesOfLeaf};
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

PlacedMeshes::PlacedMeshes(const scenes::Scene& scene, const scenes::Instances& instances)
    : scene_(scene), instances_(instances), own_(tree_of(scene.soup)) {
  trees_.reserve(instances.meshes.size());
  for (const scenes::SharedMesh& mesh : instances.meshes) trees_.push_back(tree_of(mesh.soup));
  if (!own_.empty()) {
    parts_.push_back({.soup = &scene.soup, .tree = &own_});
    triangles_ = scene.soup.triangles.size();
  }
  for (const scenes::Instance& instance : instances.all) {
    const mesh::TriangleSoup& soup = instances.meshes[instance.mesh].soup;
    Part part{.soup = &soup, .tree = &trees_[instance.mesh], .instance = &instance, .first_bit = triangles_};
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
  }
  measure();
  place();
}

void PlacedMeshes::measure() {
  for (int axis = 0; axis < 3; ++axis) {
    Extreme least(axis, -1), greatest(axis, 1);
    for (const glm::dvec3& position : scene_.soup.positions) least.add(position[axis]), greatest.add(position[axis]);
    for (const Part& part : parts_) {
      if (part.instance == nullptr) continue;
      least.add(part, part.instance->placement);
      greatest.add(part, part.instance->placement);
    }
    lower_[axis] = least.value();
    upper_[axis] = greatest.value();
  }
  origin_ = scene_.origin.value_or(0.5 * lower_ + 0.5 * upper_);  // as in make_scene_floats
}

void PlacedMeshes::place() {
  std::vector<MiddleBox> boxes;
  double grains = 0;
  for (Part& part : parts_) {
    part.offset -= origin_;
    // Positions relative to the origin are rounded to float32 once.
    const MiddleBox world = part.box(part.tree->root().box);
    part.room += 0x1p-46 * sum_of_sides(origin_) + 0x1p-22 * sum_of_sides(glm::abs(world.middle) + world.half);
    boxes.push_back(part.box(part.tree->root().box));
    if (part.instance != nullptr || parts_.size() == 1)
      grains += part.tree->leaf_size() * std::cbrt(std::abs(glm::determinant(part.linear)));
  }
  grain_ = grains / static_cast<double>(std::max<std::size_t>(instances_.all.size(), 1));
  tree_ = BoxTree(boxes, kPartsOfLeaf);
}

std::array<glm::vec3, 3> PlacedMeshes::corners(const Part& part, std::uint32_t triangle) const {
  std::array<glm::vec3, 3> corners;
  const mesh::Triangle& of = part.soup->triangles[triangle];
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3& own = part.soup->positions[of[i]];
    const glm::dvec3 world = part.instance != nullptr ? part.instance->placement(own) : own;
    corners[i] = glm::vec3(world - origin_) + 0.0f;  // as in make_scene_floats
  }
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
  std::uint64_t bytes = own_.bytes() + tree_.bytes() + parts_.capacity() * sizeof(Part);
  for (const BoxTree& tree : trees_) bytes += tree.bytes();
  return bytes;
}

}  // namespace penumbra::visibility
