#pragma once

#include "app/studio_options.hpp"
#include "scenes/formats/reader.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace penumbra::app {

/// How a glTF file is taken: sizes of lamps where it gives none, what their intensities are in, which clips are played.
struct GltfOptions {
  std::optional<double> radius, sun_angle, lumens_per_watt;
  std::vector<std::string> clips;  ///< names or numbers; empty: all that can be played at once
};

/// How OUT.exr is written, as the user gave it; what is empty was not said.
struct FormatOptions {
  std::optional<std::string> layers;
  bool half = false;
  std::string compression;
};

/// What `render` and `compare` have in common, as the user gave it.
struct RunOptions {
  std::filesystem::path scene;
  std::filesystem::path out;
  std::string light_samples, sample_pattern;  ///< empty: nobody asked for any; then 256 and rows
  std::uint32_t sample_seed = 0;
  std::string size;                 ///< empty: the scene's
  std::vector<std::string> lights;  ///< these alone, in this order; empty: all
  std::string camera, device;       ///< empty: the first, the best
  std::vector<std::string> method_options;
  bool allow_outside = false;
  bool lenient = false;
  std::string normals;  ///< empty: shading
  GltfOptions gltf;
  FormatOptions format;
  StudioOptions studio;
};

/// Adds --lamp-radius, --sun-angle, --lumens-per-watt and --clip.
void add_gltf_options(CLI::App& command, GltfOptions& gltf);
/// Adds the options of RunOptions that mean the same in `render` and in `compare`.
void add_run_options(CLI::App& command, RunOptions& options);

/// How a scene's file is to be read. Throws UsageError for sizes of lamps that are none.
scenes::ReadOptions read_options(const GltfOptions& gltf, bool allow_outside);
/// "256" or "16x16"; 1 … 4096 samples. All parsers here throw UsageError that says what would be right.
visibility::SampleRequest parse_light_samples(const RunOptions& options);
/// --normals: shading ones?
bool parse_normals(const std::string& text);
/// "1920x1080" → width, height.
std::pair<std::uint32_t, std::uint32_t> parse_size(std::string_view text);
/// KEY=VALUE texts → options; a key given twice is an error.
visibility::MethodOptions parse_method_options(const std::vector<std::string>& texts);
/// A label as a file's name: what a shell, a URL or a file system could stumble over becomes '_'.
std::string file_name_of(std::string_view label);

/// One entry of `--methods`: a name with options of its own.
struct MethodEntry {
  std::string label;  ///< as the user gave it, made unique and fit for a file name: names the entry's files
  std::string name;
  visibility::MethodOptions options;
  bool from_group = false;  ///< not asked for by name: left out, with a warning, where it cannot do the scene's lights
  bool exact_area = false;  ///< a group's member once more, for its exact areas
};
/// "a,b:key=value:key=value,c"; `geometry`, `image` and `all` stand for the methods of these families in the table,
/// each that gives exact areas by an option also with that.
std::vector<MethodEntry> parse_methods(std::string_view text);

/// A method with its options.
struct NamedMethod {
  std::string name;
  visibility::MethodOptions options;
};
/// One method, "NAME" or "NAME:key=value:...", with options that were given apart. Throws UsageError for an option that
/// is none, or is given twice. Whether there is such a method is not asked.
NamedMethod parse_method(std::string_view text, const std::vector<std::string>& more = {});

}  // namespace penumbra::app
