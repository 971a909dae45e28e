// Schwärzler, "Real-time soft shadows with adaptive light source sampling": shadow maps from the corners of the light;
// two maps of opposite corners are compared at the view samples, and where too many differ the cell is split. V is the
// weighted mean of the maps' hard shadows. Departures: pixels that are below the horizon of both points do not count,
// and every tap is compared with the receiver's plane (taps.glsl).

#include "maps/sampling/adaptive_light.hpp"

#include "base/assert.hpp"
#include "maps/host/caster_maps.hpp"
#include "maps/host/map_fit.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/sampling/repairs.hpp"
#include "maps/host/receivers.hpp"
#include "maps/products/light_shape.hpp"
#include "maps/sampling/adaptive_compare.comp.spv.hpp"
#include "maps/sampling/adaptive_light.comp.spv.hpp"
#include "maps/sampling/adaptive_light.shared.h"
#include "maps/sampling/light_tree.hpp"
#include "render/compute_pass.hpp"
#include "visibility/receivers.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace penumbra::maps {
namespace {

enum class CompareIn : std::uint8_t { camera, light };
enum class Share : std::uint8_t { map, pixels };

constexpr visibility::IntegerOption kLevels{"levels", 0, 6, 3, "how often a cell of the light can be halved"};
constexpr visibility::RealOption kEpsilon{
    "epsilon", 0, 1, 0.01, "a cell is split unless fewer pixels differ than this share of a map's texels"};
constexpr visibility::RealOption kGamma{"gamma", 0, 1, 0.02,
                                        "two maps differ at a pixel if their heights do by at least this share"};
constexpr visibility::ChoiceOption kCompare{
    "compare",
    {{"camera", CompareIn::camera}, {"light", CompareIn::light}},
    CompareIn::camera,
    "where maps are compared: at the view samples, or at the texels of a map from the "
    "light's centre, which does not depend on the camera"};
constexpr visibility::ChoiceOption kPcf =
    visibility::flag_option("pcf", true, "filters each map over the 2 x 2 texels around the receiver");
constexpr visibility::ChoiceOption kForm{"form",
                                         {{"area", LightTree::Shape::area}, {"line", LightTree::Shape::line}},
                                         LightTree::Shape::area,
                                         "line: points on the light's longer middle line alone"};
constexpr visibility::ChoiceOption kWeights{
    "weights",
    {{"paper", PointWeights::paper}, {"equal", PointWeights::equal}, {"area", PointWeights::area}},
    PointWeights::paper,
    "of the maps: the paper's, none, or each cell's area shared by its corners"};
constexpr visibility::ChoiceOption kShareOf{"shareOf",
                                            {{"map", Share::map}, {"pixels", Share::pixels}},
                                            Share::map,
                                            "what epsilon is a share of: texels of a map, "
                                            "or all pixels (texels) compared"};
constexpr visibility::IntegerOption kMostMaps{"maps", 4, 4225, 512, "no more light points than this"};
constexpr visibility::IntegerOption kSize = map_size(512);

/// Maps in one buffer at most: what is not used of the last one is lost memory.
constexpr std::uint32_t kMapsPerBuffer = 16;
/// Passes that one submission holds.
constexpr std::size_t kPassesPerSubmission = 96;

visibility::MeshVerdict verdict_on(const mesh::Diagnosis& mesh) {
  return judge_for_maps("hard shadows from as many points of the light as their maps differ", mesh);
}

visibility::MethodDescription describe() {
  visibility::MethodDescription description{
      .name = "adaptive-light",
      .family = visibility::Family::image,
      .paper = "Schwaerzler",
      .output = visibility::Output::scalar,
      .exact_for = "nothing; in the limit of large maps and many levels any soup of triangles that can be rasterised",
      .lights = planar_lights(),
      .options = map_option_descriptions(kSize),
      .verdict_on = verdict_on,
      .repairs = sampling_repairs};
  for (const visibility::OptionDescription& option :
       {kLevels.description(), kEpsilon.description(), kGamma.description(), kCompare.description(), kPcf.description(),
        kForm.description(), kWeights.description(), kShareOf.description(), kMostMaps.description()}) {
    description.options.push_back(option);
  }
  return description;
}

struct Settings {
  std::uint32_t levels, most_maps;
  double epsilon, gamma;
  CompareIn compare;
  bool filter;
  LightTree::Shape form;
  PointWeights weights;
  Share share_of;
};

/// Where maps are compared: receivers on the device, and how many of them there are in all.
struct Places {
  struct Part {
    const render::Buffer* receivers;
    std::uint32_t count;
  };
  std::vector<Part> parts;
  std::uint64_t count = 0;
};

class AdaptiveLight final : public visibility::Method {
 public:
  AdaptiveLight(const render::Device& device, const MapOptions& map, const Settings& settings)
      : device_(&device),
        description_(describe()),
        map_(map),
        settings_(settings),
        casters_(device, map.size, map.rasteriser),
        compare_(device, {.name = "compare maps",
                          .spirv = shaders::kAdaptiveCompareComp,
                          .push_bytes = sizeof(gpu::LookupPush) + sizeof(gpu::AdaptiveComparePush),
                          .constants = {}}),
        look_up_(device, {.name = "adaptive-light look-up",
                          .spirv = shaders::kAdaptiveLightComp,
                          .push_bytes = sizeof(gpu::LookupPush) + sizeof(gpu::AdaptivePush),
                          .constants = {}}) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const visibility::SceneFloats& scene) override;
  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override;
  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    return receivers_.max_rows(*device_, sizeof(std::uint32_t));
  }
  void evaluate(const visibility::Tile& tile) override;
  void read_visibility(std::span<float> visibility) override;

  std::vector<visibility::PassTime> take_pass_times() override { return times_.take(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 private:
  [[nodiscard]] std::size_t view_of(const glm::uvec2& point) const;
  /// Adds light points until no cell's maps differ by too much.
  void refine(const Places& places);
  /// Renders the maps of points that have none yet.
  void add_maps();
  /// At how many places the maps of each pair differ.
  std::vector<std::uint32_t> compare(std::span<const LightTree::Pair> pairs, const Places& places);
  [[nodiscard]] Places pixels() const;
  /// What the map of the light's centre holds, as receivers.
  Places centre_texels();
  void weigh();
  [[nodiscard]] gpu::LookupPush push() const;

  const render::Device* device_;
  visibility::MethodDescription description_;
  MapOptions map_;
  Settings settings_;
  CasterMaps casters_;
  render::ComputePass compare_, look_up_;
  Receivers receivers_;
  visibility::PassTimes times_;
  std::map<std::string, std::uint64_t> counters_;
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  LightBasis basis_;
  std::optional<LightTree> tree_;
  bool refined_ = false;
  FittedViews grid_;                        ///< of all points that the tree can have
  std::vector<gpu::LightView> views_used_;  ///< of those that it has, in its order
  std::uint32_t maps_per_buffer_ = 1, tile_pixels_ = 0;
  std::uint64_t receiving_ = 0;  ///< pixels of the view that receive shadow
  float total_ = 0;              ///< of the weights
  std::vector<std::unique_ptr<render::Buffer>> maps_;
  std::vector<render::Buffer> texels_;
  std::unique_ptr<render::Buffer> views_, weights_, counts_, results_;
};

void AdaptiveLight::prepare_mesh(const visibility::SceneFloats& scene) {
  scene_ = &scene;
  casters_.upload(scene);
}

void AdaptiveLight::prepare_light(const visibility::Light& light) {
  visibility::check_light(description_, light);
  PENUMBRA_ASSERT(scene_ != nullptr, "{}: prepare_light before prepare_mesh", description_.name);
  light_ = &light;
  basis_ = light_basis(light);
  tree_.emplace(settings_.form, settings_.levels);
  refined_ = false;

  const LightSquare square(light);
  const std::uint32_t side = (1u << settings_.levels) + 1;
  const bool line = settings_.form == LightTree::Shape::line;
  const visibility::LightFrame frame = visibility::light_frame(light);
  const bool upright = line && glm::length(frame.v) > glm::length(frame.u);
  std::vector<glm::vec3> points;
  for (std::uint32_t y = 0; y < (line ? 1 : side); ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const glm::dvec2 unit = tree_->unit({x, y});
      points.push_back(square.at(upright ? glm::dvec2(unit.y, unit.x) : unit));
    }
  }
  grid_ = fit_views(*scene_, light, basis_, points, {.size = map_.size});
  const std::uint32_t faces = std::max(grid_.faces, 1u);
  check_faces_fit(*device_, map_.size, faces);
  maps_per_buffer_ = static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(faces_per_buffer(*device_, map_.size) / faces, 1, kMapsPerBuffer));
  render::grow(*device_, views_, "map views",
               std::min<std::uint64_t>(points.size(), settings_.most_maps) * sizeof(gpu::LightView));
  views_used_.clear();
  counters_ = {{"maps", 0}, {"mapFaces", 0}, {"comparisons", 0}, {"casters", casters_.caster_count()}};
  if (settings_.compare == CompareIn::light) refine(centre_texels());
}

void AdaptiveLight::prepare_view(const visibility::ViewSamples& samples) {
  PENUMBRA_ASSERT(scene_ != nullptr, "{}: prepare_view before prepare_mesh", description_.name);
  receivers_.upload(*device_, *scene_, samples);
  receiving_ = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) receiving_ += visibility::is_receiver(*scene_, samples, i) ? 1 : 0;
  if (settings_.compare == CompareIn::light || light_ == nullptr || !refined_) return;
  tree_.emplace(settings_.form, settings_.levels);  // another view: begin again
  views_used_.clear();
  refined_ = false;
}

std::size_t AdaptiveLight::view_of(const glm::uvec2& point) const {
  return point.y * ((std::size_t{1} << settings_.levels) + 1) + point.x;
}

Places AdaptiveLight::pixels() const {
  Places places{.parts = {}, .count = receiving_};
  for (const Receivers::Part& part : receivers_.parts({0, receivers_.height()})) {
    places.parts.push_back({part.receivers, part.count});
  }
  return places;
}

Places AdaptiveLight::centre_texels() {
  const glm::vec3 centre(basis_.center);
  const FittedViews fitted = fit_views(*scene_, *light_, basis_, std::span(&centre, 1), {.size = map_.size});
  Places places;
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
             glm::vec3(-glm::normalize(direction))});  // as if it faced the light
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

void AdaptiveLight::refine(const Places& places) {
  add_maps();
  const double whole = settings_.share_of == Share::map ? static_cast<double>(map_.size) * map_.size
                                                        : std::max(static_cast<double>(places.count), 1.0);
  while (!tree_->pairs().empty()) {
    const std::vector<std::uint32_t> counts = compare(tree_->pairs(), places);
    std::vector<std::uint8_t> differs(counts.size());
    std::ranges::transform(counts, differs.begin(),
                           [&](std::uint32_t count) { return count / whole < settings_.epsilon ? 0 : 1; });  // eq. 4
    tree_->split(differs, settings_.most_maps);
    add_maps();
  }
  weigh();
  texels_.clear();
  refined_ = true;
}

void AdaptiveLight::add_maps() {
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

gpu::LookupPush AdaptiveLight::push() const {
  gpu::LookupPush push{};
  push.basis = basis_.rounded();
  push.bias = static_cast<float>(map_.bias);
  push.size = map_.size;
  push.two_sided = light_->two_sided ? 1 : 0;
  push.words_per_pixel = 1;
  push.faces = grid_.faces;
  return push;
}

template <typename Own>
std::vector<std::uint32_t> joined(const gpu::LookupPush& push, const Own& own) {
  std::vector<std::uint32_t> words = push_words(push);
  const std::vector<std::uint32_t> more = push_words(own);
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::vector<std::uint32_t> AdaptiveLight::compare(std::span<const LightTree::Pair> pairs, const Places& places) {
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
                                       .gamma = static_cast<float>(settings_.gamma)};
    for (const Places::Part& part : places.parts) {
      gpu::LookupPush look_up = push();
      look_up.receiver_count = part.count;
      const std::vector<render::BufferReference> buffers{*part.receivers, *views_, *maps_[a / maps_per_buffer_],
                                                         *counts_, *maps_[b / maps_per_buffer_]};
      const std::vector<std::uint32_t> words = joined(look_up, own);
      compare_.record(commands, std::as_bytes(std::span(words)), buffers,
                      (std::uint64_t{part.count} + gpu::kLookupGroup - 1) / gpu::kLookupGroup);
      if (++recorded % kPassesPerSubmission == 0) times_.add(commands.submit());
    }
  }
  times_.add(commands.submit());
  counts_->read<std::uint32_t>(counts);
  return counts;
}

/// A texture's mean luminance over a rectangle of the unit square, times its area; 1 a unit of area without a texture.
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

void AdaptiveLight::weigh() {
  const visibility::LightFrame frame = visibility::light_frame(*light_);
  const bool upright = settings_.form == LightTree::Shape::line && glm::length(frame.v) > glm::length(frame.u);
  const std::vector<double> weights =
      tree_->weights(settings_.weights, [&](const glm::dvec2& lower, const glm::dvec2& upper) {
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

void AdaptiveLight::evaluate(const visibility::Tile& tile) {
  PENUMBRA_ASSERT(light_ != nullptr, "{}: evaluate before prepare_light", description_.name);
  if (!refined_) refine(pixels());
  tile_pixels_ = tile.row_count * receivers_.width();
  if (tile_pixels_ == 0) return;
  render::grow(*device_, results_, "map visibility", std::uint64_t{tile_pixels_} * sizeof(std::uint32_t));
  render::Commands commands(*device_);
  const auto points = static_cast<std::uint32_t>(views_used_.size());
  for (std::uint32_t first = 0; first < points; first += maps_per_buffer_) {
    const std::uint32_t count = std::min(maps_per_buffer_, points - first);
    const gpu::AdaptivePush own{
        .filter_taps = settings_.filter ? 1u : 0u, .last = first + count == points ? 1u : 0u, .total = total_};
    for (const Receivers::Part& part : receivers_.parts(tile)) {
      gpu::LookupPush look_up = push();
      look_up.first_receiver = part.first_receiver;
      look_up.receiver_count = part.count;
      look_up.first_result = part.first_result;
      look_up.first_point = first;
      look_up.point_count = count;
      const std::vector<render::BufferReference> buffers{*part.receivers, *views_, *maps_[first / maps_per_buffer_],
                                                         *results_, *weights_};
      const std::vector<std::uint32_t> words = joined(look_up, own);
      look_up_.record(commands, std::as_bytes(std::span(words)), buffers, part.groups());
    }
    times_.add(commands.submit());
  }
}

void AdaptiveLight::read_visibility(std::span<float> visibility) {
  PENUMBRA_ASSERT(visibility.size() == tile_pixels_, "{} values for a tile of {} pixels", visibility.size(),
                  tile_pixels_);
  if (!visibility.empty()) results_->read(visibility);
}

std::uint64_t AdaptiveLight::memory_bytes() const {
  std::uint64_t bytes = casters_.memory_bytes() + receivers_.memory_bytes();
  for (const auto* buffer : {&views_, &weights_, &counts_, &results_}) bytes += *buffer ? (*buffer)->bytes() : 0;
  for (const std::unique_ptr<render::Buffer>& buffer : maps_) bytes += buffer->bytes();
  return bytes;
}

}  // namespace

visibility::MethodDescription adaptive_light_description() {
  return describe();
}

std::unique_ptr<visibility::Method> make_adaptive_light(const render::Device& device,
                                                        const visibility::MethodOptions& options) {
  const visibility::MethodDescription description = describe();
  const visibility::ParsedOptions parsed = visibility::parse_options(description, options);
  const Settings settings{.levels = parsed[kLevels],
                          .most_maps = parsed[kMostMaps],
                          .epsilon = parsed[kEpsilon],
                          .gamma = parsed[kGamma],
                          .compare = parsed[kCompare],
                          .filter = parsed[kPcf],
                          .form = parsed[kForm],
                          .weights = parsed[kWeights],
                          .share_of = parsed[kShareOf]};
  return std::make_unique<AdaptiveLight>(device, map_options(device, description, parsed), settings);
}

}  // namespace penumbra::maps
