// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compare/stats.hpp"
#include "compare/surface.hpp"
#include "session/runner.hpp"
#include "session/session.hpp"
#include "session/whole_lights.hpp"
#include "visibility/masks/bits_file.hpp"
#include "visibility/method.hpp"

#include <glm/vec3.hpp>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::session {

/// Linear beauty of a run, of each whole light alone, summed tile by tile and light by light as results arrive, so that
/// no light's masks need be kept.
class BeautyAccumulator {
 public:
  /// Both arguments must outlive this object.
  BeautyAccumulator(const Session& session, std::span<const visibility::Light> lights);
  void add(const TileResult& result);
  /// Returns, for each of whole_lights, each pixel; empty for a light without results.
  [[nodiscard]] const std::vector<std::vector<glm::vec3>>& parts() const& { return parts_; }
  [[nodiscard]] std::vector<std::vector<glm::vec3>> parts() && { return std::move(parts_); }
  /// Returns the normals that light is received with.
  [[nodiscard]] std::span<const glm::vec3> normals() const {
    return looks_.normals.empty() ? std::span(session_.samples.n) : std::span(looks_.normals);
  }
  /// Returns all lights together, added in their order: independent of the order of the runs.
  [[nodiscard]] std::vector<glm::vec3> sum() const;

 private:
  const Session& session_;
  std::span<const visibility::Light> lights_;
  std::vector<std::size_t> whole_of_;  // whole light of each of lights_
  std::vector<glm::dvec3> colors_;     // of objects
  compare::SurfaceLooks looks_;
  std::vector<std::vector<glm::vec3>> parts_;
};

/// Returns compare::auto_exposure of the pixels that show no body of a light; of all pixels, if there are no others.
/// `lamps` (empty, or one value for each pixel): not 0 where the pixel shows a light's body, though not as its carrier.
float auto_exposure(const Session& session, std::span<const glm::vec3> beauty,
                    std::span<const std::uint8_t> lamps = {});

/// Throws UsageError if `--bits` is not possible for this method and the first of these lights.
void check_bits(const visibility::MethodDescription& description, std::span<const visibility::Light> lights);

/// Output of `--bits`, tile by tile.
class BitsOutput {
 public:
  /// check_bits must be called first. All arguments must outlive this object.
  BitsOutput(std::filesystem::path path, const Session& session, const visibility::Light& light)
      : path_(std::move(path)), session_(session), light_(light) {}
  /// Adds a tile of `light`; tiles must be in order.
  void add(const TileResult& result);
  void settle() { writer_->settle(); }
  void commit();

 private:
  std::filesystem::path path_;
  const Session& session_;
  const visibility::Light& light_;
  visibility::ViewSamples numbered_;  // the view samples with triangle numbers, for a session that has numbers
  std::optional<visibility::BitsWriter> writer_;
};

/// Method as requested, with its label in files and stats.
struct MethodLabel {
  const visibility::MethodDescription& description;
  const visibility::MethodOptions& options;
  std::string device;    ///< where it ran
  bool in_part = false;  ///< used only where some light may be visible; elsewhere another method computed exact areas
};

/// Returns the device of a method with these options, for this light: the Vulkan device, or the processor's name.
std::string device_of(const std::string& method, const visibility::MethodOptions& options,
                      const visibility::Light& light, const render::Machine& machine);

/// Lights, as in Session::lights, with their methods: one label for each light, or one for all.
struct LabelledLights {
  std::span<const visibility::Light> lights;
  std::span<const MethodLabel> labels;

  [[nodiscard]] const MethodLabel& label(std::size_t light) const { return labels[labels.size() == 1 ? 0 : light]; }
};

/// Returns the number of samples of one of whole_lights, all pieces together: 0 if V is an area, exact or estimated.
std::uint32_t samples_of(const LabelledLights& all, const WholeLight& whole);
/// Returns nullopt if V is an area.
std::optional<std::string> pattern_of(const LabelledLights& all, const WholeLight& whole);
/// Returns the light's entry of stats.json, except its seconds.
compare::LightStats light_stats(const LabelledLights& all, const WholeLight& whole);

/// Returns the statistics. `run`: of whole lights.
compare::Stats make_stats(const Session& session, const LabelledLights& lights, const MethodRun& run);

/// Returns one line about a method: its name, the picture's size, triangles, light samples, seconds of `shadow`,
/// device.
std::string summary(const compare::Stats& stats);

}  // namespace penumbra::session
