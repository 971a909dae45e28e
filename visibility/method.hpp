// SPDX-License-Identifier: Apache-2.0
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
  mask,      ///< one bit for each light sample: visible or not
  scalar,    ///< V only
  radiance,  ///< V, and form factors of the visible region: cosines and colours integrated by the method itself
};
const char* name_of(Family family);
const char* name_of(Output output);

/// Lights for which a method gives the visible area itself, to the precision of a float, and the options required.
struct ExactArea {
  LightKinds lights;
  MethodOptions options = {};
};

/// Sizes of lights, in units of the scene's size (visibility/lights/device_light.hpp), that a method's float32 can
/// represent together with the scene.
struct LightSpan {
  float smallest = 0;  ///< least half-size of a light
  float farthest = std::numeric_limits<float>::infinity();
};
/// Span of methods that represent lights in float32 together with the scene: they multiply up to six lengths.
inline constexpr LightSpan kFloatSpan{0x1p-28F, 0x1p28F};

/// Description of a method, printed by `penumbra methods` and `penumbra inspect`.
struct MethodDescription {
  std::string name;
  Family family = Family::geometry;
  std::string paper;
  Output output = Output::mask;
  std::string exact_for;    ///< cases in which it is exact, in words
  LightKinds lights;        ///< supported lights
  bool textures = true;     ///< weights V by a light's texture
  bool any_pattern = true;  ///< supports every pattern; else only light samples in rows (patterns rows and grid)
  bool on_request = false;  ///< included in a comparison only if named, or with its whole family: it takes long, or
                            ///< serves only for contrast
  bool shares_of_samples = false;  ///< V without masks is the fraction of visible light samples, as with masks
  bool draws_holes = false;        ///< draws surfaces with holes (alphaMode MASK) itself: the host must not apply them
                                   ///< again
  /// Least memory that the method takes for each triangle of a mesh. Measured on meshes of one and five million
  /// triangles, and rounded down considerably: a mesh that is refused for this reason would not have fitted.
  std::uint64_t bytes_per_triangle = 50;
  std::vector<OptionDescription> options;
  std::optional<ExactArea> exact_area = {};  ///< nullopt: never exact
  LightSpan span = {};                       ///< supported sizes of lights; by default any size
  /// Returns the verdict on a mesh with these defects, with the reason. Set for every method in the table of methods.
  MeshVerdict (*verdict_on)(const mesh::Diagnosis& mesh) = nullptr;
  /// Returns runs that avoid each cause of the method's error, for the given options. Null: there is no error budget
  /// for the method.
  ErrorRepairs (*repairs)(const MethodDescription& method, const MethodOptions& given) = nullptr;
  /// Returns the width of a texel of the method's maps at each view sample, across the light's normal, in scene floats;
  /// infinite where no map is used. Null: the method has no maps. Empty result: widths are not defined.
  std::vector<float> (*texel_widths)(const SceneFloats& scene, const ViewSamples& samples, const Light& light,
                                     const MethodOptions& complete) = nullptr;
  /// Returns a warning, derived from a run's options and counters, for viewers of its picture; null: there never is
  /// one.
  std::optional<std::string> (*warning)(const MethodOptions& options,
                                        const std::map<std::string, std::uint64_t>& counters) = nullptr;

  /// Returns whether V, with these options, is the visible area itself: then light samples affect neither V nor the
  /// beauty image.
  [[nodiscard]] bool gives_area() const { return output == Output::radiance; }
  /// Returns whether V refers to the light samples of --light-samples, with or without masks. Other methods use the
  /// light's centre, points of their own, or its area.
  [[nodiscard]] bool counts_light_samples() const { return output == Output::mask || shares_of_samples; }
};

/// A band of whole pixel rows.
struct Tile {
  std::uint32_t first_row = 0, row_count = 0;
};

/// A method of turning view samples into visibility. The host calls, in this order and each as often as needed:
/// prepare_mesh, prepare_light, prepare_view, then for each tile evaluate and read. A light with another body needs
/// prepare_view again: the body of a light receives no shadow of it (visibility/receivers.hpp). The host times the
/// calls, chooses tiles no higher than max_tile_rows(), and calls each method from one thread at a time. Methods on
/// different threads are independent. Every call completes before it returns. Throws InputError for a light that is not
/// supported, ResourceError when memory does not suffice.
class Method {
 public:
  virtual ~Method() = default;

  [[nodiscard]] virtual const MethodDescription& description() const = 0;

  /// Announces that the host will use only these pixels (indices, ascending; copied). A method that works pixel by
  /// pixel skips the others and gives NaN as their V; other methods may ignore this. Default: all pixels.
  virtual void want_pixels([[maybe_unused]] std::span<const std::uint32_t> pixels) {}

  /// Announces whether read_form_factors follows each evaluate. If so, a method of Output::radiance may compute form
  /// factors during evaluate, together with V, where that costs less than afterwards. Default: read_form_factors may
  /// follow, but V is not delayed for it.
  virtual void want_form_factors([[maybe_unused]] bool wanted) {}

  /// Announces that meshes follow one another as frames. The method may then keep data for the next mesh, at the cost
  /// of memory; results are the same bits as without. Call before the first prepare_mesh.
  virtual void expect_frames() {}
  /// Called once for each mesh: adjacency, hierarchies, upload. `scene` must outlive the method.
  virtual void prepare_mesh(const SceneFloats& scene) = 0;
  /// Called again when a light moves. `light` must outlive its use.
  virtual void prepare_light(const Light& light) = 0;
  /// Takes the view samples (upload; work shared by all methods, not part of `shadow`). `samples` must outlive its use.
  virtual void prepare_view(const ViewSamples& samples) = 0;
  /// Returns the largest number of pixel rows that one evaluate can handle within the device's limits; at least 1.
  [[nodiscard]] virtual std::uint32_t max_tile_rows() const = 0;
  /// Computes V or masks from stored view samples, in the method's own memory.
  virtual void evaluate(const Tile& tile) = 0;

  /// For Output::mask only: reads for each pixel of the tile evaluated last words_per_mask() words in which bit j mod
  /// 32 of word j / 32 is set iff light sample j is visible. Background pixels: all N bits set. Bits beyond N are 0.
  virtual void read_masks(std::span<std::uint32_t> masks);
  /// For Output::radiance only: reads for each pixel of the tile evaluated last 1/π ∫ visible texel cos θp cos θl / d²
  /// dl over the light (form_factor.hpp; with a texture for each colour, else three equal numbers), which gives the
  /// beauty image when multiplied by a surface's colour and the light's radiance. Background 0, pixels not wanted NaN.
  virtual void read_form_factors(std::span<glm::dvec3> form_factors);
  /// Reads V of each pixel of the tile evaluated last; background 1.
  virtual void read_visibility(std::span<float> visibility) = 0;

  /// Returns GPU passes (or CPU stages) since the last call with their times, summed by name.
  virtual std::vector<PassTime> take_pass_times() { return {}; }
  /// Returns counters for --stats (candidate pairs, retries, fallbacks …) of the evaluate calls since prepare_light.
  [[nodiscard]] virtual std::map<std::string, std::uint64_t> counters() const { return {}; }
  /// Returns, since the last call, the structures made for meshes (treesBuilt, edgesBuilt …), and those updated from
  /// the previous mesh (treesRefit, edgesRefit …). Documented in docs/frames.md.
  virtual std::map<std::string, std::uint64_t> take_mesh_counters() { return {}; }
  /// Returns the peak number of bytes of device memory (or, for CPU methods, of their own structures).
  [[nodiscard]] virtual std::uint64_t memory_bytes() const { return 0; }
};

/// Returns the name of an object that lets this light through and whose part of the shadow the host computes for each
/// light sample, if this method does the rest (Light::filtered_by, Light::dimmed_by). Empty: there is no such object.
const std::string& left_to_host(const MethodDescription& description, const Light& light);

/// Throws InputError for a light that the method does not support, naming alternatives.
void check_light(const MethodDescription& description, const Light& light);

/// Returns the user's options, and the defaults of the others.
MethodOptions complete_options(const MethodDescription& description, const MethodOptions& given);

/// Returns the user's options as values of the declared types. Throws UsageError, see ParsedOptions.
ParsedOptions parse_options(const MethodDescription& description, const MethodOptions& given);

}  // namespace penumbra::visibility
