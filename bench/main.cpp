// SPDX-License-Identifier: Apache-2.0
// penumbra-bench: runs the requested measurement. Each measurement prints the rows of its table as they are measured,
// and writes lines of JSON if a file is given for them.

#include "base/error.hpp"
#include "base/memory.hpp"
#include "bench/cpu.hpp"
#include "bench/entry.hpp"
#include "bench/frames.hpp"
#include "bench/lines.hpp"
#include "bench/options.hpp"
#include "bench/question.hpp"
#include "bench/sequence.hpp"
#include "bench/whole_frame.hpp"
#include "compare/machine.hpp"
#include "session/machine.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <fstream>

namespace {

using namespace penumbra;

/// The table on stdout and, if requested, the lines in a file. Both are written as soon as there is a result, because a
/// long run may be watched or stopped.
class Output {
 public:
  explicit Output(const bench::Options& options) : path_(options.json) {
    if (path_.empty()) return;
    json_.open(path_, std::ios::app);
    if (!json_) throw ResourceError("{}: cannot be opened for writing", path_.string());
  }
  void write(const std::string& rows, const std::string& lines) {
    fmt::print("{}", rows);
    std::fflush(stdout);
    if (path_.empty()) return;
    json_ << lines << std::flush;
    if (!json_) throw ResourceError("{}: cannot be written", path_.string());
  }

 private:
  std::filesystem::path path_;
  std::ofstream json_;
};

void run_cpu(const bench::Options& options, Output& output) {
  output.write(bench::cpu_table_head(), "");
  bench::measure_cpu(options, [&](const bench::CpuEntry& entry) {
    output.write(bench::cpu_table_row(entry), bench::json_line(entry, options));
  });
}

void print_head(const bench::Options& options, const render::Machine& machine) {
  fmt::print(stderr, "{}; commit {}; {} runs after one discarded\n",
             machine.has_gpu() ? machine.device_name() : compare::this_machine().processor,
             options.commit.empty() ? "unknown" : options.commit, options.runs);
}

void run_frames(const bench::Options& options, Output& output) {
  const render::Machine machine = session::make_machine(options.device);
  print_head(options, machine);
  output.write(bench::cpu_table_head(), "");
  bench::measure_frames(options, machine.device(), [&](const bench::CpuEntry& entry) {
    output.write(bench::cpu_table_row(entry), bench::json_line(entry, options));
  });
  machine.check_validation();
}

void run_whole_frames(const bench::Options& options, Output& output) {
  const render::Machine machine = session::make_machine(options.device);
  print_head(options, machine);
  output.write(bench::frame_table_head(), "");
  bench::measure_whole_frames(options, machine, [&](const bench::FrameEntry& entry) {
    output.write(bench::frame_table_rows(entry), bench::frame_json_lines(entry, options));
  });
  machine.check_validation();
}

void run_sequences(const bench::Options& options, Output& output) {
  output.write(bench::sequence_table_head(), "");
  bench::measure_sequences(options, [&](const bench::SequenceEntry& entry) {
    output.write(bench::sequence_table_row(entry), bench::sequence_json_line(entry, options));
  });
}

void run_methods(const bench::Options& options, Output& output) {
  const render::Machine machine = session::make_machine(options.device);
  print_head(options, machine);
  output.write(bench::table_head(bench::takes_area(options)), "");
  for (const bench::Subject& subject : options.subjects) {
    bench::measure(subject, options, machine, [&](const bench::Entry& entry) {
      output.write(bench::table_rows(entry), bench::json_lines(entry, options));
    });
  }
  machine.check_validation();
}

int run(const std::vector<std::string>& arguments) {
  const bench::Options options = bench::parse_options(arguments);
  if (options.help) {
    fmt::print("{}", bench::kHelp);
    return 0;
  }
  Output output(options);
  if (options.cpu) {
    run_cpu(options, output);
  } else if (options.frames) {
    run_frames(options, output);
  } else if (options.sequence) {
    run_sequences(options, output);
  } else if (options.whole_frames) {
    run_whole_frames(options, output);
  } else {
    run_methods(options, output);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    keep_freed_memory();  // as in the program
    return run({argv + 1, argv + argc});
  } catch (const Error& error) {
    fmt::print(stderr, "penumbra-bench: error: {}\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    fmt::print(stderr, "penumbra-bench: error: internal: {}\n", error.what());
    return static_cast<int>(ExitCode::resource);
  }
}
