// Of FrameRenderer: which method each light gets, and what they all make of the view samples that are looked at.

#include "app/methods.hpp"
#include "app/pictures/frame_render.hpp"
#include "app/process/stopwatch.hpp"
#include "app/whole_lights.hpp"
#include "base/assert.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::app {
namespace {

/// Is any pixel lit by what is in sight of all of it (Session::filtered)?
bool any_seen_openly(std::span<const visibility::PixelClass> classes, std::span<const std::uint8_t> filtered) {
  using visibility::PixelClass;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const bool asked =
        classes[i] == PixelClass::judged || classes[i] == PixelClass::horizon || classes[i] == PixelClass::other_body;
    if (asked && filtered[i] == 0) return true;
  }
  return false;
}

}  // namespace

/// Areas know nothing of what lets light through: they are right wherever none of it is on the way.
void FrameRenderer::choose_methods(const Session& session) {
  const std::vector<visibility::Light>& lights = session.lights;
  lights_ = lights;
  for (visibility::Light& light : lights_) light.filtered_by.clear();
  chosen_ = choose_light_methods(lights_, session.floats, wish_);
  counting_.assign(lights.size(), std::nullopt);
  if (std::ranges::all_of(lights, [](const auto& light) { return light.filtered_by.empty(); })) return;
  std::vector<LightMethod> counting = choose_light_methods(lights, session.floats, wish_);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights[i].filtered_by.empty()) continue;
    if (chosen_[i].description.gives_area()) counting_[i] = counting[i];
    if (counting_[i] && any_seen_openly(session.classes[i], session.filtered[i])) {
      counting_[i]->note += " where that may be in between, exact areas elsewhere";
    } else {
      chosen_[i] = std::move(counting[i]);
      lights_[i].filtered_by = lights[i].filtered_by;
    }
  }
}

void FrameRenderer::say_notes() {
  std::vector<std::pair<std::string, std::vector<std::string>>> news;  // what is said, and of which lights
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    const std::string& note = counting_[i] ? counting_[i]->note : chosen_[i].note;
    if (note.empty()) continue;
    if (std::ranges::find(notes_, note) == notes_.end()) notes_.push_back(note);  // pieces say the same
    if (std::ranges::find(said_, note) != said_.end()) continue;
    said_.push_back(note);
    const std::string subject = fmt::format("light \"{}\"", lights_[i].name);
    PENUMBRA_ASSERT(note.starts_with(subject), "the note \"{}\" is of {}", note, subject);
    const std::string what = note.substr(subject.size());
    auto same = std::ranges::find(news, what, [](const auto& one) { return one.first; });
    if (same == news.end()) same = news.insert(news.end(), {what, {}});
    same->second.push_back(fmt::format("\"{}\"", lights_[i].name));
  }
  for (const auto& [what, names] : news)
    progress_.info(fmt::format("light{} {}{}", names.size() > 1 ? "s" : "", fmt::join(names, ", "), what));
}

void FrameRenderer::label_lights() {
  const std::vector<visibility::Light>& lights = session().lights;
  if (std::ranges::any_of(lights, [&](const auto& light) { return !done_.contains(light.name); })) {
    choose_methods(session());
    for (std::size_t i = 0; i < lights.size(); ++i) done_.try_emplace(lights[i].name, chosen_[i]);
  }
  labels_.clear();
  for (const visibility::Light& light : lights) {
    const auto& [description, options, note] = done_.at(light.name);
    labels_.push_back(
        {description, options, device_of(description.name, options, light, machine_), in_part_.contains(light.name)});
  }
  say_unused_samples();
}

void FrameRenderer::say_unused_samples() {
  const char* const asked = !options_.light_samples.empty()    ? "--light-samples"
                            : !options_.sample_pattern.empty() ? "--sample-pattern"
                                                               : nullptr;
  const LabelledLights lights{session().lights, labels_};
  const auto has_none = [&](const WholeLight& whole) { return samples_of(lights, whole) == 0; };
  if (asked == nullptr || !std::ranges::all_of(whole_lights(session().lights), has_none)) return;
  notes_.push_back(
      fmt::format("{}: {} gives areas, and takes no light samples", asked, labels_.front().description.name));
  say_once({notes_.back()});
}

FrameRenderer::Kept& FrameRenderer::method_for(const LightMethod& wanted) {
  for (Kept& kept : kept_) {
    if (kept.with.description.name != wanted.description.name || kept.with.options != wanted.options) continue;
    if (kept.mesh_version != lit().mesh_version) kept.prepared = nullptr;
    kept.mesh_version = lit().mesh_version;
    return kept;
  }
  kept_.push_back(
      {wanted, make_method(wanted.description.name, wanted.options, machine_), nullptr, lit().mesh_version});
  if (expects_frames_) kept_.back().method->expect_frames();
  return kept_.back();
}

void FrameRenderer::keep_masks(const TileResult& tile) {
  if (!frame_.keeps_masks || layers_ || tile.masks.empty()) return;
  masks_.resize(lit().lights.size());
  masks_[tile.light].insert(masks_[tile.light].end(), tile.masks.begin(), tile.masks.end());
}

void FrameRenderer::run_methods(const std::filesystem::path& bits) {
  Stopwatch watch;
  say_warnings();
  lights_something_.clear();
  mark_lights();
  choose_methods(lit());
  say_notes();
  load_seconds_ += watch.seconds();
  if (!bits.empty()) {
    check_bits(chosen_.front().description, lit().lights);
    bits_.emplace(bits, lit(), lit().lights.front());
  }
  watch.restart();
  BeautyAccumulator beauty(lit(), lit().lights);
  beauty_seconds_ += watch.seconds();
  run_ = run_lights(beauty, bits_ ? &*bits_ : nullptr);
  watch.restart();
  beauty_ = std::move(beauty).parts();
  alpha_.resize(lit().samples.size());
  std::ranges::transform(lit().samples.triangle, alpha_.begin(), [](std::int32_t triangle) {
    return triangle == visibility::ViewSamples::kBackground ? 0.0f : 1.0f;
  });
  beauty_seconds_ += watch.seconds();
  add_panes();
  say_idle_lights();
}

MethodRun FrameRenderer::run_lights(BeautyAccumulator& beauty, BitsOutput* bits) {
  MethodRun all;
  const auto run_with = [&](const LightMethod& method, RunPlan plan) {
    const Stopwatch make;
    Kept& kept = method_for(method);
    make_seconds_ += make.seconds();
    plan.prepared = kept.prepared;
    plan.shades = true;
    MethodRun run = run_method(
        *kept.method, lit(), plan,
        [&](const TileResult& tile) {
          beauty.add(tile);
          if (!plan.filtered_alone) keep_masks(tile);
          if (bits == nullptr || tile.light != 0) return;
          const Stopwatch watch;
          bits->add(tile);
          bits_seconds_ += watch.seconds();
        },
        progress_);
    // Whatever was made for a mesh is counted by who made it (Method::take_mesh_counters).
    if (!std::exchange(kept.used, true) && kept.prepared == run.prepared) ++run.counters["meshesKept"];
    kept.prepared = run.prepared;
    // Whatever is no phase of the method's is about its answers.
    const RunTimes& times = run.times;
    beauty_seconds_ += times.total - times.mesh - times.light - times.evaluate - times.view;
    add_run(all, std::move(run));
  };
  for (const std::vector<std::size_t>& lights : same_methods(chosen_))
    run_with(chosen_[lights.front()], {.lights = lights_, .only = lights});
  std::vector<std::size_t> in_part;
  std::vector<LightMethod> with;
  for (std::size_t i = 0; i < counting_.size(); ++i) {
    if (!counting_[i]) {
      done_.try_emplace(lights_[i].name, chosen_[i]);
      continue;
    }
    done_.insert_or_assign(lights_[i].name, *counting_[i]);
    all.counters["viewSamplesCounted"] +=
        static_cast<std::uint64_t>(std::ranges::count(lit().filtered[i], std::uint8_t{1}));
    if (!lights_[i].filtered_by.empty()) continue;  // no areas
    in_part_.insert(lights_[i].name);
    in_part.push_back(i);
    with.push_back(*counting_[i]);
  }
  for (std::vector<std::size_t> lights : same_methods(with)) {
    const LightMethod& method = with[lights.front()];
    for (std::size_t& light : lights) light = in_part[light];
    run_with(method, {.lights = lit().lights, .filtered_alone = true, .only = lights});
  }
  for (std::size_t i = 0; i < lit().lights.size(); ++i) {  // whom to ask is part of the answer
    all.times.evaluate += lit().filtered_seconds[i];
    all.times.lights[i].evaluate += lit().filtered_seconds[i];
  }
  view_seconds_ += all.times.view;
  return of_whole_lights(std::move(all), lit());
}

}  // namespace penumbra::app
