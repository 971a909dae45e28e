// SPDX-License-Identifier: Apache-2.0
// Implements everything common to methods of this family. Maps of many light points together would not fit into memory,
// so evaluate renders them in batches and looks up each batch at once. A batch is a power of two of light points, at
// most 32: no batch crosses two words of a mask.

#include "maps/host/map_method.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "maps/host/aliasing.hpp"
#include "maps/host/camera_faces.hpp"
#include "maps/host/queried_tiles.hpp"
#include "maps/host/receivers.hpp"
#include "render/compute_pass.hpp"
#include "visibility/all_triangles.hpp"
#include "visibility/lights/light_parts.hpp"
#include "visibility/masks/visible_share.hpp"
#include "visibility/receivers.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace penumbra::maps {
namespace {

constexpr std::uint32_t kBitsPerWord = 32;
/// Memory limits of a batch of several light points, and of a tile's masks.
constexpr std::uint64_t kBatchBytes = std::uint64_t{128} << 20, kMaskBytes = std::uint64_t{256} << 20;

class MapMethod final : public visibility::Method, public visibility::PassesTriangles, public SeesScene {
 public:
  MapMethod(const render::Device& device, MapRecipe recipe, const MapOptions& options)
      : device_(&device),
        recipe_(std::move(recipe)),
        options_(options),
        casters_(device, options.size, options.rasteriser),
        constants_(constants_for(1)),
        look_up_(make_look_up()),
        sort_(make_sort()) {
    PENUMBRA_ASSERT(!options_.fit.sees_camera() || recipe_.points == MapPoints::centre,
                    "{}: only maps from centres are fitted to a camera", recipe_.description.name);
    PENUMBRA_ASSERT(!options_.fit.has_faces() || recipe_.sub_lights == 1, "{}: maps of sub-lights are windows",
                    recipe_.description.name);
    if (const std::uint32_t least = 2 * recipe_.beside_texels + 4; options_.fit.has_faces() && options_.size < least) {
      throw UsageError(
          "method {}: size={} leaves no room between what is tapped beside a map's ends; take size={} or more",
          recipe_.description.name, options_.size, least);
    }
    casters_.set_offset(options_.offset_factor, options_.offset_units);
    if (options_.depth != DepthUse::first) recipe_.layers.count = std::max(recipe_.layers.count, 2u);
    PENUMBRA_ASSERT(recipe_.points == MapPoints::centre || total_layers() == 1, "{}: layers of a light sample's map",
                    recipe_.description.name);
    PENUMBRA_ASSERT(recipe_.sub_lights == 1 || (recipe_.points == MapPoints::centre && !gives_masks()),
                    "{}: means over sub-lights are V, from maps of their centres", recipe_.description.name);
  }

  [[nodiscard]] const visibility::MethodDescription& description() const override { return recipe_.description; }
  void want_pixels(std::span<const std::uint32_t> pixels) override { receivers_.want(pixels); }
  void pass(const visibility::AllTriangles* all) override { all_ = all; }
  void see_through(const SceneSpace& space) override { space_ = space; }
  void prepare_mesh(const visibility::SceneFloats& scene) override;
  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override;
  [[nodiscard]] std::uint32_t max_tile_rows() const override;
  void evaluate(const visibility::Tile& tile) override;
  void read_masks(std::span<std::uint32_t> masks) override;
  void read_visibility(std::span<float> visibility) override;

  std::vector<visibility::PassTime> take_pass_times() override { return times_.take(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override;
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 private:
  [[nodiscard]] bool gives_masks() const { return recipe_.description.output == visibility::Output::mask; }
  /// Returns the number of result words of a pixel: its mask, or V.
  [[nodiscard]] std::uint32_t words_per_pixel() const { return gives_masks() ? light_->words_per_mask() : 1; }
  [[nodiscard]] bool sorts_out() const { return !recipe_.sort_out.empty(); }
  /// Returns the bytes of results of `pixels` pixels; with workgroups that loop, two words a pixel more, in which
  /// workgroups whose loops were ended mark this for this pass and the next, and the words of CutLoops; with a list of
  /// workgroups, another word a pixel, and GroupList.
  [[nodiscard]] std::uint64_t result_bytes(std::uint64_t pixels) const {
    if (!recipe_.group_a_receiver) return pixels * words_per_pixel() * sizeof(std::uint32_t);
    const std::uint64_t words = words_per_pixel() + (sorts_out() ? 3 : 2);
    return pixels * words * sizeof(std::uint32_t) + (sorts_out() ? sizeof(gpu::GroupList) : 0) + sizeof(gpu::CutLoops);
  }
  /// Returns the number of light points whose maps are looked up one after the other for the same bits or V.
  [[nodiscard]] std::uint32_t point_count() const {
    return recipe_.points == MapPoints::centre ? 1 : static_cast<std::uint32_t>(fitted_.views.size());
  }
  /// Returns the basis of a part of the light: the axes of the whole light, used by maps and look-ups, around the
  /// part's centroid.
  [[nodiscard]] LightBasis basis_of(const visibility::Light& part) const {
    LightBasis basis = basis_;
    basis.center = visibility::center_of(part);
    return basis;
  }
  [[nodiscard]] std::uint32_t total_layers() const { return recipe_.layers.count + (recipe_.layers.farthest ? 1 : 0); }

  /// Returns the specialization constants of the look-up, for a light whose maps have `faces` faces: most have one.
  [[nodiscard]] std::vector<std::uint32_t> constants_for(std::uint32_t faces) const;
  [[nodiscard]] render::ComputePass make_look_up() const;
  [[nodiscard]] std::optional<render::ComputePass> make_sort() const;

  /// Returns the number of workgroups for packets of pixels.
  [[nodiscard]] std::uint64_t packets(const Receivers::Part& part) const {
    const std::uint32_t width = std::max(receivers_.width(), 1U), rows = part.count / width;
    return std::uint64_t{(width + recipe_.packet_width - 1) / recipe_.packet_width} *
           ((rows + recipe_.packet_height - 1) / recipe_.packet_height);
  }

  /// Fits the maps: to all receivers, or to the view of the camera.
  void fit_maps();
  void fit_to_camera(FitOptions fit, std::span<const glm::vec3> centres);
  void make_maps();
  /// Allocates the light's maps, and renders those of its centre.
  void make_fitted_maps();
  /// Cuts the fitted faces while a cut changes the picture.
  void query_tiles();
  [[nodiscard]] std::vector<float> whole_picture();
  void take_tile(const visibility::Tile& tile);
  void find_aliasing();
  /// Records maps of light points first … first + count − 1, in submissions that can be timed.
  void render_maps(render::Commands& commands, std::uint32_t first, std::uint32_t count);
  /// Records the layers behind the nearest surfaces in the maps of the centre of a part of the light.
  void render_layers(render::Commands& commands, std::uint32_t part);
  /// Renders the maps of the centre of a part of the light, and makes the products.
  void make_centre_maps(std::uint32_t part);
  /// Computes V of a tile from the maps of the light's parts, one after the other.
  void add_up_parts(const visibility::Tile& tile);
  /// Runs all look-ups, and repeats workgroups whose loops were ended by the device, with fewer rows of a map at a
  /// time.
  void ask_all(const visibility::Tile& tile);
  /// Returns the push constants of look-ups of a part of a tile, without rows.
  [[nodiscard]] gpu::LookupPush push_of(const Receivers::Part& part, std::uint32_t first, std::uint32_t count) const;
  [[nodiscard]] std::vector<render::BufferReference> buffers_of(const Receivers::Part& part) const;
  /// Sorts out the workgroups of a tile that have nothing to look at, and keeps the number of the others.
  void sort_out(const visibility::Tile& tile);
  /// Records the look-ups of a tile in the maps of `count` light points, `rows_at_once` rows of a map at a time.
  void ask(render::Commands& commands, const visibility::Tile& tile, std::uint32_t first, std::uint32_t count,
           std::uint32_t rows_at_once);

  const render::Device* device_;
  MapRecipe recipe_;
  MapOptions options_;
  CasterMaps casters_;
  std::vector<std::uint32_t> constants_;
  render::ComputePass look_up_;               ///< with the current constants
  std::optional<render::ComputePass> sort_;   ///< of a recipe that sorts out
  std::vector<std::uint32_t> listed_groups_;  ///< of each part of the tile, after sort_
  Receivers receivers_;
  visibility::PassTimes times_;
  std::map<std::string, std::uint64_t> counters_;
  const visibility::SceneFloats* scene_ = nullptr;
  SceneSpace space_;                               // of the camera: the scene's, or that of a sun
  const visibility::AllTriangles* all_ = nullptr;  ///< of which the scene has a part; null: it is whole
  const visibility::Light* light_ = nullptr;
  const visibility::ViewSamples* samples_ = nullptr;
  LightBasis basis_;
  std::vector<visibility::LightPart>
      parts_;  ///< parts of the light with a map each; one, unless the recipe has several
  FittedViews fitted_;
  CameraFaces faces_;  ///< maps of a camera, if not windows; fitted_ has their number
  Aliasing aliasing_;
  bool maps_are_old_ = false;  ///< made for another view
  std::vector<std::uint32_t> own_push_;
  std::uint32_t batch_ = 1;        ///< light points at a time
  visibility::Tile tile_{};        ///< most recent tile
  std::uint32_t tile_pixels_ = 0;  ///< number of pixels of tile_
  std::unique_ptr<render::Buffer> views_, depths_, results_;
  std::vector<double> mean_;  ///< V of tile_, if the light has several parts
};

std::vector<std::uint32_t> MapMethod::constants_for(std::uint32_t faces) const {
  std::vector<std::uint32_t> constants;
  for (const std::unique_ptr<MapProduct>& product : recipe_.products) {
    std::ranges::copy(product->constants(options_.size, faces), std::back_inserter(constants));
  }
  std::ranges::copy(recipe_.constants, std::back_inserter(constants));
  return constants;
}

render::ComputePass MapMethod::make_look_up() const {
  const std::size_t push_bytes = sizeof(gpu::LookupPush) + sizeof(std::uint32_t) * recipe_.push_words;
  return {*device_,
          {.name = recipe_.look_up_name,
           .spirv = options_.fit.has_faces() ? recipe_.fitted_look_up : recipe_.look_up,
           .push_bytes = static_cast<std::uint32_t>(push_bytes),
           .constants = constants_}};
}

std::optional<render::ComputePass> MapMethod::make_sort() const {
  if (!sorts_out()) return std::nullopt;
  const std::size_t push_bytes = sizeof(gpu::LookupPush) + sizeof(std::uint32_t) * recipe_.push_words;
  return std::optional<render::ComputePass>(
      std::in_place, *device_,
      render::ComputePassOptions{.name = recipe_.look_up_name + " (sorting)",
                                 .spirv = recipe_.sort_out,
                                 .push_bytes = static_cast<std::uint32_t>(push_bytes),
                                 .constants = constants_});
}

void MapMethod::prepare_mesh(const visibility::SceneFloats& scene) {
  scene_ = &scene;
  if (all_ == nullptr) return casters_.upload(scene);
  PENUMBRA_ASSERT(
      recipe_.points == MapPoints::centre && recipe_.sub_lights == 1 &&
          std::ranges::all_of(recipe_.products, [](const auto& product) { return product->leaves_triangles(); }) &&
          !options_.fit.sees_camera() && !options_.fit.has_faces(),
      "{} looks at triangles more than once", recipe_.description.name);
  casters_.pass(*all_, times_);
}

void MapMethod::prepare_light(const visibility::Light& light) {
  visibility::check_light(recipe_.description, light);
  PENUMBRA_ASSERT(scene_ != nullptr, "{}: prepare_light before prepare_mesh", recipe_.description.name);
  if (options_.fit.asks_triangles() && casters_.have_holes())
    throw InputError("method {}: {} draws no surfaces with holes (alphaMode MASK); take another",
                     recipe_.description.name, words_of(options_.fit));
  light_ = &light;
  basis_ = light_basis(light, *scene_);
  parts_ = visibility::light_parts(light, recipe_.sub_lights);
  counters_ = {};
  aliasing_ = {};
  // A camera's maps are made when there are view samples.
  maps_are_old_ = options_.fit.sees_camera();
  if (!maps_are_old_) make_maps();
}

void MapMethod::fit_maps() {
  const visibility::Light& light = *light_;
  const bool many = recipe_.points == MapPoints::light_samples;
  std::vector<glm::vec3> centres;
  for (const visibility::LightPart& part : parts_) centres.emplace_back(visibility::center_of(part.light));
  FitOptions fit{options_.size, recipe_.beside ? recipe_.beside(light, basis_) : glm::dvec2(0)};
  if (recipe_.jitter != nullptr) fit.jitter = *recipe_.jitter;
  if (recipe_.whole_light) {
    for (const visibility::LightPart& part : parts_) {
      const LightBounds bounds = light_bounds(part.light, basis_of(part.light));
      fit.reach = glm::max(fit.reach, glm::max(-bounds.lower, bounds.upper));
    }
  }
  if (recipe_.all_casters) fit.reach = reach_of_all(*scene_);
  if (options_.fit.sees_camera()) return fit_to_camera(fit, centres);
  fit.hemicube = options_.fit.projection == Projection::cube;
  fit.all = all_;
  fitted_ =
      fit_views(*scene_, light, basis_, many ? std::span(light.points) : std::span<const glm::vec3>(centres), fit);
  if (options_.fit.projection == Projection::paraboloid) {
    fitted_.faces =
        faces_.take_paraboloids(*device_, basis_, options_.size, 1 + recipe_.beside_texels, fitted_.views.front());
  }
}

void MapMethod::fit_to_camera(FitOptions fit, std::span<const glm::vec3> centres) {
  const visibility::Light& light = *light_;
  const LightBounds bounds = light_bounds(light, basis_);
  if (recipe_.beside && recipe_.beside_texels == 0) fit.body_reach = glm::max(-bounds.lower, bounds.upper);
  const std::vector<BodyPoint> body = body_points(*scene_, light, basis_, *samples_, options_.fit.body, 0,
                                                  std::numeric_limits<double>::infinity(), space_);
  fit.body = &body;
  fit.snap = options_.fit.snap;
  fitted_ = fit_views(*scene_, light, basis_, centres, fit);
  if (!options_.fit.has_faces()) return;
  FaceFitOptions choices{
      .fit = options_.fit, .size = options_.size, .spare = 1 + recipe_.beside_texels, .space = space_};
  if (recipe_.beside_texels == 0) {
    choices.beside = fit.beside;
    choices.body_reach = fit.body_reach;
  }
  if (options_.fit.queries()) choices.fit.tiles = 1;
  fitted_.faces = faces_.fit(*device_, {*scene_, light, basis_, *samples_, space_}, choices, fitted_.views.front());
}

void MapMethod::make_maps() {
  fit_maps();
  maps_are_old_ = false;
  if (options_.fit.queries()) {
    query_tiles();
  } else {
    make_fitted_maps();
  }
}

void MapMethod::query_tiles() {
  std::vector<std::optional<SeenReceiver>> receivers(samples_->size());
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    if (visibility::is_receiver(*scene_, *light_, *samples_, i)) {
      receivers[i] = seen_receiver(*samples_, i, basis_, light_->two_sided, space_);
    }
  }
  const visibility::Tile asked = tile_;
  const std::vector<FittedFace> whole = faces_.faces();
  const QueriedTiles tiles = queried_tiles(whole, receivers, options_.fit, [&](const std::vector<FittedFace>& faces) {
    fitted_.faces = faces_.take(*device_, {*scene_, *light_, basis_, *samples_, space_}, faces, options_.size,
                                fitted_.views.front());
    make_fitted_maps();
    return whole_picture();
  });
  take_tile(asked);
  counters_["queriedPictures"] = tiles.pictures;
}

std::vector<float> MapMethod::whole_picture() {
  std::vector<float> visibility(samples_->size());
  const std::uint32_t rows = max_tile_rows();
  for (std::uint32_t first = 0; first < samples_->height; first += rows) {
    take_tile({first, std::min(rows, samples_->height - first)});
    ask_all(tile_);
    results_->read(std::span(visibility).subspan(std::size_t{first} * samples_->width, tile_pixels_));
  }
  return visibility;
}

void MapMethod::take_tile(const visibility::Tile& tile) {
  tile_ = tile;
  tile_pixels_ = tile.row_count * receivers_.width();
  if (tile_pixels_ == 0) return;
  render::grow(*device_, results_, gives_masks() ? "map masks" : "map visibility", result_bytes(tile_pixels_));
}

void MapMethod::make_fitted_maps() {
  const visibility::Light& light = *light_;
  const bool many = recipe_.points == MapPoints::light_samples;
  const std::uint32_t faces = std::max(fitted_.faces, 1u);
  check_faces_fit(*device_, options_.size, faces * total_layers());
  if (std::vector<std::uint32_t> constants = constants_for(faces); constants != constants_) {
    constants_ = std::move(constants);
    look_up_ = make_look_up();
    sort_ = make_sort();
  }

  const std::uint64_t point_bytes =
      std::uint64_t{faces} * total_layers() * options_.size * options_.size * sizeof(float);
  const std::uint64_t most = std::min(kBatchBytes, device_->limits().max_storage_buffer_range) / point_bytes;
  batch_ = std::bit_floor(std::clamp(static_cast<std::uint32_t>(most), 1u, kBitsPerWord));
  batch_ = many ? std::min(batch_, std::bit_ceil(point_count())) : 1;
  render::grow(*device_, depths_, "map depths", point_bytes * batch_);
  render::grow(*device_, views_, "map views", fitted_.views.size() * sizeof(gpu::LightView));
  views_->write<gpu::LightView>(fitted_.views);
  counters_ = {{"maps", 0}, {"mapFaces", 0}, {"casters", casters_.caster_count()}};
  for (const std::unique_ptr<MapProduct>& product : recipe_.products) {
    product->make({*scene_, light, basis_, casters_, fitted_.views.front(), fitted_.faces, options_.size, options_.bias,
                   times_, counters_});
  }
  own_push_ = recipe_.push ? recipe_.push(light) : std::vector<std::uint32_t>();
  PENUMBRA_ASSERT(own_push_.size() == recipe_.push_words, "{}: {} words of push constants", recipe_.description.name,
                  own_push_.size());
  if (many) {
    counters_["mapsPerBatch"] = batch_;
    return;
  }
  // Parts share the memory for maps: with several parts, each map is made before its look-up.
  if (parts_.size() == 1) make_centre_maps(0);
}

void MapMethod::make_centre_maps(std::uint32_t part) {
  views_->write<gpu::LightView>(std::span(&fitted_.views[part], 1));
  render::Commands commands(*device_);
  render_maps(commands, part, 1);
  render_layers(commands, part);
  const visibility::Light& light = parts_[part].light;
  const LightBasis basis = basis_of(light);
  for (const std::unique_ptr<MapProduct>& product : recipe_.products) {
    product->record(commands, {*views_, *depths_, fitted_.faces, options_.size, light, basis, *scene_,
                               recipe_.layers.count, options_.fit.has_faces() ? &faces_.table() : nullptr});
  }
  times_.add(commands.submit());
  counters_["casters"] = casters_.caster_count();
}

void MapMethod::prepare_view(const visibility::ViewSamples& samples) {
  PENUMBRA_ASSERT(light_ != nullptr, "{}: prepare_view before prepare_light", recipe_.description.name);
  samples_ = &samples;
  aliasing_ = {};
  maps_are_old_ = options_.fit.sees_camera();
  receivers_.upload(*device_, *scene_, *light_, samples);
}

std::uint32_t MapMethod::max_tile_rows() const {
  PENUMBRA_ASSERT(light_ != nullptr, "{}: max_tile_rows before prepare_light", recipe_.description.name);
  const std::uint64_t pixel_bytes = result_bytes(1) - result_bytes(0);
  const std::uint32_t possible = receivers_.max_rows(*device_, pixel_bytes);
  if (recipe_.points == MapPoints::centre) {
    const bool full =
        result_bytes(std::uint64_t{possible} * receivers_.width()) > device_->limits().max_storage_buffer_range;
    return full && possible > 1 ? possible - 1 : possible;
  }
  // Every tile renders all maps again: tiles are as high as memory allows.
  const std::uint64_t row_bytes = std::max(receivers_.width(), 1u) * pixel_bytes;
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(kMaskBytes / row_bytes, 1, possible));
}

void MapMethod::render_maps(render::Commands& commands, std::uint32_t first, std::uint32_t count) {
  std::uint32_t recorded = 0;
  for (std::uint32_t k = 0; k < count; ++k) {
    if (recorded + fitted_.faces > kFacesPerSubmission && recorded > 0) {
      times_.add(commands.submit());
      recorded = 0;
    }
    if (options_.fit.has_faces()) {
      faces_.record(casters_, commands, light_->index, *depths_, times_);
      continue;
    }
    casters_.record(commands, fitted_.views[first + k], basis_, light_->index, *depths_,
                    std::uint64_t{k} * fitted_.faces);
    recorded += fitted_.faces;
  }
  counters_["maps"] += count;
  counters_["mapFaces"] += std::uint64_t{count} * fitted_.faces;
}

void MapMethod::render_layers(render::Commands& commands, std::uint32_t part) {
  for (std::uint32_t layer = 1; layer < total_layers(); ++layer) {
    times_.add(commands.submit());
    const std::uint64_t first = std::uint64_t{layer} * fitted_.faces;
    const gpu::LightView& view = fitted_.views[part];
    if (options_.fit.has_faces()) {
      faces_.record_behind(casters_, commands, light_->index, *depths_, first, times_);
    } else if (layer < recipe_.layers.count) {
      casters_.record_behind(commands, view, basis_, light_->index, *depths_, first, first - fitted_.faces);
    } else {
      casters_.record_farthest(commands, view, basis_, light_->index, *depths_, first);
    }
    counters_["maps"] += 1;
    counters_["mapFaces"] += fitted_.faces;
  }
}

gpu::LookupPush MapMethod::push_of(const Receivers::Part& part, std::uint32_t first, std::uint32_t count) const {
  return {.basis = basis_.rounded(),
          .bias = static_cast<float>(options_.bias),
          .size = options_.size,
          .two_sided = is_body(light_->kind) ? 2u
                       : light_->two_sided   ? 1u
                                             : 0u,
          .first_receiver = part.first_receiver,
          .receiver_count = part.count,
          .first_result = part.first_result,
          .words_per_pixel = words_per_pixel(),
          .first_point = first,
          .point_count = count,
          .faces = fitted_.faces,
          .layers = recipe_.layers.count,
          .depth_use = static_cast<std::uint32_t>(options_.depth),
          .first_row = 0,
          .last_row = options_.size - 1,
          .width = receivers_.width(),
          .own_depth = options_.receiver_plane ? 0u : 1u};
}

std::vector<render::BufferReference> MapMethod::buffers_of(const Receivers::Part& part) const {
  std::vector<render::BufferReference> buffers{*part.receivers, *views_, *depths_, *results_};
  if (options_.fit.has_faces()) buffers.emplace_back(faces_.table());
  for (const std::unique_ptr<MapProduct>& product : recipe_.products) {
    std::ranges::copy(product->buffers(), std::back_inserter(buffers));
  }
  return buffers;
}

void MapMethod::sort_out(const visibility::Tile& tile) {
  const std::uint64_t list =
      (results_->bytes() - sizeof(gpu::CutLoops) - sizeof(gpu::GroupList)) / sizeof(std::uint32_t);
  gpu::GroupList head{.count = 0, .first = tile_pixels_ * (words_per_pixel() + 2)};
  listed_groups_.clear();
  for (const Receivers::Part& part : receivers_.parts(tile)) {
    render::Commands commands(*device_);
    commands.fill(*results_, 0, list * sizeof(std::uint32_t), sizeof(std::uint32_t));
    commands.fill(*results_, head.first, (list + 1) * sizeof(std::uint32_t), sizeof(std::uint32_t));
    std::vector<std::uint32_t> words = push_words(push_of(part, 0, 1));
    words.insert(words.end(), own_push_.begin(), own_push_.end());
    sort_->record(commands, std::as_bytes(std::span(words)), buffers_of(part),
                  (packets(part) + gpu::kLookupGroup - 1) / gpu::kLookupGroup);
    times_.add(commands.submit());
    results_->read(std::span(&head.count, 1), list * sizeof(std::uint32_t));
    listed_groups_.push_back(head.count);
  }
}

void MapMethod::ask(render::Commands& commands, const visibility::Tile& tile, std::uint32_t first, std::uint32_t count,
                    std::uint32_t rows_at_once) {
  const std::vector<Receivers::Part> parts = receivers_.parts(tile);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Receivers::Part& part = parts[k];
    gpu::LookupPush push = push_of(part, first, count);
    const std::vector<render::BufferReference> buffers = buffers_of(part);
    const std::uint64_t groups = sorts_out()                ? listed_groups_[k]
                                 : recipe_.group_a_receiver ? packets(part)
                                                            : part.groups();
    if (groups == 0) continue;
    if (sorts_out()) {
      const std::uint64_t list = results_->bytes() - sizeof(gpu::CutLoops) - sizeof(gpu::GroupList);
      commands.fill(*results_, listed_groups_[k], list, sizeof(std::uint32_t));
    }
    for (std::uint32_t row = 0; row < options_.size; row += rows_at_once) {
      push.first_row = row;
      push.last_row = std::min(row + rows_at_once, options_.size) - 1;
      std::vector<std::uint32_t> words = push_words(push);
      words.insert(words.end(), own_push_.begin(), own_push_.end());
      look_up_.record(commands, std::as_bytes(std::span(words)), buffers, groups);
    }
  }
}

void MapMethod::evaluate(const visibility::Tile& tile) {
  PENUMBRA_ASSERT(light_ != nullptr, "{}: evaluate before prepare_light", recipe_.description.name);
  take_tile(tile);
  if (tile_pixels_ == 0) return;
  if (maps_are_old_) make_maps();
  if (options_.fit.aliasing != AliasingUse::off && aliasing_.errors.empty()) find_aliasing();
  if (parts_.size() > 1) return add_up_parts(tile);
  ask_all(tile);
}

void MapMethod::add_up_parts(const visibility::Tile& tile) {
  mean_.assign(tile_pixels_, 0.0);
  std::vector<float> visibility(tile_pixels_);
  for (std::uint32_t part = 0; part < parts_.size(); ++part) {
    make_centre_maps(part);
    ask_all(tile);
    results_->read<float>(visibility);
    for (std::size_t i = 0; i < mean_.size(); ++i) mean_[i] += parts_[part].weight * static_cast<double>(visibility[i]);
  }
}

void MapMethod::ask_all(const visibility::Tile& tile) {
  if (!recipe_.group_a_receiver) {
    render::Commands commands(*device_);
    for (std::uint32_t first = 0; first < point_count(); first += batch_) {
      const std::uint32_t count = std::min(batch_, point_count() - first);
      if (recipe_.points == MapPoints::light_samples) render_maps(commands, first, count);
      ask(commands, tile, first, count, options_.size);
      times_.add(commands.submit());
    }
    return;
  }
  PENUMBRA_ASSERT(point_count() == 1, "{}: workgroups ask one map", recipe_.description.name);
  if (sorts_out()) sort_out(tile);
  const std::uint64_t end = results_->bytes() / sizeof(std::uint32_t) - sizeof(gpu::CutLoops) / sizeof(std::uint32_t);
  const auto set = [&](render::Commands& commands, std::uint64_t word, std::uint32_t value) {
    commands.fill(*results_, value, (end + word) * sizeof(std::uint32_t), sizeof(std::uint32_t));
  };
  gpu::CutLoops cut{.any = 0, .asked = 0, .to_ask = tile_pixels_ * words_per_pixel()};
  for (std::uint32_t rows = options_.size;; rows = (rows + 3) / 4) {
    render::Commands commands(*device_);
    set(commands, 0, 0);
    set(commands, 1, cut.asked);
    set(commands, 2, cut.to_ask);
    commands.fill(*results_, 0, std::uint64_t{cut.to_ask} * sizeof(std::uint32_t),
                  std::uint64_t{tile_pixels_} * sizeof(std::uint32_t));
    ask(commands, tile, 0, 1, rows);
    times_.add(commands.submit());
    results_->read(std::span(&cut.any, 1), end * sizeof(std::uint32_t));
    if (cut.any == 0) return;
    if (rows == 1) {
      throw ResourceError("method {}: {} ends the loop over one row of a map before its end; take a smaller size",
                          recipe_.description.name, device_->info().name);
    }
    const std::uint32_t other = cut.asked != 0 ? cut.asked : cut.to_ask + tile_pixels_;
    cut.asked = std::exchange(cut.to_ask, other);
  }
}

void MapMethod::read_masks(std::span<std::uint32_t> masks) {
  const std::size_t words = std::size_t{tile_pixels_} * (light_ == nullptr ? 0 : words_per_pixel());
  PENUMBRA_ASSERT(gives_masks() && masks.size() == words, "{} words for masks of {}", masks.size(), words);
  if (!masks.empty()) results_->read(masks);
}

void MapMethod::read_visibility(std::span<float> visibility) {
  PENUMBRA_ASSERT(visibility.size() == tile_pixels_, "{} values for a tile of {} pixels", visibility.size(),
                  tile_pixels_);
  if (visibility.empty()) return;
  if (parts_.size() > 1) {
    std::transform(mean_.begin(), mean_.end(), visibility.begin(), [](double v) { return static_cast<float>(v); });
  } else if (!gives_masks()) {
    results_->read(visibility);
  } else {
    std::vector<std::uint32_t> masks(visibility.size() * words_per_pixel());
    read_masks(masks);
    visibility::visible_shares(*light_, masks, visibility);
  }
  if (options_.fit.aliasing == AliasingUse::show) {
    const auto first = aliasing_.errors.begin() + std::ptrdiff_t{tile_.first_row} * receivers_.width();
    std::transform(first, first + static_cast<std::ptrdiff_t>(visibility.size()), visibility.begin(),
                   [](float error) { return error > 1 ? 1 / error : 1.0F; });
  }
  receivers_.leave_out(tile_, visibility);
}

void MapMethod::find_aliasing() {
  const std::vector<FittedFace> windows = faces_of(fitted_.views.front());
  aliasing_ = measure_aliasing(options_.fit.has_faces() ? faces_.faces() : windows, *scene_, *light_, *samples_, basis_,
                               options_.size, space_);
}

std::map<std::string, std::uint64_t> MapMethod::counters() const {
  std::map<std::string, std::uint64_t> counters = counters_;
  counters.insert(aliasing_.counters.begin(), aliasing_.counters.end());
  if (light_ == nullptr) return counters;
  for (const std::unique_ptr<MapProduct>& product : recipe_.products) product->add_counters(counters);
  return counters;
}

std::uint64_t MapMethod::memory_bytes() const {
  std::uint64_t bytes = casters_.memory_bytes() + receivers_.memory_bytes() + faces_.memory_bytes();
  for (const auto* buffer : {&views_, &depths_, &results_}) bytes += *buffer ? (*buffer)->bytes() : 0;
  for (const std::unique_ptr<MapProduct>& product : recipe_.products) bytes += product->memory_bytes();
  return bytes;
}

}  // namespace

std::unique_ptr<visibility::Method> make_map_method(const render::Device& device, MapRecipe recipe,
                                                    const visibility::MethodOptions& options) {
  const MapOptions chosen =
      map_options(device, recipe.description, visibility::parse_options(recipe.description, options));
  return std::make_unique<MapMethod>(device, std::move(recipe), chosen);
}

}  // namespace penumbra::maps
