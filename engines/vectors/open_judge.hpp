#pragma once

#include "engines/vectors/masks.hpp"
#include "visibility/pair_judge.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace penumbra::native {

/// Decides by exact predicates what is not certain, on the spot, and counts that.
class OpenJudge final : public Judge {
 public:
  OpenJudge(const visibility::PairJudge& judge, const Frame& frame) : judge_(judge), frame_(frame) {}

  std::uint32_t depth(const Placed& sample, std::uint32_t light_sample) override;
  std::optional<std::uint32_t> depth_in_plane(const Placed& sample, const glm::dvec2& st) override;
  HorizonLine horizon(const Placed& sample) override;
  glm::dvec3 normal_towards(const Placed& sample, std::uint32_t triangle) override;
  void decide(const Placed& sample, const Open& open, Seen& seen) override;

  [[nodiscard]] std::uint64_t pixels() const { return pixels_; }
  [[nodiscard]] std::uint64_t pairs() const { return pairs_; }

 private:
  void decide_row(const Placed& sample, std::uint32_t row, Seen& seen);
  void decide_one(const Placed& sample, std::uint32_t light_sample, Seen& seen);

  const visibility::PairJudge& judge_;
  const Frame& frame_;
  std::vector<std::uint32_t> numbers_;
  std::uint64_t pixels_ = 0, pairs_ = 0;
};

}  // namespace penumbra::native
