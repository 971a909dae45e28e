// SPDX-License-Identifier: Apache-2.0
// Part of FrameRenderer: the methods of each light, and their results at the current view samples.

#include "base/assert.hpp"
#include "base/memory.hpp"
#include "session/methods.hpp"
#include "session/pictures/frame_render.hpp"
#include "session/pictures/lens_areas.hpp"
#include "session/pictures/sky.hpp"
#include "session/pictures/spot_cones.hpp"
#include "session/process/stopwatch.hpp"
#include "session/whole_lights.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::session {
namespace {

/// Returns the view samples that are marked in either of the two (RunPlan::dark).
std::vector<std::vector<std::uint8_t>> either(std::vector<std::vector<std::uint8_t>> one,
                                              const std::vector<std::vector<std::uint8_t>>& other) {
  if (one.empty() || other.empty()) return one.empty() ? other : one;
  std::vector<std::vector<std::uint8_t>> both = std::move(one);
  for (std::size_t light = 0; light < both.size(); ++light) {
    if (both[light].empty()) both[light] = other[light];
    if (other[light].empty()) continue;
    std::ranges::transform(both[light], other[light], both[light].begin(), std::bit_or());
  }
  return both;
}

/// Returns whether any pixel is lit without a possible translucent surface or hole in between (Session::filtered).
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

/// Chooses the methods. Area methods do not handle translucent surfaces and holes: their result is right only where
/// none of these is between view sample and light.
void FrameRenderer::choose_methods(const Session& session) {
  const std::vector<visibility::Light>& lights = session.lights;
  plan_.lights = lights;
  for (visibility::Light& light : plan_.lights) {
    light.filtered_by.clear();
    light.dimmed_by.clear();
  }
  const LightScene scene{session.floats, session.scene.lights, session.triangle_count()};
  plan_.chosen = choose_light_methods(plan_.lights, scene, wish_);
  const bool has_blockers_of_samples = !session.numbers.empty() && counts_dome_samples(wish_, session.scene.lights);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    PENUMBRA_ASSERT(!has_blockers_of_samples || !lights[i].dome || !plan_.chosen[i].description.gives_area(),
                    "light {}: areas by {} of a part for light samples", lights[i].name,
                    plan_.chosen[i].description.name);
  }
  plan_.counting.assign(lights.size(), std::nullopt);
  if (std::ranges::all_of(lights, [](const auto& light) { return light.filtered_by.empty(); })) return;
  std::vector<LightMethod> counting = choose_light_methods(lights, scene, wish_);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights[i].filtered_by.empty()) continue;
    if (plan_.chosen[i].description.gives_area()) plan_.counting[i] = counting[i];
    if (plan_.counting[i] && any_seen_openly(session.classes[i], session.filtered[i])) {
      plan_.counting[i]->note += " where that may be in between, exact areas elsewhere";
    } else {
      plan_.chosen[i] = std::move(counting[i]);
      plan_.lights[i].filtered_by = lights[i].filtered_by;
      plan_.lights[i].dimmed_by = lights[i].dimmed_by;
    }
  }
}

void FrameRenderer::say_notes() {
  std::vector<std::pair<std::string, std::vector<std::string>>> news;  // notes, each with the names of its lights
  for (std::size_t i = 0; i < plan_.chosen.size(); ++i) {
    const std::string& note = plan_.counting[i] ? plan_.counting[i]->note : plan_.chosen[i].note;
    if (note.empty()) continue;
    if (std::ranges::find(picture_.notes, note) == picture_.notes.end())
      picture_.notes.push_back(note);  // the same for all pieces
    if (std::ranges::find(said_.warnings, note) != said_.warnings.end()) continue;
    said_.warnings.push_back(note);
    const std::string subject = fmt::format("light \"{}\"", plan_.lights[i].name);
    PENUMBRA_ASSERT(note.starts_with(subject), "the note \"{}\" is of {}", note, subject);
    const std::string what = note.substr(subject.size());
    auto same = std::ranges::find(news, what, [](const auto& one) { return one.first; });
    if (same == news.end()) same = news.insert(news.end(), {what, {}});
    same->second.push_back(fmt::format("\"{}\"", plan_.lights[i].name));
  }
  for (const auto& [what, names] : news)
    progress_.info(fmt::format("light{} {}{}", names.size() > 1 ? "s" : "", fmt::join(names, ", "), what));
}

void FrameRenderer::label_lights() {
  const std::vector<visibility::Light>& lights = session().lights;
  if (std::ranges::any_of(lights, [&](const auto& light) { return !done_.with.contains(light.name); })) {
    choose_methods(session());
    for (std::size_t i = 0; i < lights.size(); ++i) done_.with.try_emplace(lights[i].name, plan_.chosen[i]);
  }
  done_.labels.clear();
  for (const visibility::Light& light : lights) {
    const auto& [description, options, note] = done_.with.at(light.name);
    done_.labels.push_back({description, options, device_of(description.name, options, light, machine_),
                            done_.in_part.contains(light.name)});
  }
  say_unused_samples();
}

void FrameRenderer::say_unused_samples() {
  const char* const asked = !options_.light_samples.empty()    ? "--light-samples"
                            : !options_.sample_pattern.empty() ? "--sample-pattern"
                                                               : nullptr;
  const LabelledLights lights{session().lights, done_.labels};
  const auto has_none = [&](const WholeLight& whole) { return samples_of(lights, whole) == 0; };
  if (asked == nullptr || !std::ranges::all_of(whole_lights(session().lights), has_none)) return;
  picture_.notes.push_back(
      fmt::format("{}: {} computes areas, and uses no light samples", asked, done_.labels.front().description.name));
  say_once({picture_.notes.back()});
}

FrameRenderer::Kept& FrameRenderer::method_for(const LightMethod& wanted) {
  for (Kept& kept : kept_) {
    if (kept.with.description.name != wanted.description.name || kept.with.options != wanted.options) continue;
    if (kept.mesh_version != lit().mesh_version) kept.prepared = nullptr;
    kept.mesh_version = lit().mesh_version;
    return kept;
  }
  // Idle methods are kept for a picture that uses them, but only a few: each holds its hierarchies.
  constexpr std::ptrdiff_t kMostIdle = 8;
  if (std::ranges::count(kept_, false, &Kept::used) >= kMostIdle)
    kept_.erase(std::ranges::find(kept_, false, &Kept::used));  // the oldest
  kept_.push_back(
      {wanted, make_method(wanted.description.name, wanted.options, machine_), nullptr, lit().mesh_version});
  if (expects_frames_) kept_.back().method->expect_frames();
  return kept_.back();
}

void FrameRenderer::require_room_for_masks() const {
  if (!picture_.frame.keeps_masks || picture_.layers) return;
  std::uint64_t samples = 0, words = 0;  // of all lights
  for (std::size_t i = 0; i < plan_.lights.size(); ++i) {
    if (plan_.chosen[i].description.output != visibility::Output::mask) continue;
    samples += plan_.lights[i].sample_count();
    words += plan_.lights[i].words_per_mask();
  }
  require_memory(words * sizeof(std::uint32_t) * lit().pixel_count(),
                 fmt::format("a mask with a bit for each of {} light samples, for each of {}x{} pixels,", samples,
                             lit().width, lit().height),
                 "choose a smaller size or fewer light samples, or do without masks");
}

void FrameRenderer::keep_masks(const TileResult& tile) {
  if (!picture_.frame.keeps_masks || picture_.layers || tile.masks.empty()) return;
  picture_.masks.resize(lit().lights.size());
  std::vector<std::uint32_t>& masks = picture_.masks[tile.light];
  if (masks.empty()) masks.reserve(lit().pixel_count() * plan_.lights[tile.light].words_per_mask());
  masks.insert(masks.end(), tile.masks.begin(), tile.masks.end());
}

void FrameRenderer::run_methods(const std::filesystem::path& bits) {
  Stopwatch watch;
  say_warnings();
  if (!picture_.in_bands) done_.lights_something.clear();
  mark_lights();
  choose_methods(lit());
  say_notes();
  require_room_for_masks();
  spent_.load += watch.seconds();
  if (!bits.empty()) {
    check_bits(plan_.chosen.front().description, lit().lights);
    picture_.bits.emplace(bits, lit(), lit().lights.front());
  }
  watch.restart();
  BeautyAccumulator beauty(lit(), lit().lights);
  spent_.beauty += watch.seconds();
  picture_.run = run_lights(beauty, picture_.bits ? &*picture_.bits : nullptr);
  watch.restart();
  picture_.beauty = std::move(beauty).parts();
  add_visible_skies(lit(), picture_.beauty);
  picture_.alpha.resize(lit().samples.size());
  std::ranges::transform(lit().samples.triangle, picture_.alpha.begin(), [](std::int32_t triangle) {
    return triangle == visibility::ViewSamples::kBackground ? 0.0f : 1.0f;
  });
  spent_.beauty += watch.seconds();
  if (!surface_) add_panes();
  if (!picture_.in_bands) say_idle_lights();
}

std::vector<std::string> FrameRenderer::lights_without_v() const {
  const bool is_looked_at = surface_ || tev_ != nullptr || picture_.frame.keeps_masks;
  if (is_looked_at || !picture_.frame.moments.empty()) return {};  // other moments may have other lights
  const std::vector<std::string> layers = layer_names(session().lights), names = whole_names(session().lights);
  const std::set<std::string> written = wanted_channels(
      format_, picture_channels(layers, picture_.frame.pixel_side > 1, session().floats.triangles.size()));
  std::vector<std::string> without;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool is_written = written.contains(layers[i] + ".V") || written.contains(layers[i] + "_V.V");
    if (!is_written && !(i == 0 && written.contains("V"))) without.push_back(names[i]);
  }
  return without;
}

FaintLights FrameRenderer::leave_out_faint(const BeautyAccumulator& beauty) {
  const double below = picture_.frame.light_cutoff;
  if (below == 0) return {};
  FaintLights faint =
      find_faint_lights(lit(), beauty.normals(), below, picture_.own_rows.value_or(visibility::Tile{0, lit().height}));
  if (!picture_.cutoff) picture_.cutoff = compare::LightCutoff{below};
  picture_.cutoff->pairs += faint.pairs;
  picture_.cutoff->largest_share = std::max(picture_.cutoff->largest_share, faint.largest_share);
  return faint;
}

visibility::FrameMemory* FrameRenderer::memory() {
  const bool of_one_moment = picture_.frame.moments.empty() && !lit().camera.lens;
  if (!memories_ || picture_.layers || picture_.in_bands || !of_one_moment) return nullptr;
  return &(*memories_)[picture_.frame.camera];
}

MethodRun FrameRenderer::run_lights(BeautyAccumulator& beauty, BitsOutput* bits) {
  MethodRun all;
  const Stopwatch find;
  std::vector<std::vector<std::uint8_t>> beside =
      bits != nullptr ? std::vector<std::vector<std::uint8_t>>()
                      : samples_beside_cones(lit().samples, lit().lights, lights_without_v());
  const FaintLights faint = leave_out_faint(beauty);
  std::optional<std::uint64_t> beside_cones;
  for (const std::vector<std::uint8_t>& one : beside)
    beside_cones = beside_cones.value_or(0) + static_cast<std::uint64_t>(std::ranges::count(one, std::uint8_t{1}));
  const std::vector<std::vector<std::uint8_t>> dark = either(std::move(beside), faint.dark);
  spent_.view += find.seconds();
  const auto run_with = [&](const LightMethod& method, RunPlan plan) {
    const Stopwatch make;
    Kept& kept = method_for(method);
    spent_.make += make.seconds();
    const visibility::SceneFloats* const before = kept.prepared;
    plan.prepared = before;
    plan.holds = &kept.prepared;
    plan.band_rows = picture_.frame.band_rows;
    plan.shades = true;
    visibility::remember(*kept.method, memory());
    visibility::pass(*kept.method, picture_.all);
    std::unique_ptr<visibility::Method> around;  // passes on fewer view samples, or in another order
    if (method.description.gives_area() && lit().camera.lens)
      around = std::make_unique<LensAreas>(*kept.method);
    else if (method.description.gives_area() && picture_.frame.pixel_side > 1 && picture_.frame.pixel_tolerance > 0)
      around = std::make_unique<InterpolatedAreas>(*kept.method, lit().floats, picture_.frame.pixel_side,
                                                   picture_.frame.pixel_tolerance);
    else if (method.description.gives_area() && picture_.still && !picture_.layers && !plan.filtered_alone &&
             faint.dark.empty())
      around = std::make_unique<StillAreas>(*kept.method, *picture_.still, plan.lights);
    plan.dark = around ? faint.dark : dark;  // interpolation needs V outside spot cones, too
    MethodRun run = run_method(
        around ? *around : *kept.method, lit(), plan,
        [&](const TileResult& tile) {
          beauty.add(tile);
          if (!plan.filtered_alone) keep_masks(tile);
          if (bits == nullptr || tile.light != 0) return;
          const Stopwatch watch;
          bits->add(tile);
          spent_.bits += watch.seconds();
        },
        progress_);
    // Structures made for a mesh are counted by the method that made them (Method::take_mesh_counters).
    if (!std::exchange(kept.used, true) && before == run.prepared) ++run.counters["meshesKept"];
    // Time outside of the method's phases is spent on its results.
    const RunTimes& times = run.times;
    spent_.beauty += times.total - times.mesh - times.light - times.evaluate - times.view;
    visibility::MethodOptions changed = run.changed_defaults;
    add_run(all, std::move(run));
    return changed;
  };
  for (const std::vector<std::size_t>& lights : same_methods(plan_.chosen)) {
    const visibility::MethodOptions changed =
        run_with(plan_.chosen[lights.front()], {.lights = plan_.lights, .only = lights});
    // For labels; the method itself is kept under the requested options.
    for (const std::size_t light : lights) plan_.chosen[light].options.insert(changed.begin(), changed.end());
  }
  std::vector<std::size_t> in_part;
  std::vector<LightMethod> with;
  for (std::size_t i = 0; i < plan_.counting.size(); ++i) {
    if (!plan_.counting[i]) {
      done_.with.try_emplace(plan_.lights[i].name, plan_.chosen[i]);
      continue;
    }
    done_.with.insert_or_assign(plan_.lights[i].name, *plan_.counting[i]);
    all.counters["viewSamplesCounted"] +=
        static_cast<std::uint64_t>(std::ranges::count(lit().filtered[i], std::uint8_t{1}));
    if (!plan_.lights[i].filtered_by.empty()) continue;  // this light is not computed by areas
    done_.in_part.insert(plan_.lights[i].name);
    in_part.push_back(i);
    with.push_back(*plan_.counting[i]);
  }
  for (std::vector<std::size_t> lights : same_methods(with)) {
    const LightMethod& method = with[lights.front()];
    for (std::size_t& light : lights) light = in_part[light];
    run_with(method, {.lights = lit().lights, .filtered_alone = true, .only = lights});
  }
  // the search for pixels with translucent surfaces is part of the evaluation
  for (std::size_t i = 0; i < lit().lights.size(); ++i) {
    all.times.evaluate += lit().filtered_seconds[i];
    all.times.lights[i].evaluate += lit().filtered_seconds[i];
  }
  if (beside_cones) all.counters["viewSamplesBesideCones"] += *beside_cones;
  spent_.view += all.times.view;
  return of_whole_lights(std::move(all), lit());
}

}  // namespace penumbra::session
