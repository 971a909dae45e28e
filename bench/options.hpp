// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/subject.hpp"
#include "session/options.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::bench {

/// Task of a ray caster (bench/README.md, "What is measured").
enum class RayWork {
  all,         ///< "plain-rays": every view sample
  nontrivial,  ///< "nontrivial-rays": view samples of blocks in which V is neither 0 nor 1 throughout
  adaptive,    ///< "adaptive-rays": 64 light samples, and all N where the 64 disagree
};
const char* name_of(RayWork work);

struct Peer {
  RayWork work = RayWork::all;
  bool jittered = false;  ///< jittered light samples instead of the methods' rows
  std::string name;       ///< "plain-rays", "plain-rays:pattern=jittered"
};

struct Options {
  std::vector<Subject> subjects;
  std::vector<session::MethodEntry> methods;  ///< the labels are contestants' names, with options as given
  std::vector<Peer> peers;                    ///< in addition to plain-rays, which always runs
  std::vector<std::uint32_t> light_samples;   ///< 256 if none were given
  bool samples_in_name = false;               ///< light samples were given on the command line
  std::string reference;                      ///< a method of the family `reference`; empty: none
  std::uint32_t reference_samples = 16384;
  std::string sample_pixels = "2000";  ///< for a reference that computes areas
  std::uint32_t runs = 5;              ///< timed runs, after one discarded run
  double budget = 0;   ///< seconds; a contestant whose timed runs have used this budget gets no further run; 0: no
                       ///< limit
  std::string device;  ///< in the form of `penumbra --device`
  std::filesystem::path json;
  std::string commit;
  bool cpu = false;                      ///< time the parts that run on the processor, not methods
  bool whole_frames = false;             ///< time whole pictures in comparison with a plain program on Embree
  bool sequence = false;                 ///< time the program on a sequence of pictures
  std::uint32_t sequence_frames = 100;   ///< --sequence: number of frames
  bool frames = false;                   ///< time silhouettes and wedges of a moving light, on device and processor
  std::vector<std::uint64_t> triangles;  ///< --cpu, --wedges-per-frame: numbers of triangles of the knots
  std::uint64_t edges = 1'000'000;       ///< --cpu: number of edges with wedges
  bool help = false;
};

/// Parses the command line. Throws UsageError if it is invalid.
Options parse_options(const std::vector<std::string>& arguments);
extern const char* const kHelp;

}  // namespace penumbra::bench
