#include "app/output.hpp"

#include "app/methods.hpp"
#include "base/error.hpp"
#include "base/exr.hpp"
#include "compare/beauty.hpp"
#include "compare/machine.hpp"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace penumbra::app {
namespace {

std::string options_text(const visibility::MethodOptions& options) {
  std::string text;
  for (const auto& [key, value] : options) text += fmt::format("{}{}={}", text.empty() ? "" : " ", key, value);
  return text;
}

const char* beauty_text(visibility::Output output) {
  switch (output) {
    case visibility::Output::mask:
      return "radiance and cosines integrated sample by sample, each with its cell of the light";
    case visibility::Output::scalar:
      return "V times the unshadowed integral";
    case visibility::Output::radiance:
      return "radiance and cosines integrated over the visible part of the light";
  }
  return "?";
}

std::uint32_t samples_of(const LabelledLights& all, std::size_t light) {
  return all.label(light).description.gives_area() ? 0 : all.lights[light].sample_count();
}

/// Nothing: V is an area.
std::optional<std::string> pattern_of(const LabelledLights& all, std::size_t light) {
  if (all.label(light).description.gives_area()) return std::nullopt;
  return visibility::name_of(all.lights[light].pattern);
}

compare::LightStats light_stats(const LabelledLights& all, std::size_t light) {
  const MethodLabel& label = all.label(light);
  return {.name = all.lights[light].name,
          .method = label.description.name,
          .options = label.options,
          .area = label.description.gives_area(),
          .light_samples = samples_of(all, light),
          .sample_pattern = pattern_of(all, light).value_or("")};
}

/// `lights` of stats.json, without the seconds: the same command gives the same bytes.
std::string lights_text(const LabelledLights& all) {
  auto rows = nlohmann::ordered_json::array();
  for (std::size_t light = 0; light < all.lights.size(); ++light) {
    rows.push_back(compare::to_json(light_stats(all, light)));
    rows.back().erase("seconds");
  }
  return rows.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// Rows [tile.first_row, + row_count) as view samples of their own.
visibility::ViewSamples rows_of(const visibility::ViewSamples& all, const visibility::Tile& tile) {
  const auto first = static_cast<std::ptrdiff_t>(std::size_t{tile.first_row} * all.width);
  const auto end = first + static_cast<std::ptrdiff_t>(std::size_t{tile.row_count} * all.width);
  visibility::ViewSamples rows;
  rows.width = all.width;
  rows.height = tile.row_count;
  rows.triangle.assign(all.triangle.begin() + first, all.triangle.begin() + end);
  rows.p.assign(all.p.begin() + first, all.p.begin() + end);
  rows.n.assign(all.n.begin() + first, all.n.begin() + end);
  rows.depth.assign(all.depth.begin() + first, all.depth.begin() + end);
  rows.eye = all.eye;
  return rows;
}

/// The components of interleaved vectors or colours as channels that need no copy.
void add_components(ExrImage& image, std::array<const char*, 3> names, std::span<const glm::vec3> values) {
  const auto* floats = &values.front().x;
  for (std::size_t c = 0; c < 3; ++c) {
    image.channels.push_back({names[c], std::span<const float>(floats + c, 3 * values.size() - 2), 3});
  }
}

}  // namespace

BeautyAccumulator::BeautyAccumulator(const Session& session, std::span<const visibility::Light> lights)
    : session_(session), lights_(lights), pixels_(session.pixel_count(), glm::vec3(0)) {
  for (const scenes::Object& object : session.scene.objects) colors_.push_back(object.color);
}

void BeautyAccumulator::add(const TileResult& result) {
  // One light at a time: light adds up, and a light's body shows its radiance in its own turn alone.
  const visibility::ViewSamples rows = rows_of(session_.samples, result.tile);
  compare::LightVisibility seen;
  seen.form_factors = result.form_factors;
  seen.masks = result.masks;
  if (result.form_factors.empty() && result.masks.empty()) seen.visibility = result.visibility;
  const auto band =
      compare::integrate_beauty({session_.floats, rows, colors_, lights_.subspan(result.light, 1)}, {&seen, 1});
  const std::size_t first = std::size_t{result.tile.first_row} * session_.width;
  for (std::size_t i = 0; i < band.size(); ++i) {
    if (!std::isnan(result.visibility[i])) pixels_[first + i] += band[i];  // what was not evaluated stays black
  }
}

void check_bits(const visibility::MethodDescription& description, const visibility::Light& light) {
  if (description.output != visibility::Output::mask) {
    throw UsageError("--bits: method {} gives V alone, not one bit a light sample; see `penumbra methods`",
                     description.name);
  }
  if (light.kind == visibility::LightKind::sphere) {
    throw UsageError(
        "--bits: light \"{}\" is a sphere, whose points differ from pixel to pixel; choose another with --light",
        light.name);
  }
}

void BitsOutput::add(const TileResult& result) {
  if (!writer_) {
    open_.emplace();
    writer_.emplace(path_, session_.floats.origin, session_.samples, light_);
  }
  writer_->append(result.masks);
}

void BitsOutput::commit() {
  writer_->commit();
  writer_.reset();
  open_.reset();
}

std::string device_of(const visibility::MethodDescription& description, const std::string& vulkan_device) {
  const bool vulkan = runs_on_device(description.name) && !description.gives_area();
  return vulkan ? vulkan_device : compare::this_machine().processor;
}

void write_picture(const std::filesystem::path& path, const Session& session, const LabelledLights& all,
                   const MethodRun& run, std::span<const glm::vec3> beauty) {
  const std::span<const visibility::Light> lights = all.lights;
  const MethodLabel& label = all.label(0);
  const visibility::ViewSamples& samples = session.samples;
  const std::size_t count = session.pixel_count();
  std::vector<float> alpha(count);
  std::vector<std::uint32_t> id(count);
  std::vector<glm::vec3> world(count, glm::vec3(0));
  for (std::size_t i = 0; i < count; ++i) {
    const bool background = samples.triangle[i] == visibility::ViewSamples::kBackground;
    alpha[i] = background ? 0.0f : 1.0f;
    id[i] = static_cast<std::uint32_t>(samples.triangle[i]);  // background: 4294967295
    if (!background) world[i] = glm::vec3(glm::dvec3(samples.p[i]) + session.floats.origin);
  }

  ExrImage image;
  image.width = session.width;
  image.height = session.height;
  add_components(image, {"R", "G", "B"}, beauty);
  image.channels.push_back({"A", std::span<const float>(alpha), 1});
  image.channels.push_back({"V", std::span<const float>(run.visibility.front()), 1});
  for (std::size_t light = 0; light < lights.size(); ++light) {
    image.channels.push_back({"V." + lights[light].name, std::span<const float>(run.visibility[light]), 1});
  }
  add_vector_channels(image, "P", world);
  add_vector_channels(image, "Prel", samples.p);
  add_vector_channels(image, "N", samples.n);
  image.channels.push_back({"Z", std::span<const float>(samples.depth), 1});
  image.channels.push_back({"id", std::span<const std::uint32_t>(id), 1});

  image.attributes = {{"penumbra.method", label.description.name},
                      {"penumbra.options", options_text(label.options)},
                      {"penumbra.output", visibility::name_of(label.description.output)},
                      {"penumbra.beauty", beauty_text(label.description.output)},
                      {"penumbra.lightSamples", fmt::format("{}", samples_of(all, 0))},
                      {"penumbra.samplePattern", pattern_of(all, 0).value_or("null")},
                      {"penumbra.lights", lights_text(all)},
                      {"penumbra.scene", session.scene.name},
                      {"penumbra.version", PENUMBRA_VERSION},
                      {"penumbra.device", label.device}};
  image.vectors = {{"penumbra.origin", session.floats.origin}};
  write_exr(path, image);
}

compare::Stats make_stats(const Session& session, const LabelledLights& lights, const MethodRun& run) {
  const MethodLabel& label = lights.label(0);
  compare::Stats stats;
  stats.scene = session.scene.name;
  stats.width = session.width;
  stats.height = session.height;
  stats.device = label.device;
  stats.triangles = session.floats.triangles.size();
  stats.method = label.description.name;
  stats.options = label.options;
  stats.light_samples = samples_of(lights, 0);
  stats.sample_pattern = pattern_of(lights, 0).value_or("");
  for (std::size_t light = 0; light < lights.lights.size(); ++light) {
    stats.lights.push_back(light_stats(lights, light));
    if (light >= run.times.lights.size()) continue;  // it failed
    stats.lights.back().light = run.times.lights[light].light;
    stats.lights.back().evaluate = run.times.lights[light].evaluate;
  }
  stats.seconds.load = session.load_seconds;
  stats.seconds.mesh = run.times.mesh;
  stats.seconds.view = session.view_seconds;
  stats.seconds.light = run.times.light;
  stats.seconds.evaluate = run.times.evaluate;
  stats.seconds.warmup = run.times.warmup;
  stats.seconds.total = session.open_seconds + run.times.total;
  stats.passes = run.passes;
  stats.peak_memory_bytes = run.memory_bytes;
  stats.counters = run.counters;
  stats.warnings = session.warnings;
  return stats;
}

std::string summary(const compare::Stats& stats) {
  std::vector<std::string> methods, questions;
  const auto add = [](std::vector<std::string>& words, std::string word) {
    if (std::ranges::find(words, word) == words.end()) words.push_back(std::move(word));
  };
  for (const compare::LightStats& light : stats.lights) {
    add(methods, light.method);
    add(questions,
        light.area ? "exact areas" : fmt::format("{} light samples ({})", light.light_samples, light.sample_pattern));
  }
  return fmt::format("{}: {}x{}, {} triangles, {}; shadow {:.3f} s on {}", fmt::join(methods, " + "), stats.width,
                     stats.height, stats.triangles, fmt::join(questions, " + "), stats.seconds.shadow().value_or(0),
                     stats.device);
}

}  // namespace penumbra::app
