// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/caster_maps.hpp"
#include "maps/host/light_basis.hpp"
#include "maps/host/map_fit.hpp"
#include "maps/host/options.hpp"
#include "render/buffer.hpp"
#include "render/commands.hpp"
#include "render/device.hpp"
#include "visibility/method.hpp"
#include "visibility/pass_times.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// Recipe of a method of this family: the viewpoint of maps, the products made of them, and one function in GLSL that
/// looks them up for a view sample. MapMethod implements the rest, for all recipes.
namespace penumbra::maps {

/// Viewpoints of a method's maps.
enum class MapPoints : std::uint8_t {
  centre,         ///< the light's centroid: one map, rendered when the light is prepared
  light_samples,  ///< every light sample: maps are rendered in batches, again for every tile
};

/// Maps of one light, as read by products and look-ups.
struct MapSet {
  const render::Buffer& views;   ///< a LightView for each light point
  const render::Buffer& depths;  ///< `faces` · size² floats for each light point of the batch, or each of the layers
  std::uint32_t faces, size;
  const visibility::Light& light;
  const LightBasis& basis;
  const visibility::SceneFloats& scene;
  std::uint32_t layers = 1;                    ///< MapLayers::count; a farthest layer follows
  const render::Buffer* face_table = nullptr;  ///< table of fitted faces (face_fit.hpp), which are not described by
                                               ///< `views`
};

/// Layers of a texel's surfaces, in maps from the light's centre: layer i begins at face i · faces.
struct MapLayers {
  std::uint32_t count = 1;  ///< the nearest surface, and those found behind it by depth peeling
  bool farthest = false;    ///< the farthest surface after these: 0 for empty texels
};

/// Input of a product with viewpoints other than the light's centre.
struct MapSource {
  const visibility::SceneFloats& scene;
  const visibility::Light& light;
  const LightBasis& basis;
  const CasterMaps& casters;
  const gpu::LightView& centre;  ///< view of the light's centre, used by look-ups
  std::uint32_t faces, size;
  double bias;
  visibility::PassTimes& times;
  std::map<std::string, std::uint64_t>& counters;
};

/// Data made from a light's maps before the look-up (a minimum, a pyramid), or data of the light itself for a look-up
/// (points on the light): one buffer on the device, or several. A file pair, its shader, and a twin in C++ in the
/// tests.
class MapProduct {
 public:
  MapProduct() = default;
  MapProduct(const MapProduct&) = delete;
  MapProduct& operator=(const MapProduct&) = delete;
  virtual ~MapProduct() = default;

  /// Makes the product from separate maps, in separate submissions. Called once for each light, before record and
  /// MapRecipe::push.
  virtual void make([[maybe_unused]] const MapSource& source) {}
  /// Records the computation from maps whose rendering is already recorded. Called once for each light, for maps from
  /// its centre.
  virtual void record(render::Commands& commands, const MapSet& maps) = 0;
  [[nodiscard]] virtual const render::Buffer& buffer() const = 0;
  /// Returns the buffers bound by a look-up, in this order; their number is constant.
  [[nodiscard]] virtual std::vector<render::BufferReference> buffers() const { return {buffer()}; }
  /// Returns specialization constants for the code of its look-ups, for maps of this size; their number does not depend
  /// on the size.
  [[nodiscard]] virtual std::vector<std::uint32_t> constants([[maybe_unused]] std::uint32_t size,
                                                             [[maybe_unused]] std::uint32_t faces) const {
    return {};
  }
  /// Returns whether the product is made from maps and light alone: then triangles pass only once
  /// (visibility::AllTriangles).
  [[nodiscard]] virtual bool leaves_triangles() const { return false; }
  [[nodiscard]] virtual std::uint64_t memory_bytes() const { return buffer().bytes(); }
  /// Adds the counts of its look-ups so far (Method::counters).
  virtual void add_counters([[maybe_unused]] std::map<std::string, std::uint64_t>& counters) const {}
};

/// Returns a struct of 32-bit numbers as words of push constants.
template <typename Push>
std::vector<std::uint32_t> push_words(const Push& push) {
  static_assert(sizeof(Push) % sizeof(std::uint32_t) == 0);
  const auto words = std::bit_cast<std::array<std::uint32_t, sizeof(Push) / sizeof(std::uint32_t)>>(push);
  return {words.begin(), words.end()};
}

/// Returns the words of several structs, one after the other.
template <typename Push, typename... More>
std::vector<std::uint32_t> push_words(const Push& push, const More&... more) {
  std::vector<std::uint32_t> words = push_words(push);
  const std::vector<std::uint32_t> behind = push_words(more...);
  words.insert(words.end(), behind.begin(), behind.end());
  return words;
}

struct MapRecipe {
  /// Output::mask: the look-up computes one bit for each light sample, from the sample's own map or from the centre's;
  /// scalar: the look-up computes V.
  visibility::MethodDescription description;
  MapPoints points = MapPoints::centre;
  /// Look-up: a shader that includes look_up.glsl, defines one function, and includes one of the mains named by
  /// look_up.glsl. The shader reads receivers, views, depths, results and then the products' buffers, in this order.
  std::string look_up_name;
  std::span<const std::uint32_t> look_up{};
  /// The look-up with FITTED_FACES, for options `fit` with maps other than windows. Empty: not supported by the method.
  std::span<const std::uint32_t> fitted_look_up{};
  /// With group_a_receiver: the look-up with SORTS_OUT, a pass that excludes workgroups that have nothing to look at
  /// (group_list.glsl). Empty: all workgroups run.
  std::span<const std::uint32_t> sort_out{};
  std::vector<std::uint32_t> constants{};  ///< specialization constants of the look-up, after those of the products
  std::vector<std::unique_ptr<MapProduct>> products{};
  /// Largest distance of the look-up's taps from a receiver's direction (FitOptions::beside), for a light. Empty: no
  /// taps elsewhere.
  std::function<glm::dvec2(const visibility::Light&, const LightBasis&)> beside{};
  /// Largest distance of taps from a receiver's texel, in texels; `beside` then is the largest extent of this distance.
  std::uint32_t beside_texels = 0;
  /// The look-up needs all occluders between a receiver and any point of the light (FitOptions::reach).
  bool whole_light = false;
  /// The look-up also needs casters elsewhere: windows hold all casters, or become hemicubes.
  bool all_casters = false;
  /// A workgroup processes one receiver, with many texels (group_scalar_main.glsl, group_mask_main.glsl).
  bool group_a_receiver = false;
  /// With group_a_receiver: number of pixels across and down processed by a workgroup (GROUP_A_PACKET).
  std::uint32_t packet_width = 1, packet_height = 1;
  /// Number of parts of the light along each axis, each with a map from its own centre; V is their mean.
  std::uint32_t sub_lights = 1;
  /// Displacement of the map's window in texels (FitOptions::jitter) whenever maps are made. Null: none.
  const glm::dvec2* jitter = nullptr;
  visibility::MethodOptions changed_defaults{};  ///< visibility::ChangesDefaults
  /// Layers of the map in addition to the second one, which the option `depth` may request.
  MapLayers layers{};
  /// Push constants of the shader after LookupPush: `push_words` words, for a light.
  std::uint32_t push_words = 0;
  std::function<std::vector<std::uint32_t>(const visibility::Light&)> push{};
};

/// Makes a method from `recipe`. `options` are those of MapOptions and of the recipe's description. Throws UsageError
/// if an option is unknown.
std::unique_ptr<visibility::Method> make_map_method(const render::Device& device, MapRecipe recipe,
                                                    const visibility::MethodOptions& options);

}  // namespace penumbra::maps
