// SPDX-License-Identifier: Apache-2.0
// Compares the tables of docs/accumulate.md, docs/pcss.md and docs/shadow-map.md with measurements.

#include "scenes/formats/reader.hpp"
#include "tests/analytic/maps/documented_table.hpp"
#include "tests/analytic/maps/parallel_square.hpp"
#include "visibility/pair_truth.hpp"

#include <fmt/format.h>

#include <array>

namespace penumbra::tests {
namespace {

class MapsTable : public MapsTest {
 protected:
  static std::filesystem::path page(const char* name) { return std::filesystem::path(PENUMBRA_DOCS) / name; }
};

TEST_F(MapsTable, AccumulateOverMapResolution) {
  const DocumentedTable documented(page("accumulate.md"), "| size | differing pairs");
  const Stage stage(parallel_square(), 128, 128, light_samples(256));
  const ParallelSquare exact(stage);
  const auto on_floor = [&](std::size_t i) { return exact.on_floor(i); };
  fmt::print("| size | differing pairs | RMSE against the exact count | largest | RMSE against the area |\n");
  ASSERT_EQ(documented.rows(), 5U);
  for (std::size_t row = 0; row < documented.rows(); ++row) {
    const std::uint32_t size = 128U << row;
    ASSERT_EQ(documented.value(row, 0), size);
    const Masks result = run(maps::make_accumulate, stage, {{"size", std::to_string(size)}});
    double largest = 0;
    std::size_t pairs = 0, differing = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!exact.on_floor(i)) continue;
      largest = std::max(largest, std::abs(result.visibility[i] - exact.visibility(i)));
      for (std::size_t j = 0; j < 256; ++j) {
        ++pairs;
        differing += result.visible(i, j) != exact.visible(i, j) ? 1 : 0;
      }
    }
    const double share = 100.0 * static_cast<double>(differing) / static_cast<double>(pairs);
    const double error =
        rmse(stage, on_floor, [&](std::size_t i) { return result.visibility[i] - exact.visibility(i); });
    const double area = rmse(stage, on_floor, [&](std::size_t i) { return result.visibility[i] - exact.area(i); });
    fmt::print("| {} | {:.3f} % | {:.5f} | {:.3f} | {:.5f} |\n", size, share, error, largest, area);
    documented.expect(row, 1, share);
    documented.expect(row, 2, error);
    documented.expect(row, 3, largest);
    documented.expect(row, 4, area);
  }
}

/// On a curved receiver, pairs that are wrongly dark are acne, pairs that are wrongly lit are leaks.
TEST_F(MapsTable, AccumulateOverBias) {
  const DocumentedTable documented(page("accumulate.md"), "| bias | size 256");
  const Stage stage(scenes::read_scene(std::filesystem::path(PENUMBRA_SCENES) / "bunny.json"), 64, 64,
                    light_samples(9));
  std::vector<std::uint8_t> truth;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    for (std::uint32_t j = 0; j < stage.light.sample_count(); ++j) {
      truth.push_back(stage.samples.triangle[i] < 0 ||
                      visibility::decide_pair(stage.floats, stage.samples, i, stage.light, j).outcome ==
                          visibility::PairOutcome::visible);
    }
  }
  fmt::print("| bias | size 256: dark | lit | size 1024: dark | lit | size 2048: dark | lit |\n");
  static constexpr std::array kBiases{"0.01", "0.1", "0.25", "0.5", "1", "2"};
  ASSERT_EQ(documented.rows(), kBiases.size());
  for (std::size_t row = 0; row < kBiases.size(); ++row) {
    ASSERT_EQ(documented.value(row, 0), std::stod(kBiases[row]));
    fmt::print("| {} ", kBiases[row]);
    std::size_t column = 1;
    for (const char* size : {"256", "1024", "2048"}) {
      const Masks result = run(maps::make_accumulate, stage, {{"size", size}, {"bias", kBiases[row]}});
      std::size_t dark = 0, lit = 0;
      for (std::size_t k = 0; k < truth.size(); ++k) {
        const bool visible = result.visible(k / stage.light.sample_count(), k % stage.light.sample_count());
        dark += !visible && truth[k] != 0 ? 1 : 0;
        lit += visible && truth[k] == 0 ? 1 : 0;
      }
      const double per_cent = 100.0 / static_cast<double>(truth.size());
      fmt::print("| {:.3f} % | {:.3f} % ", per_cent * static_cast<double>(dark), per_cent * static_cast<double>(lit));
      documented.expect(row, column++, per_cent * static_cast<double>(dark));
      documented.expect(row, column++, per_cent * static_cast<double>(lit));
    }
    fmt::print("|\n");
  }
}

TEST_F(MapsTable, PcssAndShadowMapAgainstTheArea) {
  const DocumentedTable documented(page("pcss.md"), "| taps (each)");
  static constexpr std::array kTaps{"16", "64", "256", "1024"};
  ASSERT_EQ(documented.rows(), kTaps.size());
  fmt::print("| scene | method | RMSE | mean error |\n");
  for (std::size_t column : {std::size_t{1}, std::size_t{3}}) {
    const char* name = column == 1 ? "square" : "half-plane";
    const Stage stage(column == 1 ? parallel_square() : parallel_square(5, 6), 128, 128, light_samples(1));
    const ParallelSquare exact(stage);
    const auto on_floor = [&](std::size_t i) { return exact.on_floor(i); };
    struct Errors {
      double rmse, mean;
    };
    const auto errors = [&](const char* method, const Masks& result) {
      double sum = 0, count = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        if (!exact.on_floor(i)) continue;
        sum += result.visibility[i] - exact.area(i);
        ++count;
      }
      const Errors found{rmse(stage, on_floor, [&](std::size_t i) { return result.visibility[i] - exact.area(i); }),
                         sum / count};
      fmt::print("| {} | {} | {:.4f} | {:+.4f} |\n", name, method, found.rmse, found.mean);
      return found;
    };
    for (std::size_t row = 0; row < kTaps.size(); ++row) {
      const Errors found = errors(
          kTaps[row], run(maps::make_pcss, stage, {{"blockerSamples", kTaps[row]}, {"filterSamples", kTaps[row]}}));
      documented.expect(row, column, found.rmse);
      // Mean errors are sums that nearly cancel: the tolerance is a tenth of the RMSE, plus a unit of the last digit.
      EXPECT_NEAR(found.mean, documented.value(row, column + 1), 0.1 * documented.value(row, column) + 1e-4) << name;
    }
    // docs/shadow-map.md: "RMSE of V is 0.144 over the floor, whatever the map's size".
    for (const char* size : {"256", "1024", "4096"}) {
      const Errors hard = errors("shadow-map", run(maps::make_shadow_map, stage, {{"size", size}}));
      if (column == 1) {
        EXPECT_NEAR(hard.rmse, 0.144, 0.002);
      }
    }
  }
}

}  // namespace
}  // namespace penumbra::tests
