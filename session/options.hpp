// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/formats/reader.hpp"
#include "session/studio_options.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace penumbra::session {

/// Options of reading a glTF file: sizes of lamps without their own, the unit of intensities, and the played clips.
struct GltfOptions {
  std::optional<double> radius, sun_angle, lumens_per_watt;
  std::vector<std::string> clips;  ///< names or indices; empty: all that can be played at once
};

/// Format of OUT.exr as given by the user; empty members were not given.
struct FormatOptions {
  std::optional<std::string> layers;
  bool half = false;
  std::string compression;
};

/// Options common to `render` and `compare`, as given by the user.
struct RunOptions {
  std::filesystem::path scene;
  /// For a scene that is one file per frame: the first file, around which a studio is built; null: any other scene.
  std::shared_ptr<const scenes::Scene> rest = {};
  std::filesystem::path out;
  std::string light_samples, sample_pattern;  ///< empty: not requested; then 256 and rows
  std::uint32_t sample_seed = 0;
  std::string size;                 ///< empty: the scene's
  std::vector<std::string> lights;  ///< only these lights, in this order; empty: all
  std::string camera, device;       ///< empty: the first, the best
  std::vector<std::string> method_options;
  bool allow_outside = false;
  bool lenient = false;
  std::string normals;  ///< empty: shading
  GltfOptions gltf;
  FormatOptions format;
  StudioOptions studio;
};

/// Returns the options of reading a scene's file. Throws UsageError for invalid sizes of lamps.
scenes::ReadOptions read_options(const GltfOptions& gltf, bool allow_outside);
/// Parses "256" or "16x16"; 1 … 4096 samples. All parsers here throw UsageError with the expected form.
visibility::SampleRequest parse_light_samples(const RunOptions& options);
/// Parses --normals; returns whether shading normals are used.
bool parse_normals(const std::string& text);
/// Parses "1920x1080" to width and height.
std::pair<std::uint32_t, std::uint32_t> parse_size(std::string_view text);
/// Parses KEY=VALUE texts to options; a key given twice is an error.
visibility::MethodOptions parse_method_options(const std::vector<std::string>& texts);
/// Returns a label as a file's name: characters special in a shell, a URL or a file system become '_'.
std::string file_name_of(std::string_view label);

/// Entry of `--methods`: a name with its options.
struct MethodEntry {
  std::string label;  ///< as given by the user, made unique and fit for a file name: names the entry's files
  std::string name;
  visibility::MethodOptions options;
  bool from_group = false;  ///< not named explicitly: left out, with a warning, if the scene's lights are not supported
  bool by_default = false;  ///< of the group `default`: left out, with a warning, if it is slow on the device
  bool exact_area = false;  ///< second entry of a group's member, for its exact areas
};
/// Parses "a,b:key=value:key=value,c"; `geometry`, `image` and `all` stand for the methods of these families in the
/// table. A method that computes exact areas by an option appears twice, also with this option.
std::vector<MethodEntry> parse_methods(std::string_view text);

/// Method with its options.
struct NamedMethod {
  std::string name;
  visibility::MethodOptions options;
};
/// Parses one method, "NAME" or "NAME:key=value:...", with further options in `more`. Throws UsageError for a malformed
/// option, or one given twice. Does not check whether the method exists.
NamedMethod parse_method(std::string_view text, const std::vector<std::string>& more = {});

}  // namespace penumbra::session
