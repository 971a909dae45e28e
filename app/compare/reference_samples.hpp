#pragma once

#include "app/options.hpp"
#include "app/session.hpp"
#include "visibility/light_samples.hpp"

#include <string>
#include <vector>

namespace penumbra::app {

/// Which light samples the reference looks at: the methods' own (`wanted` is "same"), or a number of its own, by the
/// same pattern. UsageError for what is neither.
visibility::SampleRequest reference_samples(const RunOptions& run, const std::string& wanted);

/// The session's lights again, piece by piece, with other light samples.
std::vector<visibility::Light> with_samples(const Session& session, const visibility::SampleRequest& request);

}  // namespace penumbra::app
