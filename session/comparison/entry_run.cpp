// SPDX-License-Identifier: Apache-2.0
// Runs one entry of a comparison: its method, the beauty and the masks of its tiles, and its picture.

#include "session/comparison/entry_run.hpp"

#include "session/comparison/report_views.hpp"
#include "session/methods.hpp"
#include "session/output.hpp"
#include "session/pictures/picture_file.hpp"
#include "session/pictures/tev_pictures.hpp"
#include "session/whole_lights.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

namespace penumbra::session {

using visibility::Light;

EntryRun EntryRunner::run(const Entry& entry, bool is_reference, const std::vector<Light>& lights,
                          const TileSink& sink) const {
  const auto& [session, machine, options, files, format, wanted, progress, warn] = with_;
  const visibility::MethodDescription& description = entry.description;
  const auto method = make_method(description.name, entry.options, machine);
  if (options.memories != nullptr && !is_reference) {
    visibility::remember(*method, &(*options.memories)[entry.label]);
  }
  BeautyAccumulator beauty(session, lights);
  std::optional<BitsOutput> bits;
  if (wants_bits(entry, options)) bits.emplace(files.of(entry.label, ".bits"), session, lights.front());
  RunPlan plan = plan_of(entry, is_reference, options);
  plan.lights = lights;
  // Methods are evaluated in whole tiles, as they are timed.
  constexpr std::uint32_t kJudgeSamples = 1U << 13U;
  if (options.reports_often && description.family == visibility::Family::reference)
    plan.band_rows = std::max(kJudgeSamples / session.width, 1U);
  // Map methods compute all pixels in little time, and their pictures are complete.
  if (description.family != visibility::Family::image) plan.pixels = wanted;
  PackedMasks masks(lights.size());
  EntryRun done;
  MethodRun run = run_method(
      *method, session, plan,
      [&](const TileResult& tile) {
        beauty.add(tile);
        masks.add(tile);
        if (bits && tile.light == 0) bits->add(tile);
        sink(tile);
      },
      progress);
  done.run = of_whole_lights(std::move(run), session);
  done.beauty = beauty.sum();
  done.masks = masks.finish();
  machine.check_validation();
  progress.clear();
  if (!options.writes) return done;
  write(entry, lights, done, beauty);
  if (bits) bits->commit();
  return done;
}

void EntryRunner::write(const Entry& entry, std::span<const Light> lights, const EntryRun& done,
                        const BeautyAccumulator& beauty) const {
  const Entry used = as_run(entry, done.run);
  const std::vector<MethodLabel> labels = labels_of(used, lights, with_.machine);
  const PictureContent written{with_.session, {lights, labels}, done.run.visibility, beauty.parts(), done.beauty};
  const std::filesystem::path file = with_.files.of(entry.label, ".exr");
  for (std::string& warning : write_picture(file, written, with_.format)) with_.warn(std::move(warning));
  if (with_.options.tev != nullptr) with_.options.tev->show(file.filename().string(), written);
}

compare::Stats EntryRunner::stats_of(const Entry& entry, std::span<const Light> lights, const MethodRun& run) const {
  const Entry used = as_run(entry, run);
  const std::vector<MethodLabel> labels = labels_of(used, lights, with_.machine);
  return make_stats(with_.session, {lights, labels}, run);
}

}  // namespace penumbra::session
