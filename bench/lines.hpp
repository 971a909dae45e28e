#pragma once

#include "bench/entry.hpp"

#include <string>

namespace penumbra::bench {

/// The table on stdout, a row an entry.
std::string table_head();
std::string table_row(const Entry& entry);

/// One JSON line a contestant, each with its name ("bunny/view-sample"), which never changes.
std::string json_lines(const Entry& entry, const Options& options);

}  // namespace penumbra::bench
