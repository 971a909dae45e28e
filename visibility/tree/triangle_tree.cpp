#include "visibility/tree/triangle_tree.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"

#include <embree3/rtcore.h>
#include <glm/common.hpp>

#include <algorithm>
#include <limits>
#include <new>
#include <utility>

namespace penumbra::visibility {
namespace {

/// A node while Embree builds: inner nodes hold children, leaves hold triangles. Lives in the builder's own memory.
struct Built {
  std::array<Built*, TriangleTree::kWidth> children{};
  std::array<RTCBounds, TriangleTree::kWidth> bounds{};
  std::array<std::uint32_t, TriangleTree::kWidth> triangles{};
  std::uint32_t count = 0;
  bool leaf = false;
};

Built* allocate(RTCThreadLocalAllocator allocator) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(Built), alignof(Built))) Built{};
}

void* create_node(RTCThreadLocalAllocator allocator, unsigned int count, void*) {
  Built* node = allocate(allocator);
  node->count = count;
  return node;
}

void set_children(void* node, void** children, unsigned int count, void*) {
  for (unsigned int i = 0; i < count; ++i) static_cast<Built*>(node)->children[i] = static_cast<Built*>(children[i]);
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned int count, void*) {
  for (unsigned int i = 0; i < count; ++i) static_cast<Built*>(node)->bounds[i] = *bounds[i];
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count, void*) {
  PENUMBRA_ASSERT(count <= TriangleTree::kWidth, "a leaf of {} triangles", count);
  Built* leaf = allocate(allocator);
  leaf->leaf = true;
  leaf->count = static_cast<std::uint32_t>(count);
  for (std::size_t i = 0; i < count; ++i) leaf->triangles[i] = primitives[i].primID;
  return leaf;
}

std::vector<RTCBuildPrimitive> primitives_of(const SceneFloats& scene) {
  std::vector<RTCBuildPrimitive> primitives;
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.casts_shadow[i] == 0) continue;
    const auto [a, b, c] = scene.corners(i);
    const glm::vec3 lower = glm::min(a, glm::min(b, c)), upper = glm::max(a, glm::max(b, c));
    primitives.push_back({lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z, i});
  }
  return primitives;
}

glm::vec3 lower_of(const RTCBounds& b) {
  return {b.lower_x, b.lower_y, b.lower_z};
}
glm::vec3 upper_of(const RTCBounds& b) {
  return {b.upper_x, b.upper_y, b.upper_z};
}

class Flattener {
 public:
  explicit Flattener(TriangleTree& tree) : tree_(&tree) {}

  std::uint32_t node(const Built& built, std::uint32_t depth) {
    tree_->depth = std::max(tree_->depth, depth);
    const auto index = static_cast<std::uint32_t>(tree_->nodes.size());
    tree_->nodes.emplace_back();
    for (std::uint32_t i = 0; i < built.count; ++i) {
      const Built& child = *built.children[i];
      const std::uint32_t reference = child.leaf ? leaf(child) : node(child, depth + 1);
      tree_->nodes[index][i] = {lower_of(built.bounds[i]), upper_of(built.bounds[i]), reference};
    }
    return index;
  }

  std::uint32_t leaf(const Built& built) {
    TriangleTree::Leaf slots;
    slots.fill(TriangleTree::kNoTriangle);
    std::copy_n(built.triangles.begin(), built.count, slots.begin());
    std::sort(slots.begin(), slots.end());  // kNoTriangle is the largest
    tree_->leaves.push_back(slots);
    return static_cast<std::uint32_t>(tree_->leaves.size() - 1) | TriangleTree::kLeafBit;
  }

 private:
  TriangleTree* tree_;
};

TriangleTree make_tree(std::vector<RTCBuildPrimitive> primitives) {
  TriangleTree tree;
  if (primitives.empty()) return tree;
  const std::size_t count = primitives.size();
  Bounds bounds_of_all{glm::vec3(std::numeric_limits<float>::max()), glm::vec3(std::numeric_limits<float>::lowest())};
  for (const RTCBuildPrimitive& p : primitives) {  // before the builder reorders and splits them
    bounds_of_all.lower = glm::min(bounds_of_all.lower, {p.lower_x, p.lower_y, p.lower_z});
    bounds_of_all.upper = glm::max(bounds_of_all.upper, {p.upper_x, p.upper_y, p.upper_z});
  }

  const RTCDevice device = rtcNewDevice(nullptr);
  if (device == nullptr)
    throw ResourceError("Embree cannot start (error {})", static_cast<int>(rtcGetDeviceError(nullptr)));
  const RTCBVH bvh = rtcNewBVH(device);
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
  arguments.maxBranchingFactor = TriangleTree::kWidth;
  arguments.maxDepth = 64;
  arguments.sahBlockSize = TriangleTree::kWidth;  // a leaf costs the same whether one lane is used or all
  arguments.minLeafSize = TriangleTree::kWidth;
  arguments.maxLeafSize = TriangleTree::kWidth;
  arguments.traversalCost = 1.0F;
  arguments.intersectionCost = 1.0F;
  arguments.bvh = bvh;
  arguments.primitives = primitives.data();
  arguments.primitiveCount = count;
  arguments.primitiveArrayCapacity = count;
  arguments.createNode = create_node;
  arguments.setNodeChildren = set_children;
  arguments.setNodeBounds = set_bounds;
  arguments.createLeaf = create_leaf;
  const auto* root = static_cast<const Built*>(rtcBuildBVH(&arguments));
  if (root != nullptr) {
    Flattener flattener(tree);
    if (root->leaf) {
      tree.nodes.emplace_back();
      tree.depth = 1;
      const auto [lower, upper] = bounds_of_all;
      tree.nodes[0][0] = {lower, upper, flattener.leaf(*root)};
    } else {
      flattener.node(*root, 1);
    }
  }
  rtcReleaseBVH(bvh);
  rtcReleaseDevice(device);
  if (root == nullptr) throw ResourceError("no memory for the hierarchy over {} boxes", count);
  return tree;
}

}  // namespace

TriangleTree make_triangle_tree(const SceneFloats& scene) {
  return make_tree(primitives_of(scene));
}

TriangleTree make_tree_over(std::span<const Bounds> boxes) {
  std::vector<RTCBuildPrimitive> primitives;
  primitives.reserve(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    const auto& [lower, upper] = boxes[i];
    primitives.push_back({lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z, i});
  }
  return make_tree(std::move(primitives));
}

}  // namespace penumbra::visibility
