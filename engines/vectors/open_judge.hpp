// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/vectors/masks.hpp"
#include "visibility/tree/pair_judge.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace penumbra::vectors {

/// Decides open questions immediately, by exact predicates, and counts them.
class ExactOpenJudge final : public OpenJudge {
 public:
  ExactOpenJudge(const visibility::PairJudge& judge, const LightGrid& grid) : judge_(judge), grid_(grid) {}

  std::uint32_t depth(const GridSample& sample, std::uint32_t light_sample) override;
  std::optional<std::uint32_t> depth_in_plane(const GridSample& sample, const glm::dvec2& st) override;
  glm::dvec3 direction_to(const GridSample& sample, std::uint32_t light_sample) override;
  HorizonLine horizon(const GridSample& sample) override;
  glm::dvec3 normal_towards(const GridSample& sample, std::uint32_t triangle) override;
  void decide(const GridSample& sample, const Open& open, SampleMask& mask) override;

  [[nodiscard]] std::uint64_t pixels() const { return pixels_; }
  [[nodiscard]] std::uint64_t pairs() const { return pairs_; }

 private:
  [[nodiscard]] glm::vec3 light_point(const GridSample& sample, std::uint32_t light_sample);
  void decide_row(const GridSample& sample, std::uint32_t row, SampleMask& mask);
  void decide_one(const GridSample& sample, std::uint32_t light_sample, SampleMask& mask);

  const visibility::PairJudge& judge_;
  const LightGrid& grid_;
  std::vector<std::uint32_t> numbers_;
  struct Seen {
    std::uint32_t pixel;
    visibility::LightFrame disk;
  };
  std::optional<Seen> seen_;  // cache for a sphere
  std::uint64_t pixels_ = 0, pairs_ = 0;
};

}  // namespace penumbra::vectors
