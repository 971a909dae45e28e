#include "volumes/counters/depth_judge.hpp"

#include "visibility/pair_judge.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace penumbra::volumes {
namespace {

class Judge {
 public:
  explicit Judge(const DepthJudgeInput& input)
      : in_(input), judge_{input.scene, input.tree, input.samples, input.light} {}

  void answer(const gpu::DepthQuestion& question, DepthAnswers& answers) const {
    const std::uint32_t words = in_.light.words_per_mask();
    const std::size_t pixel = in_.first_pixel + question.pixel;
    const std::uint32_t first_word = question.pixel * words;
    if ((question.word & gpu::kReference) != 0) {
      if (is_visible(pixel, question.word & ~gpu::kReference)) return;
      for (std::uint32_t word = 0; word < words; ++word) {
        answers.dark.push_back({question.pixel, first_word + word, 0xffffffffU, 0});
      }
      return;
    }
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < 32; ++i) {
      if ((question.bits >> i & 1U) == 0) continue;
      bits |= (is_visible(pixel, question.word * 32 + i) ? 1U : 0U) << i;
    }
    answers.decided.push_back({question.pixel, first_word + question.word, question.bits, bits});
  }

 private:
  [[nodiscard]] bool is_visible(std::size_t pixel, std::uint32_t light_sample) const {
    return judge_.is_visible(pixel, in_.light.points[light_sample]);
  }

  const DepthJudgeInput& in_;
  visibility::PairJudge judge_;
};

}  // namespace

DepthAnswers judge_depths(const DepthJudgeInput& input, std::span<const gpu::DepthQuestion> questions) {
  const Judge judge(input);
  tbb::enumerable_thread_specific<DepthAnswers> parts;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, questions.size(), 8), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) judge.answer(questions[i], parts.local());
  });
  DepthAnswers all;
  for (const DepthAnswers& part : parts) {
    all.dark.insert(all.dark.end(), part.dark.begin(), part.dark.end());
    all.decided.insert(all.decided.end(), part.decided.begin(), part.decided.end());
  }
  return all;
}

int exact_depth(const DepthJudgeInput& input, std::size_t pixel, std::uint32_t light_sample) {
  const visibility::PairJudge judge{input.scene, input.tree, input.samples, input.light};
  const glm::vec3& l = input.light.points[light_sample];
  return static_cast<int>(judge.depth(pixel, l));
}

}  // namespace penumbra::volumes
