// SPDX-License-Identifier: Apache-2.0
// Times `penumbra render` on a generated sequence of frames.

#include "bench/sequence.hpp"

#include "app/process/child_program.hpp"
#include "base/error.hpp"
#include "bench/cpu.hpp"
#include "bench/folder.hpp"
#include "scenes/formats/writer.hpp"
#include "session/process/stopwatch.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numbers>
#include <thread>

namespace penumbra::bench {
namespace {

using nlohmann::json;

constexpr double kFramesPerSecond = 24;
constexpr std::array kStatsPhases = {"load", "mesh", "view", "light", "evaluate", "beauty", "write"};

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw ResourceError("{}: cannot be opened", path.string());
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Binary glTF in its two chunks.
struct Glb {
  json document;
  std::string data;

  explicit Glb(const std::string& file) {
    const std::size_t size = number_at(file, 12);
    document = json::parse(file.substr(20, size));
    data = file.substr(28 + size, number_at(file, 20 + size));
  }
  [[nodiscard]] std::string file() {
    document["buffers"][0]["byteLength"] = data.size();
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4);
    return "glTF" + bytes_of(2) + bytes_of(28 + text.size() + data.size()) + bytes_of(text.size()) + "JSON" + text +
           bytes_of(data.size()) + std::string("BIN\0", 4) + data;
  }
  std::size_t add_floats(const char* type, std::size_t count, const std::vector<float>& values) {
    data.resize((data.size() + 3) / 4 * 4);
    const std::size_t bytes = values.size() * sizeof(float);
    document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", bytes}});
    data.append(reinterpret_cast<const char*>(values.data()), bytes);
    document["accessors"].push_back({{"bufferView", document["bufferViews"].size() - 1},
                                     {"componentType", 5126},
                                     {"count", count},
                                     {"type", type}});
    return document["accessors"].size() - 1;
  }

 private:
  static std::size_t number_at(const std::string& file, std::size_t at) {
    std::uint32_t number = 0;
    std::memcpy(&number, file.data() + at, sizeof(number));
    return number;
  }
  static std::string bytes_of(std::size_t number) {
    const auto small = static_cast<std::uint32_t>(number);
    return {reinterpret_cast<const char*>(&small), sizeof(small)};
  }
};

/// Gives every node accepted by `moves` a parent that moves once around a circle of size `reach` during all frames.
template <typename Moves>
void move_nodes(Glb& glb, std::uint32_t frames, float reach, Moves&& moves) {
  constexpr int kKeys = 33;
  std::vector<float> times, places;
  for (int i = 0; i < kKeys; ++i) {
    const double share = i / (kKeys - 1.0), angle = 2 * std::numbers::pi * share;
    times.push_back(static_cast<float>(share * frames / kFramesPerSecond));
    places.insert(places.end(),
                  {reach * static_cast<float>(std::cos(angle)), reach * static_cast<float>(std::sin(angle)) / 4,
                   reach * static_cast<float>(std::sin(angle))});
  }
  json& document = glb.document;
  const std::size_t input = glb.add_floats("SCALAR", kKeys, times), output = glb.add_floats("VEC3", kKeys, places);
  json animation = {{"samplers", {{{"input", input}, {"output", output}}}}, {"channels", json::array()}};
  for (json& root : document["scenes"][0]["nodes"]) {
    if (!moves(document["nodes"][root.get<std::size_t>()])) continue;
    document["nodes"].push_back({{"name", "Motion"}, {"children", {root}}});
    root = document["nodes"].size() - 1;
    animation["channels"].push_back({{"sampler", 0}, {"target", {{"node", root}, {"path", "translation"}}}});
  }
  if (animation["channels"].empty()) throw InputError("--sequence: the scene has nothing of a kind that is to move");
  document["animations"].push_back(animation);
}

void write_moving_scene(const std::filesystem::path& path, const scenes::Scene& scene, std::uint32_t frames) {
  scenes::write_scene(scene, path);
  Glb glb(read_file(path));
  const auto is_camera = [](const json& node) { return node.contains("camera"); };
  move_nodes(glb, frames, 0.2F, is_camera);
  move_nodes(glb, frames, 0.5F, [&](const json& node) {  // a lamp, or a mesh that only marks the position of a light
    return (node.contains("extensions") && !is_camera(node)) ||
           (node.contains("mesh") && !glb.document["meshes"][node["mesh"].get<std::size_t>()]
                                          .value("extras", json::object())
                                          .value("body", true));
  });
  std::ofstream(path, std::ios::binary) << glb.file();
}

/// Adds the seconds of finished frames, and removes their pictures.
void take_frames(const Folder& folder, SequenceEntry& entry, std::uint32_t& next) {
  while (next <= entry.frames) {
    const std::filesystem::path stats = folder / fmt::format("out.{:04}.json", next).c_str();
    if (!std::filesystem::exists(stats)) return;
    const json seconds = json::parse(read_file(stats)).at("seconds");
    for (const char* phase : kStatsPhases) entry.phases[phase] += seconds.at(phase).get<double>();
    std::filesystem::remove(folder / fmt::format("out.{:04}.exr", next).c_str());
    ++next;
  }
}

SequenceEntry measure(const Subject& subject, const Options& options) {
  SequenceEntry entry;
  entry.name = fmt::format("sequence/{}/frames={}", subject.name, options.sequence_frames);
  entry.frames = options.sequence_frames;
  entry.height = subject.size;
  entry.width = subject.size * 16 / 9;
  const Folder folder;
  const scenes::Scene scene = read_subject(subject);
  entry.triangles = scene.soup.triangles.size();
  write_moving_scene(folder / "scene.glb", scene, entry.frames);
  std::vector<std::string> command = {std::filesystem::path(app::own_program()).replace_filename("penumbra").string(),
                                      "render",
                                      (folder / "scene.glb").string(),
                                      "-o",
                                      (folder / "out.####.exr").string(),
                                      "--stats",
                                      (folder / "out.####.json").string(),
                                      "--frames",
                                      fmt::format("1-{}", entry.frames),
                                      "--size",
                                      fmt::format("{}x{}", entry.width, entry.height),
                                      "--quiet"};
  if (!options.device.empty()) command.insert(command.end(), {"--device", options.device});
  entry.load_before = load_of_machine();
  std::uint32_t next = 1;
  const session::Stopwatch watch;
  app::ChildProgram program(command);
  while (!program.has_ended()) {
    take_frames(folder, entry, next);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  entry.elapsed = watch.seconds();
  if (const int code = program.exit_code(); code != 0)
    throw ResourceError("{}: exit code {}: {}", command.front(), code, program.take_errors());
  take_frames(folder, entry, next);
  if (next != entry.frames + 1)
    throw ResourceError("{}: {} of {} frames are there", command.front(), next - 1, entry.frames);
  return entry;
}

}  // namespace

double SequenceEntry::work() const {
  double sum = 0;
  for (const char* phase : {"view", "light", "evaluate", "beauty", "write"}) sum += phases.at(phase);
  return sum;
}

void measure_sequences(const Options& options, const std::function<void(const SequenceEntry&)>& sink) {
  for (const Subject& subject : options.subjects) sink(measure(subject, options));
}

std::string sequence_table_head() {
  return fmt::format("{:44} {:>9} {:>10} {:>7} {:>9} {:>8} {:>7}\n", "", "triangles", "size", "frames", "elapsed s",
                     "work s", "ratio");
}

std::string sequence_table_row(const SequenceEntry& entry) {
  return fmt::format("{:44} {:>9} {:>10} {:>7} {:>9.2f} {:>8.2f} {:>7.3f}\n", entry.name, entry.triangles,
                     fmt::format("{}x{}", entry.width, entry.height), entry.frames, entry.elapsed, entry.work(),
                     entry.elapsed / entry.work());
}

std::string sequence_json_line(const SequenceEntry& entry, const Options& options) {
  json line = {{"name", entry.name},
               {"commit", options.commit},
               {"triangles", entry.triangles},
               {"width", entry.width},
               {"height", entry.height},
               {"frames", entry.frames},
               {"seconds", entry.phases},
               {"elapsed", entry.elapsed},
               {"work", entry.work()},
               {"elapsedOverWork", entry.elapsed / entry.work()},
               {"loadBefore", entry.load_before}};
  return line.dump() + "\n";
}

}  // namespace penumbra::bench
