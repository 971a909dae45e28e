// SPDX-License-Identifier: Apache-2.0
// Parses the command line.

#include "bench/options.hpp"

#include "base/error.hpp"
#include "bench/adaptive_rays.hpp"
#include "session/methods.hpp"
#include "session/parse.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <map>
#include <string_view>

namespace penumbra::bench {

const char* const kHelp =
    R"(penumbra-bench: shadow methods, ray casters and the oracle side by side, on the same view samples

  --scene NAME|FILE|knot:T|sphere:T
                       a shipped scene by name, a scene file, or a generated knot or sphere of T triangles; may be given
                       again (default: all shipped scenes but terrain-1m, and bunny with light half sizes 0.3 and 2)
  --all                terrain-1m too
  --light-half H       half size of each scene's first rectangle light instead of the scene's; may be given again
  --light KIND         turns each scene's first light, a rectangle, into a disk, an ellipse (one axis twice the other), a
                       polygon (a hexagon) with its area, a sphere or a sun as wide; may be given again
  --sample-pattern P   rows, grid, sobol, jittered or rgss (default: rows); may be given again
  --size N             pixels on a side (default 512); may be given again
  --light-samples N    1 to 4096 (default 256); may be given again
  --method NAME[:KEY=VALUE...]
                       a contestant; may be given again (default: edge-scatter, view-sample)
  --peer NAME[:pattern=jittered]
                       a ray caster beside plain-rays: plain-rays, nontrivial-rays, adaptive-rays; may be given again;
                       none: no other (default: plain-rays:pattern=jittered, nontrivial-rays, adaptive-rays)
  --reference NAME     a method of the family reference: also the errors against it, with many light samples or by areas
  --reference-samples M
                       of a reference with light samples: 1 to 1048576 (default 16384)
  --sample-pixels N    of a reference by areas: how many pixels in penumbra (default 2000), or all
  --runs N             timed runs after one that is discarded (default 5)
  --budget SECONDS     a contestant whose timed runs have used as much gets no further run
  --frame              instead of shadows alone: whole pictures from scenes in memory, by each method and by a plain
                       program on Embree (default: of bunny and sphere:1000000, by edge-scatter and
                       edge-scatter:rows=exact)
  --sequence           instead of methods: the program renders 100 pictures, 16:9, as high as --size (default 1080), in
                       which light and camera move (default: of knot:70000), with exact areas; elapsed seconds over
                       those of the frames' phases
  --frames N           of --sequence
  --cpu                instead of methods: edge graphs, edge records, hierarchies and penumbra wedges on the processor
  --wedges-per-frame   instead of methods: silhouettes and wedges of a light that moves, built again on the device and,
                       in turns with it, on the processor
  --triangles T        of the knots of --cpu (default 5000, 50000, 500000) and of --wedges-per-frame (default 10000,
                       100000, 1000000); may be given again
  --edges N            of --cpu's wedges (default 1000000)
  --device NAME|INDEX|cpu
  --json FILE          append one JSON line a contestant; bench/error_chart.py draws error against time from them
  --commit TEXT        instead of the commit that this was configured at
  --help

The table goes to stdout, what is going on to stderr. bench/README.md says how to read it.
)";

namespace {

constexpr std::string_view kJittered = ":pattern=jittered";

template <typename Integer>
Integer parse_number(const std::string& option, const std::string& text, Integer most) {
  const auto number = session::parse_integer<Integer>(text);
  if (!number || *number == 0 || *number > most)
    throw UsageError("{} {}: expected a whole number from 1 to {}", option, text, most);
  return *number;
}

double parse_seconds(const std::string& text) {
  char* end = nullptr;
  const double seconds = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(seconds > 0))
    throw UsageError("--budget {}: expected seconds above 0, such as 60", text);
  return seconds;
}

Peer parse_peer(const std::string& text) {
  std::string_view name = text;
  const bool jittered = name.ends_with(kJittered);
  if (jittered) name.remove_suffix(kJittered.size());
  for (const RayWork work : {RayWork::all, RayWork::nontrivial, RayWork::adaptive}) {
    if (name == name_of(work)) return {work, jittered, text};
  }
  throw UsageError("--peer {}: expected plain-rays, nontrivial-rays or adaptive-rays, perhaps with {}, or none", text,
                   kJittered);
}

/// Returns "name:key=value:key=value", the keys in their order.
std::string contestant_name(const session::MethodEntry& entry) {
  std::string name = entry.name;
  for (const auto& [key, value] : entry.options) name += fmt::format(":{}={}", key, value);
  return name;
}

void add_methods(std::vector<session::MethodEntry>& methods, const std::string& text) {
  for (session::MethodEntry& entry : session::parse_methods(text)) {
    if (entry.from_group && entry.name == session::ray_judge().name) continue;  // always runs
    entry.label = contestant_name(entry);
    methods.push_back(std::move(entry));
  }
}

/// Command line in the course of parsing; set_defaults fills in missing options.
struct Reading {
  Options options;
  SubjectRequest subjects;
  std::vector<std::string> peers;
};

using Take = std::function<void(Reading&, const std::string& option, const std::string& value)>;

const std::map<std::string, Take>& options_with_value() {
  static const std::map<std::string, Take> takes = {
      {"--scene", [](Reading& r, auto&, auto& value) { r.subjects.scenes.push_back(value); }},
      {"--light-half", [](Reading& r, auto&, auto& value) { r.subjects.halves.push_back(value); }},
      {"--light", [](Reading& r, auto&, auto& value) { r.subjects.lights.push_back(value); }},
      {"--sample-pattern", [](Reading& r, auto&, auto& value) { r.subjects.patterns.push_back(value); }},
      {"--size", [](Reading& r, auto& option,
                    auto& value) { r.subjects.sizes.push_back(parse_number<std::uint32_t>(option, value, 16384)); }},
      {"--light-samples",
       [](Reading& r, auto& option, auto& value) {
         r.options.light_samples.push_back(parse_number<std::uint32_t>(option, value, 4096));
       }},
      {"--method", [](Reading& r, auto&, auto& value) { add_methods(r.options.methods, value); }},
      {"--peer", [](Reading& r, auto&, auto& value) { r.peers.push_back(value); }},
      {"--reference",
       [](Reading& r, auto&, auto& value) { r.options.reference = session::describe_judge(value).name; }},
      {"--reference-samples",
       [](Reading& r, auto& option, auto& value) {
         r.options.reference_samples = parse_number<std::uint32_t>(option, value, 1U << 20);
       }},
      {"--sample-pixels", [](Reading& r, auto&, auto& value) { r.options.sample_pixels = value; }},
      {"--runs", [](Reading& r, auto& option,
                    auto& value) { r.options.runs = parse_number<std::uint32_t>(option, value, 1000); }},
      {"--budget", [](Reading& r, auto&, auto& value) { r.options.budget = parse_seconds(value); }},
      {"--triangles",
       [](Reading& r, auto& option, auto& value) {
         r.options.triangles.push_back(parse_number<std::uint64_t>(option, value, mesh::kMaxShapeTriangles));
       }},
      {"--edges",
       [](Reading& r, auto& option, auto& value) {
         r.options.edges = parse_number<std::uint64_t>(option, value, mesh::kMaxShapeTriangles);
       }},
      {"--frames", [](Reading& r, auto& option,
                      auto& value) { r.options.sequence_frames = parse_number<std::uint32_t>(option, value, 9999); }},
      {"--device", [](Reading& r, auto&, auto& value) { r.options.device = value; }},
      {"--json", [](Reading& r, auto&, auto& value) { r.options.json = value; }},
      {"--commit", [](Reading& r, auto&, auto& value) { r.options.commit = value; }}};
  return takes;
}

void require_once(const std::vector<std::string>& names) {
  std::vector<std::string> sorted = names;
  std::ranges::sort(sorted);
  const auto twice = std::ranges::adjacent_find(sorted);
  if (twice != sorted.end()) throw UsageError("{} is given twice; its results would have one name", *twice);
}

void set_defaults(Reading& reading) {
  Options& options = reading.options;
  const char* const usual = options.whole_frames ? "edge-scatter,edge-scatter:rows=exact" : "edge-scatter,view-sample";
  if (options.methods.empty()) add_methods(options.methods, usual);
  if (options.sequence && reading.subjects.scenes.empty()) reading.subjects.scenes = {"knot:70000"};
  if (options.sequence && reading.subjects.sizes.empty()) reading.subjects.sizes = {1080};
  if (options.whole_frames && reading.subjects.scenes.empty()) reading.subjects.scenes = {"bunny", "sphere:1000000"};
  if (reading.peers.empty()) reading.peers = {"plain-rays:pattern=jittered", "nontrivial-rays", "adaptive-rays"};
  if (reading.peers != std::vector<std::string>{"none"}) {
    for (const std::string& text : reading.peers) options.peers.push_back(parse_peer(text));
  }
  options.samples_in_name = !options.light_samples.empty();
  if (options.light_samples.empty()) options.light_samples = {256};
  if (int{options.cpu} + int{options.frames} + int{options.whole_frames} + int{options.sequence} > 1)
    throw UsageError("--cpu, --frame, --sequence and --wedges-per-frame are runs of their own: give one of them");
  const auto few =
      std::ranges::find_if(options.light_samples, [](std::uint32_t count) { return count <= AdaptiveRays::kFew; });
  if (options.whole_frames && few != options.light_samples.end()) {
    throw UsageError("--light-samples {}: with --frame more than {}, which the program on Embree takes at first", *few,
                     AdaptiveRays::kFew);
  }
  const bool methods = !options.cpu && !options.frames;
  if (options.triangles.empty() && options.frames) options.triangles = {10'000, 100'000, 1'000'000};
  if (options.triangles.empty()) options.triangles = {5'000, 50'000, 500'000};
  if (methods) options.subjects = make_subjects(reading.subjects);
  // contestants that always run
  std::vector<std::string> rivals = {name_of(RayWork::all), session::ray_judge().name}, subjects, samples;
  for (const session::MethodEntry& method : options.methods) rivals.push_back(method.label);
  for (const Peer& peer : options.peers) rivals.push_back(peer.name);
  for (const Subject& subject : options.subjects) subjects.push_back(subject.name);
  for (const std::uint32_t count : options.light_samples) samples.push_back(fmt::format("--light-samples {}", count));
  for (const auto& names : {rivals, subjects, samples}) require_once(names);
}

}  // namespace

const char* name_of(RayWork work) {
  switch (work) {
    case RayWork::all:
      return "plain-rays";
    case RayWork::nontrivial:
      return "nontrivial-rays";
    case RayWork::adaptive:
      return "adaptive-rays";
  }
  return "";
}

Options parse_options(const std::vector<std::string>& arguments) {
  Reading reading;
  reading.options.commit = PENUMBRA_COMMIT;
  for (std::size_t next = 0; next < arguments.size(); ++next) {
    const std::string& option = arguments[next];
    if (option == "--help" || option == "-h") {
      reading.options.help = true;
      return reading.options;
    }
    if (option == "--all") {
      reading.subjects.all = true;
    } else if (option == "--cpu") {
      reading.options.cpu = true;
    } else if (option == "--frame") {
      reading.options.whole_frames = true;
    } else if (option == "--sequence") {
      reading.options.sequence = true;
    } else if (option == "--wedges-per-frame") {
      reading.options.frames = true;
    } else if (const auto take = options_with_value().find(option); take == options_with_value().end()) {
      throw UsageError("{}: no such option; --help lists what there is", option);
    } else if (next + 1 == arguments.size()) {
      throw UsageError("{}: expected a value after it; --help lists the options", option);
    } else {
      take->second(reading, option, arguments[++next]);
    }
  }
  set_defaults(reading);
  return reading.options;
}

}  // namespace penumbra::bench
