#include "app/commands.hpp"
#include "app/inspect/examine.hpp"
#include "app/inspect/export.hpp"
#include "app/inspect/report.hpp"
#include "app/process/output_files.hpp"
#include "app/process/terminal_progress.hpp"
#include "app/reading_options.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "mesh/soup_ply.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>

namespace penumbra::app {
namespace {

constexpr std::uint32_t kListed = 16;  ///< places of each defect in JSON
constexpr std::uint32_t kListedInTable = 3;

class InspectCommand : public Command {
 public:
  explicit InspectCommand(CLI::App& app)
      : Command(app, "inspect", "what is wrong with a mesh, and what each method will make of it") {
    cli_.add_option("FILE", files_, "meshes (OBJ, PLY, OFF, STL …) or scenes (.json, .gltf, .glb)")->required();
    cli_.add_option("--json", json_, "the whole report as JSON; - for stdout, in place of the table")
        ->type_name("FILE");
    cli_.add_option("--export-defects", defects_, "the mesh with its defects coloured (see below)")
        ->type_name("FILE.ply");
    cli_.add_option("--repair", repaired_, "repair what can be repaired, and say what was done and what was not")
        ->type_name("OUT.ply");
    cli_.add_option("--weld", weld_, "vertices at most this far apart (the file's unit) are one")
        ->type_name("T")
        ->default_str("0");
    auto* holes = cli_.add_option("--fill-holes", fill_holes_, "with --repair: close holes of up to N edges")
                      ->type_name("N")
                      ->default_str("0");
    auto* resolve = cli_.add_flag("--resolve-self-intersections", resolve_,
                                  "with --repair: replace triangles that cross others of their part, moving "
                                  "the surface by at most 1 % of its size");
    for (auto* option : {holes, static_cast<CLI::Option*>(resolve)}) option->needs("--repair");
    cli_.add_flag("--no-self-intersections", no_intersections_, "do not search them: the search that takes longest");
    cli_.add_option(
            "--list", list_,
            fmt::format("places listed of each defect (default {} in JSON, {} in the table)", kListed, kListedInTable))
        ->type_name("N");
    add_allow_outside(cli_, allow_outside_);
    cli_.footer(
        "JSON: \"files\" lists every FILE with its \"notes\", \"objects\" and their \"total\"; of a single FILE all "
        "this\nstands at the top level, too, and so do the total's keys: `penumbra inspect m.ply --json - | jq "
        ".boundaryEdges`.\nIn \"lists\", \"triangles\" are numbers in the order of `convert`, \"faces\" those of "
        "the mesh's own file.\nExit code 0 if every file could be read, whatever is wrong with it; 3 if not.\n"
        "Colours of --export-defects (of two, the lower in this list):\n" +
        defect_legend());
  }

  int run(const GlobalOptions& global) override {
    const OutputFiles outputs = checked_outputs();
    TerminalProgress progress(!global.quiet);
    std::vector<FileReport> reports;
    std::optional<RepairReport> repaired;
    for (const std::filesystem::path& file : files_) {
      try {
        const InspectedMesh mesh = read_inspected(file, allow_outside_);
        outputs.refuse_inputs(mesh.sources);
        reports.push_back(examine(file, mesh, diagnosis_options(), progress));
        if (!defects_.empty()) export_defects(defects_, mesh.soup, reports.back().total);
        if (!repaired_.empty()) repaired = repair(mesh.soup);
      } catch (const InputError& error) {
        progress.clear();
        spdlog::error("{}", error.what());
        reports.emplace_back();
        reports.back().file = file;
        reports.back().error = error.what();
      }
      if (json_ != "-" && reports.back().error.empty()) fmt::print("{}", report_table(reports.back(), table_limit()));
    }
    if (repaired && json_ != "-") fmt::print("{}", report_table(*repaired));
    if (!json_.empty()) write_json(reports, repaired);
    const bool all_read = std::ranges::all_of(reports, [](const FileReport& report) { return report.error.empty(); });
    return static_cast<int>(all_read ? ExitCode::done : ExitCode::input);
  }

 private:
  /// What is wrong with the command line is said before anything long begins.
  [[nodiscard]] OutputFiles checked_outputs() const {
    if (!(weld_ >= 0 && std::isfinite(weld_))) {
      throw UsageError("--weld {}: expected a distance, 0 or more, in the file's unit", weld_);
    }
    for (const std::filesystem::path* output : {&defects_, &repaired_}) {
      if (output->empty()) continue;
      if (output->extension() != ".ply") throw UsageError("{}: expected a name that ends in .ply", output->string());
      if (files_.size() > 1)
        throw UsageError("{}: {} FILEs are too many for one output", output->string(), files_.size());
    }
    if (!repaired_.empty()) mesh::require_repair();
    OutputFiles outputs;
    if (json_ != "-") outputs.add("--json", json_);
    outputs.add("--export-defects", defects_);
    outputs.add("--repair", repaired_);
    outputs.refuse_inputs(files_);
    outputs.require_writable();
    return outputs;
  }

  [[nodiscard]] std::size_t table_limit() const { return list_.value_or(kListedInTable); }
  [[nodiscard]] mesh::DiagnosisOptions diagnosis_options() const {
    mesh::DiagnosisOptions options;
    options.weld = weld_;
    options.search_intersections = !no_intersections_;
    // A picture needs every place.
    options.list_limit = defects_.empty() ? list_.value_or(kListed) : std::numeric_limits<std::size_t>::max();
    return options;
  }

  [[nodiscard]] RepairReport repair(const mesh::TriangleSoup& soup) const {
    mesh::Repaired repaired =
        mesh::repair(soup, {.weld = weld_, .fill_holes_up_to = fill_holes_, .resolve_self_intersections = resolve_});
    mesh::PlyMesh ply;
    ply.positions = std::move(repaired.soup.positions);
    ply.triangles = std::move(repaired.soup.triangles);
    mesh::write_ply(repaired_, ply);
    return {repaired_, ply.triangles.size(), std::move(repaired.done), std::move(repaired.left)};
  }

  void write_json(std::span<const FileReport> reports, const std::optional<RepairReport>& repaired) const {
    // A file's name may hold bytes that are no UTF-8.
    const std::string text = report_json(reports, repaired, list_.value_or(kListed))
                                 .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
                             "\n";
    if (json_ == "-") {
      fmt::print("{}", text);
    } else {
      write_file_atomically(json_, text);
    }
  }

  std::vector<std::filesystem::path> files_;
  std::filesystem::path json_, defects_, repaired_;
  double weld_ = 0;
  std::uint32_t fill_holes_ = 0;
  std::optional<std::uint32_t> list_;
  bool resolve_ = false, no_intersections_ = false, allow_outside_ = false;
};

}  // namespace

std::unique_ptr<Command> make_inspect_command(CLI::App& app) {
  return std::make_unique<InspectCommand>(app);
}

}  // namespace penumbra::app
