// The tables of docs/accumulate.md, docs/pcss.md and docs/shadow-map.md; each line is also a bound.

#include "tests/analytic/maps_parallel_square.hpp"

#include "visibility/pair_truth.hpp"

#include <fmt/format.h>

#include <chrono>

namespace penumbra::maps_test {
namespace {

class MapsTable : public MapsTest {};

TEST_F(MapsTable, AccumulateOverMapResolution) {
  const Stage stage = make_stage(parallel_square(), samples(256), 128);
  const ParallelSquare exact(stage);
  const auto on_floor = [&](std::size_t i) { return exact.on_floor(i); };
  fmt::print("| size | RMSE against the count | against the area | largest | differing pairs | evaluate |\n");
  double last = 1;
  for (const std::uint32_t size : {128u, 256u, 512u, 1024u, 2048u}) {
    const auto method = maps::make_accumulate(device_, {{"size", std::to_string(size)}});
    const auto start = std::chrono::steady_clock::now();
    const Result result = run(*method, stage);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    double largest = 0;
    std::size_t pairs = 0, differing = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!exact.on_floor(i)) continue;
      largest = std::max(largest, std::abs(result.visibility[i] - exact.visibility(i)));
      for (std::size_t j = 0; j < 256; ++j) {
        ++pairs;
        differing += ((result.masks[i * 8 + j / 32] >> (j % 32) & 1) != 0) != exact.visible(i, j) ? 1 : 0;
      }
    }
    const double error =
        rmse(stage, on_floor, [&](std::size_t i) { return result.visibility[i] - exact.visibility(i); });
    const double area = rmse(stage, on_floor, [&](std::size_t i) { return result.visibility[i] - exact.area(i); });
    fmt::print("| {} | {:.5f} | {:.5f} | {:.4f} | {:.3f} % | {:.2f} s |\n", size, error, area, largest,
               100.0 * static_cast<double>(differing) / static_cast<double>(pairs), seconds.count());
    EXPECT_LT(error, last);
    last = error;
  }
}

/// The curved receiver: pairs wrongly dark are acne, pairs wrongly lit are leaks.
TEST_F(MapsTable, AccumulateOverBias) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, 3});
  add_sphere(scene, {0, 0.9, 0}, 1, 48);                          // sinks into the floor: a contact
  add_quad(scene, {1.6, 0.02, 0.6}, {0.4, 0, 0}, {0, 0, 0.4});    // hovers over the floor
  add_quad(scene, {-1.7, 0.3, 0.8}, {0.3, 0.3, 0}, {0, 0, 0.5});  // stands on it, leaning
  scene.lights.push_back(square_light(5, 0.5));
  scene.cameras.push_back(camera_at({2, 4, 5}, {0, 0.4, 0}, 40));
  const Stage stage = make_stage(scene, samples(9), 64);
  std::vector<std::uint8_t> truth;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    for (std::uint32_t j = 0; j < stage.light.sample_count(); ++j) {
      truth.push_back(stage.samples.triangle[i] < 0 ||
                      visibility::decide_pair(stage.scene, stage.samples, i, stage.light, j).outcome ==
                          visibility::PairOutcome::visible);
    }
  }
  for (const char* size : {"256", "1024"}) {
    fmt::print("| size | bias | wrongly dark | wrongly lit |\n");
    for (const char* bias : {"0", "0.01", "0.05", "0.1", "0.25", "0.5", "1", "2"}) {
      const Result result = run(maps::make_accumulate, stage, {{"size", size}, {"bias", bias}});
      std::size_t dark = 0, lit = 0;
      for (std::size_t k = 0; k < truth.size(); ++k) {
        const std::size_t i = k / stage.light.sample_count(), j = k % stage.light.sample_count();
        const bool visible = (result.masks[i] >> j & 1) != 0;
        dark += !visible && truth[k] ? 1 : 0;
        lit += visible && !truth[k] ? 1 : 0;
      }
      const double pairs = static_cast<double>(truth.size());
      fmt::print("| {} | {} | {:.3f} % | {:.3f} % |\n", size, bias, 100.0 * static_cast<double>(dark) / pairs,
                 100.0 * static_cast<double>(lit) / pairs);
      if (std::string(bias) == "0.5") {
        EXPECT_LT(static_cast<double>(dark + lit) / pairs, 0.005);
      }
    }
  }
}

TEST_F(MapsTable, PcssAndShadowMapAgainstTheArea) {
  fmt::print("| scene | method | options | RMSE | bias |\n");
  for (const auto& [key, scene] :
       {std::pair("square", parallel_square()), std::pair("half-plane", parallel_square(5, 6))}) {
    const char* name = key;  // clang 14 lets no lambda take a structured binding
    const Stage stage = make_stage(scene, samples(1), 128);
    const ParallelSquare exact(stage);
    const auto on_floor = [&](std::size_t i) { return exact.on_floor(i); };
    const auto line = [&](const char* method, const char* options, const Result& result) {
      double sum = 0, count = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        if (!exact.on_floor(i)) continue;
        sum += result.visibility[i] - exact.area(i);
        ++count;
      }
      const double error = rmse(stage, on_floor, [&](std::size_t i) { return result.visibility[i] - exact.area(i); });
      fmt::print("| {} | {} | {} | {:.4f} | {:+.4f} |\n", name, method, options, error, sum / count);
      EXPECT_LT(error, 0.4);
    };
    line("shadow-map", "", run(maps::make_shadow_map, stage));
    for (const char* taps : {"16", "64", "256", "1024"}) {
      line("pcss", taps, run(maps::make_pcss, stage, {{"blockerSamples", taps}, {"filterSamples", taps}}));
    }
  }
}

}  // namespace
}  // namespace penumbra::maps_test
