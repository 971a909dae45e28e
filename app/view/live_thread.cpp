// SPDX-License-Identifier: Apache-2.0
// Thread of LiveRenderer.
#include "app/view/live_renderer.hpp"
#include "app/view/live_steps.hpp"
#include "mesh/edge_graph.hpp"
#include "render/device.hpp"
#include "scenes/picture_size.hpp"
#include "session/machine.hpp"
#include "session/methods.hpp"
#include "session/output.hpp"
#include "session/process/interrupt.hpp"
#include "session/process/stopwatch.hpp"
#include "session/whole_lights.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace penumbra::app {

using nlohmann::ordered_json;

namespace {

constexpr std::uint32_t kSmallestSide = 32;  // of a reduced picture
constexpr std::uint32_t kMaskSamples = 256;
/// Number of rows of a band of a final picture; the picture can be cancelled after each band.
constexpr std::uint32_t kBand = 64;
/// Longest time that a picture waits for the last frame to be shown during a drag.
constexpr std::chrono::milliseconds kLongestShow{250};
/// Time that a final picture waits for further changes during a drag.
constexpr std::chrono::milliseconds kPause{90};
/// The same for a slow method, which notices a cancellation late.
constexpr std::chrono::milliseconds kPauseOfSlow{1000};

}  // namespace

bool LiveRenderer::is_overtaken(std::uint64_t revision) const {
  const std::lock_guard lock(mutex_);
  return revision_ != revision || wants_reload_ || ending_;
}

bool LiveRenderer::needs_masks() const {
  const bool has_masks = masks_ && masks_->revision == revision_ && masks_->light == state_.display.light;
  return state_.masks && !has_masks && masks_failed_ != revision_;
}

bool LiveRenderer::has_work() const {
  if (ending_ || wants_reload_ || (wants_show_ && picture_)) return true;
  const bool is_done = failed_ == revision_ || (picture_ && picture_->revision == revision_ && picture_->is_final);
  return !is_done || (failed_ != revision_ && (needs_masks() || needs_edges()));
}

void LiveRenderer::work() {
  try {
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [this] { return has_work(); });
      if (ending_) return;
      work_on(lock);
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    thrown_ = std::current_exception();
    ended_.notify_all();
  }
}

void LiveRenderer::work_on(std::unique_lock<std::mutex>& lock) {
  if (std::exchange(wants_reload_, false)) {
    lock.unlock();
    read_again();
    lock.lock();
    return;
  }
  // Waits until the page has drawn the last frame: a frame made earlier would be outdated when a slow page comes to
  // draw it, and would take processor time from the page.
  if (state_.moving && !wants_show_) {
    wake_.wait_for(lock, kLongestShow,
                   [this] { return !is_awaited_ || ending_ || wants_reload_ || wants_show_ || !state_.moving; });
    if (ending_ || wants_reload_) return;
  }
  const bool has_any = picture_ && picture_->revision == revision_;
  Order order{state_, whole_, revision_, pace_.quality(), has_any || final_milliseconds_ < kQuickTime, stamps_};
  if (failed_ == revision_ || (has_any && picture_->is_final) || wants_show_) {
    const bool shows = std::exchange(wants_show_, false), masks = needs_masks(), edges = needs_edges();
    lock.unlock();
    if (shows)
      show();
    else if (masks)
      make_masks(order);
    else if (edges)
      count_edges(order.whole);
    lock.lock();
    return;
  }
  if (order.is_final && order.state.moving && has_any) {
    const auto something_came = [&] {
      return ending_ || wants_reload_ || wants_show_ || revision_ != order.revision || !state_.moving;
    };
    const bool is_slow =
        slow_.contains(order.state.method) || (order.state.other && slow_.contains(*order.state.other));
    if (wake_.wait_for(lock, is_slow ? kPauseOfSlow : kPause, something_came)) {
      // The drag ended, or there is a newer state: checks again.
      if (revision_ != order.revision || ending_ || wants_reload_ || wants_show_) return;
    }
  }
  lock.unlock();
  make_picture(order);
  lock.lock();
}

void LiveRenderer::failed(std::uint64_t revision, const std::string& message) {
  {
    const std::lock_guard lock(mutex_);
    failed_ = revision;
  }
  events_.say("error", message);
}

void LiveRenderer::read_again() {
  try {
    session::InstanceUse use = session::InstanceUse::automatic;
    {
      const std::lock_guard lock(mutex_);
      use = whole_->use;
    }
    WholeScene read = read_whole_scene(options_, use);
    auto file = std::make_shared<const scenes::Scene>(session::without_meshes(read.scene));
    std::shared_ptr<const WholeScene> whole;
    {
      const std::lock_guard lock(mutex_);
      whole = whole_;
    }
    const bool same = whole->instances.empty() && read.instances.empty() && same_meshes(whole->scene, read.scene);
    {
      const std::lock_guard lock(mutex_);
      state_ = reloaded(state_, *file_, session::without_meshes(read.scene));
      file_ = std::move(file);
      if (!same || whole != whole_) {
        whole_ = std::make_shared<const WholeScene>(std::move(read));
        ++meshes_;
      }
      ++revision_;
    }
    events_.reloaded();
  } catch (const session::Interrupted&) {
    throw;
  } catch (const Error& error) {
    events_.say("error", error.what());  // the previous picture stays
  }
}

scenes::Scene LiveRenderer::scene_of(const Order& order) const {
  const LiveState& state = order.state;
  const bool same_meshes =
      frames_ && frames_->has_meshes() && rendered_ == order.whole && order.whole->instances.empty();
  scenes::Scene scene = same_meshes ? state.scene : with_meshes(state.scene, order.whole->scene);
  scene.cameras = {state.camera};
  return scene;
}

void LiveRenderer::render(const Order& order, scenes::Scene scene, bool keeps_masks) {
  if (!frames_) {
    frames_ = std::make_unique<session::FrameRenderer>(run_, wish_, machine_, *steps_);
    frames_->expect_frames();
  }
  const scenes::Instances& instances = order.whole->instances;
  const bool same_meshes = scene.soup.triangles.empty() && instances.empty();
  if (!instances.empty()) {
    scenes::Scene lit = session::without_meshes(scene);
    std::erase_if(lit.lights,
                  [&](const auto& light) { return std::ranges::find(run_.lights, light.name) == run_.lights.end(); });
    require_no_copies(lit, instances, wish_);
  }
  const session::Frame frame{.number = {},
                             .camera = scene.cameras.front().name,
                             .instances = &instances,
                             .same_meshes = same_meshes,
                             .keeps_masks = keeps_masks,
                             .band_rows = kBand};
  if (!same_meshes) rendered_ = order.whole;
  frames_->render(std::move(scene), frame, {}, 0);
}

/// Returns what to render for an entry. Quick pictures of exact areas, and of methods that are too slow for quick
/// pictures, use the default method for light samples instead.
session::MethodWish LiveRenderer::wish_for(const Order& order, const std::string& entry) {
  session::NamedMethod method = session::parse_method(entry);
  const std::uint32_t asked = order.state.light_samples;
  session::MethodWish wish{std::move(method.name), std::move(method.options), asked != 0};
  std::uint32_t samples = asked;
  if (!order.is_final) {
    samples = std::min(order.quality.light_samples, asked != 0 ? asked : kMaskSamples);
    if (wish.method.empty() || slow_.contains(entry) ||
        session::describe_method(wish.method, wish.options).gives_area()) {
      wish = {{}, {}, true};
    } else if (session::describe_method(wish.method, wish.options).counts_light_samples()) {
      wish.samples = true;
    } else {
      samples = 0;
    }
  }
  run_.light_samples = samples == 0 ? "" : fmt::format("{}", samples);
  return wish;
}

LiveAnswer LiveRenderer::answer(const Order& order, const std::string& entry, scenes::Scene& scene) {
  const session::Stopwatch watch;
  wish_ = wish_for(order, entry);
  render(order, std::move(scene), false);
  if (order.is_final)
    slow_.took_final(entry, 1000 * watch.seconds());
  else if (!wish_.method.empty())
    slow_.took(entry, 1000 * watch.seconds(), pace_.is_lowest());
  const compare::Stats stats = frames_->stats();
  LiveAnswer made;
  made.method = stats.method;
  for (const auto& [key, value] : stats.options) made.method += ":" + key + "=" + value;
  made.light_samples = stats.light_samples;
  made.milliseconds = 1000 * stats.seconds.shadow().value_or(0);
  made.seconds = compare::to_json(stats)["seconds"];
  made.frame = frames_->take();
  return made;
}

void LiveRenderer::make_picture(const Order& order) {
  const session::Stopwatch watch;
  const LiveState& state = order.state;
  if (std::exchange(slow_of_, order.whole) != order.whole) slow_.clear();
  try {
    std::uint32_t width = state.width, height = state.height;
    if (width == 0) std::tie(width, height) = scenes::picture_size(state.scene, state.camera);
    std::uint32_t divisor = order.is_final ? 1 : order.quality.divisor;
    while (divisor > 1 && std::min(width, height) / divisor < kSmallestSide) divisor /= 2;
    run_.size = fmt::format("{}x{}", (width + divisor - 1) / divisor, (height + divisor - 1) / divisor);
    run_.lights = lights_on(state);
    scenes::Scene scene = scene_of(order);
    if (run_.lights.empty()) {  // a picture needs at least one light
      run_.lights = {scene.lights.front().name};
      scene.lights.front().radiance = glm::dvec3(0);
    }
    steps_->set_revision(order.is_final ? order.revision : 0);
    auto picture = std::make_shared<LivePicture>();
    picture->answers.push_back(answer(order, state.method, scene));
    if (state.other) {
      scene = scene_of(order);
      if (lights_on(state).empty()) scene.lights.front().radiance = glm::dvec3(0);
      picture->answers.push_back(answer(order, *state.other, scene));
    }
    const session::Session& session = frames_->session();
    picture->revision = order.revision;
    picture->is_final = order.is_final;
    picture->full_width = width;
    picture->full_height = height;
    picture->lights = session::whole_names(session.lights);
    picture->samples = session.samples;
    picture->origin = session.floats.origin;
    for (std::int32_t& triangle : picture->samples.triangle) triangle = session.number_of(triangle);
    picture->triangles = session.triangle_count();
    if (order.is_final || !has_stops_) {
      automatic_stops_ = std::log2(session::auto_exposure(session, picture->answers.front().frame.sum));
      has_stops_ = true;
    }
    picture->automatic_stops = automatic_stops_;
    picture->stamps = order.stamps;
    picture->milliseconds = 1000 * watch.seconds();
    publish(std::move(picture));
    if (order.is_final)
      final_milliseconds_ = 1000 * watch.seconds();
    else
      pace_.took(1000 * watch.seconds());
  } catch (const GivenUp&) {
    final_milliseconds_ = std::max(final_milliseconds_, 1000 * watch.seconds());
  } catch (const session::Interrupted&) {
    throw;
  } catch (const render::DeviceDoesNotAnswer& error) {
    static_cast<void>(frames_.release());  // objects of a device at work must not be destroyed
    machine_ = session::make_machine(options_.device);
    failed(order.revision, error.what());
  } catch (const Error& error) {
    frames_.reset();  // its data may belong partly to one scene and partly to another
    failed(order.revision, error.what());
  }
}

void LiveRenderer::make_masks(const Order& order) {
  try {
    const LiveState& state = order.state;
    std::shared_ptr<const LivePicture> picture;
    {
      const std::lock_guard lock(mutex_);
      picture = picture_;
    }
    run_.size = fmt::format("{}x{}", picture->full_width, picture->full_height);
    run_.lights = {state.display.light};
    run_.light_samples = fmt::format("{}", kMaskSamples);
    wish_ = {{}, {}, true};
    steps_->set_revision(order.revision);
    render(order, scene_of(order), true);
    const session::Session& session = frames_->session();
    auto made = std::make_shared<LiveMasks>();
    made->revision = order.revision;
    made->light = state.display.light;
    const visibility::Light& light = session.lights.front();
    made->shape = visibility::name_of(light.kind);
    made->places = light.coordinates;
    made->words = light.words_per_mask();
    session::RenderedFrame frame = frames_->take();
    if (session.lights.size() == 1 && !frame.masks.empty()) made->masks = std::move(frame.masks.front());
    const std::lock_guard lock(mutex_);
    masks_ = std::move(made);
  } catch (const GivenUp&) {
  } catch (const session::Interrupted&) {
    throw;
  } catch (const Error& error) {
    frames_.reset();
    const std::lock_guard lock(mutex_);
    masks_failed_ = order.revision;
  }
}

void LiveRenderer::count_edges(const std::shared_ptr<const WholeScene>& whole) {
  std::optional<std::size_t> edges;
  if (frames_ && frames_->has_meshes() && rendered_ == whole && whole->instances.empty()) {
    const visibility::SceneFloats& floats = frames_->session().floats;
    edges = mesh::build_edge_graph({mesh::widened(floats.positions), floats.triangles}).edges.size();
  }
  const std::lock_guard lock(mutex_);
  counted_ = whole;
  edges_ = edges;
  wants_show_ = wants_show_ || edges.has_value();
}

void LiveRenderer::publish(std::shared_ptr<LivePicture> picture) {
  {
    const std::lock_guard lock(mutex_);
    picture_ = std::move(picture);
    wants_show_ = false;
  }
  show();
}

void LiveRenderer::show() {
  std::shared_ptr<const LivePicture> picture;
  LiveDisplay display;
  ordered_json stamps = ordered_json::object(), edges;
  {
    const std::lock_guard lock(mutex_);
    if (!picture_) return;
    is_awaited_ = events_.says_shown;
    picture = picture_;
    display = state_.display;
    if (counted_ == whole_ && edges_) edges = *edges_;
    for (const auto& [client, stamp] : picture->stamps) stamps[fmt::format("{}", client)] = stamp;
  }
  const ordered_json more = {{"frame", ++frame_}, {"stamps", std::move(stamps)}, {"edges", std::move(edges)}};
  if (events_.frame) events_.frame(std::make_shared<const std::string>(frame_message(*picture, display, more)));
  if (events_.picture) events_.picture(std::move(picture));
}

}  // namespace penumbra::app
