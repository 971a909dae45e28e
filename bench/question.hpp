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

/// What a subject's runs have in common, whatever the light samples.
struct Ground {
  scenes::Scene scene;
  visibility::SceneFloats floats;
  visibility::ViewSamples samples;
  std::vector<visibility::PixelClass> classes;                          ///< for the first light
  std::vector<std::uint32_t> judged;                                    ///< pixels of that class, in order
  visibility::SamplePattern pattern = visibility::SamplePattern::rows;  ///< of light samples
};
Ground make_ground(const Subject& subject, const render::Machine& machine);

/// The first light with light samples: those that methods get, or others.
visibility::Light light_of(const Ground& ground, std::uint32_t samples,
                           std::optional<visibility::SamplePattern> pattern = {}, std::uint32_t seed = 0);

/// What all contestants are asked, and what the oracle (rays on the same light samples) answers.
struct Question {
  const Ground& ground;
  const visibility::Light& light;
  std::vector<float> truth;          ///< V of each pixel; empty until the oracle has run
  std::vector<std::uint32_t> masks;  ///< the oracle's masks; empty if no pairs are compared
};

/// V that does not depend on the light samples of a question.
struct ReferenceVisibility {
  std::string name;                   ///< the method's, and how many light samples if it takes them
  std::vector<float> visibility;      ///< one for each pixel
  std::vector<std::uint32_t> pixels;  ///< those that are compared
};
/// By rays: Owen-scrambled Sobol samples in passes of up to 4096, each with a seed of its own, over judged pixels.
/// By areas: over the pixels chosen among those that are judged and in penumbra by 64 light samples.
ReferenceVisibility make_reference(const Ground& ground, const Options& options, const render::Machine& machine);
/// Is there a reference, and by areas?
bool takes_area(const Options& options);

/// The pixels that the fair peer must still trace: those of the 8 × 8 blocks in which V is between 0 and 1 somewhere,
/// or is not the same everywhere, among the view samples that are evaluated at all (no background, emitter or receiver
/// without shadow). All other blocks are lit or dark throughout, as far as the light samples can tell. One entry for
/// each pixel, 1 where it must be traced.
std::vector<std::uint8_t> nontrivial_pixels(const Question& question);

}  // namespace penumbra::bench
