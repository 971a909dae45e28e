#pragma once

#include "app/options.hpp"
#include "bench/subject.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::bench {

/// What a ray caster is asked to do (bench/README.md, "What is measured").
enum class RayWork {
  all,         ///< "plain-rays": every view sample
  nontrivial,  ///< "nontrivial-rays": those of blocks in which V is neither 0 nor 1 throughout
  adaptive,    ///< "adaptive-rays": 64 light samples, and all N where those do not agree
};
const char* name_of(RayWork work);

struct Peer {
  RayWork work = RayWork::all;
  bool jittered = false;  ///< jittered light samples instead of the methods' rows
  std::string name;       ///< "plain-rays", "plain-rays:pattern=jittered"
};

struct Options {
  std::vector<Subject> subjects;
  std::vector<app::MethodEntry> methods;     ///< their labels are contestants' names, with options as given
  std::vector<Peer> peers;                   ///< beside plain-rays, which always runs
  std::vector<std::uint32_t> light_samples;  ///< 256 if none were asked for
  bool samples_in_name = false;              ///< the user asked for them
  std::string reference;                     ///< a method of the family `reference`; empty: none
  std::uint32_t reference_samples = 16384;
  std::string sample_pixels = "2000";  ///< of a reference that gives areas
  std::uint32_t runs = 5;              ///< timed runs, after one that is discarded
  double budget = 0;   ///< seconds; a contestant whose timed runs have used as much gets no further run; 0: no limit
  std::string device;  ///< as `penumbra --device` takes it
  std::filesystem::path json, picture;
  std::string commit;
  bool cpu = false;                      ///< time the parts that run on the processor, not methods
  bool whole_frames = false;             ///< time whole pictures beside a plain program on Embree
  bool sequence = false;                 ///< time the program on a sequence of pictures
  std::uint32_t sequence_frames = 100;   ///< --sequence: how many
  bool frames = false;                   ///< time silhouettes and wedges of a moving light, on device and processor
  std::vector<std::uint64_t> triangles;  ///< --cpu, --wedges-per-frame: of the knots
  std::uint64_t edges = 1'000'000;       ///< --cpu: how many edges get wedges
  bool help = false;
};

/// Throws UsageError.
Options parse_options(const std::vector<std::string>& arguments);
extern const char* const kHelp;

}  // namespace penumbra::bench
