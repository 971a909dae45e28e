// SPDX-License-Identifier: Apache-2.0
// Every file of Debian's assimp-testmodels either loads or is refused with a message; none crashes or hangs us.
#include "base/error.hpp"
#include "mesh/import.hpp"
#include "scenes/formats/gltf_reader.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <map>

namespace penumbra {
namespace {

const std::filesystem::path kCorpus = "/usr/share/assimp/models";

struct Counts {
  int files = 0, loaded = 0, refused = 0, unknown_kind = 0, crashed = 0, timed_out = 0;
  double slowest = 0;
  std::string slowest_file;
};

template <typename Read>
void try_file(const std::filesystem::path& file, Counts& counts, Read read) {
  ++counts.files;
  const auto start = std::chrono::steady_clock::now();
  try {
    read(file);
    ++counts.loaded;
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(file.string()), std::string::npos) << message;
    EXPECT_GT(message.size(), file.string().size() + 2) << "no reason given";
    ++counts.refused;
    if (message.find("no importer for") != std::string::npos) ++counts.unknown_kind;
    if (message.find("the importer crashed") != std::string::npos) ++counts.crashed;
    if (message.find("took longer than") != std::string::npos) ++counts.timed_out;
    if (message.find("crashed") != std::string::npos) fmt::print("{}\n", message);
  } catch (const std::exception& error) {
    ADD_FAILURE() << file << ": " << error.what();
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_LT(seconds, 21) << file;
  if (seconds > counts.slowest) counts.slowest = seconds, counts.slowest_file = file.string();
}

void report(const char* what, const Counts& counts) {
  fmt::print(
      "{}: {} files, {} loaded, {} refused ({} of no known kind, {} crashed the helper, {} timed out); slowest {:.2f} "
      "s {}\n",
      what, counts.files, counts.loaded, counts.refused, counts.unknown_kind, counts.crashed, counts.timed_out,
      counts.slowest, counts.slowest_file);
}

TEST(ImportCorpus, EveryFileLoadsOrIsRefused) {
  ASSERT_TRUE(std::filesystem::exists(kCorpus)) << "install the package assimp-testmodels (packages.txt)";
  Counts meshes, scenes;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kCorpus)) {
    if (!entry.is_regular_file()) continue;
    try_file(entry.path(), meshes, [](const auto& file) { mesh::import_mesh(file); });
    const auto extension = entry.path().extension();
    if (extension != ".gltf" && extension != ".glb") continue;
    try_file(entry.path(), scenes, [](const auto& file) { scenes::read_gltf(file); });
  }
  report("meshes", meshes);
  report("glTF scenes", scenes);
  EXPECT_GT(meshes.loaded, 250);  // 315 of 595 files, many of which are pictures and texts, with Assimp 5.2.5
  EXPECT_EQ(meshes.loaded + meshes.refused, meshes.files);
}

}  // namespace
}  // namespace penumbra
