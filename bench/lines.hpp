// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/cpu.hpp"
#include "bench/entry.hpp"

#include <string>

namespace penumbra::bench {

/// Return the table on stdout, one row for each contestant. `penumbra`: only pixels in penumbra are compared with the
/// reference.
std::string table_head(bool penumbra);
std::string table_rows(const Entry& entry);

/// Returns one JSON line for each contestant, with a name that never changes ("bunny/n=1024/edge-scatter").
std::string json_lines(const Entry& entry, const Options& options);

/// Return the head and the rows of the table printed by --cpu.
std::string cpu_table_head();
std::string cpu_table_row(const CpuEntry& entry);
std::string json_line(const CpuEntry& entry, const Options& options);

}  // namespace penumbra::bench
