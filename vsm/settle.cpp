#include "vsm/settle.hpp"

#include "visibility/pair_truth.hpp"

#include <glm/common.hpp>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace penumbra::vsm {
namespace {

/// One question, answered sample by sample into blocked bits.
class Judge {
 public:
  Judge(const SettleInput& input, std::vector<Answer>& answers) : in_(input), answers_(answers) {}

  void answer(const gpu::OpenQuestion& question) {
    const std::size_t pixel = in_.first_pixel + question.pixel;
    const auto carrier = static_cast<std::uint32_t>(in_.samples.triangle[pixel]);
    const glm::vec3& p = in_.samples.p[pixel];
    const auto each_sample = [&](auto&& is_blocked) {
      if (question.light_sample != gpu::kAllSamples) {
        if (is_blocked(in_.bit_of[question.light_sample])) block(question.pixel, question.light_sample);
        return;
      }
      for (std::uint32_t j = 0; j < in_.light.sample_count(); ++j) {
        if (is_blocked(in_.bit_of[j])) block(question.pixel, j);
      }
    };
    const auto below_horizon = [&](std::uint32_t j) {
      return !visibility::above_horizon(in_.scene.corners(carrier), in_.samples.facing[pixel], in_.light.points[j]);
    };
    if (question.triangle == gpu::kCarrier) {
      each_sample(below_horizon);
    } else if (question.triangle == gpu::kWholePixel) {
      if (!visibility::in_front_of_light(in_.light, p)) {
        each_sample([](std::uint32_t) { return true; });
        return;
      }
      const std::vector<std::uint32_t> near = candidates(p, carrier);
      each_sample([&](std::uint32_t j) {
        if (below_horizon(j)) return true;
        for (const std::uint32_t triangle : near) {
          if (meets(p, j, triangle)) return true;
        }
        return false;
      });
    } else {
      // p on the triangle's plane: not met, whatever the light sample.
      const auto corners = in_.scene.corners(question.triangle);
      if (question.light_sample == gpu::kAllSamples &&
          visibility::side_of_plane(corners[0], corners[1], corners[2], p) == visibility::Side::on) {
        return;
      }
      each_sample([&](std::uint32_t j) { return meets(p, j, question.triangle); });
    }
  }

 private:
  [[nodiscard]] bool meets(const glm::vec3& p, std::uint32_t j, std::uint32_t triangle) const {
    return visibility::segment_meets_triangle(p, in_.light.points[j], in_.scene.corners(triangle), in_.light).meets;
  }

  [[nodiscard]] std::vector<std::uint32_t> candidates(const glm::vec3& p, std::uint32_t carrier) const {
    glm::vec3 lower = p, upper = p;
    for (const glm::vec3& point : in_.light.points) {
      lower = glm::min(lower, point);
      upper = glm::max(upper, point);
    }
    std::vector<std::uint32_t> near;
    in_.tree.for_each_near(lower, upper, [&](std::uint32_t triangle) {
      if (visibility::may_occlude(in_.scene, in_.light, carrier, triangle)) near.push_back(triangle);
    });
    return near;
  }

  void block(std::uint32_t pixel, std::uint32_t sample) {
    answers_.push_back({pixel * in_.light.words_per_mask() + sample / 32, 1U << (sample % 32)});
  }

  const SettleInput& in_;
  std::vector<Answer>& answers_;
};

}  // namespace

std::vector<Answer> settle(const SettleInput& input, std::span<const gpu::OpenQuestion> questions) {
  tbb::enumerable_thread_specific<std::vector<Answer>> parts;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, questions.size(), 64), [&](const auto& range) {
    Judge judge(input, parts.local());
    for (std::size_t i = range.begin(); i < range.end(); ++i) judge.answer(questions[i]);
  });
  std::vector<Answer> answers;
  for (const auto& part : parts) answers.insert(answers.end(), part.begin(), part.end());
  return answers;
}

}  // namespace penumbra::vsm
