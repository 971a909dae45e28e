#include "base/error.hpp"
#include "bench/entry.hpp"
#include "bench/lines.hpp"
#include "bench/options.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <fstream>

namespace {

int run(const std::vector<std::string>& arguments) {
  using namespace penumbra;
  const bench::Options options = bench::parse_options(arguments);
  if (options.help) {
    fmt::print("{}", bench::kHelp);
    return 0;
  }
  std::ofstream json;
  if (!options.json.empty()) {
    json.open(options.json, std::ios::app);
    if (!json) throw ResourceError("{}: cannot be opened for writing", options.json.string());
  }
  const render::Device device({.wanted = options.device});
  fmt::print(stderr, "{}; commit {}; {} runs after one discarded\n", device.info().name,
             options.commit.empty() ? "unknown" : options.commit, options.runs);
  fmt::print("{}", bench::table_head());
  for (const bench::Subject& subject : options.subjects) {
    const bench::Entry entry = bench::measure(subject, options, device);
    fmt::print("{}", bench::table_row(entry));
    std::fflush(stdout);  // a long run is watched
    if (json.is_open()) {
      json << bench::json_lines(entry, options) << std::flush;
      if (!json) throw ResourceError("{}: cannot be written", options.json.string());
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run({argv + 1, argv + argc});
  } catch (const penumbra::Error& error) {
    fmt::print(stderr, "penumbra-bench: error: {}\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    fmt::print(stderr, "penumbra-bench: error: internal: {}\n", error.what());
    return static_cast<int>(penumbra::ExitCode::resource);
  }
}
