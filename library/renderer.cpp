// SPDX-License-Identifier: Apache-2.0
// Renders pictures of one scene one after another, with the frame renderer of the command line.

#include "base/error.hpp"
#include "compare/stats.hpp"
#include "library/as_error.hpp"
#include "library/library_progress.hpp"
#include "library/picture_state.hpp"
#include "library/scene_state.hpp"
#include "render/device.hpp"
#include "render/machine.hpp"
#include "scenes/formats/checks.hpp"
#include "scenes/instances.hpp"
#include "session/light_methods.hpp"
#include "session/machine.hpp"
#include "session/methods.hpp"
#include "session/options.hpp"
#include "session/pictures/frame_render.hpp"
#include "session/pictures/request.hpp"
#include "session/process/stopwatch.hpp"
#include "session/whole_lights.hpp"

#include <penumbra/renderer.hpp>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace penumbra {
namespace {

constexpr float kFar = 1e10F;  // Z of the background

/// Returns the number of rows that methods evaluate between two calls of the progress function: some tenths of a second
/// of work. All rows if there is no such function, and for pictures with several view samples a pixel, which have
/// separate bands (FrameRenderer::mean_bands).
std::uint32_t band_rows(const RendererOptions& renderer, const scenes::Scene& scene, const RenderOptions& options) {
  constexpr std::uint32_t kSamples = 1U << 16U;
  if (!renderer.progress || options.pixel_samples > 1) return std::numeric_limits<std::uint32_t>::max();
  const std::uint32_t width = options.width != 0 ? options.width : scene.width;
  return std::max(kSamples / std::max(width, 1U), 1U);
}

/// Returns the number of view samples along each axis of a pixel. Throws UsageError for a number that is not a square.
std::uint32_t pixel_side(std::uint32_t samples) {
  for (std::uint32_t side = 1; side <= 8; ++side) {
    if (side * side == samples) return side;
  }
  throw UsageError("pixel_samples {}: expected a square number from 1 to 64, such as 4, 9 or 16", samples);
}

double pixel_tolerance(double tolerance) {
  if (tolerance >= 0 && tolerance <= 1) return tolerance;
  throw UsageError("pixel_tolerance {}: expected a number from 0 (every view sample is evaluated) to 1", tolerance);
}

double light_cutoff(double share) {
  if (share >= 0 && share <= 1) return share;
  throw UsageError("light_cutoff {}: expected a share of a pixel's light from 0 (no light is left out) to 1", share);
}

void check_lights_and_cameras(const scenes::Scene& scene) {
  for (const scenes::AreaLight& light : scene.lights)
    scenes::check_light(light, fmt::format("light \"{}\"", light.name));
  for (const scenes::Camera& camera : scene.cameras)
    scenes::check_camera(camera, fmt::format("camera \"{}\"", camera.name));
}

session::RunOptions run_options(const RenderOptions& options) {
  session::RunOptions run;
  run.scene = "the scene";
  if (options.light_samples != 0) run.light_samples = fmt::format("{}", options.light_samples);
  run.sample_pattern = options.sample_pattern;
  run.sample_seed = options.sample_seed;
  if ((options.width == 0) != (options.height == 0))
    throw UsageError("size {}x{}: expected both, or neither for the scene's", options.width, options.height);
  if (options.width != 0) run.size = fmt::format("{}x{}", options.width, options.height);
  run.lights = options.lights;
  run.normals = options.shading_normals ? "shading" : "geometric";
  return run;
}

std::string camera_of(const Scene::State& scene, const RenderOptions& options) {
  if (!options.camera.empty() || !scene.camera) return options.camera;
  return scene.scene.cameras[*scene.camera].name;
}

std::shared_ptr<const Picture::State> picture_of(session::FrameRenderer& frames, double seconds) {
  auto picture = std::make_shared<Picture::State>();
  const session::Session& session = frames.session();
  picture->width = session.width;
  picture->height = session.height;
  compare::Stats stats = frames.stats();
  stats.seconds.total = seconds;
  picture->stats = compare::json_text(compare::to_json(stats));
  for (const compare::LightStats& light : stats.lights) {
    picture->lights.push_back(light.name);
    picture->methods.push_back(light.method);
    picture->light_samples.push_back(light.light_samples);
  }
  picture->frame = frames.take();
  const std::vector<session::WholeLight> wholes = session::whole_lights(session.lights);
  std::vector<std::vector<std::uint32_t>> masks(wholes.size());
  for (std::size_t light = 0; light < wholes.size(); ++light) {
    const bool is_whole = wholes[light].count == 1 && wholes[light].first < picture->frame.masks.size();
    if (is_whole) masks[light] = std::move(picture->frame.masks[wholes[light].first]);
    picture->words.push_back(masks[light].empty() ? 0 : session.lights[wholes[light].first].words_per_mask());
  }
  picture->frame.masks = std::move(masks);

  const visibility::ViewSamples& samples = session.samples;
  picture->origin = session.floats.origin;
  picture->relative_positions = samples.p;
  picture->normals = samples.n;
  picture->positions.resize(samples.size());
  picture->depth.resize(samples.size());
  picture->ids.resize(samples.size());
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    const bool is_background = samples.triangle[i] == visibility::ViewSamples::kBackground;
    picture->positions[i] = is_background ? glm::vec3(0) : glm::vec3(glm::dvec3(samples.p[i]) + session.floats.origin);
    picture->depth[i] = is_background ? kFar : samples.depth[i];
    picture->ids[i] = static_cast<std::uint32_t>(session.number_of(samples.triangle[i]));
  });
  return picture;
}

}  // namespace

void LibraryProgress::begin(std::string stage, std::uint64_t steps) {
  stage_ = std::move(stage);
  steps_ = std::max<std::uint64_t>(steps, 1);
  done_ = 0;
  report();
}

void LibraryProgress::advance(std::uint64_t steps) {
  done_ = std::min(done_ + steps, steps_);
  report();
}

template <typename Function>
void LibraryProgress::call(const Function& function) {
  if (thrown_) throw Cancelled();
  try {
    function();
  } catch (...) {
    thrown_ = std::current_exception();
    throw Cancelled();
  }
}

void LibraryProgress::report() {
  call([&] {
    if (options_.progress && !options_.progress(stage_, static_cast<double>(done_) / static_cast<double>(steps_)))
      throw Cancelled();
  });
}

void LibraryProgress::rethrow() {
  if (const std::exception_ptr thrown = std::exchange(thrown_, nullptr)) std::rethrow_exception(thrown);
}

void LibraryProgress::say(Level level, const std::string& message) {
  constexpr std::array kLevels = {LogLevel::debug, LogLevel::info, LogLevel::warning, LogLevel::error};
  call([&] {
    if (options_.log) options_.log(kLevels.at(static_cast<std::size_t>(level)), message);
  });
}

Cancelled::Cancelled() : Error(ExitCode::interrupted, "cancelled by the progress function") {}
Cancelled::~Cancelled() = default;

struct Renderer::State {
  State(Scene made, RendererOptions wished)
      : scene(std::move(made)), options(std::move(wished)), machine(session::make_machine(options.device)) {}

  /// Throws UsageError during a call: its progress and log functions cannot start another.
  void require_idle() const {
    if (working) throw UsageError("the renderer is at work; it is for one call at a time");
  }
  /// Marks the state as at work during its lifetime.
  class Working {
   public:
    explicit Working(State& state) : state_(state) { state_.working = true; }
    Working(const Working&) = delete;
    Working& operator=(const Working&) = delete;
    ~Working() { state_.working = false; }

   private:
    State& state_;
  };

  Scene scene;
  RendererOptions options;
  std::atomic<bool> working = false;
  render::Machine machine;
  LibraryProgress progress{options};
  session::RunOptions run;
  session::MethodWish wish;
  std::uint64_t rendered = 0;                      // Scene::State::meshes of the most recent picture
  bool shared = false;                             // the most recent picture was of instances without copies
  std::unique_ptr<session::FrameRenderer> frames;  // refers to run, wish and progress
};

Renderer::Renderer(Scene scene, RendererOptions options)
    : state_(std::make_unique<State>(std::move(scene), std::move(options))) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Scene& Renderer::scene() {
  state_->require_idle();
  return state_->scene;
}
const Scene& Renderer::scene() const {
  return state_->scene;
}

Picture Renderer::render(const RenderOptions& options) {
  const session::Stopwatch total;
  State& state = *state_;
  state.require_idle();
  const State::Working working(state);
  const Scene::State& scene = state.scene.state();
  const std::uint64_t meshes = scene.meshes;
  // Invalid options are rejected before any change, so that the kept data stay valid.
  session::NamedMethod method = session::parse_method(options.method);
  for (const auto& [key, value] : options.options) {
    if (!method.options.emplace(key, value).second)
      throw UsageError("method {}: option {} is given twice", method.name, key);
  }
  if (!method.name.empty()) static_cast<void>(session::describe_method(method.name, method.options));
  session::MethodWish wish{std::move(method.name), std::move(method.options),
                           options.light_samples != 0 || !options.sample_pattern.empty()};
  const std::uint32_t side = pixel_side(options.pixel_samples);
  const bool copies = session::needs_copies(scene.scene, scene.instances,
                                            session::parse_instances(options.instances, wish), wish, side * side);
  const bool shares = !copies && !scene.instances.empty();
  const bool same_meshes = options.pixel_samples == 1 && state.frames && state.frames->has_meshes() &&
                           state.rendered == meshes && !scene.scene.lights.empty() && !shares && !state.shared;
  if (same_meshes)
    check_lights_and_cameras(scene.scene);
  else
    scenes::check_scene(scene.scene, "the scene", true, scene.instances);
  session::RunOptions run = run_options(options);
  run.camera = camera_of(scene, options);
  const session::Frame frame{.number = {},
                             .camera = run.camera,
                             .pixel_side = side,
                             .pixel_tolerance = pixel_tolerance(options.pixel_tolerance),
                             .instances = shares ? &scene.instances : nullptr,
                             .same_meshes = same_meshes,
                             .light_cutoff = light_cutoff(options.light_cutoff),
                             .keeps_masks = options.masks && options.pixel_samples == 1,
                             .band_rows = band_rows(state.options, scene.scene, options)};
  static_cast<void>(session::parse_light_samples(run));
  state.run = std::move(run);
  state.wish = std::move(wish);
  if (!state.frames) {
    state.frames = std::make_unique<session::FrameRenderer>(state.run, state.wish, state.machine, state.progress);
    state.frames->expect_frames();
  }
  try {
    state.frames->render(
        same_meshes ? session::without_meshes(scene.scene)
        : copies ? scenes::copied(scene.scene, scene.instances, session::bytes_per_copy(state.wish, scene.scene.lights))
                 : scene.scene,
        frame, {}, 0);
    state.rendered = meshes;
    state.shared = shares;
    Picture picture(picture_of(*state.frames, total.seconds()));
    state.progress.rethrow();
    return picture;
  } catch (const render::DeviceDoesNotAnswer& error) {
    // Objects of a device at work must not be destroyed: the frame renderer is leaked deliberately.
    static_cast<void>(state.frames.release());
    state.machine = session::make_machine(state.options.device);
    throw ResourceError(error.what());
  } catch (...) {
    state.frames.reset();  // its data may belong partly to one scene and partly to another
    state.progress.rethrow();
    throw_as_error();
  }
}

}  // namespace penumbra
