// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace penumbra::import {

/// Returns a file's content in the form that its reader needs: a text format without its byte order mark, and in UTF-8
/// if the mark indicates UTF-16 or UTF-32; any other content unchanged. `extension` in lower case. Throws InputError
/// for invalid text.
std::string utf8_content(std::string content, const std::string& extension, const std::string& file);

}  // namespace penumbra::import
