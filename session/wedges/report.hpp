// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/wedges/coverage.hpp"
#include "session/wedges/explain.hpp"
#include "visibility/light_samples.hpp"
#include "volumes/wedges/wedge_tightness.hpp"
#include "volumes/wedges/wedge_validation.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace penumbra::session {

/// Results of `wedges`.
struct WedgesResult {
  const visibility::Light& light;
  const volumes::LightHull& hull;
  glm::dvec3 origin{0};
  std::string construction, from;  ///< as on the command line
  std::span<const volumes::Wedge> wedges;
  const volumes::ValidationReport* validation = nullptr;  ///< set if requested
  const volumes::Tightness* tightness = nullptr;
  const CoverageOutcome* coverage = nullptr;
  const Explanation* explanation = nullptr;
  std::filesystem::path svg{};  ///< of the explanation
};

/// Returns the JSON of `wedges --json`, with "counts", if validated also "checks", "tightness" and "coverage", and for
/// an explained pixel "explain".
std::string wedges_json(const WedgesResult& result);

/// Prints the results on stdout: number of wedges of each outcome, proofs, the first violations.
void print_wedges(const WedgesResult& result);

}  // namespace penumbra::session
