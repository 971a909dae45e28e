#include "volumes/scatter/row_judge.hpp"

#include "visibility/pair_judge.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

namespace penumbra::volumes {
namespace {

class Judge {
 public:
  Judge(const RowJudgeInput& input, std::vector<gpu::MaskWord>& words)
      : in_(input), judge_{input.scene, input.tree, input.samples, input.light}, words_(words) {}

  void answer(const gpu::RowQuestion& question) {
    const std::size_t begin = words_.size();
    answer_rows(question);
    for (const std::uint32_t sample : {question.sample_1, question.sample_2}) {
      if (sample != gpu::kNoSample) answer_sample(question, sample, begin);
    }
  }

 private:
  [[nodiscard]] std::uint32_t row_words() const { return (in_.light.rows + 3) / 4; }
  [[nodiscard]] std::uint32_t column_words() const { return (in_.light.columns + 7) / 8; }
  /// The word of these 4 rows and 8 columns.
  [[nodiscard]] std::uint32_t word_of(std::uint32_t pixel, std::uint32_t row, std::uint32_t column) const {
    return (pixel * column_words() + column / 8) * row_words() + row / 4;
  }

  void answer_rows(const gpu::RowQuestion& question) {
    const std::uint32_t pixel = question.pixel & ~gpu::kWholePixel;
    const std::uint64_t rows = question.low | std::uint64_t{question.high} << 32U;
    for (std::uint32_t row = question.first_row; row < std::min(question.first_row + 64, in_.light.rows); row += 4) {
      const auto asked = static_cast<std::uint32_t>(rows >> (row - question.first_row) & 15U);
      if (asked == 0) continue;
      std::uint32_t bits = 0;
      for (std::uint32_t r = 0; r < 4; ++r) bits |= (asked >> r & 1U) * (0xffU << (8 * r));
      for (std::uint32_t column = 0; column < in_.light.columns; column += 8) {
        words_.push_back(decide({question.pixel, word_of(pixel, row, column), bits, 0}, row, column));
      }
    }
  }

  /// A word is written once: what is decided joins the one that rows of the same question began.
  void answer_sample(const gpu::RowQuestion& question, std::uint32_t sample, std::size_t begin) {
    const std::uint32_t row = sample / in_.light.columns, column = sample % in_.light.columns;
    const std::uint32_t word = word_of(question.pixel & ~gpu::kWholePixel, row, column);
    const gpu::MaskWord one =
        decide({question.pixel, word, 1U << (row % 4 * 8 + column % 8), 0}, row / 4 * 4, column / 8 * 8);
    const auto same = std::find_if(words_.begin() + static_cast<std::ptrdiff_t>(begin), words_.end(),
                                   [&](const gpu::MaskWord& w) { return w.word == word; });
    if (same == words_.end()) {
      words_.push_back(one);
    } else {
      same->bits = (same->bits & ~one.decided) | one.bits;
      same->decided |= one.decided;
    }
  }

  [[nodiscard]] gpu::MaskWord decide(gpu::MaskWord word, std::uint32_t first_row, std::uint32_t first_column) const {
    const std::size_t pixel = in_.first_pixel + (word.pixel & ~gpu::kWholePixel);
    for (std::uint32_t i = 0; i < 32; ++i) {
      const std::uint32_t row = first_row + i / 8, column = first_column + i % 8;
      if ((word.decided >> i & 1U) == 0 || row >= in_.light.rows || column >= in_.light.columns) continue;
      word.bits |= (judge_.is_visible(pixel, in_.light.points[row * in_.light.columns + column]) ? 1U : 0U) << i;
    }
    return word;
  }

  const RowJudgeInput& in_;
  visibility::PairJudge judge_;
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
