// SPDX-License-Identifier: Apache-2.0
// Sums beauty, writes bits and collects statistics of runs.

#include "session/output.hpp"

#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/pages.hpp"
#include "compare/beauty.hpp"
#include "compare/error_picture.hpp"
#include "compare/machine.hpp"
#include "session/methods.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace penumbra::session {
namespace {

std::vector<glm::dvec3> colors_of(std::span<const scenes::Object> objects) {
  std::vector<glm::dvec3> colors;
  for (const scenes::Object& object : objects) colors.push_back(object.color);
  return colors;
}

}  // namespace

std::uint32_t samples_of(const LabelledLights& all, const WholeLight& whole) {
  std::uint32_t count = 0;
  for (std::size_t piece = whole.first; piece < whole.first + whole.count; ++piece) {
    if (all.label(piece).description.counts_light_samples()) count += all.lights[piece].sample_count();
  }
  return count;
}

std::optional<std::string> pattern_of(const LabelledLights& all, const WholeLight& whole) {
  if (samples_of(all, whole) == 0) return std::nullopt;
  return visibility::name_of(all.lights[whole.first].pattern);
}

compare::LightStats light_stats(const LabelledLights& all, const WholeLight& whole) {
  const MethodLabel& label = all.label(whole.first);
  return {.name = all.lights[whole.first].name,
          .method = label.description.name,
          .options = label.options,
          .area = samples_of(all, whole) == 0,
          .light_samples = samples_of(all, whole),
          .sample_pattern = pattern_of(all, whole).value_or(""),
          .in_part = label.in_part};
}

BeautyAccumulator::BeautyAccumulator(const Session& session, std::span<const visibility::Light> lights)
    : session_(session),
      lights_(lights),
      whole_of_(wholes_of_pieces(lights)),
      colors_(colors_of(session.scene.objects)),
      looks_(compare::look_at(session.scene, session.floats, session.samples, session.shading_normals)),
      parts_(whole_lights(lights).size()) {}

void BeautyAccumulator::add(const TileResult& result) {
  // One light at a time: light is additive, and a light's body shows its radiance only in its own sum.
  std::vector<glm::vec3>& pixels = parts_[whole_of_[result.light]];
  if (pixels.empty()) resize_on_all_cores(pixels, session_.pixel_count());
  compare::LightVisibility seen;
  seen.form_factors = result.form_factors;
  seen.masks = result.masks;
  seen.transmittances = result.transmittances;
  seen.dimmed = result.dimmed;
  if (result.masks.empty() && (result.form_factors.empty() || !looks_.normals.empty()))
    seen.visibility = result.visibility;
  const std::size_t first_pixel = std::size_t{result.tile.first_row} * session_.width;
  compare::add_beauty({.scene = session_.floats,
                       .samples = session_.samples,
                       .colors = colors_,
                       .lights = lights_.subspan(result.light, 1),
                       .pixel_colors = looks_.colors,
                       .normals = looks_.normals,
                       .first_pixel = first_pixel},
                      {&seen, 1}, result.visibility,  // pixels that were not evaluated are unchanged
                      std::span(pixels).subspan(first_pixel, result.visibility.size()));
}

std::vector<glm::vec3> BeautyAccumulator::sum() const {
  std::vector<glm::vec3> pixels(session_.pixel_count(), glm::vec3(0));
  for (const std::vector<glm::vec3>& part : parts_) {
    for (std::size_t i = 0; i < part.size(); ++i) pixels[i] += part[i];
  }
  return pixels;
}

float auto_exposure(const Session& session, std::span<const glm::vec3> beauty, std::span<const std::uint8_t> lamps) {
  std::vector<std::uint8_t> bodies(beauty.size());
  for (std::size_t i = 0; i < beauty.size(); ++i) {
    const std::int32_t triangle = session.samples.triangle[i];
    const bool body = triangle >= 0 && session.floats.emits[static_cast<std::size_t>(triangle)] >= 0;
    const bool through_body = !lamps.empty() && lamps[i] != 0;
    const bool sky = triangle < 0 && lamps.empty();  // not if antialiased: pixels may be partly sky
    bodies[i] = body || sky || through_body ? 1 : 0;
  }
  return compare::auto_exposure(beauty, bodies);
}

void check_bits(const visibility::MethodDescription& description, std::span<const visibility::Light> lights) {
  const visibility::Light& light = lights.front();
  if (description.output != visibility::Output::mask) {
    throw UsageError("--bits: method {} computes only V, not one bit per light sample; see `penumbra methods`",
                     description.name);
  }
  if (const std::size_t pieces = whole_lights(lights).front().count; pieces > 1) {
    throw UsageError(
        "--bits: light \"{}\" is divided into {} pieces, and the file can only contain one; choose another with "
        "--light",
        light.name, pieces);
  }
  if (is_body(light.kind)) {
    throw UsageError(
        "--bits: light \"{}\" is a {}, whose light samples differ from pixel to pixel; choose another with --light",
        light.name, name_of(light.kind));
  }
}

void BitsOutput::add(const TileResult& result) {
  if (!writer_) {
    if (!session_.numbers.empty()) {
      numbered_ = session_.samples;
      for (std::int32_t& triangle : numbered_.triangle) triangle = session_.number_of(triangle);
    }
    writer_.emplace(path_, session_.floats.origin, session_.numbers.empty() ? session_.samples : numbered_, light_);
  }
  writer_->append(result.masks);
}

void BitsOutput::commit() {
  writer_->commit();
  writer_.reset();
}

std::string device_of(const std::string& method, const visibility::MethodOptions& options,
                      const visibility::Light& light, const render::Machine& machine) {
  return runs_on_device(method, options, light, machine) ? machine.device_name() : compare::this_machine().processor;
}

namespace {

template <typename... Lists>
std::uint64_t bytes_of(const Lists&... lists) {
  return (... + (lists.capacity() * sizeof(typename Lists::value_type)));
}

/// Returns the memory in use while a method runs: the scene as read, the numbers shared by all methods, the view
/// samples, the method's own memory, and its results (V, and the light's contribution to beauty).
std::map<std::string, std::uint64_t> memory_of(const Session& session, std::size_t lights, const MethodRun& run) {
  const mesh::TriangleSoup& soup = session.scene.soup;
  const auto floats_bytes = [](const visibility::SceneFloats& floats) {
    return bytes_of(floats.positions, floats.triangles, floats.object, floats.plane, floats.casts_shadow,
                    floats.receives_shadow, floats.emits);
  };
  const visibility::ViewSamples& samples = session.samples;
  std::map<std::string, std::uint64_t> memory = {
      {"scene", bytes_of(soup.positions, soup.triangles, soup.object, soup.source_face)},
      {"sceneFloats", floats_bytes(session.floats)},
      {"viewSamples", bytes_of(samples.triangle, samples.p, samples.n, samples.depth, samples.facing)},
      {"method", run.memory_bytes},
      {"answers", lights * session.pixel_count() * (sizeof(float) + sizeof(glm::vec3))},
      {"peakResident", peak_resident_bytes()}};
  if (!session.numbers.empty()) memory["numbers"] = bytes_of(session.numbers);
  for (const visibility::SceneFloats& linked : session.linked) memory["sceneFloats"] += floats_bytes(linked);
  for (const auto& classes : session.classes) memory["viewSamples"] += bytes_of(classes);
  return memory;
}

}  // namespace

compare::Stats make_stats(const Session& session, const LabelledLights& lights, const MethodRun& run) {
  const MethodLabel& label = lights.label(0);
  const std::vector<WholeLight> wholes = whole_lights(lights.lights);
  compare::Stats stats;
  stats.scene = session.scene.name;
  stats.width = session.width;
  stats.height = session.height;
  stats.device = label.device;
  stats.triangles = session.triangle_count();
  stats.method = label.description.name;
  stats.options = label.options;
  stats.light_samples = samples_of(lights, wholes.front());
  stats.sample_pattern = pattern_of(lights, wholes.front()).value_or("");
  for (std::size_t light = 0; light < wholes.size(); ++light) {
    stats.lights.push_back(light_stats(lights, wholes[light]));
    if (light >= run.times.lights.size()) continue;  // the run failed
    stats.lights.back().light = run.times.lights[light].light;
    stats.lights.back().evaluate = run.times.lights[light].evaluate;
  }
  stats.seconds.load = session.load_seconds;
  stats.seconds.mesh = run.times.mesh;
  stats.seconds.view = session.view_seconds;
  stats.seconds.light = run.times.light;
  stats.seconds.evaluate = run.times.evaluate;
  stats.seconds.warmup = run.times.warmup;
  stats.runs = run.times.runs;
  stats.seconds.total = stats.seconds.sum();
  stats.passes = run.passes;
  stats.peak_memory_bytes = run.memory_bytes;
  stats.memory = memory_of(session, wholes.size(), run);
  stats.counters = run.counters;
  stats.warnings = session.warnings;
  if (const auto warning = label.description.warning) {
    if (auto text = warning(stats.options, run.counters)) stats.warnings.push_back(*std::move(text));
  }
  return stats;
}

std::string summary(const compare::Stats& stats) {
  std::vector<std::string> methods, questions;
  const auto add = [](std::vector<std::string>& words, std::string word) {
    if (std::ranges::find(words, word) == words.end()) words.push_back(std::move(word));
  };
  for (const compare::LightStats& light : stats.lights) {
    add(methods, light.method);
    const bool exact = describe_method(light.method, light.options).gives_area();
    add(questions, exact        ? "exact areas"
                   : light.area ? "an estimate of V"
                                : fmt::format("{} light samples ({}){}", light.light_samples, light.sample_pattern,
                                              light.in_part ? " and exact areas" : ""));
  }
  return fmt::format("{}: {}x{}, {} triangles, {}; shadow {:.3f} s on {}", fmt::join(methods, " + "), stats.width,
                     stats.height, stats.triangles, fmt::join(questions, " + "), stats.seconds.shadow().value_or(0),
                     stats.device);
}

}  // namespace penumbra::session
