// SPDX-License-Identifier: Apache-2.0
// Runs the steps of a repair in order and counts their changes.

#include "repair/run_repair.hpp"

#include "repair/steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <map>
#include <new>
#include <string_view>
#include <utility>

namespace penumbra::repair {

namespace {

constexpr int kMostPasses = 8;  // two suffice for all but tangled meshes; each costs a sort of all edges

/// Sentences about the steps, in their order. {} is the count.
constexpr std::array<std::pair<RepairKind, std::string_view>, static_cast<std::size_t>(RepairKind::kinds)> kSentences =
    {{
        {RepairKind::repeated, "removed {} triangles with two corners at one point"},
        {RepairKind::collinear, "removed {} triangles whose corners lie on a line"},
        {RepairKind::split_face,
         "split {} triangles at vertices on their edges, which triangles without area had joined there"},
        {RepairKind::duplicate, "removed {} triangles that others repeat"},
        {RepairKind::moved, "moved {} positions onto others within the welding distance"},
        {RepairKind::merged, "merged {} repeated positions"},
        {RepairKind::stitched, "stitched {} edges along which triangles met without sharing their vertices"},
        {RepairKind::split_edge, "split {} edges that joined more triangles than a surface has there"},
        {RepairKind::split_vertex, "split {} vertices in which surfaces only touched"},
        {RepairKind::turned, "turned {} triangles to agree with their neighbours"},
        {RepairKind::outward, "turned {} closed parts inside out, to face outward (or, in others, inward)"},
        {RepairKind::hole, "filled {} holes"},
        {RepairKind::hole_face, "added {} triangles in holes"},
        {RepairKind::intersection, "resolved {} intersecting pairs of triangles by remeshing around them"},
        {RepairKind::unused, "dropped {} positions that no triangle used"},
    }};

/// Runs steps one after another; a CGAL step that fails leaves the soup unchanged.
class Pass {
 public:
  Pass(const TriangleSoup& soup, const RepairOptions& options) : soup_(soup), options_(options) {}

  void run() {
    soup_ = remove_empty_triangles(soup_, options_.weld, record_);
    soup_ = remove_duplicates(soup_, options_.weld, record_);
    soup_ = join(soup_, options_.weld, record_);
    if (soup_.triangles.empty()) return;
    attempt("orienting closed parts", [&](RepairRecord& record) { return turn_outward(soup_, record); });
    if (options_.fill_holes_up_to > 0) {
      attempt("filling holes",
              [&](RepairRecord& record) { return fill_holes(soup_, options_.fill_holes_up_to, record); });
    }
    if (options_.resolve_self_intersections) {
      attempt("resolving intersections", [&](RepairRecord& record) { return resolve_intersections(soup_, record); });
    }
  }

  [[nodiscard]] bool changed() const {
    return std::ranges::any_of(record_.done, [](std::uint64_t count) { return count > 0; });
  }
  [[nodiscard]] const RepairRecord& record() const { return record_; }
  [[nodiscard]] const TriangleSoup& soup() const { return soup_; }

 private:
  template <typename Step>
  void attempt(std::string_view what, Step step) {
    RepairRecord tried = record_;
    try {
      soup_ = step(tried);
      record_ = std::move(tried);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      std::string message = error.what();
      std::ranges::replace(message, '\n', ' ');
      record_.left.push_back(fmt::format("{} failed in CGAL ({})", what, message));
    }
  }

  TriangleSoup soup_;
  const RepairOptions& options_;
  RepairRecord record_;
};

/// Counts the boundary edges of the joined soup: edges of one triangle, by indices.
std::uint64_t count_open_edges(const TriangleSoup& soup) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> triangles;
  for (const Triangle& t : soup.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++triangles[std::minmax(t[i], t[(i + 1) % 3])];
  }
  return static_cast<std::uint64_t>(
      std::ranges::count_if(triangles, [](const auto& entry) { return entry.second == 1; }));
}

}  // namespace

Repaired run_repair(const TriangleSoup& soup, const RepairOptions& options) {
  Repaired repaired{soup, {}, {}};
  std::array<std::uint64_t, static_cast<std::size_t>(RepairKind::kinds)> total{};
  bool settled = false;
  for (int i = 0; i < kMostPasses && !settled; ++i) {
    Pass pass(repaired.soup, options);
    pass.run();
    settled = !pass.changed();
    repaired.left = pass.record().left;
    if (settled) break;
    repaired.soup = pass.soup();
    for (std::size_t kind = 0; kind < total.size(); ++kind) total[kind] += pass.record().done[kind];
  }
  for (const auto& [kind, sentence] : kSentences) {
    const std::uint64_t count = total[static_cast<std::size_t>(kind)];
    if (count > 0) repaired.done.push_back({fmt::format(fmt::runtime(sentence), count), count});
  }
  if (!settled) {
    repaired.left.push_back(fmt::format("it still changed after {} passes: repair the result again", kMostPasses));
  }
  if (const std::uint64_t open = count_open_edges(repaired.soup); open > 0) {
    repaired.left.push_back(fmt::format("{} edges are open: holes, rims of sheets, cracks", open));
  }
  return repaired;
}

}  // namespace penumbra::repair
