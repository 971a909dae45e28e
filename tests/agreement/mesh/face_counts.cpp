// SPDX-License-Identifier: Apache-2.0
// Tests that readers lose no surface: every file of Debian's assimp-testmodels and of libcgal-demo is compared with
// counts by separate code of this test. Files that the readers refuse are left to the corpus test; files that they
// accept must be complete.
#include "mesh/import.hpp"

#include "base/error.hpp"
#include "tests/agreement/mesh/face_counters.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

namespace penumbra {
namespace {

/// Files whose surfaces are known to differ from the count, each with the reason.
const std::map<std::string, std::string> kKnown = {};

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension;
}

std::uint64_t surfaces_of(const mesh::TriangleSoup& soup) {
  return std::set<std::uint32_t>(soup.source_face.begin(), soup.source_face.end()).size();
}

struct Tally {
  std::uint64_t read = 0, counted = 0, refused = 0;
};

TEST(MeshFaceCounts, EverySurfaceComesOut) {
  std::map<std::string, Tally> tallies;
  for (const std::filesystem::path corpus : {"/usr/share/assimp/models", PENUMBRA_CGAL_CORPUS "/meshes"}) {
    ASSERT_TRUE(std::filesystem::exists(corpus)) << corpus << ": install the packages of packages.txt";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(corpus)) {
      if (!entry.is_regular_file()) continue;
      const std::string extension = lower_extension(entry.path());
      Tally& tally = tallies[extension];
      std::uint64_t surfaces = 0;
      std::string notes;
      try {
        const mesh::ImportedMesh mesh = mesh::import_mesh(entry.path());
        surfaces = surfaces_of(mesh.soup);
        for (const std::string& note : mesh.notes) notes += "\n  " + note;
      } catch (const InputError&) {
        ++tally.refused;
        continue;
      }
      ++tally.read;
      const auto counter = test::face_counters().find(extension);
      if (counter == test::face_counters().end()) continue;
      try {
        const test::FaceCount count = counter->second(entry.path());
        if (!count) continue;
        ++tally.counted;
        const auto known = kKnown.find(std::filesystem::relative(entry.path(), corpus).string());
        if (known == kKnown.end())
          EXPECT_EQ(surfaces, *count) << entry.path() << notes;
        else
          EXPECT_NE(surfaces, *count) << entry.path() << " is on the list of differences: " << known->second;
      } catch (const std::exception& error) {
        ADD_FAILURE() << entry.path()
                      << ": the reader accepts the file, but this test cannot count its faces: " << error.what();
      }
    }
  }
  Tally all;
  for (const auto& [extension, tally] : tallies) {
    if (tally.read == 0) continue;
    fmt::print("{:>9}: {:3} read, {:3} counted, {:3} not counted\n", extension, tally.read, tally.counted,
               tally.read - tally.counted);
    all.read += tally.read;
    all.counted += tally.counted;
    all.refused += tally.refused;
  }
  fmt::print("      all: {} read, {} counted, {} not counted, {} refused; {} known to differ\n", all.read, all.counted,
             all.read - all.counted, all.refused, kKnown.size());
  EXPECT_GT(all.counted, 300u);
}

}  // namespace
}  // namespace penumbra
