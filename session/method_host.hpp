// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/pages.hpp"
#include "session/runner.hpp"
#include "visibility/alpha/alpha_filter.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Times of one run, for each light, and for meshes.
struct OneRun {
  std::vector<LightTimes> lights;
  double mesh = 0, view = 0, read = 0;
  double bands = 0;  ///< estimated part of `lights` for tiles beyond the number that other runs have
};

/// Returns the lights of a plan, as indices.
std::vector<std::size_t> chosen_lights(const RunPlan& plan);

/// One method on one session: each run goes through all lights of a plan, tile by tile. The host applies its rules
/// (run_method) to what it reads, and passes it to the result and to the sink. All arguments must outlive this object.
class MethodHost {
 public:
  MethodHost(visibility::Method& method, const Session& session, const RunPlan& plan, const TileSink& sink,
             Progress& progress)
      : method_(method), session_(session), plan_(plan), sink_(sink), progress_(progress), mesh_(plan.prepared) {}

  /// Returns the scene that the method has.
  [[nodiscard]] const visibility::SceneFloats* prepared() const { return mesh_; }

  /// Runs the method once. `reads`: pass on the results. `limited`: throw TakesTooLong if the run would take longer
  /// than RunPlan::most_seconds. The tiles of a limited run begin with a few rows and double in size, so that both
  /// parts of a tile's time, per tile and per row, become known.
  OneRun run(bool reads, bool limited, MethodRun& result);

 private:
  void hold(const visibility::SceneFloats* floats);
  /// Returns whether part of this light's shadow is computed by the host.
  [[nodiscard]] bool filters(std::size_t light) const;
  [[nodiscard]] bool filtered_alone(std::size_t light) const;
  /// Returns the view samples for a light; samples that need no evaluation are background.
  [[nodiscard]] const visibility::ViewSamples& samples_for(std::size_t light);
  [[nodiscard]] std::span<const std::uint8_t> dark_of(std::size_t light) const;
  /// Returns the lights in an order in which lights with the same casters are consecutive, so that each mesh is
  /// prepared once per run. The same order in every run: beauty is a sum over lights.
  [[nodiscard]] std::vector<std::size_t> in_order_of_meshes() const;
  /// Returns the rows whose masks are read back at once: at most a quarter of a GiB of host memory.
  [[nodiscard]] std::uint32_t most_rows_to_read(std::size_t light_index) const;
  /// Prepares the meshes of a light, and its filter, if the light before it had others.
  void prepare_meshes(std::size_t light, OneRun& times);
  /// Evaluates a tile. Returns the seconds.
  double evaluate(const visibility::Tile& tile);
  /// Applies translucent surfaces and holes to the masks. Returns the seconds, without reading masks.
  double filter(std::size_t light_index, const visibility::ViewSamples& samples, const visibility::Tile& tile);
  /// Computes V of masks changed by filter().
  void share_filtered(const visibility::Light& light, std::size_t first, std::span<float> values);
  void read(std::size_t light_index, const visibility::Tile& tile, MethodRun& result);
  /// Sets values that are outside 0 … 1 by rounding alone to 0 or 1, and throws for others; V of every method passes
  /// through this function.
  void settle_shares(const visibility::Light& light, std::size_t first, std::span<float> values) const;
  /// Sets form factors to 0 where V is 0, and where rounding made them negative; throws for other negative numbers.
  void settle_form_factors(const visibility::Light& light, std::size_t first, std::span<const float> values);
  [[nodiscard]] bool wanted(std::size_t pixel) const;
  [[noreturn]] void refuse(const visibility::Light& light, std::size_t pixel, const std::string& what) const;
  void leave_out(std::size_t light, std::size_t first, std::span<float> values) const;
  /// `dark`: of these pixels; may be empty.
  void read_masks(std::size_t light_index, std::span<const visibility::PixelClass> classes,
                  std::span<const std::uint8_t> dark);

  visibility::Method& method_;
  const Session& session_;
  const RunPlan& plan_;
  const TileSink& sink_;
  Progress& progress_;
  const visibility::SceneFloats* mesh_;                // scene that the method has
  const visibility::SceneFloats* filtered_ = nullptr;  // scene that filter_ has
  std::optional<visibility::AlphaFilter> filter_;
  visibility::ViewSamples part_;          // view samples of the current light, if only some are evaluated
  visibility::AlphaCounts alpha_counts_;  // of the current light
  std::vector<float> transmittances_;     // of the most recent tile, as set by filter()
  std::vector<std::uint8_t> dimmed_;
  UnsetList<std::uint32_t> masks_;
  std::vector<glm::dvec3> form_factors_;
};

}  // namespace penumbra::session
