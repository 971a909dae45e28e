// SPDX-License-Identifier: Apache-2.0
// Combines the results of a light's pieces.

#include "session/whole_lights.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <utility>

namespace penumbra::session {

using visibility::Light;
using visibility::PixelClass;

std::vector<WholeLight> whole_lights(std::span<const Light> lights) {
  std::vector<WholeLight> wholes;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights[i].piece == 0)
      wholes.push_back({i, 1});
    else
      ++wholes.back().count;
    PENUMBRA_ASSERT(lights[i].piece + 1 == wholes.back().count, "piece {} of light {} follows {} others",
                    lights[i].piece, lights[i].name, wholes.back().count - 1);
  }
  return wholes;
}

std::vector<std::string> whole_names(std::span<const Light> lights) {
  std::vector<std::string> names;
  for (const WholeLight& whole : whole_lights(lights)) names.push_back(lights[whole.first].name);
  return names;
}

std::vector<std::size_t> wholes_of_pieces(std::span<const Light> lights) {
  std::vector<std::size_t> wholes;
  for (const Light& light : lights)
    wholes.push_back(light.piece > 0 ? wholes.back() : wholes.empty() ? 0 : wholes.back() + 1);
  return wholes;
}

std::vector<PixelClass> whole_classes(const WholeLight& whole, std::span<const std::vector<PixelClass>> pieces) {
  std::vector<PixelClass> classes = pieces[whole.first];
  for (std::size_t piece = whole.first + 1; piece < whole.first + whole.count; ++piece) {
    for (std::size_t i = 0; i < classes.size(); ++i) {
      const PixelClass other = pieces[piece][i];
      if (classes[i] == PixelClass::behind || other == PixelClass::horizon) classes[i] = other;
    }
  }
  return classes;
}

std::vector<float> whole_visibility(const WholeLight& whole, std::span<const Light> lights,
                                    std::span<const std::vector<PixelClass>> classes,
                                    std::span<const std::vector<float>> visibility) {
  if (whole.count == 1) return visibility[whole.first];
  std::vector<double> seen(visibility[whole.first].size(), 0), area(seen.size(), 0);
  for (std::size_t piece = whole.first; piece < whole.first + whole.count; ++piece) {
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (classes[piece][i] == PixelClass::behind) continue;
      seen[i] += lights[piece].area * static_cast<double>(visibility[piece][i]);
      area[i] += lights[piece].area;
    }
  }
  std::vector<float> v(seen.size(), 0);
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (area[i] > 0) v[i] = std::min(static_cast<float>(seen[i] / area[i]), 1.0F);
  }
  return v;
}

MethodRun of_whole_lights(MethodRun run, const Session& session) {
  const std::vector<WholeLight> wholes = whole_lights(session.lights);
  if (wholes.size() == session.lights.size()) return run;
  std::vector<std::vector<float>> visibility;
  std::vector<LightTimes> times;
  for (const WholeLight& whole : wholes) {
    visibility.push_back(whole.count == 1 ? std::move(run.visibility[whole.first])
                                          : whole_visibility(whole, session.lights, session.classes, run.visibility));
    LightTimes& sum = times.emplace_back();
    for (std::size_t piece = whole.first; piece < whole.first + whole.count; ++piece) {
      sum.light += run.times.lights[piece].light;
      sum.evaluate += run.times.lights[piece].evaluate;
      std::vector<float>().swap(run.visibility[piece]);
    }
  }
  run.visibility = std::move(visibility);
  run.times.lights = std::move(times);
  return run;
}

}  // namespace penumbra::session
