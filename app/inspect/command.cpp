// SPDX-License-Identifier: Apache-2.0
// Command `inspect`: options, reports, pictures, repair.

#include "app/commands.hpp"
#include "app/inspect/counts.hpp"
#include "app/inspect/defect_picture.hpp"
#include "app/inspect/export.hpp"
#include "app/inspect/inspected_files.hpp"
#include "app/inspect/repaired_file.hpp"
#include "app/process/terminal_progress.hpp"
#include "app/reading_options.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/png.hpp"
#include "session/inspect/examine.hpp"
#include "session/inspect/report.hpp"
#include "session/options.hpp"
#include "session/process/output_files.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>

namespace penumbra::app {
namespace {

constexpr std::uint32_t kListed = 16;  ///< locations of each defect in JSON
constexpr std::uint32_t kListedInTable = 3;

class InspectCommand : public Command {
 public:
  explicit InspectCommand(CLI::App& app)
      : Command(app, "inspect", "list defects of meshes, and each method's verdict on them") {
    cli_.add_option("FILE", named_,
                    "meshes (OBJ, PLY, OFF, STL …), scenes (.json, .gltf, .glb), or folders of them, searched with all "
                    "subfolders")
        ->required()
        ->type_name("FILE|FOLDER");
    cli_.add_option("--json", json_,
                    "the whole report as JSON, for several files an array; - for stdout, in place of the table")
        ->type_name("FILE");
    cli_.add_option("--csv", csv_,
                    "a row for each file, with the counts of the JSON; - for stdout, in place of the table")
        ->type_name("FILE");
    cli_.add_option("--fail-on", fail_on_text_,
                    "exit with 1 if one of these counts of the JSON is not 0 in a file: boundaryEdges, needles …, "
                    "open (not closed), non-manifold (edges and vertices)")
        ->type_name("NAME,…");
    cli_.add_flag("--methods", methods_, "list each method's verdict on the mesh, with its reason");
    cli_.add_option("--png", png_,
                    "a picture of the mesh with its defects coloured (see below), from two sides; for several files "
                    "OUT-0001-NAME.png and so on")
        ->type_name("OUT.png");
    cli_.add_option("--export-defects", defects_, "the mesh with its defects coloured (see below)")
        ->type_name("FILE.ply");
    cli_.add_option("--repair", repaired_, "repair what can be repaired, and report what was and was not repaired")
        ->type_name("OUT.ply|.obj|.stl|.off|.glb");
    cli_.add_option("--weld", weld_, "merge vertices at most this far apart (in the file's unit)")
        ->type_name("T")
        ->default_str("0");
    auto* holes = cli_.add_option("--fill-holes", fill_holes_, "with --repair: close holes of up to N edges")
                      ->type_name("N")
                      ->default_str("0");
    auto* resolve = cli_.add_flag("--resolve-self-intersections", resolve_,
                                  "with --repair: replace triangles that cross others of their part, moving "
                                  "the surface by at most 1 % of its size");
    for (auto* option : {holes, static_cast<CLI::Option*>(resolve)}) option->needs("--repair");
    cli_.add_flag("--no-self-intersections", no_intersections_,
                  "do not search for self-intersections, which takes longest");
    cli_.add_option("--list", list_,
                    fmt::format("number of places listed for each defect (default: {} in JSON, {} in the table)",
                                kListed, kListedInTable))
        ->type_name("N");
    add_allow_outside(cli_, allow_outside_);
    cli_.footer(
        "Prints the whole report of one file. For several files, or a folder, prints one table with a row for each "
        "file; --verbose prints the whole report of each. A file that cannot be read has a row with the reason; the "
        "other files are inspected.\n"
        "JSON of one FILE has \"notes\", \"objects\", their \"total\" and, at the top level, the total's keys: "
        "`penumbra inspect m.ply --json - | jq .boundaryEdges`; JSON of several files is an array of such entries. In "
        "\"lists\", \"triangles\" are numbers in the order in which `convert` writes triangles, \"faces\" are numbers "
        "of faces in the mesh's own file.\n"
        "Exit code 0 if every file could be read, whatever is wrong with it; 3 if not; 1 if --fail-on found "
        "something.\n"
        "Colours of --export-defects and --png (where two defects meet, the colour of the lower one in this list):\n" +
        defect_legend());
  }

  int run(const GlobalOptions& global) override {
    const FailOn fail_on(fail_on_text_, !no_intersections_);
    inspected_ = inspected_files(named_);
    const session::OutputFiles outputs = checked_outputs();
    TerminalProgress progress(!global.quiet);
    const bool prints = json_ != "-" && csv_ != "-", whole = !inspected_.several || global.verbose;
    if (prints && !whole) fmt::print("{}", summary_header());
    std::vector<session::FileReport> reports;
    std::optional<session::RepairReport> repaired;
    bool failed = false;
    for (std::size_t i = 0; i < inspected_.files.size(); ++i) {
      reports.push_back(report_on(i, outputs, repaired, progress));
      const session::FileReport& report = reports.back();
      if (prints) {
        if (!whole) fmt::print("{}", summary_row(report));
        if (whole && report.error.empty())
          fmt::print("{}", session::report_table(report, {table_limit(), methods_ || global.verbose}));
        std::fflush(stdout);
      }
      const std::string found = fail_on.found_in(report);
      failed = failed || !found.empty();
      if (!found.empty()) spdlog::error("{}: {} (--fail-on)", report.file.string(), found);
      if (inspected_.several && json_.empty()) forget_places(reports.back());
    }
    if (repaired && prints) fmt::print("{}", session::report_table(*repaired));
    if (!json_.empty()) write_json(reports, repaired);
    if (csv_ == "-")
      fmt::print("{}", report_csv(reports));
    else if (!csv_.empty())
      write_file_atomically(csv_, report_csv(reports));
    const bool all_read =
        std::ranges::all_of(reports, [](const session::FileReport& report) { return report.error.empty(); });
    return static_cast<int>(!all_read ? ExitCode::input : failed ? ExitCode::answer_is_no : ExitCode::done);
  }

 private:
  /// Reads, examines, draws and repairs one file; errors of reading are in the report.
  session::FileReport report_on(std::size_t number, const session::OutputFiles& outputs,
                                std::optional<session::RepairReport>& repaired, session::Progress& progress) const {
    const std::filesystem::path& file = inspected_.files[number];
    try {
      const session::InspectedMesh mesh = session::read_inspected(file, allow_outside_);
      outputs.refuse_inputs(mesh.sources);
      session::FileReport report = session::examine(file, mesh, diagnosis_options(), progress);
      if (!defects_.empty()) export_defects(defects_, mesh.soup, report.total);
      if (!png_.empty()) draw(picture_of(number), mesh, report, progress);
      if (!repaired_.empty())
        repaired =
            repaired_file(repaired_, mesh.soup,
                          {.weld = weld_, .fill_holes_up_to = fill_holes_, .resolve_self_intersections = resolve_},
                          {.weld = weld_, .search_intersections = !no_intersections_, .list_limit = 0}, progress);
      return report;
    } catch (const InputError& error) {
      progress.clear();
      spdlog::error("{}", error.what());
      session::FileReport report;
      report.file = file;
      report.error = error.what();
      return report;
    }
  }

  static void draw(const std::filesystem::path& picture, const session::InspectedMesh& mesh,
                   const session::FileReport& report, session::Progress& progress) {
    constexpr std::uint32_t kSide = 512;
    try {
      write_png(picture, defect_picture(mesh.soup, report.total, kSide));
    } catch (const InputError& error) {
      progress.clear();
      spdlog::warn("{}: no picture: {}", report.file.string(), error.what());
    }
  }

  /// Locations of defects are needed only by the JSON, and may be many.
  static void forget_places(session::FileReport& report) {
    for (const session::DefectRow& row : session::kDefects) (report.total.diagnosis.*row.counted).first = {};
    if (report.total.diagnosis.self_intersections) report.total.diagnosis.self_intersections->first = {};
    report.objects = {};
    report.source_face = {};
  }

  /// Returns "defects.png" for one file; for several "defects-0001-bunny.png".
  [[nodiscard]] std::filesystem::path picture_of(std::size_t number) const {
    if (!inspected_.several) return png_;
    std::string name = session::file_name_of(inspected_.files[number].stem().string());
    std::ranges::replace(name, ':', ',');
    return png_.parent_path() / fmt::format("{}-{:04}-{}.png", png_.stem().string(), number + 1, name);
  }

  /// Checks the command line before any long work.
  [[nodiscard]] session::OutputFiles checked_outputs() const {
    if (!(weld_ >= 0 && std::isfinite(weld_))) {
      throw UsageError("--weld {}: expected a distance, 0 or more, in the file's unit", weld_);
    }
    if (json_ == "-" && csv_ == "-")
      throw UsageError("--json - and --csv -: only one of them can be written to stdout");
    if (!defects_.empty() && defects_.extension() != ".ply")
      throw UsageError("{}: expected a name that ends in .ply", defects_.string());
    if (!png_.empty() && png_.extension() != ".png")
      throw UsageError("--png {}: expected a name that ends in .png", png_.string());
    if (!repaired_.empty()) require_mesh_ending(repaired_);
    for (const std::filesystem::path* output : {&defects_, &repaired_}) {
      if (!output->empty() && inspected_.several)
        throw UsageError("{}: {} FILEs are too many for one output", output->string(), inspected_.files.size());
    }
    if (!repaired_.empty()) mesh::require_repair();
    session::OutputFiles outputs;
    if (json_ != "-") outputs.add("--json", json_);
    if (csv_ != "-") outputs.add("--csv", csv_);
    outputs.add("--export-defects", defects_);
    outputs.add("--repair", repaired_);
    for (std::size_t i = 0; !png_.empty() && i < inspected_.files.size(); ++i) outputs.add("--png", picture_of(i));
    outputs.refuse_inputs(inspected_.files);
    outputs.require_writable();
    return outputs;
  }

  [[nodiscard]] std::size_t table_limit() const { return list_.value_or(kListedInTable); }
  [[nodiscard]] mesh::DiagnosisOptions diagnosis_options() const {
    mesh::DiagnosisOptions options;
    options.weld = weld_;
    options.search_intersections = !no_intersections_;
    // A picture needs every location.
    const bool draws = !defects_.empty() || !png_.empty();
    options.list_limit = draws ? std::numeric_limits<std::size_t>::max() : list_.value_or(kListed);
    return options;
  }

  void write_json(std::span<const session::FileReport> reports,
                  const std::optional<session::RepairReport>& repaired) const {
    const std::size_t limit = list_.value_or(kListed);
    const nlohmann::ordered_json json = inspected_.several ? session::report_json(reports, limit)
                                                           : session::report_json(reports.front(), repaired, limit);
    // A note may contain bytes that are not UTF-8.
    const std::string text = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    if (json_ == "-") {
      fmt::print("{}", text);
    } else {
      write_file_atomically(json_, text);
    }
  }

  std::vector<std::filesystem::path> named_;
  InspectedFiles inspected_;
  std::filesystem::path json_, csv_, png_, defects_, repaired_;
  std::string fail_on_text_;
  double weld_ = 0;
  std::uint32_t fill_holes_ = 0;
  std::optional<std::uint32_t> list_;
  bool resolve_ = false, no_intersections_ = false, allow_outside_ = false, methods_ = false;
};

}  // namespace

std::unique_ptr<Command> make_inspect_command(CLI::App& app) {
  return std::make_unique<InspectCommand>(app);
}

}  // namespace penumbra::app
