#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::bench {

/// One row of the table: a scene, perhaps with its first light made larger or smaller.
struct Subject {
  std::string name;  ///< stable: the scene's file name without extension, and "/half=H" if the light was scaled
  std::filesystem::path scene;
  std::optional<double> light_half;  ///< half size of the first light instead of the scene's
};

struct Options {
  std::vector<Subject> subjects;
  std::uint32_t runs = 5;  ///< timed ones, after one that is discarded
  std::uint32_t size = 512;
  std::uint32_t light_samples = 256;
  std::string device;  ///< as `penumbra --device` takes it
  std::filesystem::path json;
  std::string commit;
  bool help = false;
};

/// Throws UsageError.
Options parse_options(const std::vector<std::string>& arguments);
extern const char* const kHelp;

}  // namespace penumbra::bench
