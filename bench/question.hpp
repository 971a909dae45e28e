// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/options.hpp"
#include "render/machine.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::bench {

/// Data of a subject, independent of the number of light samples.
struct Ground {
  scenes::Scene scene;
  visibility::SceneFloats floats;
  visibility::ViewSamples samples;
  std::vector<visibility::PixelClass> classes;                          ///< for the first light
  std::vector<std::uint32_t> judged;                                    ///< judged pixels, in order
  visibility::SamplePattern pattern = visibility::SamplePattern::rows;  ///< of light samples
};
Ground make_ground(const Subject& subject, const render::Machine& machine);

/// Returns the first light with light samples: those given to methods, or others.
visibility::Light light_of(const Ground& ground, std::uint32_t samples,
                           std::optional<visibility::SamplePattern> pattern = {}, std::uint32_t seed = 0);

/// Task of all contestants, and the oracle's result (rays on the same light samples).
struct Question {
  const Ground& ground;
  const visibility::Light& light;
  std::vector<float> truth;          ///< V of each pixel; empty until the oracle has run
  std::vector<std::uint32_t> masks;  ///< the oracle's masks; empty if no pairs are compared
};

/// V independent of the light samples of a question.
struct ReferenceVisibility {
  std::string name;                   ///< the method's name, and the number of its light samples if any
  std::vector<float> visibility;      ///< one for each pixel
  std::vector<std::uint32_t> pixels;  ///< compared pixels
};
/// Returns the reference. By rays: Owen-scrambled Sobol samples in passes of up to 4096, each with a different
/// seed, over judged pixels. By areas: over pixels chosen among those judged pixels that are in penumbra according to
/// 64 light samples.
ReferenceVisibility make_reference(const Ground& ground, const Options& options, const render::Machine& machine);
/// Returns whether the reference computes areas.
bool takes_area(const Options& options);

/// Returns the pixels that nontrivial-rays must trace: those of the 8 × 8 blocks in which V of the evaluated view
/// samples (no background, emitter or receiver without shadow) is somewhere strictly between 0 and 1, or not uniform.
/// All other blocks are completely lit or dark, up to the resolution of the light samples. The result has one entry for
/// each pixel, 1 where a trace is needed.
std::vector<std::uint8_t> nontrivial_pixels(const Question& question);

}  // namespace penumbra::bench
