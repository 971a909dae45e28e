// SPDX-License-Identifier: Apache-2.0
// Builds a binary hierarchy over light samples by dividing them in halves at whole words of masks.

#include "vsm/light_tree.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>

namespace penumbra::vsm {
namespace {

constexpr std::uint32_t kWord = 32;

/// Returns the position at which `count` light samples are halved: a whole word.
std::uint32_t half_of(std::uint32_t count) {
  const std::uint32_t words = (count + kWord - 1) / kWord;
  return words / 2 * kWord;
}

struct Span2 {
  glm::dvec2 lower, upper;
};

template <typename Place>
Span2 span_of(std::uint32_t begin, std::uint32_t end, const Place& place) {
  Span2 span{place(begin), place(begin)};
  for (std::uint32_t i = begin; i < end; ++i) {
    span.lower = glm::min(span.lower, place(i));
    span.upper = glm::max(span.upper, place(i));
  }
  return span;
}

void sort_part(std::vector<std::uint32_t>& order, const std::vector<glm::dvec2>& places, std::uint32_t begin,
               std::uint32_t end) {
  if (end - begin <= kWord) return;
  const Span2 span = span_of(begin, end, [&](std::uint32_t i) { return places[order[i]]; });
  const int axis = span.upper.x - span.lower.x >= span.upper.y - span.lower.y ? 0 : 1;
  const std::uint32_t middle = begin + half_of(end - begin);
  const auto at = [&](std::uint32_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
    return places[a][axis] < places[b][axis] || (places[a][axis] == places[b][axis] && a < b);
  });
  sort_part(order, places, begin, middle);
  sort_part(order, places, middle, end);
}

void build(LightTree& tree, const std::vector<glm::dvec2>& places, std::uint32_t begin, std::uint32_t end) {
  const std::size_t own = tree.nodes.size();
  tree.nodes.emplace_back();
  std::uint32_t right = 0;
  if (end - begin > kWord) {
    const std::uint32_t middle = begin + half_of(end - begin);
    build(tree, places, begin, middle);
    right = static_cast<std::uint32_t>(tree.nodes.size());
    build(tree, places, middle, end);
  }
  LightTree::Node& node = tree.nodes[own];
  const auto [lower, upper] = span_of(begin, end, [&](std::uint32_t i) { return places[i]; });
  node.corners = {tree.box.at(lower), tree.box.at({upper.x, lower.y}), tree.box.at(upper),
                  tree.box.at({lower.x, upper.y})};
  node.lower = lower;
  node.upper = upper;
  node.middle = tree.box.at(0.5 * (lower + upper));
  node.radius = 0.5 * glm::length(upper - lower);
  node.word = begin / kWord;
  node.words = (end - begin + kWord - 1) / kWord;
  node.right = right;
}

std::vector<glm::dvec2> places_of(const visibility::Light& light, const pairs::LightBox& box) {
  std::vector<glm::dvec2> places;
  for (const glm::vec3& l : light.points) places.push_back(box.sample(l));
  return places;
}

}  // namespace

std::vector<std::uint32_t> compact_order(const visibility::Light& light) {
  std::vector<std::uint32_t> order(light.points.size());
  std::iota(order.begin(), order.end(), 0U);
  sort_part(order, places_of(light, pairs::make_light_box(light)), 0, static_cast<std::uint32_t>(order.size()));
  return order;
}

LightTree make_light_tree(const visibility::Light& light) {
  LightTree tree{pairs::make_light_box(light), {}};
  build(tree, places_of(light, tree.box), 0, static_cast<std::uint32_t>(light.points.size()));
  return tree;
}

}  // namespace penumbra::vsm
