// SPDX-License-Identifier: Apache-2.0
#include "tests/analytic/maps/parallel_square.hpp"

#include "base/error.hpp"
#include "maps/filters/methods.hpp"
#include "maps/host/caster_maps.hpp"

#include <bit>

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

class MapsMethod : public MapsTest {
 protected:
  /// Makes methods with small maps, unless the test gives a size: results of these tests do not depend on it.
  static Factory small(const Factory& make) {
    return [make](const render::Device& device, MethodOptions options) {
      options.try_emplace("size", "64");
      return make(device, options);
    };
  }
  const std::vector<Factory> all_{small(maps::make_shadow_map),
                                  small(maps::make_pcf),
                                  small(maps::make_pcss),
                                  small(maps::make_vssm),
                                  small(maps::make_occlusion_textures),
                                  small(maps::make_convolution),
                                  small(maps::make_accumulate),
                                  small(maps::make_bitmask),
                                  small(maps::make_backproject),
                                  small(maps::make_layer_rays),
                                  small(maps::make_silhouette_map),
                                  small(maps::make_forward_map),
                                  small(maps::make_penumbra_map),
                                  small(maps::make_smoothies),
                                  small(maps::make_brabec_seidel),
                                  small(maps::make_kirsch_doellner),
                                  small(maps::make_parker),
                                  small(maps::make_arvo),
                                  small(maps::make_contour),
                                  small(maps::make_packet),
                                  small(maps::make_backproject_peel),
                                  small(maps::make_soft_shadow_map),
                                  small(maps::make_adaptive_light),
                                  small(maps::make_deep_penumbra),
                                  small(maps::make_layered_attenuation)};
};

TEST_F(MapsMethod, ASphereIsRefusedWithWhatCanBeDone) {
  scenes::Scene scene = parallel_square();
  scene.lights.front().shape = scenes::Sphere{{0, 5, 0}, 0.5};
  const Stage stage(scene, 8, 8, light_samples(4));
  for (const Factory& factory : all_) {
    const auto method = factory(device(), {});
    method->prepare_mesh(stage.floats);
    EXPECT_THROW(method->prepare_light(stage.light), InputError);
  }
}

TEST_F(MapsMethod, OptionsThatCannotBeMeantAreRefused) {
  for (const Factory& factory : all_) {
    for (const MethodOptions& options :
         {MethodOptions{{"size", "0"}}, MethodOptions{{"size", "1e3"}}, MethodOptions{{"size", "-4"}},
          MethodOptions{{"size", "1000000"}}, MethodOptions{{"bias", "-1"}}, MethodOptions{{"bias", "nan"}},
          MethodOptions{{"bias", "0.1x"}}, MethodOptions{{"resolution", "512"}}}) {
      EXPECT_THROW(factory(device(), options), UsageError) << options.begin()->first << "=" << options.begin()->second;
    }
  }
  EXPECT_THROW(maps::make_pcss(device(), {{"filterSamples", "0"}}), UsageError);
  EXPECT_THROW(maps::make_pcss(device(), {{"blockerSamples", "5000"}}), UsageError);
  EXPECT_THROW(maps::make_accumulate(device(), {{"filterSamples", "4"}}), UsageError);
}

TEST_F(MapsMethod, MapsThatFitIntoNoBufferAreRefusedWithTheSizeThatDoes) {
  // The largest number of faces that fits, and one more; this holds on every device, however large its buffers are.
  constexpr std::uint32_t kSize = 1024;
  const auto most = static_cast<std::uint32_t>(maps::faces_per_buffer(device(), kSize));
  EXPECT_NO_THROW(maps::check_faces_fit(device(), kSize, most));
  try {
    maps::check_faces_fit(device(), kSize, most + 1);
    ADD_FAILURE() << most + 1 << " faces are too many";
  } catch (const ResourceError& error) {
    const std::string message = error.what();
    const std::size_t at = message.rfind("size=");
    ASSERT_NE(at, std::string::npos) << message;
    const auto size = static_cast<std::uint32_t>(std::stoul(message.substr(at + 5)));
    EXPECT_LT(size, kSize);
    EXPECT_NO_THROW(maps::check_faces_fit(device(), size, most + 1)) << "the size that it names does";
  }
}

TEST_F(MapsMethod, TheSameBytesTwiceAndInTiles) {
  const Stage stage(parallel_square(), 24, 24, light_samples(40));
  for (const Factory& factory : all_) {
    const auto method = factory(device(), {{"size", "128"}});
    const Masks first = run(*method, stage), again = run(*method, stage), tiled = run(*method, stage, 7);
    EXPECT_EQ(first.visibility, again.visibility);
    EXPECT_EQ(first.words, again.words);
    EXPECT_EQ(first.visibility, tiled.visibility);
    EXPECT_EQ(first.words, tiled.words);
    EXPECT_GT(method->memory_bytes(), 128u * 128 * 4);
    EXPECT_FALSE(method->counters().empty());
  }
}

TEST_F(MapsMethod, AnyNumberOfLightSamplesAndNoBitBeyond) {
  for (const std::uint32_t count : {1u, 5u, 32u, 33u, 256u, 4096u}) {
    visibility::SampleRequest request = light_samples(count);
    request.pattern = visibility::SamplePattern::sobol;
    const Stage stage(parallel_square(), 24, 24, request);
    ASSERT_EQ(stage.light.sample_count(), count);
    const Masks result = run(maps::make_accumulate, stage, {{"size", "64"}});
    const ParallelSquare exact(stage);
    double error = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      std::uint32_t bits = 0;
      for (std::uint32_t w = 0; w < stage.light.words_per_mask(); ++w) {
        const std::uint32_t word = result.words[i * stage.light.words_per_mask() + w];
        bits += static_cast<std::uint32_t>(std::popcount(word));
        const std::uint32_t used = std::min(count - 32 * w, 32u);
        if (used < 32) {
          EXPECT_EQ(word >> used, 0u);
        }
      }
      EXPECT_EQ(result.visibility[i], static_cast<float>(bits) / static_cast<float>(count));
      if (stage.samples.triangle[i] < 0) {
        EXPECT_EQ(bits, count);
      }
      if (exact.on_floor(i)) error += std::abs(static_cast<double>(result.visibility[i]) - exact.visibility(i));
    }
    EXPECT_LT(error / static_cast<double>(stage.samples.size()), 0.03) << count;
  }
}

TEST_F(MapsMethod, DiskEllipseAndPolygonShapesAreDone) {
  for (const scenes::LightShape& shape :
       {scenes::LightShape(scenes::Disk{{0, 5, 0}, {0, -1, 0}, 0.7}),
        scenes::LightShape(scenes::Ellipse{{0, 5, 0}, {0.9, 0, 0}, {0.1, 0, 0.5}}),
        scenes::LightShape(scenes::Polygon{{{-1, 5, -1}, {1, 5, -0.5}, {0, 5, 1}}})}) {
    scenes::Scene scene = parallel_square();
    scene.lights.front().shape = shape;
    const Stage stage(scene, 40, 40, light_samples(64));
    const ParallelSquare exact(stage);
    const auto on_floor = [&](std::size_t i) { return exact.on_floor(i); };
    for (const auto& [factory, bound] :
         {std::pair(Factory(maps::make_accumulate), 0.02), std::pair(Factory(maps::make_pcss), 0.2)}) {
      const Masks result = run(factory, stage);
      EXPECT_LT(rmse(stage, on_floor, [&](std::size_t i) { return result.visibility[i] - exact.visibility(i); }),
                bound);
    }
  }
}

TEST_F(MapsMethod, TheBodyOfTheLightItselfDoesNotShadeAndIsLit) {
  scenes::Scene bare = parallel_square();
  scenes::Scene with_body = bare;
  add_quad(with_body, {0, 4.99, 0}, {1, 0, 0}, {0, 0, 1}).emits = 0;  // just below the light, which it would hide
  add_quad(with_body, {1.5, 0.5, 1}, {0.2, 0, 0}, {0, 0.3, 0.1}).emits = 0;
  with_body.soup.positions.emplace_back(0, -4.99, 0);  // keeps the bounding box's centre, and so all floats, the same
  bare.soup.positions.emplace_back(0, -4.99, 0);
  bare.soup.positions.emplace_back(0, 4.99, 0);
  const Stage without(bare, 48, 48, light_samples(16)), with(with_body, 48, 48, light_samples(16));
  ASSERT_EQ(without.floats.origin, with.floats.origin);
  for (const Factory& factory : all_) {
    // A body in front of a hard shadow's border hides the border from arvo's flood on the screen.
    if (factory(device(), {})->description().name == "arvo") continue;
    const Masks a = run(factory, without), b = run(factory, with);
    std::size_t bodies = 0;
    for (std::size_t i = 0; i < without.samples.size(); ++i) {
      const std::int32_t triangle = with.samples.triangle[i];
      if (triangle >= 0 && with.floats.emits[static_cast<std::size_t>(triangle)] == 0) {
        ++bodies;
        EXPECT_EQ(b.visibility[i], 1.0f);
      } else {
        EXPECT_EQ(a.visibility[i], b.visibility[i]);
      }
    }
    EXPECT_GT(bodies, 0u);
  }
}

TEST_F(MapsMethod, WhatCastsNoShadowShadesNothingAndWhatReceivesNoneIsLit) {
  scenes::Scene scene = parallel_square();
  scene.objects[1].casts_shadow = false;
  const Stage no_caster(scene, 32, 32, light_samples(5));
  scene.objects[0].receives_shadow = false;
  scene.objects[1].casts_shadow = true;
  const Stage no_receiver(scene, 32, 32, light_samples(5));
  for (const Factory& factory : all_) {
    // Splats of forward-map end at the floor's border.
    if (factory(device(), {})->description().name == "forward-map") continue;
    for (const Stage* stage : {&no_caster, &no_receiver}) {
      const Masks result = run(factory, *stage);
      const ParallelSquare exact(*stage);
      for (std::size_t i = 0; i < stage->samples.size(); ++i) {
        if (exact.on_floor(i)) {
          EXPECT_EQ(result.visibility[i], 1.0f);
        }
      }
    }
  }
}

TEST_F(MapsMethod, AnOccluderThatCrossesTheLightsPlaneIsCutNotLost) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, 3});
  // A tall upright wall from the floor to far above the light: it separates the floor's right side from the light.
  add_quad(scene, {1, 10, 0}, {0, 10, 0}, {0, 0, 6});
  scene.lights.push_back(ceiling_light(2, 0.5));
  scene.cameras.push_back(camera({-1, 4, 6}, {0.5, 0, 0}, 50));
  const Stage stage(scene, 48, 48, light_samples(16));
  const Masks result = run(maps::make_accumulate, stage);
  std::size_t lit = 0, dark = 0, wrong = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    const std::int32_t triangle = stage.samples.triangle[i];
    if (triangle < 0 || stage.floats.object[static_cast<std::size_t>(triangle)] != 0) continue;
    const double x = stage.samples.p[i].x + stage.floats.origin.x;
    if (std::abs(x - 1) < 0.05) continue;  // within a few texels of the wall's foot
    (x < 1 ? lit : dark) += 1;
    wrong += result.visibility[i] != (x < 1 ? 1.0f : 0.0f) ? 1 : 0;
  }
  EXPECT_GT(lit, 0u);
  EXPECT_EQ(wrong, 0u) << lit << " lit, " << dark << " dark";
}

}  // namespace
}  // namespace penumbra::tests
