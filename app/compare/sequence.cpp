// SPDX-License-Identifier: Apache-2.0
// Compares the frames of an animation and sums their errors.

#include "app/compare/sequence.hpp"

#include "app/process/say_once.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "compare/metrics_csv.hpp"
#include "session/comparison/comparison_files.hpp"
#include "session/session.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::app {
namespace {

using Json = nlohmann::ordered_json;

/// Errors of V over the pixels of several frames; keeps only the largest, for p999.
class ErrorSum {
 public:
  /// `most`: largest number of pixels of all frames together.
  explicit ErrorSum(std::size_t most) : kept_(most / 1000 + 2) {}

  void add(std::span<const float> errors) {
    for (const float e : errors) {
      if (std::isnan(e)) continue;
      const double magnitude = std::abs(double{e});
      ++count_;
      mean_ += magnitude;
      bias_ += e;
      squares_ += magnitude * magnitude;
      if (magnitude > 0.05) ++over_;
      largest_.push_back(std::abs(e));
      if (largest_.size() >= 2 * kept_ + 1024) trim();
    }
  }

  /// Returns the error; nullopt if there are no pixels.
  [[nodiscard]] std::optional<compare::VisibilityError> error() {
    if (count_ == 0) return std::nullopt;
    std::ranges::sort(largest_, std::greater());
    const auto n = static_cast<double>(count_);
    // The nearest rank ⌈0.999 n⌉ from below is the ⌊0.001 n⌋-th from above, counted from 0.
    return compare::VisibilityError{.mean = mean_ / n,
                                    .rmse = std::sqrt(squares_ / n),
                                    .p999 = largest_[count_ / 1000],
                                    .max = largest_.front(),
                                    .over05 = static_cast<double>(over_) / n,
                                    .bias = bias_ / n};
  }

 private:
  void trim() {
    std::nth_element(largest_.begin(), largest_.begin() + static_cast<std::ptrdiff_t>(kept_), largest_.end(),
                     std::greater());
    largest_.resize(kept_);
  }

  std::size_t kept_, count_ = 0, over_ = 0;
  double mean_ = 0, bias_ = 0, squares_ = 0;
  std::vector<float> largest_;
};

/// Sum of squares of changes of the error from frame to frame, their number, and the number of pops.
struct Changes {
  static constexpr double kPop = 0.05;
  double sum = 0, largest = 0;
  std::uint64_t count = 0, pops = 0;

  void add(std::span<const float> now, std::span<const float> before) {
    for (std::size_t i = 0; i < std::min(now.size(), before.size()); ++i) {
      const double change = double{now[i]} - before[i];
      if (std::isnan(change)) continue;
      sum += change * change;
      largest = std::max(largest, std::abs(change));
      ++count;
      if (std::abs(change) > kPop) ++pops;
    }
  }
  Changes& operator+=(const Changes& other) {
    sum += other.sum, count += other.count, pops += other.pops;
    largest = std::max(largest, other.largest);
    return *this;
  }
  [[nodiscard]] std::optional<compare::Pops> popping() const {
    if (count == 0) return std::nullopt;
    return compare::Pops{static_cast<double>(pops) / static_cast<double>(count), largest};
  }
  [[nodiscard]] std::optional<double> root() const {
    return count == 0 ? std::nullopt : std::optional(std::sqrt(sum / static_cast<double>(count)));
  }
};

/// Sums of one entry over the frames so far.
struct EntrySum {
  ErrorSum errors;
  Changes flicker;
  std::vector<double> light, evaluate;
  std::vector<float> before;                      ///< errors of the previous frame
  std::optional<compare::MethodFailure> failure;  ///< of the first frame in which the entry failed
  std::size_t frames = 0;                         ///< number of frames with the entry
};

/// Replaces the last frame's numbers by those of all frames, and removes numbers that are not summed over the frames.
void take_sum(compare::MethodResult& result, EntrySum& sum, std::size_t frames) {
  result.horizon_error.reset();
  result.beauty_error.reset();
  result.separation.reset();
  result.flip.reset();
  result.all_lights_error.reset();
  result.pairs.reset();
  result.verdicts.reset();
  result.error.reset();
  if (!sum.failure && sum.frames < frames)
    sum.failure = {static_cast<int>(ExitCode::input), "it does not support the lights of every frame"};
  result.failure = sum.failure;
  compare::Seconds& seconds = result.stats.seconds;
  if (result.failure) {
    seconds = {};
    return;
  }
  result.error = sum.errors.error();
  result.flicker = sum.flicker.root();
  result.pops = sum.flicker.popping();
  if (!sum.light.empty()) seconds.light = session::median(sum.light);
  if (!sum.evaluate.empty()) seconds.evaluate = session::median(sum.evaluate);
  seconds.total.reset();
  seconds.total = seconds.sum();
}

Json number_or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

Json pops_json(const std::optional<compare::Pops>& pops) {
  return pops ? Json{{"share", pops->share}, {"max", pops->max}} : Json();
}

Json frame_json(std::int64_t number, const compare::Metrics& metrics, std::span<const Changes> flicker) {
  Json methods = Json::array();
  for (std::size_t i = 0; i < metrics.methods.size(); ++i) {
    const compare::MethodResult& result = metrics.methods[i];
    methods.push_back({{"entry", result.entry},
                       {"rmse", result.error ? Json(result.error->rmse) : Json()},
                       {"bias", result.error ? Json(result.error->bias) : Json()},
                       {"flicker", number_or_null(flicker[i].root())},
                       {"pops", pops_json(flicker[i].popping())},
                       {"shadow", number_or_null(result.stats.seconds.shadow())},
                       {"failure", result.failure ? Json(result.failure->message) : Json()}});
  }
  return {{"frame", number},
          {"judgedPixels", metrics.judged_pixels},
          {"horizonPixels", metrics.horizon_pixels},
          {"methods", methods}};
}

}  // namespace

compare::Metrics compare_frames(const session::RunOptions& run, const session::ComparisonOptions& options,
                                std::span<const std::int64_t> frames, double fps,
                                const std::vector<std::string>& arguments, session::Progress& progress) {
  // Files are claimed before any long work; the last frame's comparison claims them again.
  session::ComparisonFiles files(run.out, {.png = options.png, .bits = options.bits});
  files.claim(run.scene, options.methods, options.stats);
  compare::Metrics all;
  SayOnce said(progress);
  std::map<std::string, EntrySum> sums;
  std::map<std::string, visibility::FrameMemory> memories;
  Json rows = Json::array();
  std::uint64_t judged = 0, horizon = 0;
  for (const std::int64_t number : frames) {
    session::ComparisonOptions of_frame = options;
    of_frame.time = static_cast<double>(number) * (1 / fps);  // as in `render`
    of_frame.writes = number == frames.back();
    if (!of_frame.writes) of_frame.stats.clear();
    of_frame.memories = &memories;
    for (auto& [entry, memory] : memories) memory.next_frame();
    session::EntryErrors errors;
    all = session::compare_methods(run, of_frame, arguments, said, &errors);
    const std::size_t most = std::size_t{all.reference.width} * all.reference.height * frames.size();
    std::vector<Changes> flicker(errors.size());
    for (std::size_t i = 0; i < errors.size(); ++i) {
      const compare::MethodResult& result = all.methods[i];
      EntrySum& sum = sums.try_emplace(result.entry, EntrySum{ErrorSum(most), {}, {}, {}, {}, {}, 0}).first->second;
      ++sum.frames;
      if (result.failure && !sum.failure) sum.failure = result.failure;
      flicker[i].add(errors[i], sum.before);
      sum.flicker += flicker[i];
      sum.errors.add(errors[i]);
      if (const auto& light = result.stats.seconds.light) sum.light.push_back(*light);
      if (const auto& evaluate = result.stats.seconds.evaluate) sum.evaluate.push_back(*evaluate);
      sum.before = std::move(errors[i]);
    }
    rows.push_back(frame_json(number, all, flicker));
    judged += all.judged_pixels;
    horizon += all.horizon_pixels;
  }
  all.judged_pixels = judged;
  all.horizon_pixels = horizon;
  for (compare::MethodResult& result : all.methods) take_sum(result, sums.at(result.entry), frames.size());
  Json json = compare::to_json(all);
  json["frames"] = rows;
  write_file_atomically(run.out / "metrics.json", compare::json_text(json));
  write_file_atomically(run.out / "metrics.csv", compare::metrics_csv(all));
  if (!options.stats.empty()) write_file_atomically(options.stats, compare::json_text(json));
  return all;
}

}  // namespace penumbra::app
