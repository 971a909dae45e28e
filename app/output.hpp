#pragma once

#include "app/process/interrupt.hpp"
#include "app/runner.hpp"
#include "app/session.hpp"
#include "compare/stats.hpp"
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

/// The linear beauty of a run, tile by tile and light by light as results come, so that no light's masks need be kept.
class BeautyAccumulator {
 public:
  /// Both must outlive it.
  BeautyAccumulator(const Session& session, std::span<const visibility::Light> lights);
  void add(const TileResult& result);
  [[nodiscard]] const std::vector<glm::vec3>& pixels() const { return pixels_; }

 private:
  const Session& session_;
  std::span<const visibility::Light> lights_;
  std::vector<glm::dvec3> colors_;
  std::vector<glm::vec3> pixels_;
};

/// Throws UsageError if `--bits` cannot be had of this method and light.
void check_bits(const visibility::MethodDescription& description, const visibility::Light& light);

/// `--bits` as tiles come. The file is opened with the first of them: until then an interrupt need not wait.
class BitsOutput {
 public:
  /// check_bits comes first. All must outlive it.
  BitsOutput(std::filesystem::path path, const Session& session, const visibility::Light& light)
      : path_(std::move(path)), session_(session), light_(light) {}
  /// The tiles of `light` in order.
  void add(const TileResult& result);
  void commit();

 private:
  std::filesystem::path path_;
  const Session& session_;
  const visibility::Light& light_;
  std::optional<FileIsOpen> open_;
  std::optional<visibility::BitsWriter> writer_;
};

/// A method as it was asked for, with what its files and stats say of it.
struct MethodLabel {
  const visibility::MethodDescription& description;
  const visibility::MethodOptions& options;
  std::string device;  ///< where it ran
};

/// Which device a method runs on: the Vulkan device (also for engine=native of a method that may run there, where that
/// device is the processor), or the processor's name.
std::string device_of(const visibility::MethodDescription& description, const std::string& vulkan_device);

/// Lights with what each was done with: one label a light, or one for all of them.
struct LabelledLights {
  std::span<const visibility::Light> lights;
  std::span<const MethodLabel> labels;

  [[nodiscard]] const MethodLabel& label(std::size_t light) const { return labels[labels.size() == 1 ? 0 : light]; }
};

/// OUT.exr with all channels and attributes.
void write_picture(const std::filesystem::path& path, const Session& session, const LabelledLights& lights,
                   const MethodRun& run, std::span<const glm::vec3> beauty);

compare::Stats make_stats(const Session& session, const LabelledLights& lights, const MethodRun& run);

/// One line a method for people: its name, the picture's size, triangles, light samples, seconds of `shadow`, device.
std::string summary(const compare::Stats& stats);

}  // namespace penumbra::app
