// SPDX-License-Identifier: Apache-2.0
// Part of FrameRenderer: pictures that are the mean of several view samples a pixel, of moments, and of a lens's
// points.

#include "session/pictures/frame_render.hpp"
#include "session/pictures/surfaces.hpp"
#include "session/process/stopwatch.hpp"
#include "session/whole_lights.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

namespace penumbra::session {
namespace {

constexpr std::uint32_t kFewestRows = 16;  ///< pixel rows of a band: its neighbours' rows are evaluated, too

/// Pixel rows on either side of a band whose interpolated answers may differ from those of the whole picture
/// (InterpolatedAreas): a view sample's cell has corners up to one row away, the slope at a corner needs the curvature
/// at its neighbours, one row farther, and that curvature needs their neighbours, another row farther.
constexpr std::uint32_t kRowsInterpolated = 3;

}  // namespace

std::vector<FrameRenderer::MeanBand> FrameRenderer::mean_bands() const {
  const std::uint32_t side = picture_.frame.pixel_side, width = session().width, height = session().height;
  const std::vector<LightMethod> chosen = choose_light_methods(
      session().lights, {session().floats, session().scene.lights, session().triangle_count()}, wish_);
  const bool are_areas = std::ranges::all_of(chosen, [](const auto& one) { return one.description.gives_area(); });
  const bool has_instances = picture_.frame.instances != nullptr && !picture_.frame.instances->empty();
  std::uint32_t count = 1;
  if (are_areas && !has_instances && session().floats.alphas.empty()) {
    const std::uint64_t samples = std::uint64_t{width} * side * side * height, most = picture_.frame.band_samples;
    count = static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>((samples + most - 1) / most, 1, std::max(height / kFewestRows, 1U)));
  }
  const std::uint32_t more =
      count == 1 ? 0 : static_cast<std::uint32_t>(std::ceil(picture_.frame.filter.reach())) + kRowsInterpolated;
  std::vector<MeanBand> bands;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(std::uint64_t{height} * i / count),
               end = static_cast<std::uint32_t>(std::uint64_t{height} * (i + 1) / count);
    const std::uint32_t from = first - std::min(first, more), to = std::min(end + more, height);
    bands.push_back({{first, end - first}, {from * side, (to - from) * side}});
  }
  return bands;
}

bool FrameRenderer::has_lens(const scenes::Scene& scene) {
  const std::string& wanted = picture_.frame.camera;
  const auto camera =
      wanted.empty() ? scene.cameras.begin() : std::ranges::find(scene.cameras, wanted, &scenes::Camera::name);
  if (surface_ || camera == scene.cameras.end() || !camera->lens) return false;
  if (picture_.frame.pixel_side > 1 || !picture_.frame.moments.empty()) return true;
  picture_.notes.push_back(
      fmt::format("camera \"{}\" has an aperture: with one view sample per pixel, it looks through the lens's middle, "
                  "and everything is sharp; blur needs --pixel-samples N",
                  camera->name));
  say_once({picture_.notes.back()});
  return false;
}

void FrameRenderer::render_mean(scenes::Scene scene, bool by_lens) {
  const std::uint32_t side = picture_.frame.pixel_side;
  const bool is_fine = side > 1 || by_lens;
  if (is_fine) {
    show(maker_, scene, picture_.frame.instances);
    check_wanted_layers();
    spent_.view += session().filtering_seconds();
    const std::string size = fmt::format("{}x{}", session().width * side, session().height * side);
    RunOptions options = options_;  // options_ may have changed since the last picture
    options.size = size;
    if (!fine_ || fine_->options.size != size) {
      kept_.clear();  // kept methods refer to the session that is replaced
      fine_.emplace(options, machine_);
    }
    fine_->options = std::move(options);
    fine_->maker.look_through_lens(std::nullopt);
  }
  const std::vector<MeanBand> bands = is_fine ? mean_bands() : std::vector<MeanBand>(1);
  picture_.in_bands = bands.size() > 1;
  std::map<std::string, LightTimes> times;
  const auto moments = static_cast<std::uint32_t>(std::max<std::size_t>(picture_.frame.moments.size(), 1));
  std::uint32_t moment_number = 0;
  const auto add_band = [&](const MeanBand& band) {
    const bool is_whole = lit().numbers.empty();  // parts of moments number their triangles differently
    if (!is_fine && is_whole && StillMoments::are_worth(lit().samples.size(), lit().lights.size())) {
      if (!picture_.still) picture_.still.emplace();
      picture_.still->begin(lit().floats);
    } else {
      picture_.still.reset();
    }
    if (picture_.in_bands)
      picture_.own_rows = {band.pixels.first_row * side - band.samples.first_row, band.pixels.row_count * side};
    MethodRun before = std::exchange(picture_.run, {});
    before.visibility.clear();  // V of the last band, which is already in the mean
    picture_.beauty.clear();
    run_methods({});
    const Stopwatch watch;
    const PictureBand rows =
        is_fine ? PictureBand{band.pixels, band.samples.first_row} : PictureBand{{0, session().height}, 0};
    if (!picture_.mean) {
      const std::uint32_t width = session().width, height = session().height;
      picture_.mean.emplace(width, height, picture_.frame.filter,
                            moments == 1 ? PictureMean::Adds::once : PictureMean::Adds::often);
      picture_.mattes =
          Mattes{MatteShares(width, height, picture_.frame.filter), MatteShares(width, height, picture_.frame.filter)};
    }
    const Surfaces surfaces(lit());
    std::vector<std::uint32_t> shown(lit().samples.size());
    const auto numbers = [&](auto number) -> std::span<const std::uint32_t> {
      tbb::parallel_for(std::size_t{0}, shown.size(), [&](std::size_t i) { shown[i] = (surfaces.*number)(i); });
      return shown;
    };
    picture_.mattes->objects.add(surfaces.objects(), numbers(&Surfaces::object), side, rows);
    picture_.mattes->materials.add(surfaces.materials(), numbers(&Surfaces::material), side, rows);
    const std::vector<std::string> names = whole_names(lit().lights);
    picture_.mean->add(picture_.alpha, names, picture_.run.visibility, picture_.beauty, side, rows);
    spent_.beauty += watch.seconds();
    for (std::size_t light = 0; light < names.size(); ++light) {
      times[names[light]].light += picture_.run.times.lights[light].light;
      times[names[light]].evaluate += picture_.run.times.lights[light].evaluate;
    }
    before.times.lights.clear();  // the lights of the other moment may differ
    add_times(picture_.run, before);
  };
  const auto add = [&](scenes::Scene moment, const scenes::Instances* instances) {
    if (by_lens)
      fine_->maker.look_through_lens(visibility::Lens{.side = side, .moment = moment_number++, .moments = moments});
    if (is_fine) fine_->maker.look_at_rows(bands.size() > 1 ? std::optional(bands.front().samples) : std::nullopt);
    show(is_fine ? fine_->maker : maker_, std::move(moment), instances);
    done_.lights_something.clear();
    add_band(bands.front());
    for (std::size_t i = 1; i < bands.size(); ++i) {
      fine_->maker.look_at_rows(bands[i].samples);
      fine_->maker.show_again(without_meshes(lit().scene), picture_.frame.camera, progress_);
      note_seconds(fine_->maker);
      add_band(bands[i]);
    }
    if (picture_.in_bands) say_idle_lights();
  };
  if (picture_.frame.moments.empty()) add(scene, picture_.frame.instances);
  for (const auto& moment : picture_.frame.moments) {
    const Stopwatch read;
    PictureScene then = moment();
    spent_.load += read.seconds();
    add(std::move(then.scene), &then.instances);
  }
  picture_.still.reset();
  picture_.own_rows.reset();
  picture_.mattes->objects.settle();
  picture_.mattes->materials.settle();
  // The results of the view samples are now in the mean.
  picture_.run.visibility.clear();
  picture_.beauty.clear();
  picture_.alpha.clear();
  if (std::exchange(picture_.in_bands, false)) fine_->maker.forget_view();
  if (!is_fine) {
    show(maker_, std::move(scene), picture_.frame.instances);
    spent_.view += session().filtering_seconds();
  }
  // Outputs of lights describe the lights at the frame's own time.
  picture_.run.times.lights.clear();
  const std::vector<std::string> own = whole_names(session().lights);
  for (const std::string& light : own) picture_.run.times.lights.push_back(times[light]);
  for (const std::string& light : picture_.mean->lights()) {
    if (std::ranges::find(own, light) != own.end()) continue;
    picture_.notes.push_back(fmt::format(
        "light \"{}\" does not exist at the frame's own time: R G B contain its light, but it has no layer", light));
    say_once({picture_.notes.back()});
  }
}

void FrameRenderer::note_means(std::map<std::string, std::string>& attributes) const {
  const Frame& frame = picture_.frame;
  const bool interpolates = std::ranges::any_of(
      picture_.run.counters, [](const auto& counter) { return counter.first == "viewSamplesInterpolated"; });
  if (frame.pixel_side > 1) {
    attributes["penumbra.pixelSamples"] = fmt::format("{}", frame.pixel_side * frame.pixel_side);
    attributes["penumbra.pixelFilter"] =
        frame.filter.kind == PixelFilter::Kind::box ? "box" : fmt::format("blackman-harris {}", frame.filter.width);
    attributes["penumbra.pixelTolerance"] = fmt::format("{}", interpolates ? frame.pixel_tolerance : 0);
  }
  if (!frame.moments.empty()) attributes["penumbra.motionSamples"] = fmt::format("{}", frame.moments.size());
  if (const auto& lens = lit().camera.lens; lens)
    attributes["penumbra.lens"] = fmt::format("aperture {}, focus distance {}", lens->radius, lens->focus_distance);
}

}  // namespace penumbra::session
