#pragma once

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

struct FrameRange {
  std::int64_t first = 0, last = 0;
};

/// Of glTF lamps whose file gives none.
struct LampSizes {
  std::optional<double> radius, sun_angle;
};

/// What `render` and `compare` have in common, as the user gave it.
struct RunOptions {
  std::filesystem::path scene;
  std::filesystem::path out;
  std::string light_samples, sample_pattern;  ///< empty: nobody asked for any; then 256 and rows
  std::uint32_t sample_seed = 0;
  std::string size;                   ///< empty: the scene's
  std::string light, camera, device;  ///< empty: the first, the first, the best
  std::vector<std::string> method_options;
  bool allow_outside = false;
  LampSizes lamps;
};

/// Adds --lamp-radius and --sun-angle.
void add_lamp_options(CLI::App& command, LampSizes& lamps);
/// Adds the options of RunOptions that mean the same in `render` and in `compare`.
void add_run_options(CLI::App& command, RunOptions& options);

/// How a scene's file is to be read. Throws UsageError for sizes of lamps that are none.
scenes::ReadOptions read_options(const LampSizes& lamps, bool allow_outside);
/// "256" or "16x16"; 1 … 4096 samples. All parsers here throw UsageError that says what would be right.
visibility::SampleRequest parse_light_samples(const RunOptions& options);
/// "1920x1080" → width, height.
std::pair<std::uint32_t, std::uint32_t> parse_size(std::string_view text);
/// "A-B", A ≤ B.
FrameRange parse_frames(std::string_view text);
/// KEY=VALUE texts → options; a key given twice is an error.
visibility::MethodOptions parse_method_options(const std::vector<std::string>& texts);
/// OUT.exr and frame 7 → OUT.0007.exr; a name that holds "%04d" (any width) gets the number there.
std::filesystem::path frame_path(const std::filesystem::path& out, std::int64_t frame);

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

}  // namespace penumbra::app
