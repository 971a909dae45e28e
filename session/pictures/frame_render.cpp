// SPDX-License-Identifier: Apache-2.0
// Renders a picture of a scene and writes its files.

#include "session/pictures/frame_render.hpp"

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/exr.hpp"
#include "base/png.hpp"
#include "session/methods.hpp"
#include "session/parse.hpp"
#include "session/pictures/surfaces.hpp"
#include "session/process/interrupt.hpp"
#include "session/process/process_clock.hpp"
#include "session/process/stopwatch.hpp"
#include "session/whole_lights.hpp"
#include "visibility/alpha/panes.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <future>
#include <map>
#include <numeric>
#include <utility>

namespace penumbra::session {
namespace {

/// Returns the sum of all lights, in their order.
std::vector<glm::vec3> sum_of(std::span<const std::vector<glm::vec3>> parts, std::size_t pixels) {
  std::vector<glm::vec3> sum(pixels, glm::vec3(0));
  for (const std::vector<glm::vec3>& part : parts) {
    for (std::size_t i = 0; i < part.size(); ++i) sum[i] += part[i];
  }
  return sum;
}

/// Returns, in words, which structures of the previous picture's meshes were reused (docs/frames.md); empty: unknown.
std::string mesh_line(const std::map<std::string, std::uint64_t>& counters) {
  std::string line;
  for (const auto& [counter, words] : {std::pair{"meshesKept", "nothing moved"},
                                       {"treesRefit", "triangles' hierarchy refit"},
                                       {"treesBuilt", "triangles' hierarchy built"},
                                       {"edgesRefit", "edges refit"},
                                       {"edgeTreesBuilt", "edges' hierarchy built"},
                                       {"edgesBuilt", "edges found"}}) {
    const auto count = counters.find(counter);
    if (count == counters.end() || count->second == 0) continue;
    line += (line.empty() ? "meshes: " : ", ") + std::string(words);
    if (count->second > 1) line += fmt::format(" {} times", count->second);
  }
  return line;
}

/// Returns whether any pixel is on a side that receives the light.
bool lights_anything(std::span<const visibility::PixelClass> classes) {
  using visibility::PixelClass;
  return std::ranges::any_of(classes, [](PixelClass one) {
    return one == PixelClass::judged || one == PixelClass::horizon || one == PixelClass::unshadowed ||
           one == PixelClass::other_body;
  });
}

}  // namespace

void FrameRenderer::add_times(MethodRun& to, const MethodRun& before) {
  to.times.mesh += before.times.mesh;
  to.times.light += before.times.light;
  to.times.evaluate += before.times.evaluate;
  to.times.read += before.times.read;
  for (std::size_t light = 0; light < before.times.lights.size(); ++light) {
    to.times.lights[light].light += before.times.lights[light].light;
    to.times.lights[light].evaluate += before.times.lights[light].evaluate;
  }
  to.passes.insert(to.passes.begin(), before.passes.begin(), before.passes.end());
  for (const auto& [name, count] : before.counters) to.counters[name] += count;
  to.memory_bytes = std::max(to.memory_bytes, before.memory_bytes);
}

FrameRenderer::FrameRenderer(const RunOptions& options, const MethodWish& wish, const render::Machine& machine,
                             Progress& progress)
    : options_(options),
      wish_(wish),
      format_(parse_format(options.format)),
      machine_(machine),
      progress_(progress),
      maker_(options, machine) {}

void FrameRenderer::look_at_surface(SurfaceView view) {
  maker_.find_view_by(view.finder);
  surface_ = std::move(view);
}

void FrameRenderer::say_once(const std::vector<std::string>& warnings) {
  progress_.clear();
  for (const std::string& warning : warnings) {
    if (std::ranges::find(said_.warnings, warning) != said_.warnings.end()) continue;
    progress_.warn(warning);
    said_.warnings.push_back(warning);
  }
}

void FrameRenderer::say_warnings() {
  progress_.clear();
  const auto& cameras = session().scene.cameras;
  if (cameras.size() > 1 && options_.camera.empty() && !std::exchange(said_.camera, true))
    progress_.info(
        fmt::format("camera \"{}\", the first of {}; --camera NAME or all", cameras.front().name, cameras.size()));
  say_once(lit().warnings);
}

void FrameRenderer::mark_lights() {
  const std::vector<WholeLight> lights = whole_lights(lit().lights);
  done_.lights_something.resize(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const auto pieces = std::span(lit().classes).subspan(lights[i].first, lights[i].count);
    if (std::ranges::any_of(pieces, [](const auto& piece) { return lights_anything(piece); }))
      done_.lights_something[i] = 1;
  }
}

void FrameRenderer::say_idle_lights() {
  std::vector<std::string> warnings;
  const std::vector<WholeLight> lights = whole_lights(lit().lights);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const visibility::Light& light = lit().lights[lights[i].first];
    if (light.radiance == glm::dvec3(0) || done_.lights_something[i] != 0) continue;
    warnings.push_back(
        fmt::format("no visible point is in front of light \"{}\": nothing in the picture is lit by it{}", light.name,
                    light.two_sided ? "" : " (does it shine the other way?)"));
  }
  say_once(warnings);
}

void FrameRenderer::show(SessionMaker& maker, scenes::Scene scene, const scenes::Instances* instances) {
  if (instances != nullptr && !instances->empty()) {
    maker.look_into(scene, *instances, counts_dome_samples(wish_, scene.lights));
    maker.show_part({0, maker.picture_size(scene, picture_.frame.camera).second}, picture_.frame.camera, progress_);
    maker.look_away();
  } else if (picture_.frame.same_meshes) {
    maker.show_again(std::move(scene), picture_.frame.camera, progress_);
  } else {
    maker.show(std::move(scene), picture_.frame.camera, 0, progress_);
  }
  note_seconds(maker);
}

void FrameRenderer::note_seconds(const SessionMaker& maker) {
  spent_.load += maker.session().load_seconds;
  spent_.make += maker.session().device_seconds;
  spent_.view += maker.session().view_seconds + maker.session().receiver_seconds;
}

void FrameRenderer::check_wanted_layers() const {
  check_layers(format_, session(), picture_.frame.pixel_side > 1 || !picture_.frame.moments.empty());
}

/// Marks the pixels at which the current surfaces are bodies of lights.
void FrameRenderer::mark_lamps() {
  picture_.lamps.resize(session().pixel_count());
  const std::uint32_t side = lit().width / session().width;
  for (std::size_t i = 0; i < lit().samples.size(); ++i) {
    const std::int32_t triangle = lit().samples.triangle[i];
    if (triangle < 0 || lit().floats.emits[static_cast<std::size_t>(triangle)] < 0) continue;
    picture_.lamps[i / lit().width / side * session().width + i % lit().width / side] = 1;
  }
}

void FrameRenderer::add_panes() {
  const Stopwatch find;
  const visibility::Panes panes(lit().floats, lit().samples);
  spent_.view += find.seconds();
  if (panes.depth() == 0) return;
  const std::size_t pixels = picture_.alpha.size();
  std::vector<double> through(pixels, 1.0);
  std::vector<std::vector<glm::dvec3>> over(picture_.beauty.size(), std::vector<glm::dvec3>(pixels, glm::dvec3(0)));
  const auto add = [&](std::size_t pixel, double share, std::span<const std::vector<glm::vec3>> beauty) {
    for (std::size_t light = 0; light < over.size(); ++light) {
      if (!beauty[light].empty()) over[light][pixel] += share * glm::dvec3(beauty[light][pixel]);
    }
  };
  visibility::ViewSamples behind;
  picture_.layers = true;
  for (std::size_t number = 0; number < panes.depth(); ++number) {
    Stopwatch watch;
    visibility::PaneLayer layer = panes.layer(number);
    visibility::ViewSamples before = lit_maker().look_at(std::move(layer.samples));
    if (behind.size() == 0) behind = std::move(before);
    choose_methods(lit());
    say_notes();
    spent_.view += watch.seconds() - lit().filtering_seconds();
    watch.restart();
    mark_lights();
    mark_lamps();
    BeautyAccumulator beauty(lit(), lit().lights);
    spent_.beauty += watch.seconds();
    add_times(picture_.run, run_lights(beauty, nullptr));
    watch.restart();
    for (std::size_t i = 0; i < pixels; ++i) {
      add(i, through[i] * double{layer.alpha[i]}, beauty.parts());
      through[i] *= 1 - double{layer.alpha[i]};
    }
    spent_.beauty += watch.seconds();
  }
  picture_.layers = false;
  const Stopwatch back;
  lit_maker().look_at(std::move(behind));
  spent_.view += back.seconds();
  for (std::size_t i = 0; i < pixels; ++i) {
    add(i, through[i], picture_.beauty);
    picture_.alpha[i] = static_cast<float>(1 - through[i] * (1 - double{picture_.alpha[i]}));
  }
  for (std::size_t light = 0; light < over.size(); ++light)
    picture_.beauty[light].assign(over[light].begin(), over[light].end());
}

void FrameRenderer::require_device() const {
  if (wish_.method.empty() || !needs_device(wish_.method, wish_.options)) return;
  try {
    static_cast<void>(machine_.device());
  } catch (const ResourceError& error) {
    throw ResourceError("{}: {}", wish_.method, error.what());
  }
}

void FrameRenderer::render(scenes::Scene scene, const Frame& frame, const std::filesystem::path& bits,
                           double read_seconds) {
  require_device();
  picture_.frame = frame;
  if (memories_) (*memories_)[frame.camera].next_frame();
  spent_ = {.load = read_seconds};
  picture_.bits.reset();
  picture_.mean.reset();
  picture_.still.reset();
  picture_.mattes.reset();
  picture_.masks.clear();
  picture_.in_bands = false;
  picture_.own_rows.reset();
  picture_.layers = false;
  picture_.lamps.clear();
  for (Kept& kept : kept_) kept.used = false;
  done_.with.clear();
  done_.in_part.clear();
  picture_.notes.clear();
  picture_.cutoff.reset();
  picture_.run = {};
  const bool lens = has_lens(scene);
  if (frame.pixel_side == 1 && !lens && fine_) {
    kept_.clear();  // kept methods refer to the session that is replaced
    fine_.reset();
  }
  picture_.all = nullptr;
  if (passes_triangles()) {
    render_passing(scene, bits);
  } else if (shows_in_bands(bits)) {
    render_in_bands(scene);
  } else if (frame.moments.empty() && frame.pixel_side == 1) {
    show(maker_, std::move(scene), frame.instances);
    check_wanted_layers();
    run_methods(bits);
  } else {
    render_mean(std::move(scene), lens);
  }
  label_lights();
  machine_.check_validation();  // throws before a file appears: a picture computed with validation errors is not
                                // written
}

RenderedFrame FrameRenderer::take() {
  const std::vector<std::string> own = whole_names(session().lights);
  RenderedFrame frame;
  frame.beauty = picture_.mean ? picture_.mean->take_beauty(own) : std::move(picture_.beauty);
  frame.visibility = picture_.mean ? picture_.mean->take_visibility(own) : std::move(picture_.run.visibility);
  frame.alpha = picture_.mean ? picture_.mean->take_alpha() : std::move(picture_.alpha);
  frame.masks = std::move(picture_.masks);
  frame.sum = sum_of(frame.beauty, session().pixel_count());
  if (!picture_.mean) return frame;
  std::vector<std::string> others = picture_.mean->lights();  // lights of other moments only
  std::erase_if(others, [&](const std::string& light) { return std::ranges::find(own, light) != own.end(); });
  const std::vector<glm::vec3> more = sum_of(picture_.mean->take_beauty(others), frame.sum.size());
  for (std::size_t i = 0; i < more.size(); ++i) frame.sum[i] += more[i];
  return frame;
}

compare::Stats FrameRenderer::stats() {
  compare::Stats stats = make_stats(session(), {session().lights, done_.labels}, picture_.run);
  say_once(stats.warnings);
  stats.warnings.insert(stats.warnings.end(), picture_.notes.begin(), picture_.notes.end());
  stats.light_cutoff = picture_.cutoff;
  compare::Seconds& seconds = stats.seconds;
  seconds.load = spent_.load;
  seconds.mesh = *seconds.mesh + spent_.make;
  seconds.view = spent_.view;
  seconds.beauty = std::max(spent_.beauty - spent_.bits, 0.0);
  return stats;
}

compare::Stats FrameRenderer::write(const FrameFiles& files, Exposure& exposure) {
  const Stopwatch write;
  const LabelledLights lights{session().lights, done_.labels};
  RenderedFrame content = take();
  if (surface_) surface_->finish(content, session());
  float stops = exposure.stops;
  if (exposure.kind == Exposure::Kind::automatic || std::isnan(stops))
    stops = std::log2(auto_exposure(session(), content.sum, picture_.lamps));
  if (exposure.kind == Exposure::Kind::first) exposure.stops = stops;
  std::map<std::string, std::string> attributes = {{kExposureAttribute, fmt::format("{}", stops)}};
  if (surface_) attributes.insert(surface_->attributes.begin(), surface_->attributes.end());
  note_means(attributes);
  if (picture_.cutoff) attributes["penumbra.lightCutoff"] = fmt::format("{}", picture_.cutoff->below);
  if (picture_.frame.number) attributes["penumbra.frame"] = fmt::format("{}", *picture_.frame.number);

  progress_.clear();
  // All files are completely on the disk before the first gets its name: if there is no room, nothing is left.
  AtomicFile picture(files.picture);
  std::optional<AtomicFile> png, stats_file;
  std::future<std::vector<std::byte>> packed;
  if (!files.png.empty()) {
    png.emplace(files.png);
    // libpng uses one thread; OpenEXR's compression runs in parallel.
    packed = std::async(std::launch::async, [this, &content, stops] {
      return encode_png(to_srgb(session().width, session().height, content.sum, std::exp2(stops)));
    });
  }
  const PictureContent written{
      session(),   lights,        content.visibility,    content.beauty,
      content.sum, content.alpha, std::move(attributes), picture_.mattes ? &*picture_.mattes : nullptr};
  say_once(write_picture(picture, written, format_));
  if (tev_ != nullptr) tev_->show(files.picture.filename().string(), written);
  picture.settle();
  if (png) {
    png->write(packed.get());
    png->settle();
  }
  compare::Stats stats = this->stats();
  compare::Seconds& seconds = stats.seconds;
  seconds.write = write.seconds() + spent_.bits;
  // Seconds from the last picture to this one: those of a sequence's pictures add up to the total.
  const double now = seconds_since_start();
  seconds.total = now - std::exchange(written_, now);
  if (!files.stats.empty()) {
    stats_file.emplace(files.stats);
    stats_file->write(compare::json_text(compare::to_json(stats)));
    stats_file->settle();
  }
  if (picture_.bits) picture_.bits->settle();
  // Either all of a frame's files get their names or none, even if a signal arrives now.
  const UnwindsAfterSignals unwinds;
  if (picture_.bits) picture_.bits->commit();
  picture_.bits.reset();
  picture.commit();
  if (png) png->commit();
  if (const std::string line = mesh_line(picture_.run.counters); expects_frames_ && !line.empty())
    progress_.debug(line);
  if (stats_file) stats_file->commit();
  return stats;
}

}  // namespace penumbra::session
