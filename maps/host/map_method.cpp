// SPDX-License-Identifier: Apache-2.0
// Implements everything common to methods of this family. Maps of many light points together would not fit into memory,
// so evaluate renders them in batches and looks up each batch at once. A batch is a power of two of light points, at
// most 32: no batch crosses two words of a mask.

#include "maps/host/recipe_method.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "maps/host/queried_tiles.hpp"
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

}  // namespace

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
    throw InputError("method {}: {} cannot draw surfaces with holes (alphaMode MASK); take another one",
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

std::unique_ptr<visibility::Method> make_map_method(const render::Device& device, MapRecipe recipe,
                                                    const visibility::MethodOptions& options) {
  const MapOptions chosen =
      map_options(device, recipe.description, visibility::parse_options(recipe.description, options));
  return std::make_unique<MapMethod>(device, std::move(recipe), chosen);
}

}  // namespace penumbra::maps
