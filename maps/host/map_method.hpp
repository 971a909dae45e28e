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

/// A method of this family is a recipe: where maps are looked from, what is made of them, and one function in GLSL that
/// asks them for a view sample. MapMethod does everything else, for all of them.
namespace penumbra::maps {

/// Where a method's maps are looked from.
enum class MapPoints : std::uint8_t {
  centre,         ///< the light's centroid: one map, rendered when the light is prepared
  light_samples,  ///< every light sample: maps are rendered in batches, again for every tile
};

/// The maps of one light, as products and look-ups read them.
struct MapSet {
  const render::Buffer& views;   ///< a LightView for each light point
  const render::Buffer& depths;  ///< `faces` · size² floats for each light point of the batch, or each of the layers
  std::uint32_t faces, size;
  const visibility::Light& light;
  const LightBasis& basis;
  const visibility::SceneFloats& scene;
  std::uint32_t layers = 1;                    ///< MapLayers::count; if there is a farthest one it is the next
  const render::Buffer* face_table = nullptr;  ///< of fitted faces (face_fit.hpp), which `views` does not describe
};

/// What is kept of a texel's surfaces, in maps from the light's centre: layer i begins at face i · faces.
struct MapLayers {
  std::uint32_t count = 1;  ///< the nearest, and what depth peeling finds behind it
  bool farthest = false;    ///< the farthest after them: 0 where there is nothing
};

/// What a product needs that looks from other points than the light's centre.
struct MapSource {
  const visibility::SceneFloats& scene;
  const visibility::Light& light;
  const LightBasis& basis;
  const CasterMaps& casters;
  const gpu::LightView& centre;  ///< the view of the light's centre, which look-ups ask
  std::uint32_t faces, size;
  double bias;
  visibility::PassTimes& times;
  std::map<std::string, std::uint64_t>& counters;
};

/// What a light's maps are made into before they are asked (a minimum, a pyramid), or what a look-up needs of the light
/// itself (points on it): one buffer on the device, or several. A file pair, its shader, and a twin in C++ in the
/// tests.
class MapProduct {
 public:
  MapProduct() = default;
  MapProduct(const MapProduct&) = delete;
  MapProduct& operator=(const MapProduct&) = delete;
  virtual ~MapProduct() = default;

  /// Makes it of maps of its own, in submissions of its own. Once a light, before record and MapRecipe::push.
  virtual void make([[maybe_unused]] const MapSource& source) {}
  /// Records what makes it of maps whose rendering is recorded before. Once a light, for maps from its centre.
  virtual void record(render::Commands& commands, const MapSet& maps) = 0;
  [[nodiscard]] virtual const render::Buffer& buffer() const = 0;
  /// What a look-up binds, in this order; there are always as many.
  [[nodiscard]] virtual std::vector<render::BufferReference> buffers() const { return {buffer()}; }
  /// Specialization constants of its look-ups' code, for maps of this size: as many for any.
  [[nodiscard]] virtual std::vector<std::uint32_t> constants([[maybe_unused]] std::uint32_t size,
                                                             [[maybe_unused]] std::uint32_t faces) const {
    return {};
  }
  [[nodiscard]] virtual std::uint64_t memory_bytes() const { return buffer().bytes(); }
  /// What its look-ups counted since (Method::counters).
  virtual void add_counters([[maybe_unused]] std::map<std::string, std::uint64_t>& counters) const {}
};

/// A struct of 32-bit numbers as the words that a shader's push constants take.
template <typename Push>
std::vector<std::uint32_t> push_words(const Push& push) {
  static_assert(sizeof(Push) % sizeof(std::uint32_t) == 0);
  const auto words = std::bit_cast<std::array<std::uint32_t, sizeof(Push) / sizeof(std::uint32_t)>>(push);
  return {words.begin(), words.end()};
}

/// One behind the other.
template <typename Push, typename... More>
std::vector<std::uint32_t> push_words(const Push& push, const More&... more) {
  std::vector<std::uint32_t> words = push_words(push);
  const std::vector<std::uint32_t> behind = push_words(more...);
  words.insert(words.end(), behind.begin(), behind.end());
  return words;
}

struct MapRecipe {
  /// Output::mask: the look-up answers for each light sample, from its own map or from the centre's; scalar: it gives
  /// V.
  visibility::MethodDescription description;
  MapPoints points = MapPoints::centre;
  /// The look-up: a shader that includes look_up.glsl, defines one function, and includes one of the mains that
  /// look_up.glsl names. It reads receivers, views, depths, results and then the products' buffers, in this order.
  std::string look_up_name;
  std::span<const std::uint32_t> look_up{};
  /// The same with FITTED_FACES, for options `fit` that have other maps than windows. Empty: the method has none.
  std::span<const std::uint32_t> fitted_look_up{};
  std::vector<std::uint32_t> constants{};  ///< its specialization constants behind those of the products
  std::vector<std::unique_ptr<MapProduct>> products{};
  /// How far beside a receiver's direction the look-up taps (FitOptions::beside), for a light. Empty: not at all.
  std::function<glm::dvec2(const visibility::Light&, const LightBasis&)> beside{};
  /// It taps so many texels beside a receiver's, and `beside` says no more than how far that is at most.
  std::uint32_t beside_texels = 0;
  /// The look-up asks for all that stands between a receiver and any point of the light (FitOptions::reach).
  bool whole_light = false;
  /// It asks for casters that stand elsewhere, too: windows hold all that there are, or become hemicubes.
  bool all_casters = false;
  /// A workgroup answers one receiver, looking at many texels (group_scalar_main.glsl, group_mask_main.glsl).
  bool group_a_receiver = false;
  /// With group_a_receiver: it answers so many pixels across and down (GROUP_A_PACKET).
  std::uint32_t packet_width = 1, packet_height = 1;
  /// The light is cut into so many parts along each axis, each with a map from its own centre; V is their mean.
  std::uint32_t sub_lights = 1;
  /// Beside the second one, which the option `depth` may ask for.
  MapLayers layers{};
  /// What the shader's push constants have behind LookupPush: `push_words` of them, for a light.
  std::uint32_t push_words = 0;
  std::function<std::vector<std::uint32_t>(const visibility::Light&)> push{};
};

/// `options` are MapOptions' and whatever else the recipe's description declares; unknown ones are a UsageError.
std::unique_ptr<visibility::Method> make_map_method(const render::Device& device, MapRecipe recipe,
                                                    const visibility::MethodOptions& options);

}  // namespace penumbra::maps
