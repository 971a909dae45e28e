// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/instances.hpp"
#include "scenes/scene.hpp"
#include "session/light_methods.hpp"
#include "session/options.hpp"
#include "session/pictures/frame_render.hpp"
#include "session/process/output_files.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Options of `render` and `submit` as given by the user; empty members were not given.
struct PictureOptions {
  RunOptions run;
  std::string method, exposure, frames, fps, pixel_samples, pixel_filter, filter_width, pixel_tolerance, light_cutoff,
      motion_samples, shutter, aperture, focus_distance, instances;
  std::optional<std::string> frame;            ///< for `render` alone
  std::vector<std::filesystem::path> moments;  ///< --moment: files of the scene at moments of the open shutter
  bool skip_existing = false;
  std::map<std::string, std::string> camera_words;  ///< --camera all: camera_words(), set after the scene is
                                                    ///< read
  std::filesystem::path stats, png, bits;
};

/// How render treats meshes that a scene has several times: copies of each, or none; automatic: copies where they cost
/// little.
enum class InstanceUse : std::uint8_t { automatic, copies, shared };

/// Parsed options, as far as possible before the scene is read.
struct PictureRequest {
  MethodWish wish;
  Exposure exposure;
  double seconds_per_frame = 0;
  std::uint32_t pixel_side = 1, moments = 1;
  PixelFilter filter;
  double pixel_tolerance = kPixelTolerance;
  double light_cutoff = 0;
  InstanceUse instances = InstanceUse::automatic;
  double shutter_frames = 0.5;
  std::optional<double> aperture, focus_distance;  ///< replace the cameras' own values; aperture 0: everything is sharp
  /// Frame numbers: one entry without a number if no frame was requested; numbers of a sequence are whole.
  std::vector<std::optional<double>> frames;

  /// Returns the number of view samples of a pixel, at all moments.
  [[nodiscard]] std::uint32_t view_samples() const { return pixel_side * pixel_side * moments; }
};

/// Returns whether a method's answer for a view sample depends only on the surfaces between the view sample and the
/// light: true where masks are exact for every pair, and where areas are exact.
bool answers_apart(const visibility::MethodDescription& method);

/// Parses --instances, for a method. Throws UsageError for "shared" with a method that needs all triangles.
InstanceUse parse_instances(const std::string& text, const MethodWish& wish);

/// Returns whether the scene's instances become copies: if copies are requested or cheap; under a dome of which areas
/// may be computed, since its directions reach all triangles; and for a method that is given all triangles once
/// (passes_triangles), if the scene, or several view samples per pixel or moments, would require them again. Throws
/// UsageError if `use` is shared and that is not possible.
bool needs_copies(const scenes::Scene& scene, const scenes::Instances& instances, InstanceUse use,
                  const MethodWish& wish, std::uint32_t pixel_samples);

/// Returns the memory that the scene floats and a method need for each triangle of a copy, in addition to the scene's.
/// `lights`: empty if not yet known; the memory is then that for computing areas.
std::uint64_t bytes_per_copy(const MethodWish& wish, std::span<const scenes::AreaLight> lights);

/// Parses the options. Throws UsageError; throws InputError if --exposure names a picture without an exposure
/// attribute.
PictureRequest parse_request(const PictureOptions& options);

/// Sets the requested lens on the scene's cameras that the picture uses. `camera`: --camera. Throws UsageError if the
/// focus distance is not given.
void set_lens(scenes::Scene& scene, const PictureRequest& request, const std::string& camera);

/// Throws UsageError for a --png file that does not end in .png. Call it after outputs_of, whose messages say more.
void check_png_name(const PictureOptions& options);

/// Returns the files of a frame's picture: named after camera and frame, if there are several.
FrameFiles files_of(const PictureOptions& options, std::optional<double> frame, const std::string& camera);
/// Returns whether the frame's files exist, for all cameras.
bool is_there(const PictureOptions& options, std::optional<double> frame, const std::vector<std::string>& cameras);
/// Returns all files of these frames and cameras. Throws UsageError if two are the same, or one is the scene.
OutputFiles outputs_of(const PictureOptions& options, const std::vector<std::optional<double>>& frames,
                       const std::vector<std::string>& cameras);

}  // namespace penumbra::session
