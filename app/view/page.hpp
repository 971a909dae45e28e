#pragma once

#include <string_view>

namespace penumbra::app {

/// The page's parts: app/view/page/.
extern const std::string_view kViewStyle, kViewScript, kViewMarkup;

}  // namespace penumbra::app
