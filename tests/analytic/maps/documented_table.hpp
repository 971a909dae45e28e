// SPDX-License-Identifier: Apache-2.0
#pragma once

// Compares tables on documentation pages with measurements.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace penumbra::tests {

/// The numbers of a Markdown table on a page, row by row, as text (its decimals give the precision). A minus sign may
/// be U+2212; stars and per cent signs are left out.
class DocumentedTable {
 public:
  /// `head`: the beginning of the table's first line.
  DocumentedTable(const std::filesystem::path& page, const std::string& head) {
    std::ifstream file(page);
    std::string line;
    bool inside = false;
    while (std::getline(file, line)) {
      if (!inside) {
        inside = line.starts_with(head);
        continue;
      }
      if (!line.starts_with('|')) break;
      if (line.starts_with("| ---")) continue;
      std::vector<std::string> row;
      std::stringstream cells(line.substr(1));
      for (std::string cell; std::getline(cells, cell, '|');) row.push_back(number(cell));
      rows_.push_back(row);
    }
    EXPECT_FALSE(rows_.empty()) << page << " has no table that begins with " << head;
  }

  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  [[nodiscard]] double value(std::size_t row, std::size_t column) const {
    return std::strtod(rows_.at(row).at(column).c_str(), nullptr);
  }
  /// Returns one unit of the last written digit.
  [[nodiscard]] double digit(std::size_t row, std::size_t column) const {
    const std::string& text = rows_.at(row).at(column);
    const std::size_t point = text.find('.');
    return point == std::string::npos ? 1 : std::pow(10, -static_cast<double>(text.size() - point - 1));
  }
  /// Expects agreement within a tenth of the value, because another driver may snap edges differently, and within a
  /// unit of the last digit for rounding.
  void expect(std::size_t row, std::size_t column, double measured) const {
    EXPECT_NEAR(measured, value(row, column), 0.1 * std::abs(value(row, column)) + digit(row, column))
        << "row " << row << ", column " << column;
  }

 private:
  static std::string number(const std::string& cell) {
    std::string text;
    for (std::size_t i = 0; i < cell.size(); ++i) {
      if (cell.compare(i, 3, "\u2212") == 0) {
        text += '-';
        i += 2;
      } else if (std::string("+0123456789.").find(cell[i]) != std::string::npos) {
        text += cell[i];
      }
    }
    return text;
  }

  std::vector<std::vector<std::string>> rows_;
};

}  // namespace penumbra::tests
