// SPDX-License-Identifier: Apache-2.0
// Opens sessions: scene, view samples, lights and classes of pixels.

#include "session/session.hpp"

#include "base/assert.hpp"
#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "scenes/picture_size.hpp"
#include "session/process/stopwatch.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>
#include <variant>

namespace penumbra::session {
namespace {

/// Returns the element with the requested name; the first one if none is requested. `option` and `scene` are for the
/// message.
template <typename Named>
std::size_t find_named(const std::vector<Named>& elements, const std::string& wanted, std::string_view option,
                       const std::string& scene) {
  const auto found = std::ranges::find(elements, wanted, &Named::name);
  if (found != elements.end()) return static_cast<std::size_t>(found - elements.begin());
  std::vector<std::string> names;
  for (const Named& element : elements) names.push_back(element.name);
  throw UsageError("{} {}: {} has no such name; it has: {}{}", option, wanted, scene, fmt::join(names, ", "),
                   did_you_mean(wanted, names));
}

/// Returns the requested lights (indices), in the order of the request; all, if there is no request.
std::vector<std::size_t> wanted_lights(const scenes::Scene& scene, const std::vector<std::string>& names,
                                       const std::string& scene_name) {
  std::vector<std::size_t> wanted;
  for (const std::string& name : names) {
    const std::size_t light = find_named(scene.lights, name, "--light", scene_name);
    if (std::ranges::find(wanted, light) != wanted.end()) throw UsageError("--light {} is given twice", name);
    wanted.push_back(light);
  }
  if (!names.empty()) return wanted;
  wanted.resize(scene.lights.size());
  std::iota(wanted.begin(), wanted.end(), std::size_t{0});
  return wanted;
}

/// Throws for an image that needs more memory than this machine has; otherwise long work would end in a killed process.
void require_image_memory(std::uint64_t width, std::uint64_t height, std::uint64_t lights, std::uint64_t pieces) {
  // Bytes per pixel: 48 for the view sample, 120 for scene colours and for normals, depths and ids in the EXR, 12 for
  // beauty; per light, 4 for the channel of V, 24 for beauty and channels; per piece of a light, 5 for V and class.
  require_memory(width * height * (180 + 28 * lights + 5 * pieces),
                 fmt::format("an image of {}x{} pixels", width, height), "choose a smaller --size");
}

/// Returns whether the objects' flags and the origins are equal.
bool same_casters(const scenes::Scene& a, const scenes::Scene& b) {
  const auto alike = [](const scenes::Object& one, const scenes::Object& other) {
    return one.casts_shadow == other.casts_shadow && one.receives_shadow == other.receives_shadow &&
           one.emits == other.emits && one.alpha == other.alpha && one.picture == other.picture;
  };
  return a.origin == b.origin && std::ranges::equal(a.objects, b.objects, alike);
}

/// Returns whether the two scenes, with equal flags, have the same scene floats.
bool same_mesh(const scenes::Scene& a, const scenes::Scene& b) {
  const bool filters = std::ranges::any_of(
      a.objects, [](const scenes::Object& object) { return object.alpha.mode != scenes::Alpha::Mode::opaque; });
  if (filters && (a.looks.places != b.looks.places || a.looks.colors != b.looks.colors || a.pictures != b.pictures))
    return false;
  return same_casters(a, b) && equal_on_all_cores(a.soup.positions, b.soup.positions) &&
         equal_on_all_cores(a.soup.triangles, b.soup.triangles) && equal_on_all_cores(a.soup.object, b.soup.object);
}

/// Returns, for each light, the objects left out of its own scene (Light::unshaded_by).
std::vector<std::vector<std::uint8_t>> casters_of(const std::vector<visibility::Light>& lights) {
  std::vector<std::vector<std::uint8_t>> all;
  for (const visibility::Light& light : lights) all.push_back(light.unshaded_by);
  return all;
}

/// Shares one scene among lights for which the same triangles cast shadows, however their casters are named.
void link_casters(Session& session) {
  session.linked.clear();
  session.linked_of.clear();
  for (const visibility::Light& light : session.lights) {
    std::optional<std::size_t>& own = session.linked_of.emplace_back();
    if (light.unshaded_by.empty()) continue;
    visibility::SceneFloats linked = cast_for(session.floats, light);
    const auto casters = [](const visibility::SceneFloats& floats) {
      return std::tie(floats.casts_shadow, floats.alphas.casters);
    };
    if (casters(linked) == casters(session.floats)) continue;
    const auto same =
        std::ranges::find_if(session.linked, [&](const auto& other) { return casters(other) == casters(linked); });
    own = static_cast<std::size_t>(same - session.linked.begin());
    if (same == session.linked.end()) session.linked.push_back(std::move(linked));
  }
}

/// Turns view samples outside these rows into background.
void leave_rows(const visibility::Tile& rows, visibility::ViewSamples& samples) {
  const std::size_t first = std::size_t{rows.first_row} * samples.width,
                    end = first + std::size_t{rows.row_count} * samples.width;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i >= first && i < end) continue;
    samples.triangle[i] = visibility::ViewSamples::kBackground;
    samples.p[i] = samples.n[i] = glm::vec3(0);
    samples.depth[i] = 0;
    samples.facing[i] = 0;
  }
}

}  // namespace

double median(std::vector<double> values) {
  PENUMBRA_ASSERT(!values.empty(), "median of nothing");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

SessionMaker::SessionMaker(const RunOptions& options, const render::Machine& machine)
    : options_(options), machine_(machine) {
  // Wrong options are reported before a scene is read.
  static_cast<void>(parse_light_samples(options));
  if (!options.size.empty()) static_cast<void>(parse_size(options.size));
  session_.shading_normals = parse_normals(options.normals);
}

void SessionMaker::show(scenes::Scene scene, const std::string& camera, std::uint32_t runs, Progress& progress) {
  const bool changed = !is_whole_ || !session_.numbers.empty() || !same_mesh(session_.scene, scene);
  session_.numbers.clear();
  rows_.reset();
  show(std::move(scene), changed, camera, runs, progress);
}

void SessionMaker::look_into(const scenes::Scene& scene, const scenes::Instances& instances, bool dome_samples) {
  viewed_.clear();
  dome_samples_ = dome_samples;
  placed_.place(scene, instances);
}

visibility::PinholeCamera SessionMaker::look_through(const scenes::Camera& camera, const glm::dvec3& origin,
                                                     std::uint32_t width, std::uint32_t height) const {
  visibility::PinholeCamera view = visibility::make_camera(camera, origin, width, height);
  if (lens_share_ && camera.lens) {
    visibility::Lens& lens = view.lens.emplace(*lens_share_);
    lens.radius = camera.lens->radius;
    lens.focus_distance = camera.lens->focus_distance;
  }
  return view;
}

void SessionMaker::show_part(const visibility::Tile& rows, const std::string& camera, Progress& progress) {
  progress.begin("what is seen", 1);
  const Stopwatch watch;
  const scenes::Scene& scene = placed_.scene();
  const auto [width, height] = picture_size(scene, camera);
  const std::size_t number =
      camera.empty() ? 0 : find_named(scene.cameras, camera, "--camera", options_.scene.string());
  visibility::SeenPart part =
      visibility::seen_part(placed_, look_through(scene.cameras[number], placed_.origin(), width, height),
                            make_lights(scene, placed_.origin(), nullptr), rows,
                            {.dome_samples = dome_samples_, .viewed = rows.row_count < height ? &viewed_ : nullptr});
  show_part(std::move(part), rows, camera, watch.seconds(), progress);
}

void SessionMaker::show_seen(const std::string& camera, Progress& progress) {
  progress.begin("what is seen", 1);
  const Stopwatch watch;
  const scenes::Scene& scene = placed_.scene();
  const auto [width, height] = picture_size(scene, camera);
  const std::size_t number =
      camera.empty() ? 0 : find_named(scene.cameras, camera, "--camera", options_.scene.string());
  visibility::SeenPart part = visibility::seen_part(
      placed_, look_through(scene.cameras[number], placed_.origin(), width, height), {}, {0, height});
  show_part(std::move(part), {0, height}, camera, watch.seconds(), progress);
}

void SessionMaker::show_viewed(const std::string& camera, Progress& progress) {
  progress.begin("what is seen", 1);
  const Stopwatch watch;
  visibility::SeenPart part = visibility::viewed_part(placed_, viewed_);
  const std::uint32_t height = picture_size(placed_.scene(), camera).second;
  show_part(std::move(part), {0, height}, camera, watch.seconds(), progress);
}

void SessionMaker::show_part(visibility::SeenPart part, const visibility::Tile& rows, const std::string& camera,
                             double seconds, Progress& progress) {
  progress.advance();
  session_.whole_triangles = part.triangles;
  whole_ = {part.lower, part.upper};
  const bool changed = !is_whole_ || session_.numbers != part.numbers || !same_mesh(session_.scene, part.scene);
  session_.numbers = std::move(part.numbers);
  rows_ = rows;
  seen_.reset();
  show(std::move(part.scene), changed, camera, 0, progress);
  session_.view_seconds += seconds;
}

std::pair<std::uint32_t, std::uint32_t> SessionMaker::picture_size(const scenes::Scene& scene,
                                                                   const std::string& camera) const {
  if (!options_.size.empty()) return parse_size(options_.size);
  const std::size_t number =
      camera.empty() ? 0 : find_named(scene.cameras, camera, "--camera", options_.scene.string());
  return scenes::picture_size(scene, scene.cameras[number]);
}

std::vector<visibility::Light> SessionMaker::make_lights(const scenes::Scene& scene, const glm::dvec3& origin,
                                                         std::vector<std::string>* notes) const {
  const visibility::SampleRequest request = parse_light_samples(options_);
  std::vector<visibility::Light> lights;
  for (const std::size_t light : wanted_lights(scene, options_.lights, options_.scene.string())) {
    std::ranges::move(visibility::make_light_pieces(scene, static_cast<std::uint32_t>(light), origin, request,
                                                    lights.empty() ? notes : nullptr),
                      std::back_inserter(lights));
  }
  return lights;
}

void SessionMaker::show_again(scenes::Scene scene, const std::string& camera, Progress& progress) {
  PENUMBRA_ASSERT(is_whole_, "{}: no scene has been shown", scene.name);
  const bool changed = !same_casters(session_.scene, scene);
  scene.soup = std::move(session_.scene.soup);
  scene.looks = std::move(session_.scene.looks);
  scene.pictures = std::move(session_.scene.pictures);
  show(std::move(scene), changed, camera, 0, progress);
}

void SessionMaker::show(scenes::Scene scene, bool changed, const std::string& camera, std::uint32_t runs,
                        Progress& progress) {
  is_whole_ = false;
  Stopwatch load;
  session_.shading_normals = parse_normals(options_.normals);
  session_.scene = std::move(scene);
  session_.warnings = session_.scene.warnings;
  const std::string scene_name = options_.scene.string();
  const std::vector<std::size_t> wanted = wanted_lights(session_.scene, options_.lights, scene_name);
  session_.camera_index = camera.empty() ? 0 : find_named(session_.scene.cameras, camera, "--camera", scene_name);
  const scenes::Camera& seen_by = session_.scene.cameras[session_.camera_index];
  const auto [width, height] = picture_size(session_.scene, camera);
  session_.width = width;
  session_.height = band_ ? band_->row_count : height;
  std::size_t pieces = 0;
  for (const std::size_t light : wanted) {
    const auto* cut = std::get_if<scenes::Pieces>(&session_.scene.lights[light].shape);
    pieces += cut == nullptr ? 1 : cut->pieces.size();
  }
  require_image_memory(session_.width, session_.height, wanted.size(), pieces);

  if (changed) {
    session_.floats = visibility::make_scene_floats(session_.scene);
    if (!session_.numbers.empty()) {  // the whole scene's box, since lights' sizes are relative to it
      session_.floats.lower = whole_.lower;
      session_.floats.upper = whole_.upper;
    }
    ++session_.mesh_version;
  }
  session_.camera = look_through(seen_by, session_.floats.origin, width, height);
  if (band_) {
    session_.camera.first_row = band_->first_row;
    session_.camera.rows_of_picture = height;
    session_.camera.height = band_->row_count;
  }
  const auto casters = casters_of(session_.lights);
  session_.lights = make_lights(session_.scene, session_.floats.origin, &session_.warnings);
  filters_.clear();
  for (const visibility::Light& light : session_.lights) filters_.push_back({light.filtered_by, light.dimmed_by});
  if (changed || casters != casters_of(session_.lights)) {
    reaches_.clear();
    link_casters(session_);
    if (!changed) ++session_.mesh_version;
  }
  session_.load_seconds = load.seconds();

  const Stopwatch start_up;
  static_cast<void>(machine_.has_gpu());  // started while the scene was read
  session_.device_seconds = start_up.seconds();
  load.restart();
  if (changed) {
    sampler_.reset();
    sampler_.emplace(machine_, session_.floats);
  }
  session_.load_seconds += load.seconds();

  const bool is_seen = runs == 0 && !changed && seen_ == session_.camera;
  if (!is_seen) forget_view();  // frees their memory before new ones are found
  progress.begin("view samples", runs + 1);
  std::vector<double> view_seconds = {0};
  for (std::uint32_t run = is_seen ? 1 : 0; run <= runs; ++run) {
    const Stopwatch view;
    session_.samples = finder_ ? finder_(session_.floats, session_.camera) : sampler_->find(session_.camera);
    if (rows_) leave_rows(*rows_, session_.samples);
    view_seconds.push_back(view.seconds());
    progress.advance();
  }
  view_seconds.erase(view_seconds.begin(), view_seconds.end() - std::max(runs, 1U));
  seen_ = session_.camera;
  session_.view_seconds = median(std::move(view_seconds));

  progress.begin("receivers", 1);
  const Stopwatch receivers;
  classify();
  progress.advance();
  session_.receiver_seconds = receivers.seconds() - session_.filtering_seconds();
  is_whole_ = true;
}

void SessionMaker::forget_view() {
  seen_.reset();
  session_.samples = {};
  session_.classes.clear();
}

visibility::ViewSamples SessionMaker::look_at(visibility::ViewSamples samples) {
  seen_.reset();
  std::swap(session_.samples, samples);
  classify();
  return samples;
}

void SessionMaker::classify() {
  session_.classes.clear();
  session_.filtered.assign(session_.lights.size(), {});
  session_.filtered_seconds.assign(session_.lights.size(), 0);
  for (std::size_t i = 0; i < session_.lights.size(); ++i) {
    visibility::Light& light = session_.lights[i];
    session_.classes.push_back(visibility::classify_pixels(session_.floats, session_.samples, light));
    light.filtered_by = filters_[i].filtered_by;
    light.dimmed_by = filters_[i].dimmed_by;
    if (light.filtered_by.empty()) continue;
    const Stopwatch watch;
    const visibility::SceneFloats& floats = session_.floats_for(i);
    session_.filtered[i] =
        reaches_.try_emplace(&floats, floats).first->second.reached(session_.samples, light, session_.classes[i]);
    if (session_.filtered[i].empty()) {
      light.filtered_by.clear();
      light.dimmed_by.clear();
    }
    session_.filtered_seconds[i] = watch.seconds();
  }
}

scenes::Scene without_meshes(const scenes::Scene& scene) {
  scenes::Scene rest;
  rest.name = scene.name;
  rest.width = scene.width;
  rest.height = scene.height;
  rest.objects = scene.objects;
  rest.lights = scene.lights;
  rest.cameras = scene.cameras;
  rest.sources = scene.sources;
  rest.origin = scene.origin;
  rest.motion = scene.motion;
  rest.warnings = scene.warnings;
  return rest;
}

scenes::Scene read_session_scene(const RunOptions& options, std::optional<double> time, const ReadBeside& beside) {
  scenes::ReadOptions reading = read_options(options.gltf, options.allow_outside);
  reading.time = time;
  reading.lenient = options.lenient;
  reading.studio = parse_studio(options.studio, options.camera);
  reading.lightmap = beside.lightmap;
  reading.instances = beside.instances;
  reading.ahead = beside.ahead;
  reading.bytes_per_copy = beside.bytes_per_copy;
  reading.rest = options.rest.get();
  if (!options.size.empty()) {
    const auto [width, height] = parse_size(options.size);
    reading.studio.aspect = static_cast<double>(width) / height;
  }
  return scenes::read_scene(options.scene, reading);
}

Session open_session(scenes::Scene scene, const RunOptions& options, const render::Machine& machine, std::uint32_t runs,
                     Progress& progress) {
  SessionMaker maker(options, machine);
  maker.show(std::move(scene), options.camera, runs, progress);
  return maker.take();
}

Session open_session(const RunOptions& options, std::optional<double> time, const render::Machine& machine,
                     std::uint32_t runs, Progress& progress, std::uint64_t bytes_per_copy) {
  progress.begin("reading " + options.scene.filename().string(), 1);
  // Errors of the command line are reported before any long work.
  SessionMaker maker(options, machine);
  machine.begin(false);
  const Stopwatch load;
  scenes::Scene scene = read_session_scene(options, time, {.bytes_per_copy = bytes_per_copy});
  const double read_seconds = load.seconds();
  maker.show(std::move(scene), options.camera, runs, progress);
  Session session = maker.take();
  session.load_seconds += read_seconds;
  return session;
}

}  // namespace penumbra::session
