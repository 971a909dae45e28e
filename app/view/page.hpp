// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace penumbra::app {

/// Parts of the page: app/view/page/.
extern const std::string_view kViewStyle, kViewScript, kViewMarkup;

/// The script of three.js, as the package libjs-three had it when the program was built; empty: it was not there.
extern const std::string_view kThreeScript;

}  // namespace penumbra::app
