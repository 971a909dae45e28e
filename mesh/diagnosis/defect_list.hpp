// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/diagnosis/diagnosis.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

namespace penumbra::mesh {

/// Counts defects and keeps the first ones, ordered by their triangles and then their vertices: the result does not
/// depend on the order in which defects are found, and memory is proportional to the limit.
class DefectList {
 public:
  explicit DefectList(std::size_t limit) : limit_(limit) {}

  /// Adds `more` defects to the count only. The list must be full without them: at least `limit` added defects come
  /// before all of them.
  void count(std::uint64_t more) { count_ += more; }

  /// Returns whether a defect whose first triangle is `first_triangle` could be among the kept ones.
  [[nodiscard]] bool may_list(std::uint32_t first_triangle) const { return limit_ > 0 && first_triangle <= last_; }

  /// Adds a defect with its triangles and vertices in the order in which they are to be listed; triangles ascending, at
  /// least one.
  void add(std::span<const std::uint32_t> triangles, std::span<const std::uint32_t> vertices) {
    ++count_;
    if (!may_list(triangles.front())) return;
    marks_.push_back({{triangles.begin(), triangles.end()}, {vertices.begin(), vertices.end()}});
    if (marks_.size() / 2 >= limit_) drop_surplus();
  }
  void add(std::initializer_list<std::uint32_t> triangles, std::initializer_list<std::uint32_t> vertices) {
    add(std::span(triangles.begin(), triangles.size()), std::span(vertices.begin(), vertices.size()));
  }
  void add_all(DefectList other) {
    count_ += other.count_;
    std::ranges::move(other.marks_, std::back_inserter(marks_));
    drop_surplus();
  }

  [[nodiscard]] Defect finish(const MeshView& mesh) && {
    drop_surplus();
    Defect defect{count_, {}};
    for (Mark& mark : marks_) {
      DefectPlace& place = defect.first.emplace_back();
      for (const std::uint32_t vertex : mark.vertices) place.points.push_back(mesh.positions[vertex]);
      place.triangles = std::move(mark.triangles);
    }
    return defect;
  }

 private:
  struct Mark {
    std::vector<std::uint32_t> triangles, vertices;
    auto operator<=>(const Mark&) const = default;
  };

  void drop_surplus() {
    std::ranges::sort(marks_);
    if (marks_.size() < limit_ || limit_ == 0) return;
    marks_.resize(limit_);
    last_ = marks_.back().triangles.front();
  }

  std::size_t limit_;
  std::uint64_t count_ = 0;
  std::vector<Mark> marks_;
  std::uint32_t last_ = 0xffffffffu;  // defects whose first triangle comes after this one are not kept
};

}  // namespace penumbra::mesh
