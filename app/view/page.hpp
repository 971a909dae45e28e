// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace penumbra::app {

/// Parts of the page, from the files in app/view/page/.
extern const std::string_view kViewStyle, kViewScript, kViewMarkup;

/// Script of three.js from the package libjs-three; empty if the package was not installed when the program was built.
extern const std::string_view kThreeScript;

}  // namespace penumbra::app
