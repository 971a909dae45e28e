// SPDX-License-Identifier: Apache-2.0
// Refines the set of light points with maps (Schwärzler, sections 3.3.1 to 3.3.3) and renders their maps.

#include "maps/sampling/adaptive_maps.hpp"

#include "maps/host/map_method.hpp"
#include "maps/products/light_shape.hpp"
#include "maps/sampling/adaptive_compare.comp.spv.hpp"
#include "maps/sampling/adaptive_light.shared.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace penumbra::maps {
namespace {

/// Largest number of maps in one buffer: the unused part of the last buffer is wasted.
constexpr std::uint32_t kMapsPerBuffer = 16;
/// Number of passes in one submission.
constexpr std::size_t kPassesPerSubmission = 96;

/// Returns a texture's mean luminance over a rectangle of the unit square, times its area; without a texture, the area.
double light_in(const visibility::Light& light, const glm::dvec2& lower, const glm::dvec2& upper) {
  const glm::dvec2 extent = upper - lower;
  if (!light.texture) return extent.x * extent.y;
  const visibility::LightTexture& texture = *light.texture;
  // Texel (x, y) covers x / width … (x + 1) / width and 1 − (y + 1) / height … 1 − y / height.
  const auto overlap = [](double from, double to, double a, double b) {
    return std::max(0.0, std::min(to, b) - std::max(from, a));
  };
  double sum = 0;
  for (std::uint32_t y = 0; y < texture.height; ++y) {
    const double rows =
        overlap(lower.y, upper.y, 1 - (y + 1.0) / texture.height, 1 - static_cast<double>(y) / texture.height);
    if (!(rows > 0)) continue;
    for (std::uint32_t x = 0; x < texture.width; ++x) {
      const double columns =
          overlap(lower.x, upper.x, static_cast<double>(x) / texture.width, (x + 1.0) / texture.width);
      sum += rows * columns * texture.luminance[std::size_t{y} * texture.width + x];
    }
  }
  return sum;
}

}  // namespace

AdaptiveMaps::AdaptiveMaps(const render::Device& device, const MapOptions& map, const AdaptiveChoices& choices)
    : device_(&device),
      map_(map),
      choices_(choices),
      casters_(device, map.size, map.rasteriser),
      compare_(device, {.name = "compare maps",
                        .spirv = shaders::kAdaptiveCompareComp,
                        .push_bytes = sizeof(gpu::LookupPush) + sizeof(gpu::AdaptiveComparePush),
                        .constants = {}}) {}

void AdaptiveMaps::set_scene(const visibility::SceneFloats& scene) {
  scene_ = &scene;
  casters_.upload(scene);
}

void AdaptiveMaps::set_light(const visibility::Light& light) {
  light_ = &light;
  basis_ = light_basis(light);
  tree_.emplace(choices_.form, choices_.levels);
  refined_ = false;

  const LightSquare square(light);
  const std::uint32_t side = (1u << choices_.levels) + 1;
  const bool line = choices_.form == LightTree::Shape::line;
  const visibility::LightFrame frame = visibility::light_frame(light);
  const bool upright = line && glm::length(frame.v) > glm::length(frame.u);
  std::vector<glm::vec3> points;
  for (std::uint32_t y = 0; y < (line ? 1 : side); ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const glm::dvec2 unit = tree_->unit({x, y});
      points.push_back(square.at(upright ? glm::dvec2(unit.y, unit.x) : unit));
    }
  }
  grid_ = fit_views(*scene_, light, basis_, points, fit_options());
  const std::uint32_t faces = std::max(grid_.faces, 1u);
  check_faces_fit(*device_, map_.size, faces);
  maps_per_buffer_ = static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(faces_per_buffer(*device_, map_.size) / faces, 1, kMapsPerBuffer));
  render::grow(*device_, views_, "map views",
               std::min<std::uint64_t>(points.size(), choices_.most_maps) * sizeof(gpu::LightView));
  views_used_.clear();
  counters_ = {{"maps", 0}, {"mapFaces", 0}, {"comparisons", 0}, {"casters", casters_.caster_count()}};
}

void AdaptiveMaps::restart() {
  tree_.emplace(choices_.form, choices_.levels);
  views_used_.clear();
  refined_ = false;
}

/// The width of a texel depends on the window's contents: no window of receivers is wider than ±kWidestTangent, and the
/// margin of one texel on every side is sufficient for 2 × 2 taps.
FitOptions AdaptiveMaps::fit_options() const {
  const double beside = choices_.taps > 2 ? 2 * kWidestTangent * (choices_.taps / 2) / map_.size : 0;
  return {.size = map_.size, .beside = glm::dvec2(beside)};
}

std::size_t AdaptiveMaps::view_of(const glm::uvec2& point) const {
  return point.y * ((std::size_t{1} << choices_.levels) + 1) + point.x;
}

ComparedReceivers AdaptiveMaps::centre_texels() {
  const glm::vec3 centre(basis_.center);
  const FittedViews fitted = fit_views(*scene_, *light_, basis_, std::span(&centre, 1), fit_options());
  ComparedReceivers places;
  texels_.clear();
  if (fitted.faces == 0) return places;
  check_faces_fit(*device_, map_.size, fitted.faces);
  const gpu::LightView& view = fitted.views.front();
  std::vector<float> depths(std::size_t{fitted.faces} * map_.size * map_.size);
  render::Buffer map(*device_, "map of the centre", depths.size() * sizeof(float));
  render::Commands commands(*device_);
  casters_.record(commands, view, basis_, light_->index, map, 0);
  times_.add(commands.submit());
  map.read<float>(depths);

  std::vector<gpu::Receiver> found;
  for (std::uint32_t face = 0; face < fitted.faces; ++face) {
    const Face axes = face_of(view, basis_, face);
    for (std::uint32_t y = 0; y < map_.size; ++y) {
      for (std::uint32_t x = 0; x < map_.size; ++x) {
        const float depth = depths[(std::size_t{face} * map_.size + y) * map_.size + x];
        if (depth == 1) continue;
        const glm::dvec3 direction = axes.direction(x, y, map_.size);
        found.push_back(
            {glm::vec3(glm::dvec3(view.point) + static_cast<double>(depth) * static_cast<double>(view.far) * direction),
             glm::vec3(-glm::normalize(direction)),  // facing the light
             visibility::SceneFloats::kNoPlane, visibility::SceneFloats::kNoPlane});
      }
    }
  }
  places.count = found.size();
  const std::size_t most = device_->limits().max_storage_buffer_range / sizeof(gpu::Receiver);
  for (std::size_t first = 0; first < found.size(); first += most) {
    const auto part = std::span(found).subspan(first, std::min(most, found.size() - first));
    texels_.push_back(render::make_buffer<gpu::Receiver>(*device_, "texels of the centre", part));
  }
  for (std::size_t i = 0; i < texels_.size(); ++i) {
    places.parts.push_back({&texels_[i], static_cast<std::uint32_t>(std::min(most, found.size() - i * most))});
  }
  return places;
}

void AdaptiveMaps::refine(const ComparedReceivers& places) {
  add_maps();
  const double whole = choices_.share_of_map ? static_cast<double>(map_.size) * map_.size
                                             : std::max(static_cast<double>(places.count), 1.0);
  while (!tree_->pairs().empty()) {
    const std::vector<std::uint32_t> counts = compare(tree_->pairs(), places);
    std::vector<std::uint8_t> differs(counts.size());
    std::ranges::transform(counts, differs.begin(),
                           [&](std::uint32_t count) { return count / whole < choices_.epsilon ? 0 : 1; });  // eq. 4
    tree_->split(differs, choices_.most_maps);
    add_maps();
  }
  weigh();
  texels_.clear();
  refined_ = true;
}

void AdaptiveMaps::add_maps() {
  const std::vector<glm::uvec2>& points = tree_->points();
  render::Commands commands(*device_);
  std::uint32_t recorded = 0;
  for (std::size_t i = views_used_.size(); i < points.size(); ++i) {
    const std::size_t buffer = i / maps_per_buffer_;
    if (buffer == maps_.size()) maps_.emplace_back();
    render::grow(*device_, maps_[buffer], "maps of light points",
                 std::uint64_t{maps_per_buffer_} * std::max(grid_.faces, 1u) * map_.size * map_.size * sizeof(float));
    views_used_.push_back(grid_.views[view_of(points[i])]);
    casters_.record(commands, views_used_.back(), basis_, light_->index, *maps_[buffer],
                    std::uint64_t{i % maps_per_buffer_} * grid_.faces);
    recorded += grid_.faces;
    if (recorded > kFacesPerSubmission) {
      times_.add(commands.submit());
      recorded = 0;
    }
  }
  times_.add(commands.submit());
  views_->write<gpu::LightView>(views_used_);
  counters_["maps"] = views_used_.size();
  counters_["mapFaces"] = views_used_.size() * grid_.faces;
}

gpu::LookupPush AdaptiveMaps::push() const {
  gpu::LookupPush push{};
  push.basis = basis_.rounded();
  push.bias = static_cast<float>(map_.bias);
  push.size = map_.size;
  push.two_sided = light_->two_sided ? 1 : 0;
  push.words_per_pixel = 1;
  push.faces = grid_.faces;
  return push;
}

std::vector<std::uint32_t> AdaptiveMaps::compare(std::span<const LightTree::Pair> pairs,
                                                 const ComparedReceivers& places) {
  std::vector<std::uint32_t> counts(pairs.size(), 0);
  counters_["comparisons"] += pairs.size();
  if (grid_.faces == 0 || places.parts.empty()) return counts;
  render::grow(*device_, counts_, "differing pixels", pairs.size() * sizeof(std::uint32_t));
  render::Commands commands(*device_);
  commands.fill(*counts_, 0);
  std::size_t recorded = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto [a, b] = pairs[i];
    const gpu::AdaptiveComparePush own{.view_a = a,
                                       .view_b = b,
                                       .map_a = a % maps_per_buffer_ * grid_.faces,
                                       .map_b = b % maps_per_buffer_ * grid_.faces,
                                       .counter = static_cast<std::uint32_t>(i),
                                       .gamma = static_cast<float>(choices_.gamma),
                                       .of_range = choices_.gamma_of_range ? 1u : 0u};
    for (const ComparedReceivers::Part& part : places.parts) {
      gpu::LookupPush look_up = push();
      look_up.receiver_count = part.count;
      const std::vector<render::BufferReference> buffers{*part.receivers, *views_, maps_of(a), *counts_, maps_of(b)};
      const std::vector<std::uint32_t> words = push_words(look_up, own);
      compare_.record(commands, std::as_bytes(std::span(words)), buffers,
                      (std::uint64_t{part.count} + gpu::kLookupGroup - 1) / gpu::kLookupGroup);
      if (++recorded % kPassesPerSubmission == 0) times_.add(commands.submit());
    }
  }
  times_.add(commands.submit());
  counts_->read<std::uint32_t>(counts);
  return counts;
}

void AdaptiveMaps::weigh() {
  const visibility::LightFrame frame = visibility::light_frame(*light_);
  const bool upright = choices_.form == LightTree::Shape::line && glm::length(frame.v) > glm::length(frame.u);
  const std::vector<double> weights =
      tree_->weights(choices_.weights, [&](const glm::dvec2& lower, const glm::dvec2& upper) {
        return upright ? light_in(*light_, {lower.y, lower.x}, {upper.y, upper.x}) : light_in(*light_, lower, upper);
      });
  const double largest = *std::ranges::max_element(weights);
  std::vector<float> relative(weights.size());
  std::ranges::transform(weights, relative.begin(),
                         [&](double weight) { return static_cast<float>(weight / largest); });
  total_ = std::accumulate(relative.begin(), relative.end(), 0.0F);
  render::grow(*device_, weights_, "weights of light points", relative.size() * sizeof(float));
  weights_->write<float>(relative);
}

std::uint64_t AdaptiveMaps::memory_bytes() const {
  std::uint64_t bytes = casters_.memory_bytes();
  for (const auto* buffer : {&views_, &weights_, &counts_}) bytes += *buffer ? (*buffer)->bytes() : 0;
  for (const std::unique_ptr<render::Buffer>& buffer : maps_) bytes += buffer->bytes();
  return bytes;
}

}  // namespace penumbra::maps
