#pragma once

#include "app/wedges/coverage.hpp"
#include "app/wedges/explain.hpp"
#include "visibility/light_samples.hpp"
#include "volumes/wedges/wedge_tightness.hpp"
#include "volumes/wedges/wedge_validation.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace penumbra::app {

/// What `wedges` found out.
struct WedgesResult {
  const visibility::Light& light;
  const volumes::LightHull& hull;
  glm::dvec3 origin{0};
  std::string construction, from;  ///< as on the command line
  std::span<const volumes::Wedge> wedges;
  const volumes::ValidationReport* validation = nullptr;  ///< if it was asked for
  const volumes::Tightness* tightness = nullptr;
  const CoverageOutcome* coverage = nullptr;
  const Explanation* explanation = nullptr;
  std::filesystem::path svg{};  ///< of the explanation
};

/// The JSON of `wedges --json`, and beside it "counts", and if they were validated "checks",
/// "tightness" and "coverage", if
/// a pixel was to be explained "explain".
std::string wedges_json(const WedgesResult& result);

/// For people, on stdout: how many of which outcome, what was proved, the first violations.
void print_wedges(const WedgesResult& result);

}  // namespace penumbra::app
