// SPDX-License-Identifier: Apache-2.0
// Adds methods of the calling program to the table of methods: each becomes a row, whose method calls that of the
// calling program.

#include "base/assert.hpp"
#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "library/float3.hpp"
#include "library/light_shape.hpp"
#include "scenes/light_kind.hpp"
#include "session/methods.hpp"
#include "session/process/failure.hpp"
#include "visibility/masks/visible_share.hpp"
#include "visibility/receivers.hpp"
#include "visibility/share.hpp"

#include <penumbra/own_method.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace penumbra {
namespace {

using visibility::MethodDescription;
using visibility::MethodOptions;
using visibility::Output;

Float3 floats_of(const glm::vec3& v) {
  return {v.x, v.y, v.z};
}

MethodScene scene_of(const visibility::SceneFloats& scene) {
  return {.origin = {scene.origin.x, scene.origin.y, scene.origin.z},
          .positions = as_floats(scene.positions),
          .triangles = scene.triangles,
          .casts = scene.casts_shadow,
          .lower = floats_of(scene.lower),
          .upper = floats_of(scene.upper)};
}

/// Returns the interface's light, which refers to `light`.
MethodLight light_of(const visibility::Light& light) {
  const bool has_frame = visibility::is_planar(light.kind) || light.sun.has_value();
  const visibility::LightFrame frame =
      has_frame ? visibility::light_frame(light) : visibility::LightFrame{.center = glm::dvec3(light.center)};
  return {.name = light.name,
          .kind = visibility::name_of(light.kind),
          .center = from_glm(frame.center),
          .u = from_glm(frame.u),
          .v = from_glm(frame.v),
          .radius = light.radius,
          .two_sided = light.two_sided,
          .outline = as_floats(light.outline),
          .points = as_floats(light.points),
          .weights = light.weights,
          .light_samples = light.sample_count(),
          .words_per_mask = light.words_per_mask(),
          .points_for = [&light](const Float3& p, std::span<Float3> points) {
            if (points.size() != light.sample_count())
              throw UsageError("light \"{}\" has {} light samples; there is room for {}", light.name,
                               light.sample_count(), points.size());
            static_assert(sizeof(glm::vec3) == sizeof(Float3));
            visibility::light_points_for(light, {p[0], p[1], p[2]}, reinterpret_cast<glm::vec3*>(points.data()));
          }};
}

MethodView view_of(const visibility::ViewSamples& samples) {
  return {.width = samples.width,
          .height = samples.height,
          .p = as_floats(samples.p),
          .n = as_floats(samples.n),
          .depth = samples.depth,
          .triangle = samples.triangle};
}

/// Calls a function of the calling program. Exceptions other than this library's errors pass through to the program.
template <typename Function>
auto call(const Function& function) {
  try {
    return function();
  } catch (const Error&) {
    throw;
  } catch (...) {
    throw session::ThrownByCaller{std::current_exception()};
  }
}

/// Method that calls the calling program's method for the pixels not decided by the definition.
class HostedMethod final : public visibility::Method {
 public:
  HostedMethod(MethodDescription description, std::unique_ptr<OwnMethod> own)
      : description_(std::move(description)), own_(std::move(own)) {
    if (own_ == nullptr) throw UsageError("method {}: its function returned no method", description_.name);
  }

  [[nodiscard]] const MethodDescription& description() const override { return description_; }
  void want_pixels(std::span<const std::uint32_t> pixels) override { wanted_.emplace(pixels.begin(), pixels.end()); }
  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    call([&] { own_->set_scene(scene_of(scene)); });
  }
  void prepare_light(const visibility::Light& light) override {
    visibility::check_light(description_, light);
    light_ = &light;
    call([&] { own_->set_light(light_of(light)); });
  }
  void prepare_view(const visibility::ViewSamples& samples) override {
    samples_ = &samples;
    call([&] { own_->set_view(view_of(samples)); });
  }
  [[nodiscard]] std::uint32_t max_tile_rows() const override;
  void evaluate(const visibility::Tile& tile) override;
  void read_masks(std::span<std::uint32_t> masks) override;
  void read_visibility(std::span<float> visibility) override;

 private:
  void choose_pixels(std::size_t first, std::size_t end);
  [[nodiscard]] bool has_masks() const { return description_.output == Output::mask; }

  MethodDescription description_;
  std::unique_ptr<OwnMethod> own_;
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  const visibility::ViewSamples* samples_ = nullptr;
  std::optional<std::vector<std::uint32_t>> wanted_;  // ascending; nullopt: every pixel
  std::size_t first_ = 0, count_ = 0;                 // pixels of the most recent tile
  std::vector<std::uint32_t> pixels_;                 // of these, the pixels passed to the method
  std::vector<float> visibility_;                     // of pixels_
  std::vector<std::uint32_t> masks_;                  // of pixels_
};

void HostedMethod::choose_pixels(std::size_t first, std::size_t end) {
  pixels_.clear();
  const auto ask = [&](std::size_t pixel) {
    if (visibility::is_receiver(*scene_, *light_, *samples_, pixel))
      pixels_.push_back(static_cast<std::uint32_t>(pixel));
  };
  if (wanted_) {
    for (auto pixel = std::ranges::lower_bound(*wanted_, first); pixel != wanted_->end() && *pixel < end; ++pixel)
      ask(*pixel);
  } else {
    for (std::size_t pixel = first; pixel < end; ++pixel) ask(pixel);
  }
}

std::uint32_t HostedMethod::max_tile_rows() const {
  if (light_ == nullptr || samples_ == nullptr || !light_->points.empty())
    return std::numeric_limits<std::uint32_t>::max();
  // A method may need the light samples of all of a tile's pixels at once, which differ from pixel to pixel.
  constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 28;
  const std::uint64_t row_bytes = std::uint64_t{samples_->width} * light_->sample_count() * sizeof(Float3);
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(kMostBytes / row_bytes, 1, samples_->height));
}

void HostedMethod::evaluate(const visibility::Tile& tile) {
  PENUMBRA_ASSERT(scene_ != nullptr && light_ != nullptr && samples_ != nullptr, "the prepare functions come first");
  first_ = std::size_t{tile.first_row} * samples_->width;
  count_ = std::size_t{tile.row_count} * samples_->width;
  choose_pixels(first_, first_ + count_);
  if (has_masks()) {
    masks_.assign(pixels_.size() * light_->words_per_mask(), 0);
    if (!pixels_.empty()) call([&] { own_->masks(pixels_, masks_); });
    const std::uint32_t used = light_->sample_count() % 32, words = light_->words_per_mask();
    for (std::size_t last = words; used != 0 && last <= masks_.size(); last += words)
      masks_[last - 1] &= (1U << used) - 1;
  } else {
    visibility_.assign(pixels_.size(), std::numeric_limits<float>::quiet_NaN());
    if (!pixels_.empty()) call([&] { own_->visibility(pixels_, visibility_); });
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      if (visibility::is_share(visibility_[i])) continue;
      throw ResourceError("method {}: its function gave V = {} at pixel ({}, {}); expected a number from 0 to 1",
                          description_.name, visibility_[i], pixels_[i] % samples_->width,
                          pixels_[i] / samples_->width);
    }
  }
}

void HostedMethod::read_masks(std::span<std::uint32_t> masks) {
  if (!has_masks()) return Method::read_masks(masks);
  const std::uint32_t words = light_->words_per_mask(), used = light_->sample_count() % 32;
  PENUMBRA_ASSERT(masks.size() == count_ * words, "{} words asked for, {} pixels evaluated", masks.size(), count_);
  std::ranges::fill(masks, ~0U);
  for (std::size_t last = words; used != 0 && last <= masks.size(); last += words) masks[last - 1] = (1U << used) - 1;
  for (std::size_t i = 0; i < pixels_.size(); ++i)
    std::copy_n(masks_.begin() + static_cast<std::ptrdiff_t>(i * words), words,
                masks.begin() + static_cast<std::ptrdiff_t>((pixels_[i] - first_) * words));
}

void HostedMethod::read_visibility(std::span<float> visibility) {
  PENUMBRA_ASSERT(visibility.size() == count_, "{} pixels asked for, {} evaluated", visibility.size(), count_);
  std::ranges::fill(visibility, 1.0F);
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    float& v = visibility[pixels_[i] - first_];
    if (!has_masks()) {
      v = visibility_[i];
      continue;
    }
    const std::size_t words = light_->words_per_mask();
    v = visibility::visible_share(*light_, std::span(masks_).subspan(i * words, words), samples_->n[pixels_[i]]);
  }
}

visibility::MeshVerdict verdict_of_own(const mesh::Diagnosis& /*mesh*/) {
  return {visibility::Verdict::approximate, "a method of the calling program, of which nothing is known"};
}

visibility::Family family_of(const OwnMethodInfo& info) {
  for (const visibility::Family family : {visibility::Family::geometry, visibility::Family::image}) {
    if (info.family == visibility::name_of(family)) return family;
  }
  throw UsageError("method {}: family \"{}\": expected geometry or image", info.name, info.family);
}

scenes::LightKinds kinds_of(const OwnMethodInfo& info) {
  scenes::LightKinds kinds;
  for (const std::string& name : info.lights) {
    const auto kind = scenes::LightKinds::with([&](const scenes::LightTraits& row) { return row.name == name; });
    if (kind == scenes::LightKinds()) {
      std::vector<std::string> names;
      for (const scenes::LightTraits& row : scenes::kLightTraits) names.emplace_back(row.name);
      throw UsageError("method {}: there is no kind of light \"{}\"; the kinds are: {}{}", info.name, name,
                       scenes::kEveryLight.words(), did_you_mean(name, names));
    }
    kinds = kinds | kind;
  }
  return kinds;
}

bool is_method_name(std::string_view name) {
  const auto is_allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  return !name.empty() && std::ranges::all_of(name, is_allowed);
}

visibility::OptionDescription option_of(const OwnMethodInfo& info, const MethodOption& option) {
  const auto is_possible = [&](double end) {
    return std::isfinite(end) && (!option.whole || (end >= 0 && end <= 0x1p53 && std::floor(end) == end));
  };
  if (!is_method_name(option.name))
    throw UsageError("method {}: option \"{}\": expected a name of letters, digits, - and _", info.name, option.name);
  if (option.choices.empty() && (!is_possible(option.least) || !is_possible(option.most) || option.least > option.most))
    throw UsageError("method {}: option {} cannot be from {} to {}{}", info.name, option.name, option.least,
                     option.most, option.whole ? "; whole numbers are from 0 on" : "");
  visibility::OptionDescription described{.name = option.name,
                                          .choices = option.choices,
                                          .least = option.least,
                                          .most = option.most,
                                          .whole = option.whole,
                                          .default_value = {},
                                          .help = option.help};
  described.default_value = !option.choices.empty() ? option.choices.front()
                            : option.whole          ? fmt::format("{}", static_cast<std::uint64_t>(option.least))
                                                    : fmt::format("{}", option.least);
  // Throws if the default value is invalid.
  static_cast<void>(visibility::ParsedOptions(info.name, {{described}}, {{option.name, option.default_value}}));
  described.default_value = option.default_value;
  return described;
}

MethodDescription description_of(const OwnMethodInfo& info) {
  if (!is_method_name(info.name))
    throw UsageError("method \"{}\": expected a name of letters, digits, - and _", info.name);
  MethodDescription description;
  description.name = info.name;
  description.family = family_of(info);
  description.paper = info.paper;
  description.output = info.masks ? Output::mask : Output::scalar;
  description.exact_for = info.exact_for;
  description.lights = kinds_of(info);
  description.textures = info.masks || info.textures;
  description.on_request = true;  // never a default
  description.verdict_on = verdict_of_own;
  for (const MethodOption& option : info.options) {
    if (std::ranges::find(description.options, option.name, &visibility::OptionDescription::name) !=
        description.options.end())
      throw UsageError("method {}: option {} occurs twice", info.name, option.name);
    description.options.push_back(option_of(info, option));
  }
  return description;
}

}  // namespace

OwnMethod::~OwnMethod() = default;

void OwnMethod::visibility(std::span<const std::uint32_t> /*pixels*/, std::span<float> /*visibility*/) {
  throw UsageError("a method of the calling program without masks has no function `visibility`");
}
void OwnMethod::masks(std::span<const std::uint32_t> /*pixels*/, std::span<std::uint32_t> /*masks*/) {
  throw UsageError("a method of the calling program with masks has no function `masks`");
}

void add_method(const OwnMethodInfo& info, MakeOwnMethod make) {
  if (!make) throw UsageError("method {}: expected a function that makes it", info.name);
  MethodDescription description = description_of(info);
  const auto describe = [description](const MethodOptions& options) {
    visibility::parse_options(description, options);
    return description;
  };
  session::add_method(
      {.description = description,
       .describe = describe,
       .make =
           [describe, make = std::move(make)](const render::Machine&, const MethodOptions& options) {
             MethodDescription with = describe(options);
             std::unique_ptr<OwnMethod> own = call([&] { return make(visibility::complete_options(with, options)); });
             return std::make_unique<HostedMethod>(std::move(with), std::move(own));
           },
       .on_device = [](const render::Machine&, const MethodOptions&, const visibility::Light&) { return false; }});
}

}  // namespace penumbra
