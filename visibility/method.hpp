#pragma once

#include "visibility/error_repair.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/mesh_verdict.hpp"
#include "visibility/method_options.hpp"
#include "visibility/pass_times.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::visibility {

enum class Family { reference, geometry, image };
enum class Output {
  mask,      ///< one bit a light sample: visible or not
  scalar,    ///< V alone
  radiance,  ///< V, and form factors of what is visible: cosines and colours integrated by the method itself
};
const char* name_of(Family family);
const char* name_of(Output output);

/// Of which lights a method gives the visible area itself, to the last digit of a float, and the options that this
/// takes.
struct ExactArea {
  LightKinds lights;
  MethodOptions options = {};
};

/// Sizes of lights, in units of the scene's size (visibility/lights/device_light.hpp), that a method's float32 holds
/// together with the scene.
struct LightSpan {
  float smallest = 0;  ///< of a light's half-size
  float farthest = std::numeric_limits<float>::infinity();
};
/// Of methods that have lights in the scene's float32: they multiply up to six lengths.
inline constexpr LightSpan kFloatSpan{0x1p-28F, 0x1p28F};

/// What `penumbra methods` and `penumbra inspect` print of a method.
struct MethodDescription {
  std::string name;
  Family family = Family::geometry;
  std::string paper;
  Output output = Output::mask;
  std::string exact_for;    ///< what it is exact for, in words
  LightKinds lights;        ///< what it can do
  bool textures = true;     ///< weighs V by a light's texture
  bool any_pattern = true;  ///< otherwise only light samples in rows (patterns rows and grid)
  bool on_request = false;  ///< a comparison has it only by name, or with its whole family: it takes long, or is a foil
  bool shares_of_samples = false;  ///< V without masks is the share of light samples that are visible, as with masks
  bool draws_holes = false;        ///< knows surfaces with holes (alphaMode MASK): the host must not ask them again
  /// Memory that it takes at least for each triangle of a mesh. Measured on meshes of one and five million triangles,
  /// and rounded down a good deal: a mesh that is refused for it would not have fitted.
  std::uint64_t bytes_per_triangle = 50;
  std::vector<OptionDescription> options;
  std::optional<ExactArea> exact_area = {};  ///< none: it never gives it
  LightSpan span = {};                       ///< of lights that it does; by default of any size
  /// What it makes of a mesh with these defects, and why. Every method of the table of methods has one.
  MeshVerdict (*verdict_on)(const mesh::Diagnosis& mesh) = nullptr;
  /// Which runs do without each cause of its error, for options that it takes. Image-based methods have one.
  ErrorRepairs (*repairs)(const MethodDescription& method, const MethodOptions& given) = nullptr;
  /// How wide a texel of the maps that it makes with these options is at each view sample, across the light's normal,
  /// in scene floats; infinite where none looks. Null: it has no maps. Empty: they cannot be told so.
  std::vector<float> (*texel_widths)(const SceneFloats& scene, const ViewSamples& samples, const Light& light,
                                     const MethodOptions& complete) = nullptr;
  /// What a run's options and counters say that a viewer of its picture must know; null: never anything.
  std::optional<std::string> (*warning)(const MethodOptions& options,
                                        const std::map<std::string, std::uint64_t>& counters) = nullptr;

  /// Is V, with these options, the visible area itself? Then light samples play no part in it, nor in the beauty.
  [[nodiscard]] bool gives_area() const { return output == Output::radiance; }
  /// Is V, of masks or not, about the light samples that --light-samples asks for? Other methods look at the light's
  /// centre, at points of their own, or at its area.
  [[nodiscard]] bool counts_light_samples() const { return output == Output::mask || shares_of_samples; }
};

/// A band of whole pixel rows.
struct Tile {
  std::uint32_t first_row = 0, row_count = 0;
};

/// One way to turn view samples into visibility. The host calls, in this order and each as often as it likes:
/// prepare_mesh, prepare_light, prepare_view, then for each tile evaluate and read. A light with another body needs
/// prepare_view again: what shows a light's body receives no shadow of it (visibility/receivers.hpp). It times them,
/// chooses tiles no higher than max_tile_rows(), and calls each method from one thread at a time. Methods on
/// different threads do not meet. Every call completes before it returns. Throws InputError for a light it cannot do,
/// ResourceError when memory does not suffice.
class Method {
 public:
  virtual ~Method() = default;

  [[nodiscard]] virtual const MethodDescription& description() const = 0;

  /// The host will look at no other pixels than these (indices, ascending; copied). A method that works pixel by pixel
  /// leaves the rest out and gives NaN as their V; others need not listen. Without a call: all pixels.
  virtual void want_pixels([[maybe_unused]] std::span<const std::uint32_t> pixels) {}

  /// Will read_form_factors follow each evaluate? Then a method of Output::radiance may find them on the way to V,
  /// where they cost less than afterwards, in the time of evaluate. Without a call: it may, and V need not wait for it.
  virtual void want_form_factors([[maybe_unused]] bool wanted) {}

  /// Meshes will follow one another as frames do. What a method can carry over from the one before it then keeps, at
  /// the cost of memory; answers are the same bits as without. Before the first prepare_mesh.
  virtual void expect_frames() {}
  /// Once a mesh: adjacency, hierarchies, upload. `scene` must outlive the method.
  virtual void prepare_mesh(const SceneFloats& scene) = 0;
  /// Redone when a light moves. `light` must outlive its use.
  virtual void prepare_light(const Light& light) = 0;
  /// Takes over the view samples (upload; shared work of all methods, not part of `shadow`). Must outlive its use.
  virtual void prepare_view(const ViewSamples& samples) = 0;
  /// The most pixel rows that one evaluate can take within the device's limits; at least 1.
  [[nodiscard]] virtual std::uint32_t max_tile_rows() const = 0;
  /// From stored view samples to V or masks in the method's own memory.
  virtual void evaluate(const Tile& tile) = 0;

  /// Output::mask only: for each pixel of the tile last evaluated, words_per_mask() words in which bit j mod 32 of word
  /// j / 32 is set iff light sample j is visible. Background pixels: all N bits set. Bits beyond N are 0.
  virtual void read_masks(std::span<std::uint32_t> masks);
  /// Output::radiance only: for each pixel of the tile last evaluated, 1/π ∫ visible texel cos θp cos θl / d² dl over
  /// the light (form_factor.hpp; with a texture each colour's own, else three equal numbers), which with a surface's
  /// colour and the light's radiance is its beauty. Background 0, what was not wanted NaN.
  virtual void read_form_factors(std::span<glm::dvec3> form_factors);
  /// V of each pixel of the tile last evaluated; background 1.
  virtual void read_visibility(std::span<float> visibility) = 0;

  /// Since the last call: GPU passes (or CPU stages) with their times, summed by name.
  virtual std::vector<PassTime> take_pass_times() { return {}; }
  /// Counters for --stats (candidate pairs, retries, fallbacks …) of the last evaluate calls since prepare_light.
  [[nodiscard]] virtual std::map<std::string, std::uint64_t> counters() const { return {}; }
  /// Since the last call: what was made for meshes (treesBuilt, edgesBuilt …), and what only had to follow those of the
  /// mesh before (treesRefit, edgesRefit …). Docs: frames.md.
  virtual std::map<std::string, std::uint64_t> take_mesh_counters() { return {}; }
  /// Bytes of device memory (or, for CPU methods, of their own structures) at their peak.
  [[nodiscard]] virtual std::uint64_t memory_bytes() const { return 0; }
};

/// An object that lets this light through and whose part of the shadow is the host's, light sample by light sample, if
/// this method does the rest (Light::filtered_by, Light::dimmed_by). Empty: there is none.
const std::string& left_to_host(const MethodDescription& description, const Light& light);

/// Refuses a light that the method cannot do, and says what can be done instead.
void check_light(const MethodDescription& description, const Light& light);

/// The user's options, and the defaults of the others.
MethodOptions complete_options(const MethodDescription& description, const MethodOptions& given);

/// The user's options as values of the types that the method declares. Throws UsageError, see ParsedOptions.
ParsedOptions parse_options(const MethodDescription& description, const MethodOptions& given);

}  // namespace penumbra::visibility
