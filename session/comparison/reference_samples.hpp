// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/options.hpp"
#include "session/session.hpp"
#include "visibility/light_samples.hpp"

#include <string>
#include <vector>

namespace penumbra::session {

/// Returns the light samples of the reference: the methods' own (`wanted` is "same"), or a different number, by the
/// same pattern. Throws UsageError for any other text.
visibility::SampleRequest reference_samples(const RunOptions& run, const std::string& wanted);

/// Returns the session's lights, piece by piece, with other light samples.
std::vector<visibility::Light> with_samples(const Session& session, const visibility::SampleRequest& request);

}  // namespace penumbra::session
