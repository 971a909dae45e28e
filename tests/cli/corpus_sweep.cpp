// SPDX-License-Identifier: Apache-2.0
// Takes all meshes of two packages and the shipped scenes through the program as a user would: they are inspected,
// rendered by two exact methods and by rays, and their faces are counted by other code. Prints the results as a table.
#include "mesh/import.hpp"

#include "base/error.hpp"
#include "tests/agreement/mesh/face_counters.hpp"
#include "tests/cli/program.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>

namespace penumbra::tests {
namespace {

using nlohmann::json;

struct Tally {
  std::uint64_t files = 0, read = 0, refused = 0, other = 0, helper_crashed = 0, timed_out = 0;
  double slowest = 0;
  std::string slowest_file;
  std::uint64_t compared = 0, not_compared = 0, pairs = 0, differing = 0, method_right = 0, reference_right = 0,
                undecided = 0;
  std::uint64_t same_faces = 0, other_faces = 0, uncounted_faces = 0;
};

class CorpusSweep : public ProgramTest {
 protected:
  void sweep(const std::filesystem::path& file) {
    SCOPED_TRACE(file.string());
    const auto start = std::chrono::steady_clock::now();
    const Outcome inspected = run({"inspect", file.string(), "--json", "-", "--list", "0", "--quiet"});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (seconds > tally_.slowest) tally_.slowest = seconds, tally_.slowest_file = file.filename().string();
    ++tally_.files;
    if (inspected.code == 3) {
      ++tally_.refused;
      if (inspected.err.find("the importer crashed") != std::string::npos) ++tally_.helper_crashed;
      if (inspected.err.find("took longer than") != std::string::npos) ++tally_.timed_out;
      EXPECT_NE(inspected.err.find(file.filename().string()), std::string::npos) << inspected.err;
      return;
    }
    EXPECT_EQ(inspected.code, 0) << inspected.err;
    if (inspected.code != 0) {
      ++tally_.other;
      return;
    }
    ++tally_.read;
    const json report = json::parse(inspected.out);
    count_faces(file);
    compare(file, report["bounds"]);
  }

  /// Writes a scene with the mesh, two units large, just above a floor (not on it, because rays cannot judge coplanar
  /// surfaces) under a lamp whose odd numbers keep its samples out of the planes of a box's sides. Returns false if the
  /// mesh cannot be placed.
  bool write_scene(const std::filesystem::path& file, const json& bounds) {
    double extent = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      extent = std::max(extent, bounds[1][axis].get<double>() - bounds[0][axis].get<double>());
    const double scale = 2 / extent;
    if (!(extent > 0) || !std::isfinite(scale)) return false;
    json move = json::array();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double low = bounds[0][axis].get<double>(), high = bounds[1][axis].get<double>();
      move.push_back(axis == 1 ? 0.05 - scale * low : -scale * (low / 2 + high / 2));
    }
    const json scene = {
        {"format", "penumbra-scene/1"},
        {"camera", {{"eye", {2.5, 3.2, 4.5}}, {"target", {0, 0.7, 0}}, {"verticalFov", 40}}},
        {"lights",
         {{{"name", "key"},
           {"rectangle", {{"center", {0.713, 4.5, 0.907}}, {"halfU", {0.807, 0, 0}}, {"halfV", {0, 0, 0.811}}}}}}},
        {"meshes",
         {{{"name", "floor"}, {"quad", {{"center", {0, 0, 0}}, {"halfU", {0, 0, 4}}, {"halfV", {4, 0, 0}}}}},
          {{"name", "mesh"}, {"file", file.string()}, {"transform", {{"scale", scale}, {"translate", move}}}}}}};
    write("scene.json", scene.dump(-1, ' ', false, json::error_handler_t::replace));
    return true;
  }

  void compare(const std::filesystem::path& file, const json& bounds) {
    const bool is_scene = file.extension() == ".json";
    if (!is_scene && !write_scene(file, bounds)) {
      ++tally_.not_compared;
      return;
    }
    const Outcome outcome =
        run({"compare", is_scene ? file.string() : path("scene.json"), "-o", path("out"), "--methods",
             "edge-scatter,view-sample", "--reference", "raytrace", "--reference-samples", "same", "--light-samples",
             "64", "--size", "96x96", "--runs", "1", "--allow-outside", "--quiet"});
    // A mesh at the end of double's range is bad input for a scene, and a sphere light for these methods.
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 2 || outcome.code == 3) << outcome.code << ": " << outcome.err;
    if (outcome.code != 0) {
      fmt::print("not compared: {}: {}\n", file.string(), outcome.err);
      ++tally_.not_compared;
      return;
    }
    ++tally_.compared;
    const json metrics = json::parse(read("out/metrics.json"));
    EXPECT_EQ(metrics["methods"].size(), 2u);
    for (const json& method : metrics["methods"]) {
      tally_.pairs += method["pairsAll"].get<std::uint64_t>();
      const auto differing = method["pairsDiffering"].get<std::uint64_t>();
      tally_.differing += differing;
      if (method["pairsMethodRight"].is_number()) {
        tally_.method_right += method["pairsMethodRight"].get<std::uint64_t>();
        tally_.reference_right += method["pairsReferenceRight"].get<std::uint64_t>();
        EXPECT_EQ(method["pairsReferenceRight"], 0) << method["entry"];
      } else {
        tally_.undecided += differing;
      }
    }
  }

  void count_faces(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    const auto counter = test::face_counters().find(extension);
    const test::FaceCount count = counter == test::face_counters().end() ? std::nullopt : counter->second(file);
    if (!count) {
      ++tally_.uncounted_faces;
      return;
    }
    const std::vector<std::uint32_t> numbers = mesh::import_mesh(file).soup.source_face;
    const std::set<std::uint32_t> faces(numbers.begin(), numbers.end());
    EXPECT_EQ(faces.size(), *count);
    ++(faces.size() == *count ? tally_.same_faces : tally_.other_faces);
  }

  Tally tally_;
};

TEST_F(CorpusSweep, ReadsComparesAndCounts) {
  for (const std::filesystem::path corpus :
       {"/usr/share/assimp/models", PENUMBRA_CGAL_CORPUS "/meshes", PENUMBRA_SCENES}) {
    ASSERT_TRUE(std::filesystem::exists(corpus)) << corpus << ": install the packages of packages.txt";
    std::set<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(corpus)) {
      const auto& path = entry.path();
      const bool ours = path.parent_path() == PENUMBRA_SCENES;
      const bool wanted = !ours || (path.extension() == ".json" && !path.string().ends_with(".schema.json"));
      if (entry.is_regular_file() && wanted) files.insert(path);
    }
    for (const std::filesystem::path& file : files) sweep(file);
  }
  const Tally& t = tally_;
  fmt::print(
      "\n| area | tried | result |\n| --- | --- | --- |\n"
      "| corpora (assimp-testmodels, CGAL data, shipped scenes) | {} files | {} read, {} refused (exit 3: {} crashed "
      "the importer, {} out of time); {} other exit codes; slowest inspect {:.1f} s ({}) |\n"
      "| compare of {} of them ({} cannot be placed), edge-scatter, view-sample, raytrace | {} pairs of both methods | "
      "{} differ from raytrace, method right {}, raytrace right {}, not decided {} |\n"
      "| face counts against other code | {} files | {} same, {} differ; {} of formats or variants without a counter "
      "|\n\n",
      t.files, t.read, t.refused, t.helper_crashed, t.timed_out, t.other, t.slowest, t.slowest_file, t.compared,
      t.not_compared, t.pairs, t.differing, t.method_right, t.reference_right, t.undecided,
      t.same_faces + t.other_faces, t.same_faces, t.other_faces, t.uncounted_faces);
  EXPECT_GT(t.compared, 400u);
  EXPECT_GT(t.pairs, 100'000u * t.compared);
  EXPECT_EQ(t.reference_right, 0u);
}

}  // namespace
}  // namespace penumbra::tests
