#pragma once

#include "bench/options.hpp"
#include "render/device.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::bench {

/// What a subject's runs have in common, whatever the light samples.
struct Ground {
  scenes::Scene scene;
  visibility::SceneFloats floats;
  visibility::ViewSamples samples;
  std::vector<visibility::PixelClass> classes;  ///< for the first light
  std::vector<std::uint32_t> judged;            ///< pixels of that class, in order
};
Ground make_ground(const Subject& subject, const render::Device& device);

/// The first light with light samples: those that methods get, or jittered ones (seed 0).
visibility::Light light_of(const Ground& ground, std::uint32_t samples,
                           visibility::SamplePattern pattern = visibility::SamplePattern::rows, std::uint32_t seed = 0);

/// What all contestants are asked, and what the oracle (`raytrace`) says to it.
struct Question {
  const Ground& ground;
  const visibility::Light& light;
  std::vector<float> truth;          ///< V of each pixel; empty until the oracle has run
  std::vector<std::uint32_t> masks;  ///< its masks; empty where nobody compares pairs
};

/// V that owes nothing to the light samples of a question.
struct ReferenceVisibility {
  std::string name;                   ///< "raytrace at 16384 light samples", "exact"
  std::vector<float> visibility;      ///< of each pixel
  std::vector<std::uint32_t> pixels;  ///< that are compared
};
/// raytrace: Owen-scrambled Sobol samples in passes of up to 4096, each with a seed of its own, over judged pixels.
/// exact: over the pixels chosen among those that are judged and in penumbra by 64 light samples.
ReferenceVisibility make_reference(const Ground& ground, const Options& options);

/// The pixels that the fair peer must still ask about: those of 8 × 8 blocks in which V is 0 < V < 1 somewhere or
/// differs, among the view samples that ask at all (no background, emitter or receiver without shadow). Elsewhere a
/// block is lit or dark throughout, as far as the light samples know. One entry a pixel, 1 where it must.
std::vector<std::uint8_t> nontrivial_pixels(const Question& question);

}  // namespace penumbra::bench
