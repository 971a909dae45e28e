// SPDX-License-Identifier: Apache-2.0
// S. Laine and T. Aila, Hierarchical penumbra casting, Computer Graphics Forum 24 (3), 2005: traverses the Cartesian
// product of light samples and view samples. For one triangle at a time, pairs of boxes that the triangle is certainly
// between, or certainly not between, are decided as a whole; the others are divided.
//
// Departures. Every test has an error bound; open pairs of a leaf are decided by BlockedSamples, exactly. Cores share
// subtrees of view samples, and each handles the triangles near the hull of its subtree and the light.

#include "vsm/methods.hpp"

#include "engines/pairs/pair_method.hpp"
#include "visibility/method_repairs.hpp"
#include "vsm/box_planes.hpp"
#include "vsm/light_shaft.hpp"
#include "vsm/light_tree.hpp"
#include "vsm/receiver_tree.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <mutex>
#include <vector>

namespace penumbra::vsm {
namespace {

using pairs::PairCounts;

constexpr std::uint32_t kSubtrees = 256;  // approximate number of subtrees of view samples that cores share
constexpr std::uint32_t kLeafWords = 8;   // words of masks that are tested together against a leaf's view samples

visibility::MeshVerdict hierarchical_penumbra_verdict(const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::exact,
          visibility::reason_with("every pair is decided exactly, for every mesh", mesh,
                                  {{mesh.boundary_loops, "open boundaries, where light passes as it should"},
                                   {mesh.zero_area_triangles.count, "triangles without area, which cast no shadow"}})};
}

visibility::MethodDescription describe_hierarchical_penumbra() {
  return {.name = "hierarchical-penumbra",
          .family = visibility::Family::geometry,
          .paper = "Laine and Aila 2005",
          .output = visibility::Output::mask,
          .exact_for = "every pair of view sample and light sample, for any triangle soup",
          .lights = visibility::kEveryLight - visibility::kBodies - visibility::kDomes,
          .on_request = true,
          .options = {},
          .verdict_on = hierarchical_penumbra_verdict,
          .repairs = visibility::exact_pair_repairs};
}

PlaceBox around(const PlaceBox& a, const PlaceBox& b) {
  return {glm::min(a.lower, b.lower), glm::max(a.upper, b.upper)};
}

struct BoxCounts {
  std::uint64_t looks = 0, beside = 0, hidden = 0, hidden_pairs = 0, done = 0;
};

class HierarchicalPenumbra final : public pairs::PairMethod {
 public:
  explicit HierarchicalPenumbra(const visibility::MethodOptions& options)
      : PairMethod(describe_hierarchical_penumbra(), "cast penumbrae") {
    visibility::parse_options(description(), options);
  }

 private:
  std::vector<std::uint32_t> light_order(const visibility::Light& light) override { return compact_order(light); }
  void prepare_casters() override;
  void block(std::span<const std::uint32_t> pixels, std::map<std::string, std::uint64_t>& counters) override;

  /// One core's work: each triangle in turn against a subtree of view samples.
  class Caster;

  LightTree lights_;
  LightShaft shaft_;
  std::vector<PlaceBox> triangles_;  // for each triangle of the scene, in the light's axes
  ReceiverTree receivers_;
  std::vector<PlaceBox> places_, leaf_places_;  // boxes of the receiver tree's nodes; places of its pixels, in its
                                                // order
  std::vector<std::uint32_t> alive_;  // words() for each node: light samples that one of its view samples may still see
};

class HierarchicalPenumbra::Caster {
 public:
  explicit Caster(HierarchicalPenumbra& method)
      : method_(method),
        lights_(method.lights_),
        receivers_(method.receivers_),
        planes_(lights_.nodes.size()),
        made_for_(lights_.nodes.size(), 0) {}

  void cast(std::uint32_t triangle, std::uint32_t root) {
    triangle_ = triangle;
    ++number_;
    const auto corners = method_.scene().corners(triangle);
    for (std::size_t i = 0; i < 3; ++i) corners_[i] = glm::dvec3(corners[i]);
    middle_ = (corners_[0] + corners_[1] + corners_[2]) / 3.0;
    plane_bit_ = std::uint64_t{1} << method_.scene().plane[triangle] % 64;
    visit(0, root, BoxPlanes::kAll);
  }

  PairCounts pairs;
  BoxCounts boxes;

 private:
  using LightNode = LightTree::Node;
  using Receivers = ReceiverTree::Node;

  [[nodiscard]] std::span<std::uint32_t> alive(std::uint32_t receivers, const LightNode& light) const {
    return std::span(method_.alive_).subspan(receivers * method_.words() + light.word, light.words);
  }
  const BoxPlanes& planes_of(std::uint32_t light) {
    if (made_for_[light] != number_) {
      made_for_[light] = number_;
      planes_[light] = BoxPlanes(corners_, lights_, lights_.nodes[light]);
    }
    return planes_[light];
  }

  /// Tests the light samples of one node against the view samples of another.
  void visit(std::uint32_t light, std::uint32_t receivers, std::uint32_t open) {
    const LightNode& l = lights_.nodes[light];
    const Receivers& r = receivers_.nodes[receivers];
    if (std::ranges::all_of(alive(receivers, l), [](std::uint32_t word) { return word == 0; })) {
      ++boxes.done;
      return;
    }
    ++boxes.looks;
    if (!method_.shaft_.meets(method_.places_[receivers], method_.triangles_[triangle_], l.lower, l.upper)) {
      ++boxes.beside;
      return;
    }
    const BoxPlanes& planes = planes_of(light);
    const BoxPlanes::Answer answer = planes.look(r, open);
    if (answer == BoxPlanes::Answer::beside) {
      ++boxes.beside;
      return;
    }
    // The triangle does not hide view samples whose carrier is in its own plane; boxes know such planes only up to
    // rounding.
    if (answer == BoxPlanes::Answer::hidden && (r.planes & plane_bit_) == 0) {
      ++boxes.hidden;
      boxes.hidden_pairs += std::uint64_t{32} * l.words * r.count();
      for (std::uint32_t node = receivers; node < r.end_node; ++node) std::ranges::fill(alive(node, l), 0U);
      for (std::uint32_t i = r.begin; i < r.end; ++i)
        std::ranges::fill(method_.visible(receivers_.pixels[i]).subspan(l.word, l.words), 0U);
      return;
    }
    if (r.is_leaf() && (l.words <= kLeafWords || l.is_leaf())) return try_leaf(l, receivers);
    if (!l.is_leaf() && (r.is_leaf() || !planes.one_side() || light_is_larger(l, r))) {
      // If the box is certainly in an edge's half-spaces of all four corners, it is in those of any part of the light,
      // too; the triangle's plane does not depend on the light.
      std::uint32_t inherited = planes.one_side() ? open & 1U << 12 : 1U << 12;
      for (std::uint32_t e = 0; e < 3; ++e) {
        if (!planes.one_side() || (open >> 4 * e & 15) != 0) inherited |= 15U << 4 * e;
      }
      visit(light + 1, receivers, inherited);
      visit(l.right, receivers, inherited);
      return;
    }
    visit(light, receivers + 1, open);
    visit(light, r.right, open);
    const auto left = alive(receivers + 1, l), right = alive(r.right, l), both = alive(receivers, l);
    for (std::size_t i = 0; i < both.size(); ++i) both[i] = left[i] | right[i];
  }

  /// Returns whether the light node's extent moves a segment at the triangle more than the receivers' extent does.
  [[nodiscard]] bool light_is_larger(const LightNode& l, const Receivers& r) const {
    const double to_receivers = glm::length(middle_ - r.middle);
    if (lights_.box.sun) return l.radius * to_receivers > r.radius;
    return l.radius * to_receivers > r.radius * glm::length(middle_ - l.middle);
  }

  void try_leaf(const LightNode& l, std::uint32_t receivers) {
    const Receivers& r = receivers_.nodes[receivers];
    const auto either = alive(receivers, l);
    std::ranges::fill(either, 0U);
    const auto corners = method_.scene().corners(triangle_);
    for (std::uint32_t i = r.begin; i < r.end; ++i) {
      const std::uint32_t pixel = receivers_.pixels[i];
      const auto mask = method_.visible(pixel).subspan(l.word, l.words);
      if (method_.shaft_.meets(method_.leaf_places_[i], method_.triangles_[triangle_], l.lower, l.upper) &&
          method_.may_hide(triangle_, pixel))
        method_.blocked().hide(method_.samples().p[pixel], corners, mask, pairs, l.word);
      for (std::size_t word = 0; word < mask.size(); ++word) either[word] |= mask[word];
    }
  }

  HierarchicalPenumbra& method_;
  const LightTree& lights_;
  const ReceiverTree& receivers_;
  std::vector<BoxPlanes> planes_;        // one for each node of the light, for the triangle in made_for_
  std::vector<std::uint32_t> made_for_;  // for each entry of planes_: its triangle
  std::uint32_t number_ = 0, triangle_ = 0;
  std::array<glm::dvec3, 3> corners_{};
  glm::dvec3 middle_{0};
  std::uint64_t plane_bit_ = 0;
};

void HierarchicalPenumbra::prepare_casters() {
  lights_ = make_light_tree(light());
  const double reach = std::max(glm::length(glm::dvec3(scene().lower)), glm::length(glm::dvec3(scene().upper)));
  shaft_ = LightShaft(lights_.box, 2 * reach + glm::length(lights_.box.origin));
  triangles_.resize(scene().triangles.size());
  tbb::parallel_for(std::size_t{0}, triangles_.size(), [&](std::size_t i) {
    triangles_[i] = shaft_.box_of(scene().corners(static_cast<std::uint32_t>(i)));
  });
}

void HierarchicalPenumbra::block(std::span<const std::uint32_t> pixels,
                                 std::map<std::string, std::uint64_t>& counters) {
  receivers_ = make_receiver_tree(scene(), samples(), pixels);
  const std::size_t words = this->words();
  places_.resize(receivers_.nodes.size());
  leaf_places_.resize(pixels.size());
  tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
    leaf_places_[i] = shaft_.box_of(std::array{samples().p[receivers_.pixels[i]]});
  });
  alive_.assign(receivers_.nodes.size() * words, 0);
  for (std::size_t node = receivers_.nodes.size(); node-- > 0;) {  // children come after their parents
    const ReceiverTree::Node& r = receivers_.nodes[node];
    const auto add = [&](std::span<const std::uint32_t> mask) {
      for (std::size_t i = 0; i < words; ++i) alive_[node * words + i] |= mask[i];
    };
    places_[node] = r.is_leaf() ? leaf_places_[r.begin] : around(places_[node + 1], places_[r.right]);
    if (r.is_leaf()) {
      for (std::uint32_t i = r.begin; i < r.end; ++i) {
        add(visible(receivers_.pixels[i]));
        places_[node] = around(places_[node], leaf_places_[i]);
      }
    } else {
      add(std::span(alive_).subspan((node + 1) * words, words));
      add(std::span(alive_).subspan(r.right * words, words));
    }
  }
  std::vector<std::uint32_t> roots;
  const std::size_t most = std::max<std::size_t>(pixels.size() / kSubtrees, ReceiverTree::kLeaf);
  for (std::uint32_t node = 0; node < receivers_.nodes.size();) {
    const ReceiverTree::Node& r = receivers_.nodes[node];
    if (r.count() > most && !r.is_leaf()) {
      ++node;
      continue;
    }
    roots.push_back(node);
    node = r.end_node;
  }
  std::mutex adding;
  tbb::parallel_for(std::size_t{0}, roots.size(), [&](std::size_t i) {
    const ReceiverTree::Node& r = receivers_.nodes[roots[i]];
    Caster caster(*this);
    for_each_towards_light(glm::vec3(r.middle - r.half), glm::vec3(r.middle + r.half), [&](std::uint32_t triangle) {
      if (scene().emits[triangle] != light().index) caster.cast(triangle, roots[i]);
    });
    const std::lock_guard lock(adding);
    add(caster.pairs);
    counters["boxesTried"] += caster.boxes.looks;
    counters["boxesBeside"] += caster.boxes.beside;
    counters["boxesHidden"] += caster.boxes.hidden;
    counters["pairsHiddenInBoxes"] += caster.boxes.hidden_pairs;
    counters["boxesDoneBefore"] += caster.boxes.done;
  });
}

}  // namespace

std::unique_ptr<visibility::Method> make_hierarchical_penumbra(const visibility::MethodOptions& options) {
  return std::make_unique<HierarchicalPenumbra>(options);
}

}  // namespace penumbra::vsm
