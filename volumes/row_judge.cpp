#include "volumes/row_judge.hpp"

#include "visibility/pair_truth.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace penumbra::volumes {
namespace {

class Judge {
 public:
  Judge(const RowJudgeInput& input, std::vector<gpu::MaskWord>& words) : in_(input), words_(words) {}

  void answer(const gpu::RowQuestion& question) {
    const std::uint64_t rows = question.low | std::uint64_t{question.high} << 32U;
    const std::uint32_t column_words = (in_.light.columns + 7) / 8, row_words = (in_.light.rows + 3) / 4;
    const std::uint32_t pixel = question.pixel & ~gpu::kWholePixel;
    const std::uint32_t end = std::min(question.first_row + 64, row_words * 4);
    for (std::uint32_t first = question.first_row; first < end; first += 4) {
      const auto asked = static_cast<std::uint32_t>(rows >> (first - question.first_row) & 15U);
      if (asked == 0) continue;
      std::uint32_t decided = 0;
      for (std::uint32_t r = 0; r < 4; ++r) decided |= (asked >> r & 1U) * (0xffU << (8 * r));
      for (std::uint32_t c = 0; c < column_words; ++c) {
        const std::uint32_t at = pixel * column_words * row_words + c * row_words + first / 4;
        words_.push_back({question.pixel, at, decided, bits_of(pixel, first, asked, c * 8)});
      }
    }
  }

 private:
  [[nodiscard]] std::uint32_t bits_of(std::uint32_t pixel, std::uint32_t first_row, std::uint32_t asked,
                                      std::uint32_t first_column) const {
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < 32; ++i) {
      const std::uint32_t row = first_row + i / 8, column = first_column + i % 8;
      if ((asked >> (i / 8) & 1U) == 0 || row >= in_.light.rows || column >= in_.light.columns) continue;
      bits |= (is_visible(in_.first_pixel + pixel, in_.light.points[row * in_.light.columns + column]) ? 1U : 0U) << i;
    }
    return bits;
  }

  [[nodiscard]] bool is_visible(std::size_t pixel, const glm::vec3& l) const {
    const auto carrier = static_cast<std::uint32_t>(in_.samples.triangle[pixel]);
    const glm::vec3& p = in_.samples.p[pixel];
    if (!visibility::above_horizon(in_.scene.corners(carrier), in_.samples.facing[pixel], l) ||
        !visibility::in_front_of_light(in_.light, p)) {
      return false;
    }
    return !in_.tree.any_along(p, l, [&](std::uint32_t triangle) {
      return visibility::may_occlude(in_.scene, in_.light, carrier, triangle) &&
             visibility::segment_meets_triangle(p, l, in_.scene.corners(triangle), in_.light).meets;
    });
  }

  const RowJudgeInput& in_;
  std::vector<gpu::MaskWord>& words_;
};

}  // namespace

std::vector<gpu::MaskWord> judge_rows(const RowJudgeInput& input, std::span<const gpu::RowQuestion> questions) {
  tbb::enumerable_thread_specific<std::vector<gpu::MaskWord>> parts;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, questions.size(), 8), [&](const auto& range) {
    Judge judge(input, parts.local());
    for (std::size_t i = range.begin(); i < range.end(); ++i) judge.answer(questions[i]);
  });
  std::vector<gpu::MaskWord> words;
  for (const auto& part : parts) words.insert(words.end(), part.begin(), part.end());
  return words;
}

}  // namespace penumbra::volumes
