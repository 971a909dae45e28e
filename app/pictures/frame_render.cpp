#include "app/pictures/frame_render.hpp"

#include "app/methods.hpp"
#include "app/parse.hpp"
#include "app/pictures/picture_file.hpp"
#include "app/process/stopwatch.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/exr.hpp"
#include "base/png.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace penumbra::app {
namespace {

constexpr const char* kExposure = "penumbra.exposure";

bool is_there(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::is_regular_file(file, error);
}

}  // namespace

std::vector<std::pair<const char*, std::filesystem::path>> FrameFiles::all() const {
  std::vector<std::pair<const char*, std::filesystem::path>> files = {
      {"-o", picture}, {"--stats", stats}, {"--png", png}, {"--bits", bits}};
  std::erase_if(files, [](const auto& file) { return file.second.empty(); });
  return files;
}

bool FrameFiles::all_there() const {
  return std::ranges::all_of(all(), [](const auto& file) { return is_there(file.second); });
}

Exposure parse_exposure(const std::string& text) {
  if (text.empty() || text == "auto") return {};
  if (text == "first") return {Exposure::Kind::first, std::nanf("")};
  const auto stops = parse_number(text);
  if (!stops || !(std::abs(*stops) <= 100)) {
    throw UsageError("--exposure {}: expected auto, first, or stops from -100 to 100 (0: as it is)", text);
  }
  return {Exposure::Kind::fixed, static_cast<float>(*stops)};
}

std::optional<float> written_exposure(const std::filesystem::path& picture) {
  if (!is_there(picture)) return std::nullopt;
  const ExrFile file = read_exr(picture, {.channels = {"none of them: the header is enough"}});
  const auto text = file.attributes.find(kExposure);
  const auto stops = text == file.attributes.end() ? std::nullopt : parse_number(text->second);
  return stops ? std::optional(static_cast<float>(*stops)) : std::nullopt;
}

FrameRenderer::FrameRenderer(const RunOptions& options, const MethodWish& wish, DeviceSource& devices,
                             Progress& progress)
    : options_(options), wish_(wish), devices_(devices), progress_(progress), maker_(options, devices) {}

void FrameRenderer::say_warnings() {
  progress_.clear();
  const auto& cameras = session().scene.cameras;
  if (cameras.size() > 1 && options_.camera.empty() && said_.empty())
    spdlog::info("camera \"{}\", the first of {}; --camera NAME or all", cameras.front().name, cameras.size());
  for (const std::string& warning : session().warnings) {
    if (std::ranges::find(said_, warning) != said_.end()) continue;
    spdlog::warn("{}", warning);
    said_.push_back(warning);
  }
}

/// Says, and notes, where light samples are looked at though nobody asked for them.
void FrameRenderer::choose_methods() {
  chosen_ = choose_light_methods(session().lights, wish_);
  labels_.clear();
  notes_.clear();
  for (const LightMethod& one : chosen_) {
    labels_.push_back({one.description, one.options, device_of(one.description, devices_.name())});
    if (one.note.empty()) continue;
    notes_.push_back(one.note);
    if (std::ranges::find(said_, one.note) != said_.end()) continue;
    spdlog::info("{}", one.note);
    said_.push_back(one.note);
  }
}

FrameRenderer::Kept& FrameRenderer::method_for(const LightMethod& wanted) {
  for (Kept& kept : kept_) {
    if (kept.with.description.name != wanted.description.name || kept.with.options != wanted.options) continue;
    if (kept.mesh_version != session().mesh_version) kept.prepared = nullptr;
    kept.mesh_version = session().mesh_version;
    return kept;
  }
  kept_.push_back(
      {wanted, make_method(wanted.description.name, wanted.options, devices_), nullptr, session().mesh_version});
  return kept_.back();
}

void FrameRenderer::render(scenes::Scene scene, const Frame& frame, const std::filesystem::path& bits,
                           double read_seconds) {
  const Stopwatch busy;
  frame_ = frame;
  read_seconds_ = read_seconds;
  bits_seconds_ = 0;
  beauty_.reset();
  bits_.reset();
  run_ = {};
  maker_.show(std::move(scene), frame.camera, 0, progress_);
  say_warnings();
  choose_methods();
  if (!bits.empty()) {
    check_bits(chosen_.front().description, session().lights.front());
    bits_.emplace(bits, session(), session().lights.front());
  }
  beauty_.emplace(session(), session().lights);
  for (const std::vector<std::size_t>& lights : same_methods(chosen_)) {
    Kept& kept = method_for(chosen_[lights.front()]);
    MethodRun run = run_method(
        *kept.method, session(), {.lights = session().lights, .only = lights, .prepared = kept.prepared},
        [&](const TileResult& tile) {
          beauty_->add(tile);
          if (!bits_ || tile.light != 0) return;
          const Stopwatch watch;
          bits_->add(tile);
          bits_seconds_ += watch.seconds();
        },
        progress_);
    kept.prepared = run.prepared;
    add_run(run_, std::move(run));
  }
  devices_.check_validation();  // before anything appears: a picture that cannot be trusted is none
  busy_seconds_ = busy.seconds();
}

compare::Stats FrameRenderer::write(const FrameFiles& files, Exposure& exposure) {
  const Stopwatch write;
  const LabelledLights lights{session().lights, labels_};
  const std::vector<glm::vec3> sum = beauty_->sum();
  float stops = exposure.stops;
  if (exposure.kind == Exposure::Kind::automatic || std::isnan(stops)) stops = std::log2(auto_exposure(session(), sum));
  if (exposure.kind == Exposure::Kind::first) exposure.stops = stops;
  std::map<std::string, std::string> attributes = {{kExposure, fmt::format("{}", stops)}};
  if (frame_.number) attributes["penumbra.frame"] = fmt::format("{}", *frame_.number);

  progress_.clear();
  if (bits_) bits_->commit();
  bits_.reset();
  if (!files.png.empty()) {
    write_png(files.png, to_srgb(session().width, session().height, sum, std::exp2(stops)));
  }
  write_picture(files.picture, {session(), lights, run_.visibility, beauty_->parts(), sum, {}, std::move(attributes)});
  compare::Stats stats = make_stats(session(), lights, run_);
  stats.warnings.insert(stats.warnings.end(), notes_.begin(), notes_.end());
  // What stands between the phases is a few milliseconds of choosing and messages.
  compare::Seconds& seconds = stats.seconds;
  seconds.load = *seconds.load + read_seconds_;
  seconds.mesh = *seconds.mesh + session().device_seconds;
  seconds.view = *seconds.view + session().receiver_seconds + run_.times.view;
  seconds.beauty = std::max(run_.times.read - bits_seconds_, 0.0);
  seconds.write = write.seconds() + bits_seconds_;
  seconds.total = read_seconds_ + busy_seconds_ + write.seconds();
  if (!files.stats.empty()) write_file_atomically(files.stats, compare::json_text(compare::to_json(stats)));
  return stats;
}

}  // namespace penumbra::app
