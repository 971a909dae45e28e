// SPDX-License-Identifier: Apache-2.0
// Exact decisions about light samples that kernels left open, in parallel.

#include "engines/device/open_judge.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <bit>

namespace penumbra::device {
namespace {

bool is_hidden(const visibility::PairJudge& pairs, std::size_t pixel, const glm::vec3& l, std::uint32_t hider) {
  if (hider == gpu::kAnyTriangle) return !pairs.is_visible(pixel, l);
  if (hider != gpu::kCarrier) return pairs.meets(pixel, l, hider);
  const auto carrier = static_cast<std::uint32_t>(pairs.samples.triangle[pixel]);
  return !visibility::above_horizon(pairs.scene.corners(carrier), pairs.samples.facing[pixel], l);
}

gpu::MaskWord decide_one(const JudgeInput& in, const OpenBits& question) {
  const std::uint32_t pixel = question.pixel & ~gpu::kWholePixel;
  std::uint32_t asked = 0, hidden = 0;
  for (std::uint32_t left = question.bits; left != 0; left &= left - 1) {
    const auto bit = static_cast<std::uint32_t>(std::countr_zero(left));
    const std::uint32_t j = in.layout.sample_of(32 * question.word + bit);
    if (j == MaskLayout::kNone) continue;
    asked |= 1U << bit;
    if (is_hidden(in.pairs, in.first_pixel + pixel, in.pairs.light.points[j], question.hider)) hidden |= 1U << bit;
  }
  const bool whole = question.hider == gpu::kAnyTriangle;
  return {question.pixel, pixel * in.layout.words + question.word, whole ? asked : hidden,
          whole ? asked & ~hidden : 0U};
}

}  // namespace

std::vector<gpu::MaskWord> decide(const JudgeInput& input, std::span<const OpenBits> questions) {
  std::vector<gpu::MaskWord> words(questions.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, questions.size(), 8), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) words[i] = decide_one(input, questions[i]);
  });
  std::erase_if(words, [](const gpu::MaskWord& word) { return word.decided == 0; });
  return words;
}

}  // namespace penumbra::device
