// The area of the union of back-projected triangles, by signed edges.
//
// As seen from p each triangle is clipped to what lies between p and the light and taken counter-clockwise; each of its
// edges then counts +1 or −1. Where triangles share an edge their counts add up: 0 inside a surface, ±2 on the
// silhouette of a closed one, any integer in a soup (Laine et al. 2005 for closed ones; docs/signed-crossings.md for
// any). The edges that are left bound the same depth complexity as all triangles do, and they are few; a sweep
// (area_sweep.hpp) finds the area where it is zero. Nothing is assumed of the mesh.
//
// Why not polygon Booleans: the union of n triangles has to merge every inner edge of a surface, which here cancels
// before any crossing is looked for.

#include "areas/exact_area.hpp"

#include "base/assert.hpp"
#include "mesh/predicates.hpp"
#include "areas/area_sweep.hpp"
#include "areas/back_projection.hpp"
#include "areas/disk_measure.hpp"
#include "areas/form_factor_measure.hpp"
#include "areas/light_region.hpp"
#include "areas/light_shaft.hpp"
#include "areas/texture_measure.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/lights/unshadowed_light.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

namespace penumbra::areas {
namespace {

using visibility::Light;
using visibility::LightKind;
using visibility::SceneFloats;
using visibility::TriangleTree;

/// One triangle's use of an edge from corner `low` to corner `high`.
struct EdgeUse {
  std::uint32_t low, high;
  int count;
};

/// s = S/W and t = T/W as the sweep wants them. Equal points give equal numbers, however they were come by: that is
/// what keeps edges that meet together.
template <typename Number>
Number ratio_of(const mpz_class& over, const mpz_class& under);
template <>
mpq_class ratio_of<mpq_class>(const mpz_class& over, const mpz_class& under) {
  mpq_class value(over, under);
  value.canonicalize();
  return value;
}
template <>
double ratio_of<double>(const mpz_class& over, const mpz_class& under) {
  return mpq_class(over, under)
      .get_d();  // cut off toward zero from the exact quotient; needs no common terms cancelled
}

template <typename Number>
Number number_of(const mpq_class& value) {
  if constexpr (std::is_same_v<Number, double>) return value.get_d();
  if constexpr (!std::is_same_v<Number, double>) return value;
}

template <typename Number>
void add_edge(std::vector<SweepEdge<Number>>& edges, SweepEdge<Number> edge) {
  if (edge.s0 == edge.s1) return;  // no vertical line crosses it
  if (edge.s0 > edge.s1) {
    std::swap(edge.s0, edge.s1);
    std::swap(edge.t0, edge.t1);
    edge.cover = -edge.cover;
    edge.region = -edge.region;
  }
  edges.push_back(std::move(edge));
}

template <typename Number>
std::vector<SweepEdge<Number>> region_edges(const Region& region) {
  std::vector<SweepEdge<Number>> edges;
  for (std::size_t i = 0; i < region.size(); ++i) {
    const PlanePoint &a = region[i], &b = region[(i + 1) % region.size()];
    add_edge<Number>(
        edges, {number_of<Number>(a.s), number_of<Number>(a.t), number_of<Number>(b.s), number_of<Number>(b.t), 0, 1});
  }
  return edges;
}

bool all_inside(const GridBox& box, const HalfPlane& half_plane) {
  for (const mpz_class* s : {&box.s0, &box.s1}) {
    for (const mpz_class* t : {&box.t0, &box.t1}) {
      const mpz_class height = half_plane.at * GridBox::kGrid + half_plane.along_s * *s + half_plane.along_t * *t;
      if (height < 0) return false;
    }
  }
  return true;
}

/// For each position the first (in lexicographic order, then by index) of those at the same place.
std::vector<std::uint32_t> weld(const std::vector<glm::vec3>& positions) {
  std::vector<std::uint32_t> order(positions.size()), first(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto less = [&](std::uint32_t i, std::uint32_t j) {
    const glm::vec3 &a = positions[i], &b = positions[j];
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
  };
  std::ranges::sort(order, less);
  for (std::size_t i = 0; i < order.size(); ++i) {
    first[order[i]] = i > 0 && !less(order[i - 1], order[i]) ? first[order[i - 1]] : order[i];
  }
  return first;
}

}  // namespace

struct ExactAreaData {
  const SceneFloats* scene = nullptr;
  TriangleTree own_tree;  ///< unless there was one
  const TriangleTree* tree = nullptr;
  std::vector<std::uint32_t> corner;  ///< for each position, the one that stands for its place
  IntegerGrid grid;                   ///< of all positions
  const Light* light = nullptr;
  IntegerFrame frame;  ///< not of a sphere
  Region region;
  bool round = false;  ///< the light is what of the region is in the unit disk
  mpq_class area;      ///< of the region
  GridBox box;
  std::vector<SweepEdge<double>> edges;  ///< of the region
  std::optional<TextureColumns> texture;
  std::optional<TextureBlocks> blocks;  ///< of the same texture
};

namespace {

/// What hides the light from one view sample: edges on the light's plane, clipped to a box.
class OccluderEdges {
 public:
  OccluderEdges(const ExactAreaData& data, const Receiver& receiver, const BackProjection& projection,
                const LightShaft& shaft)
      : data_(data), receiver_(receiver), projection_(projection), shaft_(shaft) {
    for_each_candidate([&](std::uint32_t triangle) { add_triangle(triangle); });
    merge_uses();
  }

  [[nodiscard]] std::uint64_t triangles() const { return triangles_; }

  template <typename Number>
  void append_to(std::vector<SweepEdge<Number>>& edges) const {
    const auto add = [&](const ProjectiveEdge& edge, int count) {
      const auto& [a, b] = edge;
      add_edge<Number>(edges, {ratio_of<Number>(a.s, a.w), ratio_of<Number>(a.t, a.w), ratio_of<Number>(b.s, b.w),
                               ratio_of<Number>(b.t, b.w), count, 0});
    };
    for (const EdgeUse& use : uses_) {
      const glm::vec3 &low = data_.scene->positions[use.low], &high = data_.scene->positions[use.high];
      const LightShaft::Place a = shaft_.place_of(low), b = shaft_.place_of(high);
      if ((a.outside & b.outside) != 0) continue;
      const ProjectiveEdge whole{projection_.project(low), projection_.project(high)};
      if (const auto edge = projection_.clip_edge(whole, kAllClipPlanes & ~(a.inside & b.inside)))
        add(*edge, use.count);
    }
    for (const ProjectiveEdge& cut : cuts_) add(cut, 1);
  }

 private:
  template <typename Visit>
  void for_each_candidate(Visit&& visit) {
    std::vector<std::uint32_t> stack;
    if (!data_.tree->nodes.empty()) stack.push_back(0);
    while (!stack.empty()) {
      const TriangleTree::Node& node = data_.tree->nodes[stack.back()];
      stack.pop_back();
      for (const TriangleTree::Child& child : node) {
        if (child.reference == TriangleTree::kNoChild || shaft_.misses(child.lower, child.upper)) continue;
        if ((child.reference & TriangleTree::kLeafBit) == 0) {
          stack.push_back(child.reference);
          continue;
        }
        for (const std::uint32_t triangle : data_.tree->leaves[child.reference & ~TriangleTree::kLeafBit]) {
          if (triangle != TriangleTree::kNoTriangle) visit(triangle);
        }
      }
    }
  }

  /// All of a triangle's boundary or nothing: then the sums stay closed, whatever is left out.
  void add_triangle(std::uint32_t triangle) {
    if (!may_occlude(*data_.scene, *data_.light, receiver_.carrier, triangle)) return;
    const std::array<glm::vec3, 3> corners = data_.scene->corners(triangle);
    const std::array<LightShaft::Place, 3> places = {shaft_.place_of(corners[0]), shaft_.place_of(corners[1]),
                                                     shaft_.place_of(corners[2])};
    if ((places[0].outside & places[1].outside & places[2].outside) != 0) return;
    ++triangles_;
    int turn = static_cast<int>(mesh::side_of_plane(corners[0], corners[1], corners[2], receiver_.p));
    if (turn == 0) return;  // seen edge-on: not met
    if (projection_.mirrored()) turn = -turn;

    const unsigned inside = places[0].inside & places[1].inside & places[2].inside;
    constexpr unsigned kCutting = bit_of(ClipPlane::light) | bit_of(ClipPlane::bottom);
    if ((inside & kCutting) != kCutting && !cut_triangle(corners, turn)) return;
    const visibility::Triangle& t = data_.scene->triangles[triangle];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = data_.corner[t[i]], to = data_.corner[t[(i + 1) % 3]];
      uses_.push_back(from < to ? EdgeUse{from, to, turn} : EdgeUse{to, from, -turn});
    }
  }

  /// Clipping closes a triangle along the planes it crosses. Along left and right no vertical line crosses what closes
  /// it, above the top none is looked at: the cuts at the light's plane and at the bottom are left. False: nothing of
  /// the triangle is strictly between p and the light.
  bool cut_triangle(const std::array<glm::vec3, 3>& corners, int turn) {
    Polygon polygon;
    for (const glm::vec3& corner : corners) polygon.push_back(projection_.project(corner));
    if (turn < 0) std::swap(polygon[1], polygon[2]);
    if (std::ranges::none_of(polygon, [&](const auto& q) { return projection_.height(ClipPlane::light, q) > 0; }))
      return false;
    std::optional<ProjectiveEdge> cut;
    for (const ClipPlane plane : {ClipPlane::light, ClipPlane::left, ClipPlane::right, ClipPlane::bottom}) {
      polygon = projection_.clip_polygon(polygon, plane, cut);
      if (!cut || (plane != ClipPlane::light && plane != ClipPlane::bottom)) continue;
      if (auto edge = projection_.clip_edge(*cut, kAllClipPlanes & ~bit_of(plane))) cuts_.push_back(std::move(*edge));
    }
    return true;
  }

  void merge_uses() {
    std::ranges::sort(
        uses_, [](const EdgeUse& a, const EdgeUse& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < uses_.size();) {
      EdgeUse sum = uses_[i];
      for (++i; i < uses_.size() && uses_[i].low == sum.low && uses_[i].high == sum.high; ++i)
        sum.count += uses_[i].count;
      if (sum.count != 0) uses_[kept++] = sum;
    }
    uses_.resize(kept);
  }

  const ExactAreaData& data_;
  const Receiver& receiver_;
  const BackProjection& projection_;
  const LightShaft& shaft_;
  std::vector<EdgeUse> uses_;
  std::vector<ProjectiveEdge> cuts_;  ///< each counts 1
  std::uint64_t triangles_ = 0;
};

/// One question: the region of the light that is above the horizon, and what may hide it.
struct Question {
  const ExactAreaData& data;
  const Region& region;
  const OccluderEdges& occluders;
  FormFactorSum* form_factor;  ///< null: nobody asks
};

/// The sweep's measure of the uncovered part; form factors on the way, if they are wanted.
template <typename Number, typename Measure>
Number measure_uncovered(Measure measure, std::vector<SweepEdge<Number>>& edges, FormFactorSum* form_factor) {
  if (form_factor == nullptr) return AreaSweep<Number, Measure>(std::move(measure)).uncovered_area(edges);
  using Both = FormFactorMeasure<Number, Measure>;
  const Number area = AreaSweep<Number, Both>(Both(std::move(measure), *form_factor)).uncovered_area(edges);
  form_factor->finish();
  return area;
}

/// The share of the light, by area or by luminance, that is region and not hidden. `edges` are the region's, and the
/// workspace.
template <typename Number>
double share_left(const Question& question, std::vector<SweepEdge<Number>> edges, AreaWork& work) {
  const ExactAreaData& data = question.data;
  const std::size_t of_region = edges.size();
  question.occluders.append_to(edges);
  work = {question.occluders.triangles(), edges.size() - of_region};
  if (work.edges == 0 && &question.region == &data.region) {
    if (question.form_factor != nullptr) question.form_factor->add_whole();
    return 1;
  }
  if (data.texture) {
    const auto left = measure_uncovered<Number>(TextureMeasure<Number>(*data.texture), edges, question.form_factor);
    return std::clamp(mpq_class(mpq_class(left) / data.texture->integral()).get_d(), 0.0, 1.0);
  }
  FormFactorSum* form_factor = question.form_factor;
  if (work.edges == 0) {
    if (form_factor != nullptr) form_factor->add_whole();
    if (!data.round) return mpq_class(area_of(question.region) / data.area).get_d();
    form_factor = nullptr;
  }
  if (data.round) {
    const auto left = measure_uncovered<Number>(DiskMeasure<Number>(), edges, form_factor);
    return std::clamp(mpq_class(left).get_d() / std::numbers::pi, 0.0, 1.0);
  }
  const auto left = measure_uncovered<Number>(PlainMeasure<Number>(), edges, form_factor);
  return std::clamp(mpq_class(mpq_class(left) / data.area).get_d(), 0.0, 1.0);
}

}  // namespace

ExactArea::ExactArea(const SceneFloats& scene) : ExactArea(scene, TriangleTree()) {
  data_->own_tree = make_triangle_tree(scene);
  data_->tree = &data_->own_tree;
}

ExactArea::ExactArea(const SceneFloats& scene, const TriangleTree& tree) : data_(std::make_unique<ExactAreaData>()) {
  data_->scene = &scene;
  data_->tree = &tree;
  data_->corner = weld(scene.positions);
  for (const glm::vec3& position : scene.positions) data_->grid.include(position);
}

ExactArea::~ExactArea() = default;
ExactArea::ExactArea(ExactArea&&) noexcept = default;
ExactArea& ExactArea::operator=(ExactArea&&) noexcept = default;

void ExactArea::set_light(const Light& light) {
  data_->light = &light;
  if (light.kind != LightKind::sphere) data_->frame = integer_frame(light, {});
  data_->region = light_region(light);
  data_->round = visibility::is_round(light.kind);
  data_->area = area_of(data_->region);
  data_->box = box_around(data_->region);
  data_->edges = region_edges<double>(data_->region);
  data_->texture.reset();
  data_->blocks.reset();
  if (!light.texture) return;
  data_->texture.emplace(*light.texture);
  data_->blocks.emplace(*light.texture);
}

double ExactArea::visibility(const Receiver& receiver, SweepArithmetic arithmetic, AreaWork* work) const {
  AreaWork ignored;
  return visible_share(receiver, arithmetic, work != nullptr ? *work : ignored, nullptr);
}

ExactView ExactArea::view(const Receiver& receiver, SweepArithmetic arithmetic) const {
  PENUMBRA_ASSERT(data_->light != nullptr, "set_light comes first");
  const visibility::UnshadowedLight seen(*data_->light, receiver.p, receiver.n);
  FormFactorSum form_factor(seen, data_->blocks);
  ExactView view;
  view.visibility = visible_share(receiver, arithmetic, view.work, &form_factor);
  if (static_cast<float>(view.visibility) == 1 && view.work.edges != 0) {  // what is near the light hides none of it
    FormFactorSum whole(seen, data_->blocks);
    whole.add_whole();
    view.form_factor = whole.sum();
  } else {
    view.form_factor = glm::max(form_factor.sum(), glm::dvec3(0));
  }
  return view;
}

/// Of a sun of one direction: all or nothing.
bool ExactArea::sees_direction(const Receiver& receiver) const {
  const Light& light = *data_->light;
  const SceneFloats& scene = *data_->scene;
  return above_horizon(light, scene.corners(receiver.carrier), receiver.facing, light.center) &&
         !data_->tree->any_along_ray(glm::dvec3(receiver.p), glm::dvec3(light.center), [&](std::uint32_t triangle) {
           return may_occlude(scene, light, receiver.carrier, triangle) &&
                  segment_meets_triangle(receiver.p, light.center, scene.corners(triangle), light).meets;
         });
}

double ExactArea::visible_share(const Receiver& receiver, SweepArithmetic arithmetic, AreaWork& work,
                                FormFactorSum* form_factor) const {
  PENUMBRA_ASSERT(data_->light != nullptr, "set_light comes first");
  const Light& light = *data_->light;
  work = {};
  if (!in_front_of_light(light, receiver.p)) return 0;
  if (light.sun && light.sun->tangent == 0) {
    const bool sees = sees_direction(receiver);
    if (sees && form_factor != nullptr) form_factor->add_whole();
    return sees ? 1 : 0;
  }
  const IntegerFrame frame = light.kind == LightKind::sphere ? integer_frame(light, receiver.p) : data_->frame;
  IntegerGrid grid = data_->grid;
  grid.include(frame.grid);
  grid.include(receiver.p);
  BackProjection projection(frame, grid, receiver.p);
  if (projection.on_plane()) return 0;

  // The horizon cuts the region; most view samples see all of it.
  const HalfPlane above = projection.above_plane(data_->scene->corners(receiver.carrier), receiver.facing);
  const bool whole = all_inside(data_->box, above);
  const Region cut = whole ? Region() : clip(data_->region, above);
  if (!whole && area_of(cut) <= 0) return 0;
  const Region& region = whole ? data_->region : cut;
  const GridBox box = whole ? data_->box : box_around(cut);
  projection.set_box(box);
  const LightShaft shaft(frame, projection.mirrored(), receiver.p, box);
  const OccluderEdges occluders(*data_, receiver, projection, shaft);
  const Question question{*data_, region, occluders, form_factor};
  if (arithmetic == SweepArithmetic::rational) return share_left(question, region_edges<mpq_class>(region), work);
  return share_left(question, whole ? data_->edges : region_edges<double>(region), work);
}

std::uint64_t ExactArea::memory_bytes() const {
  const TriangleTree& tree = data_->own_tree;
  return tree.nodes.size() * sizeof(TriangleTree::Node) + tree.leaves.size() * sizeof(TriangleTree::Leaf) +
         data_->corner.size() * sizeof(std::uint32_t);
}

}  // namespace penumbra::areas
