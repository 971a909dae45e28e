#pragma once

#include "bench/cpu.hpp"
#include "bench/entry.hpp"

#include <string>

namespace penumbra::bench {

/// The table on stdout, a row a contestant. `penumbra`: the reference judges pixels in penumbra alone.
std::string table_head(bool penumbra);
std::string table_rows(const Entry& entry);

/// One JSON line a contestant, each with its name ("bunny/n=1024/edge-scatter"), which never changes.
std::string json_lines(const Entry& entry, const Options& options);

/// Head and rows of the table that --cpu prints.
std::string cpu_table_head();
std::string cpu_table_row(const CpuEntry& entry);
std::string json_line(const CpuEntry& entry, const Options& options);

}  // namespace penumbra::bench
