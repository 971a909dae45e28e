// SPDX-License-Identifier: Apache-2.0
// Uploads a hierarchy of edges, cuts it at a light's plane, and restores it for the next light.

#include "volumes/edges/device/edge_upload.hpp"

#include "visibility/tree/triangle_tree.hpp"

#include <algorithm>
#include <span>

namespace penumbra::volumes {
namespace {

using visibility::Texel;
using visibility::TriangleTree;

constexpr std::uint32_t kPerChild = 3;  // number of texels of a node's child
constexpr std::uint32_t kNear = 1024;   // unchanged texels between two changes that are cheaper to write than to skip
constexpr std::size_t kUsedList = 2;    // list of EdgeTexels::slots whose integers mark used slots
constexpr std::size_t kLists = 6;

}  // namespace

/// Adapter for cut_hierarchy: drops children and records of the uploaded texels.
class EdgeUpload::Dropping {
 public:
  Dropping(EdgeUpload& edges, float scale) : edges_(edges), texels_(edges.texels_), scale_(scale) {}

  [[nodiscard]] static std::vector<std::uint32_t> roots() { return {0}; }
  [[nodiscard]] std::uint32_t reference(std::uint32_t node, std::uint32_t child) const {
    return texels_.nodes[texel(node, child)].number;
  }
  [[nodiscard]] glm::vec3 middle(std::uint32_t node, std::uint32_t child) const {
    return texels_.nodes[texel(node, child)].value;
  }
  [[nodiscard]] glm::vec3 half(std::uint32_t node, std::uint32_t child) const {
    return texels_.nodes[texel(node, child) + 1].value;
  }
  void drop_child(std::uint32_t node, std::uint32_t child) {
    const std::uint32_t at = texel(node, child);
    edges_.dropped_nodes_.emplace_back(at, std::exchange(texels_.nodes[at].number, TriangleTree::kNoChild));
  }

  [[nodiscard]] bool has_record(std::uint32_t leaf, std::uint32_t slot) const {
    return texels_.slots[kUsedList][leaf * TriangleTree::kWidth + slot].number != 0;
  }
  [[nodiscard]] EdgeRecord record(std::uint32_t leaf, std::uint32_t slot) const {
    const std::size_t at = std::size_t{leaf} * TriangleTree::kWidth + slot;
    const auto& lists = texels_.slots;
    EdgeRecord record{lists[0][at].value / scale_, lists[1][at].value / scale_, {}};
    for (std::size_t i = 0; i < 2; ++i) {
      record.sides[i] = {lists[2 + 2 * i][at].value, lists[3 + 2 * i][at].value / scale_, lists[i][at].number};
    }
    return record;
  }
  void drop_record(std::uint32_t leaf, std::uint32_t slot) {
    const std::uint32_t at = leaf * TriangleTree::kWidth + slot;
    texels_.slots[kUsedList][at].number = 0;
    edges_.dropped_slots_.push_back(at);
  }

 private:
  static std::uint32_t texel(std::uint32_t node, std::uint32_t child) {
    return kPerChild * (node * TriangleTree::kWidth + child);
  }

  EdgeUpload& edges_;
  EdgeTexels& texels_;
  float scale_;
};

EdgeUpload::EdgeUpload(const render::Device& device, EdgeTexels texels)
    : device_(&device),
      texels_(std::move(texels)),
      whole_depth_(texels_.depth),
      whole_nodes_(texels_.nodes.size()),
      whole_slots_(texels_.slots[0].size()) {
  write_all({}, {});
}

void EdgeUpload::restore() {
  if (!std::exchange(is_cut_, false)) return;
  root_ = 0;
  texels_.depth = whole_depth_;
  texels_.nodes.resize(whole_nodes_);
  for (Texels& list : texels_.slots) list.resize(whole_slots_);
  std::vector<std::uint32_t> nodes;
  for (const auto& [texel, reference] : dropped_nodes_) {
    texels_.nodes[texel].number = reference;
    nodes.push_back(texel);
  }
  for (const std::uint32_t slot : dropped_slots_) texels_.slots[kUsedList][slot].number = 1;
  write_all(nodes, dropped_slots_);
  dropped_nodes_.clear();
  dropped_slots_.clear();
}

void EdgeUpload::cut(const CutInput& input) {
  restore();
  if (texels_.depth == 0) return;  // nothing casts shadows
  is_cut_ = true;
  std::vector<EdgeRecord> records =
      edges_in_plane(input.scene, input.casters, triangles_across(input), input.side, nullptr);
  Dropping dropping(*this, input.side.scale);
  cut_hierarchy(dropping, input.side, nullptr, records);
  if (!records.empty()) append(edge_texels(records, input.side.scale));
  std::vector<std::uint32_t> nodes;
  for (const auto& [texel, reference] : dropped_nodes_) nodes.push_back(texel);
  write_all(nodes, dropped_slots_);
}

/// Appends a second tree, and adds a root above both trees.
void EdgeUpload::append(const EdgeTexels& more) {
  const auto first_node = static_cast<std::uint32_t>(whole_nodes_ / kPerChild / TriangleTree::kWidth);
  const auto first_leaf = static_cast<std::uint32_t>(whole_slots_ / TriangleTree::kWidth);
  for (std::size_t i = 0; i < more.nodes.size(); ++i) {
    Texel texel = more.nodes[i];
    if (i % kPerChild == 0 && texel.number != TriangleTree::kNoChild) {
      texel.number += (texel.number & TriangleTree::kLeafBit) != 0 ? first_leaf : first_node;
    }
    texels_.nodes.push_back(texel);
  }
  for (std::size_t i = 0; i < kLists; ++i) {
    texels_.slots[i].insert(texels_.slots[i].end(), more.slots[i].begin(), more.slots[i].end());
  }
  texels_.depth = std::max(texels_.depth, more.depth);
  add_root(0, first_node);
}

/// Adds a root above two nodes, with boxes around the whole scene and cones that contain all directions.
void EdgeUpload::add_root(std::uint32_t first, std::uint32_t second) {
  root_ = static_cast<std::uint32_t>(texels_.nodes.size() / kPerChild / TriangleTree::kWidth);
  const float everything = 2;  // visibility::device_scale
  for (std::uint32_t child = 0; child < TriangleTree::kWidth; ++child) {
    const std::uint32_t reference = child == 0 ? first : child == 1 ? second : TriangleTree::kNoChild;
    texels_.nodes.push_back({glm::vec3(0), reference});
    texels_.nodes.push_back({glm::vec3(child < 2 ? everything : 0), 0});
    texels_.nodes.push_back({glm::vec3(0), 0});  // cosine 0
  }
  ++texels_.depth;
}

void EdgeUpload::write_all(const std::vector<std::uint32_t>& nodes, const std::vector<std::uint32_t>& slots) {
  write(nodes_, "edge nodes", texels_.nodes, nodes, whole_nodes_);
  for (std::size_t i = 0; i < kLists; ++i) {
    write(slots_[i], "edges", texels_.slots[i], i == kUsedList ? slots : std::vector<std::uint32_t>{}, whole_slots_);
  }
}

void EdgeUpload::write(std::unique_ptr<render::Buffer>& buffer, const char* name, const Texels& texels,
                       std::vector<std::uint32_t> changed, std::size_t first_new) const {
  const std::span<const Texel> all(texels);
  const bool is_new = !buffer;
  if (is_new || buffer->bytes() < all.size_bytes()) {
    // Reserves space for the cut edges of later lights.
    const std::size_t room = is_new ? all.size() : all.size() + (all.size() - std::min(first_new, all.size()));
    render::grow(*device_, buffer, name, room * sizeof(Texel), render::BufferUse::texels);
    buffer->write(all);
    return;
  }
  for (auto i = static_cast<std::uint32_t>(first_new); i < all.size(); ++i) changed.push_back(i);
  std::ranges::sort(changed);
  for (std::size_t begin = 0; begin < changed.size();) {
    std::size_t end = begin + 1;
    while (end < changed.size() && changed[end] - changed[end - 1] <= kNear) ++end;
    const auto part = all.subspan(changed[begin], changed[end - 1] - changed[begin] + 1);
    buffer->write(part, changed[begin] * sizeof(Texel));
    begin = end;
  }
}

}  // namespace penumbra::volumes
