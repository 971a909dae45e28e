#pragma once

#include <string_view>

namespace penumbra::app {

/// Parts of the page: app/view/page/.
extern const std::string_view kViewStyle, kViewScript, kViewMarkup;

}  // namespace penumbra::app
