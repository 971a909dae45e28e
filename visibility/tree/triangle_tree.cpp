#include "visibility/tree/triangle_tree.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/pages.hpp"
#include "base/parallel.hpp"

#include <embree3/rtcore.h>
#include <glm/common.hpp>
#include <tbb/task_group.h>

#include <algorithm>
#include <limits>
#include <new>
#include <utility>

namespace penumbra::visibility {
namespace {

/// A node or a leaf while Embree builds, in the builder's own memory: what is below it, itself included.
struct Built {
  std::uint32_t nodes = 0, leaves = 0, depth = 0;
  [[nodiscard]] bool is_leaf() const { return nodes == 0; }
};
struct BuiltNode : Built {
  std::array<Built*, TriangleTree::kWidth> children{};
  std::array<RTCBounds, TriangleTree::kWidth> bounds{};
  std::uint32_t count = 0;
};
struct BuiltLeaf : Built {
  TriangleTree::Leaf triangles{};
};

template <typename Made>
Made* allocate(RTCThreadLocalAllocator allocator) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(Made), alignof(Made))) Made{};
}

void* create_node(RTCThreadLocalAllocator allocator, unsigned int count, void*) {
  BuiltNode* node = allocate<BuiltNode>(allocator);
  node->count = count;
  return static_cast<Built*>(node);
}

/// Children are complete by now.
void set_children(void* made, void** children, unsigned int count, void*) {
  auto* node = static_cast<BuiltNode*>(static_cast<Built*>(made));
  node->nodes = 1;
  for (unsigned int i = 0; i < count; ++i) {
    const auto* child = node->children[i] = static_cast<Built*>(children[i]);
    node->nodes += child->nodes;
    node->leaves += child->leaves;
    node->depth = std::max(node->depth, child->depth);
  }
  ++node->depth;
}

void set_bounds(void* made, const RTCBounds** bounds, unsigned int count, void*) {
  auto* node = static_cast<BuiltNode*>(static_cast<Built*>(made));
  for (unsigned int i = 0; i < count; ++i) node->bounds[i] = *bounds[i];
}

glm::vec3 lower_of(const RTCBuildPrimitive& p) {
  return {p.lower_x, p.lower_y, p.lower_z};
}
glm::vec3 upper_of(const RTCBuildPrimitive& p) {
  return {p.upper_x, p.upper_y, p.upper_z};
}

/// Primitives with what they are divided by: twice their middles.
struct Divided {
  glm::vec3 middle;
  const RTCBuildPrimitive* primitive;
};

Built* make_leaf(RTCThreadLocalAllocator allocator, std::span<const Divided> primitives) {
  BuiltLeaf* leaf = allocate<BuiltLeaf>(allocator);
  leaf->leaves = 1;
  leaf->triangles.fill(TriangleTree::kNoTriangle);
  for (std::size_t i = 0; i < primitives.size(); ++i) leaf->triangles[i] = primitives[i].primitive->primID;
  std::sort(leaf->triangles.begin(), leaf->triangles.end());  // kNoTriangle is the largest
  return leaf;
}

/// Full leaves but for the last, in halves along the longest side of their middles.
void make_leaves(RTCThreadLocalAllocator allocator, std::span<Divided> primitives, BuiltNode& node) {
  const std::size_t leaves = (primitives.size() + TriangleTree::kWidth - 1) / TriangleTree::kWidth;
  glm::vec3 lower(std::numeric_limits<float>::infinity()), upper = -lower;
  if (leaves > 1) {
    for (const Divided& one : primitives) lower = glm::min(lower, one.middle), upper = glm::max(upper, one.middle);
    const glm::vec3 extent = upper - lower;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::size_t first = leaves / 2 * TriangleTree::kWidth;
    std::nth_element(primitives.begin(), primitives.begin() + static_cast<std::ptrdiff_t>(first), primitives.end(),
                     [&](const Divided& x, const Divided& y) {
                       if (x.middle[axis] != y.middle[axis]) return x.middle[axis] < y.middle[axis];
                       return x.primitive->primID < y.primitive->primID;
                     });
    make_leaves(allocator, primitives.first(first), node);
    make_leaves(allocator, primitives.subspan(first), node);
    return;
  }
  for (const Divided& one : primitives) {
    lower = glm::min(lower, lower_of(*one.primitive));
    upper = glm::max(upper, upper_of(*one.primitive));
  }
  node.bounds[node.count] = {lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z, 0};
  node.children[node.count++] = make_leaf(allocator, primitives);
}

/// Of so many and fewer the heuristic says little that is worth its time, which is three quarters of a whole build:
/// what is left is divided in halves.
constexpr std::size_t kLastTriangles = 4 * TriangleTree::kWidth;
static_assert(kLastTriangles <= RTC_BUILD_MAX_PRIMITIVES_PER_LEAF);

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count, void*) {
  PENUMBRA_ASSERT(count <= kLastTriangles, "a leaf of {} triangles", count);
  std::array<Divided, kLastTriangles> all;
  for (std::size_t i = 0; i < count; ++i) all[i] = {lower_of(primitives[i]) + upper_of(primitives[i]), primitives + i};
  const std::span<Divided> divided = std::span(all).first(count);
  if (count <= TriangleTree::kWidth) return make_leaf(allocator, divided);
  BuiltNode* node = allocate<BuiltNode>(allocator);
  make_leaves(allocator, divided, *node);
  node->nodes = node->depth = 1;
  node->leaves = node->count;
  return static_cast<Built*>(node);
}

RTCBuildPrimitive primitive_of(const Bounds& box, std::uint32_t number) {
  const auto& [lower, upper] = box;
  return {lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z, number};
}

std::vector<RTCBuildPrimitive> primitives_of(const SceneFloats& scene) {
  std::vector<std::uint32_t> casters;
  casters.reserve(scene.triangles.size());
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.casts_shadow[i] != 0) casters.push_back(i);
  }
  std::vector<RTCBuildPrimitive> primitives(casters.size());
  mesh::for_each_index(casters.size(), [&](std::size_t i) {
    const auto [a, b, c] = scene.corners(casters[i]);
    primitives[i] = primitive_of({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))}, casters[i]);
  });
  return primitives;
}

glm::vec3 lower_of(const RTCBounds& b) {
  return {b.lower_x, b.lower_y, b.lower_z};
}
glm::vec3 upper_of(const RTCBounds& b) {
  return {b.upper_x, b.upper_y, b.upper_z};
}

/// Puts nodes and leaves into their places: depth first, so that the leaves below a node follow one another.
class Flattener {
 public:
  explicit Flattener(TriangleTree& tree) : tree_(&tree) {}

  void node(const BuiltNode& built, std::uint32_t number, std::uint32_t first_leaf) {
    constexpr std::uint32_t kTask = 1024;  // nodes worth one
    if (built.nodes <= kTask) return children(built, number, first_leaf, [](const auto& below) { below(); });
    tbb::task_group tasks;
    children(built, number, first_leaf, [&](const auto& below) { tasks.run(below); });
    tasks.wait();
  }

  void leaf(const BuiltLeaf& built, std::uint32_t number) { tree_->leaves[number] = built.triangles; }

 private:
  template <typename Run>
  void children(const BuiltNode& built, std::uint32_t number, std::uint32_t first_leaf, const Run& run) {
    std::uint32_t next_node = number + 1, next_leaf = first_leaf;
    for (std::uint32_t i = 0; i < built.count; ++i) {
      const Built& child = *built.children[i];
      const std::uint32_t reference = child.is_leaf() ? next_leaf | TriangleTree::kLeafBit : next_node;
      tree_->nodes[number][i] = {lower_of(built.bounds[i]), upper_of(built.bounds[i]), reference};
      if (child.is_leaf())
        leaf(static_cast<const BuiltLeaf&>(child), next_leaf);
      else
        run([this, &child, next_node, next_leaf] { node(static_cast<const BuiltNode&>(child), next_node, next_leaf); });
      next_node += child.nodes;
      next_leaf += child.leaves;
    }
  }

  TriangleTree* tree_;
};

TriangleTree make_tree(std::vector<RTCBuildPrimitive> primitives) {
  TriangleTree tree;
  if (primitives.empty()) return tree;
  const std::size_t count = primitives.size();
  Bounds bounds_of_all{glm::vec3(std::numeric_limits<float>::max()), glm::vec3(std::numeric_limits<float>::lowest())};
  for (const RTCBuildPrimitive& p : std::span(primitives).first(std::min<std::size_t>(count, TriangleTree::kWidth))) {
    // of one leaf; before the builder reorders and splits them
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
  arguments.minLeafSize = kLastTriangles;
  arguments.maxLeafSize = kLastTriangles;
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
    resize_on_all_cores(tree.leaves, root->leaves);
    resize_on_all_cores(tree.nodes, std::max(root->nodes, 1U));
    tree.depth = std::max(root->depth, 1U);
    if (root->is_leaf()) {
      const auto [lower, upper] = bounds_of_all;
      tree.nodes[0][0] = {lower, upper, TriangleTree::kLeafBit};
      flattener.leaf(static_cast<const BuiltLeaf&>(*root), 0);
    } else {
      flattener.node(static_cast<const BuiltNode&>(*root), 0, 0);
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
  std::vector<RTCBuildPrimitive> primitives(boxes.size());
  mesh::for_each_index(boxes.size(),
                       [&](std::size_t i) { primitives[i] = primitive_of(boxes[i], static_cast<std::uint32_t>(i)); });
  return make_tree(std::move(primitives));
}

}  // namespace penumbra::visibility
