// SPDX-License-Identifier: Apache-2.0
// Parses the options of `render` and `submit`.

#include "session/pictures/request.hpp"

#include "base/error.hpp"
#include "session/methods.hpp"
#include "session/parse.hpp"
#include "session/pictures/frames.hpp"
#include "visibility/floats_memory.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <variant>

namespace penumbra::session {
namespace {

std::uint32_t parse_count(const std::string& text, const char* option, std::uint32_t most, const char* wanted) {
  const auto value = parse_integer<std::uint32_t>(text.empty() ? "1" : text);
  if (!value || *value < 1 || *value > most) throw UsageError("{} {}: expected {}", option, text, wanted);
  return *value;
}

/// Parses --pixel-samples, --motion-samples and --shutter.
void parse_means(const PictureOptions& options, PictureRequest& request) {
  const std::uint32_t samples =
      parse_count(options.pixel_samples, "--pixel-samples", 64, "a number from 1 to 64, such as 4, 9 or 16");
  while (request.pixel_side * request.pixel_side < samples) ++request.pixel_side;
  if (const std::uint32_t square = request.pixel_side * request.pixel_side; square != samples)
    spdlog::warn("--pixel-samples {}: {}, the next square number, since view samples are on a square grid", samples,
                 square);
  request.filter = parse_filter(options.pixel_filter, options.filter_width);
  if (request.filter.kind != PixelFilter::Kind::box && samples == 1)
    throw UsageError("--pixel-filter {} needs several view samples a pixel: --pixel-samples 4 or more",
                     options.pixel_filter);
  if (!options.pixel_tolerance.empty()) {
    const auto tolerance = parse_number(options.pixel_tolerance);
    if (!tolerance || !(*tolerance >= 0 && *tolerance <= 1))
      throw UsageError(
          "--pixel-tolerance {}: expected a number from 0 (every view sample is evaluated) to 1, such as 0.002",
          options.pixel_tolerance);
    if (samples == 1)
      throw UsageError("--pixel-tolerance {} needs several view samples a pixel: --pixel-samples 4 or more",
                       options.pixel_tolerance);
    request.pixel_tolerance = *tolerance;
  }
  if (!options.light_cutoff.empty()) {
    const auto cutoff = parse_number(options.light_cutoff);
    if (!cutoff || !(*cutoff >= 0 && *cutoff <= 1))
      throw UsageError(
          "--light-cutoff {}: expected a share of a pixel's light from 0 (no light is left out) to 1, such as "
          "0.001",
          options.light_cutoff);
    if (*cutoff > 0 && !options.bits.empty())
      throw UsageError("--bits needs the answers of all pairs; leave out --light-cutoff");
    request.light_cutoff = *cutoff;
  }
  request.moments = parse_count(options.motion_samples, "--motion-samples", 256, "a number from 1 to 256");
  if (!options.moments.empty()) request.moments = static_cast<std::uint32_t>(options.moments.size());
  const auto shutter = parse_number(options.shutter.empty() ? "0.5" : options.shutter);
  if (!shutter || !(*shutter >= 0 && *shutter <= 100))
    throw UsageError("--shutter {}: expected frames from 0 to 100, such as 0.5", options.shutter);
  request.shutter_frames = *shutter;
  if (!options.bits.empty() && (samples > 1 || request.moments > 1 || !options.moments.empty()))
    throw UsageError(
        "--bits writes answers at pixels' centres at one moment; leave out --pixel-samples, --motion-samples and "
        "--moment");
  if (request.moments > 1 && options.moments.empty() && options.frames.empty() && !options.frame)
    throw UsageError("--motion-samples {} needs a frame: --frame or --frames", options.motion_samples);
}

/// Throws UsageError if other options request moments in addition to those of --moment.
void check_moments(const PictureOptions& options) {
  if (options.moments.empty()) return;
  if (options.frame || !options.frames.empty() || !options.motion_samples.empty() || !options.shutter.empty())
    throw UsageError(
        "--moment: the files are the moments of the open shutter; leave out --frame, --frames, --motion-samples and "
        "--shutter");
  if (options.run.camera == "all") throw UsageError("--moment: the moments are read for one camera; name one");
  constexpr std::size_t kMost = 256;
  if (options.moments.size() > kMost)
    throw UsageError("--moment: {} files; expected at most {}", options.moments.size(), kMost);
}

/// Reads --aperture and --focus-distance.
void parse_lens(const PictureOptions& options, PictureRequest& request) {
  const auto length = [](const std::string& text, const char* option, const char* wanted, bool may_be_0) {
    const auto value = parse_number(text);
    if (!value || !(*value > 0 || (may_be_0 && *value == 0)) || !std::isfinite(*value))
      throw UsageError("{} {}: expected {}", option, text, wanted);
    return *value;
  };
  if (!options.focus_distance.empty())
    request.focus_distance =
        length(options.focus_distance, "--focus-distance", "a distance above 0, such as 2.5", false);
  if (options.aperture.empty()) return;
  request.aperture =
      length(options.aperture, "--aperture", "a lens's radius above 0, such as 0.02, or 0 for none", true);
  if (*request.aperture > 0 && request.pixel_side == 1 && request.moments == 1)
    throw UsageError(
        "--aperture {}: with one view sample per pixel, it looks through the lens's middle, and everything is sharp; "
        "blur needs --pixel-samples 4 or more",
        options.aperture);
  if (*request.aperture == 0 && request.focus_distance)
    throw UsageError("--focus-distance {}: there is no lens with --aperture 0", options.focus_distance);
}

/// Throws UsageError for a moment between frames, which has no number for a file's name.
void refuse_numbered_moments(const PictureOptions& options, const PictureRequest& request) {
  const auto& frame = request.frames.front();
  if (!frame || *frame == std::floor(*frame)) return;
  for (const auto& file : {options.run.out, options.stats, options.png, options.bits}) {
    if (has_frame_number(file))
      throw UsageError(
          "{}: frame {} is between two frames and has no whole number for the file's name; remove the placeholder for "
          "the number",
          file.string(), *frame);
  }
}

}  // namespace

InstanceUse parse_instances(const std::string& text, const MethodWish& wish) {
  if (text == "copies") return InstanceUse::copies;
  if (!text.empty() && text != "auto" && text != "shared")
    throw UsageError("--instances {}: expected auto, copies or shared", text);
  if (wish.method.empty() || answers_apart(describe_method(wish.method, wish.options)) ||
      passes_triangles(wish.method, wish.options))
    return text == "shared" ? InstanceUse::shared : InstanceUse::automatic;
  if (text == "shared")
    throw UsageError(
        "--instances shared: {} needs more than the triangles between a view sample and the light; choose another "
        "--method",
        wish.method);
  return InstanceUse::copies;
}

/// Returns the reason why a method cannot be given the scene's triangles one after the other; null: there is none.
const char* cannot_pass(const scenes::Scene& scene, std::uint32_t pixel_samples) {
  const auto is_round = [](const scenes::AreaLight& light) {
    return std::holds_alternative<scenes::Sphere>(light.shape) || std::holds_alternative<scenes::Dome>(light.shape) ||
           std::holds_alternative<scenes::Pieces>(light.shape);
  };
  if (std::ranges::any_of(scene.lights, is_round))
    return "supports only suns and lights in one plane with shared meshes";
  if (std::ranges::any_of(scene.lights, [](const auto& light) { return !light.unshaded_by.empty(); }))
    return "supports no lights with their own lists of casters with shared meshes";
  const auto is_open = [](const scenes::Object& object) { return object.alpha.mode != scenes::Alpha::Mode::opaque; };
  if (std::ranges::any_of(scene.objects, is_open))
    return "supports no surfaces with holes and no translucent ones with shared meshes";
  return pixel_samples > 1 ? "supports one view sample per pixel with shared meshes" : nullptr;
}

bool needs_copies(const scenes::Scene& scene, const scenes::Instances& instances, InstanceUse use,
                  const MethodWish& wish, std::uint32_t pixel_samples) {
  if (instances.empty()) return false;
  const bool passes = passes_triangles(wish.method, wish.options);
  const char* const why = passes ? cannot_pass(scene, pixel_samples) : nullptr;
  if (use == InstanceUse::shared) {
    if (why != nullptr) throw UsageError("--instances shared: {} {}", wish.method, why);
    return false;
  }
  return why != nullptr || use == InstanceUse::copies || triangle_count(scene, instances) <= scenes::kFewCopies ||
         !counts_dome_samples(wish, scene.lights);
}

std::uint64_t bytes_per_copy(const MethodWish& wish, std::span<const scenes::AreaLight> lights) {
  constexpr std::uint64_t kFloats = visibility::kFloatsOfTriangle;
  if (!wish.method.empty()) return kFloats + describe_method(wish.method, wish.options).bytes_per_triangle;
  const auto methods = all_methods();
  const auto areas = std::ranges::find_if(methods, [](const auto* method) { return method->exact_area.has_value(); });
  const bool counts = wish.samples || (!lights.empty() && std::ranges::all_of(lights, is_sampled));
  return kFloats + (counts || areas == methods.end() ? visibility::MethodDescription().bytes_per_triangle
                                                     : (*areas)->bytes_per_triangle);
}

bool answers_apart(const visibility::MethodDescription& method) {
  return method.family != visibility::Family::image && method.output != visibility::Output::scalar;
}

PictureRequest parse_request(const PictureOptions& options) {
  PictureRequest request;
  NamedMethod method = parse_method(options.method, options.run.method_options);
  if (!method.name.empty()) describe_method(method.name, method.options);  // throws now instead of later
  request.wish.method = std::move(method.name);
  request.wish.options = std::move(method.options);
  request.wish.samples =
      !options.run.light_samples.empty() || !options.run.sample_pattern.empty() || !options.bits.empty();
  request.exposure = parse_exposure(options.exposure);
  request.seconds_per_frame = 1 / parse_fps(options.fps);
  check_moments(options);
  parse_means(options, request);
  parse_lens(options, request);
  request.instances = parse_instances(options.instances, request.wish);
  parse_format(options.run.format);  // refuses an unknown format before rendering
  if (options.run.out.extension() != ".exr") {
    throw UsageError("-o {}: expected a name that ends in .exr (--png writes a PNG file beside it)",
                     options.run.out.string());
  }
  if (options.frames.empty()) {
    request.frames.emplace_back();
    if (options.frame) request.frames.front() = parse_frame(*options.frame);
    refuse_numbered_moments(options, request);
  } else {
    for (const std::int64_t frame : numbers_of(parse_frames(options.frames)))
      request.frames.emplace_back(static_cast<double>(frame));
  }
  return request;
}

void set_lens(scenes::Scene& scene, const PictureRequest& request, const std::string& camera) {
  if (!request.aperture && !request.focus_distance) return;
  for (scenes::Camera& one : scene.cameras) {
    const bool is_looked_through =
        camera == "all" || one.name == camera || (camera.empty() && &one == &scene.cameras.front());
    if (!is_looked_through) continue;
    if (request.aperture == 0) {
      one.lens.reset();
      continue;
    }
    if (!request.aperture && !one.lens)
      throw UsageError("--focus-distance: camera \"{}\" has no lens; set its radius with --aperture", one.name);
    if (!request.focus_distance && !one.lens)
      throw UsageError("--aperture: camera \"{}\" has no focus distance; set it with --focus-distance", one.name);
    one.lens = {request.aperture ? *request.aperture : one.lens->radius,
                request.focus_distance ? *request.focus_distance : one.lens->focus_distance};
  }
}

FrameFiles files_of(const PictureOptions& options, std::optional<double> frame, const std::string& camera) {
  const auto named = [&](std::filesystem::path path) {
    if (path.empty()) return path;
    if (options.run.camera == "all") path = camera_path(path, options.camera_words.at(camera));
    const bool numbered = frame && (!options.frames.empty() || has_frame_number(path));
    return numbered ? frame_path(path, static_cast<std::int64_t>(*frame)) : path;
  };
  return {named(options.run.out), named(options.stats), named(options.png), named(options.bits)};
}

bool is_there(const PictureOptions& options, std::optional<double> frame, const std::vector<std::string>& cameras) {
  return std::ranges::all_of(cameras, [&](const auto& camera) { return files_of(options, frame, camera).all_there(); });
}

void check_png_name(const PictureOptions& options) {
  if (!options.png.empty() && options.png.extension() != ".png")
    throw UsageError("--png {}: expected a name that ends in .png", options.png.string());
}

OutputFiles outputs_of(const PictureOptions& options, const std::vector<std::optional<double>>& frames,
                       const std::vector<std::string>& cameras) {
  OutputFiles outputs;
  for (const auto& frame : frames) {
    for (const std::string& camera : cameras) {
      for (const auto& [option, path] : files_of(options, frame, camera).all()) outputs.add(option, path);
    }
  }
  outputs.refuse_inputs({&options.run.scene, 1});
  outputs.refuse_inputs(options.moments);
  return outputs;
}

}  // namespace penumbra::session
