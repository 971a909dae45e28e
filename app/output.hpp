#pragma once

#include "app/runner.hpp"
#include "app/session.hpp"
#include "app/whole_lights.hpp"
#include "compare/stats.hpp"
#include "compare/surface.hpp"
#include "visibility/masks/bits_file.hpp"
#include "visibility/method.hpp"

#include <glm/vec3.hpp>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::app {

/// The linear beauty of a run, of each whole light alone, tile by tile and light by light as results come, so that no
/// light's masks need be kept.
class BeautyAccumulator {
 public:
  /// Both must outlive it.
  BeautyAccumulator(const Session& session, std::span<const visibility::Light> lights);
  void add(const TileResult& result);
  /// For each of whole_lights each pixel; empty for a light of which nothing came.
  [[nodiscard]] const std::vector<std::vector<glm::vec3>>& parts() const& { return parts_; }
  [[nodiscard]] std::vector<std::vector<glm::vec3>> parts() && { return std::move(parts_); }
  /// All lights together, added in their order: what does not depend on the order in which they were done.
  [[nodiscard]] std::vector<glm::vec3> sum() const;

 private:
  const Session& session_;
  std::span<const visibility::Light> lights_;
  std::vector<std::size_t> whole_of_;  // each of lights_
  std::vector<glm::dvec3> colors_;     // of objects
  compare::SurfaceLooks looks_;
  std::vector<std::vector<glm::vec3>> parts_;
};

/// compare::auto_exposure of pixels that show no body of a light; of everything, if nothing else is seen. `lamps`
/// (empty, or of each pixel): not 0 where a body is seen that does not carry the pixel.
float auto_exposure(const Session& session, std::span<const glm::vec3> beauty,
                    std::span<const std::uint8_t> lamps = {});

/// Throws UsageError if `--bits` cannot be had of this method and the first of these lights.
void check_bits(const visibility::MethodDescription& description, std::span<const visibility::Light> lights);

/// `--bits` as tiles come.
class BitsOutput {
 public:
  /// check_bits comes first. All must outlive it.
  BitsOutput(std::filesystem::path path, const Session& session, const visibility::Light& light)
      : path_(std::move(path)), session_(session), light_(light) {}
  /// The tiles of `light` in order.
  void add(const TileResult& result);
  void settle() { writer_->settle(); }
  void commit();

 private:
  std::filesystem::path path_;
  const Session& session_;
  const visibility::Light& light_;
  std::optional<visibility::BitsWriter> writer_;
};

/// A method as it was asked for, with what its files and stats say of it.
struct MethodLabel {
  const visibility::MethodDescription& description;
  const visibility::MethodOptions& options;
  std::string device;    ///< where it ran
  bool in_part = false;  ///< only where something may let light through; elsewhere another gave exact areas
};

/// What a method runs on with these options, for this light: the Vulkan device, or the processor's name.
std::string device_of(const std::string& method, const visibility::MethodOptions& options,
                      const visibility::Light& light, const render::Machine& machine);

/// Lights, as in Session::lights, with what each was done with: one label a light, or one for all of them.
struct LabelledLights {
  std::span<const visibility::Light> lights;
  std::span<const MethodLabel> labels;

  [[nodiscard]] const MethodLabel& label(std::size_t light) const { return labels[labels.size() == 1 ? 0 : light]; }
};

/// Of one of whole_lights, all pieces together: 0 if V is an area, exactly or about.
std::uint32_t samples_of(const LabelledLights& all, const WholeLight& whole);
/// Nothing if V is an area.
std::optional<std::string> pattern_of(const LabelledLights& all, const WholeLight& whole);
/// What stats.json says of it, except its seconds.
compare::LightStats light_stats(const LabelledLights& all, const WholeLight& whole);

/// `run`: of whole lights.
compare::Stats make_stats(const Session& session, const LabelledLights& lights, const MethodRun& run);

/// One line a method for people: its name, the picture's size, triangles, light samples, seconds of `shadow`, device.
std::string summary(const compare::Stats& stats);

}  // namespace penumbra::app
