#include "bench/entry.hpp"

#include "app/session.hpp"
#include "app/stopwatch.hpp"
#include "base/error.hpp"
#include "compare/machine.hpp"
#include "reference/plain_rays.hpp"
#include "reference/ray_traced.hpp"
#include "render/visibility_buffer.hpp"
#include "scenes/reader.hpp"
#include "vsm/view_sample.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <variant>

#include <stdlib.h>

namespace penumbra::bench {
namespace {

using visibility::PixelClass;

/// What all contestants are asked.
struct Question {
  visibility::SceneFloats floats;
  visibility::ViewSamples samples;
  visibility::Light light;
  std::vector<PixelClass> classes;
};

void resize_first_light(scenes::Scene& scene, double half) {
  auto* rectangle = std::get_if<scenes::Rectangle>(&scene.lights.front().shape);
  if (rectangle == nullptr) throw UsageError("--light-half: the scene's first light is no rectangle");
  rectangle->half_u = glm::normalize(rectangle->half_u) * half;
  rectangle->half_v = glm::normalize(rectangle->half_v) * half;
}

Question make_question(const Subject& subject, const Options& options, const render::Device& device) {
  scenes::Scene scene = scenes::read_scene(subject.scene);
  if (subject.light_half) resize_first_light(scene, *subject.light_half);
  Question question;
  question.floats = visibility::make_scene_floats(scene);
  const auto camera =
      visibility::make_camera(scene.cameras.front(), question.floats.origin, options.size, options.size);
  question.samples = render::VisibilityBuffer(device, question.floats).render(camera);
  question.light = visibility::make_light(scene, 0, question.floats.origin, {.count = options.light_samples});
  question.classes = visibility::classify_pixels(question.floats, question.samples, question.light);
  return question;
}

double load_of_machine() {
  double load = 0;
  return ::getloadavg(&load, 1) == 1 ? load : std::numeric_limits<double>::quiet_NaN();
}

/// A method of the program; keeps V and masks of its last run.
class MethodRunner {
 public:
  MethodRunner(std::unique_ptr<visibility::Method> method, const Question& question)
      : method_(std::move(method)), question_(question), visibility_(question.samples.size()) {
    const app::Stopwatch watch;
    method_->prepare_mesh(question_.floats);
    mesh_ = watch.seconds();
  }

  void run(bool timed) {
    app::Stopwatch watch;
    method_->prepare_light(question_.light);
    const double light = watch.seconds();
    method_->prepare_view(question_.samples);  // shared by all methods, in none's time
    method_->take_pass_times();
    const std::uint32_t step = method_->max_tile_rows(), height = question_.samples.height;
    const std::size_t words = question_.light.words_per_mask(), width = question_.samples.width;
    masks_.resize(question_.samples.size() * words);
    double evaluate = 0;
    for (std::uint32_t row = 0; row < height; row += step) {
      const visibility::Tile tile{row, std::min(step, height - row)};
      watch.restart();
      method_->evaluate(tile);
      evaluate += watch.seconds();
      method_->read_masks(std::span(masks_).subspan(row * width * words, tile.row_count * width * words));
      method_->read_visibility(std::span(visibility_).subspan(row * width, tile.row_count * width));
    }
    if (!timed) return;
    times_.light.push_back(light);
    times_.evaluate.push_back(evaluate);
    passes_.clear();
    for (const visibility::PassTime& pass : method_->take_pass_times()) passes_[pass.name] += pass.milliseconds;
  }

  [[nodiscard]] std::span<const float> visibility() const { return visibility_; }
  [[nodiscard]] std::span<const std::uint32_t> masks() const { return masks_; }
  [[nodiscard]] Contestant result(const std::string& device) const {
    return {.name = method_->description().name,
            .device = device,
            .mesh = mesh_,
            .times = times_,
            .error = {},
            .pairs = {},
            .passes = passes_,
            .counters = method_->counters()};
  }

 private:
  std::unique_ptr<visibility::Method> method_;
  const Question& question_;
  double mesh_ = 0;
  Times times_;
  std::map<std::string, double> passes_;
  std::vector<float> visibility_;
  std::vector<std::uint32_t> masks_;
};

/// The speed peer, with the packets that are fastest on this subject and processor.
class PeerRunner {
 public:
  explicit PeerRunner(const Question& question) : question_(question), visibility_(question.samples.size()) {
    double best = std::numeric_limits<double>::infinity();
    for (const int packet : {4, 8, 16}) {
      reference::PlainRays candidate({.width = packet});
      const app::Stopwatch watch;
      candidate.prepare_mesh(question_.floats);
      const double mesh = watch.seconds();
      candidate.prepare_light(question_.light);
      candidate.evaluate(question_.samples, visibility_);  // warms up
      const app::Stopwatch again;
      candidate.evaluate(question_.samples, visibility_);
      if (again.seconds() >= best) continue;
      best = again.seconds();
      packet_ = packet;
      mesh_ = mesh;
      rays_.emplace(std::move(candidate));
    }
  }

  void run(bool timed) {
    app::Stopwatch watch;
    rays_->prepare_light(question_.light);
    const double light = watch.seconds();
    watch.restart();
    rays_->evaluate(question_.samples, visibility_);
    const double evaluate = watch.seconds();
    if (!timed) return;
    times_.light.push_back(light);
    times_.evaluate.push_back(evaluate);
  }

  [[nodiscard]] int packet() const { return packet_; }
  [[nodiscard]] std::span<const float> visibility() const { return visibility_; }
  [[nodiscard]] Contestant result(const std::string& device) const {
    return {.name = "plain-rays",
            .device = device,
            .mesh = mesh_,
            .times = times_,
            .error = {},
            .pairs = {},
            .passes = {},
            .counters = {}};
  }

 private:
  const Question& question_;
  std::optional<reference::PlainRays> rays_;
  int packet_ = 0;
  double mesh_ = 0;
  Times times_;
  std::vector<float> visibility_;
};

/// Pairs over pixels with A = 1. Emitters and what receives no shadow are visible by the host's rule, whatever a method
/// made of them: their pairs count, and none differs.
compare::PairCounts count_pairs(const Question& question, const MethodRunner& method, const MethodRunner& reference) {
  std::vector<std::uint32_t> asked;
  std::uint64_t by_rule = 0;
  for (const std::uint32_t pixel : compare::pixels_with_alpha(question.samples)) {
    const PixelClass c = question.classes[pixel];
    if (c == PixelClass::emitter || c == PixelClass::unshadowed) {
      ++by_rule;
    } else {
      asked.push_back(pixel);
    }
  }
  const std::uint32_t samples = question.light.sample_count();
  compare::PairCounts counts =
      compare::count_pairs({.method = method.masks(), .reference = reference.masks(), .sample_count = samples}, asked);
  counts.all += by_rule * samples;
  return counts;
}

}  // namespace

std::vector<double> Times::shadow() const {
  std::vector<double> sums;
  for (std::size_t i = 0; i < light.size(); ++i) sums.push_back(light[i] + evaluate[i]);
  return sums;
}

Timing timing_of(std::vector<double> seconds) {
  const auto [lowest, highest] = std::ranges::minmax(seconds);
  return {app::median(std::move(seconds)), lowest, highest};
}

Entry measure(const Subject& subject, const Options& options, const render::Device& device) {
  const double load = load_of_machine();
  const Question question = make_question(subject, options, device);
  MethodRunner view_sample(vsm::make_view_sample(device, {}), question);
  MethodRunner raytrace(reference::make_ray_traced({}), question);
  PeerRunner peer(question);
  for (std::uint32_t run = 0; run <= options.runs; ++run) {
    const bool timed = run > 0;
    view_sample.run(timed);
    peer.run(timed);
    raytrace.run(timed);
  }

  const compare::Machine machine = compare::this_machine();
  const std::string processor = fmt::format("{}, {} threads", machine.processor, machine.threads);
  const auto judged = compare::pixels_of_class(question.classes, PixelClass::judged);
  Entry entry{
      .subject = subject.name,
      .triangles = question.floats.triangles.size(),
      .pixels = compare::pixels_with_alpha(question.samples).size(),
      .samples = question.light.sample_count(),
      .width = options.size,
      .height = options.size,
      .packet = peer.packet(),
      .load_before = load,
      .contestants = {view_sample.result(device.info().name), peer.result(processor), raytrace.result(processor)}};
  entry.contestants[0].error = compare::visibility_error(view_sample.visibility(), raytrace.visibility(), judged);
  entry.contestants[0].pairs = count_pairs(question, view_sample, raytrace);
  entry.contestants[1].error = compare::visibility_error(peer.visibility(), raytrace.visibility(), judged);
  return entry;
}

}  // namespace penumbra::bench
