// SPDX-License-Identifier: Apache-2.0
// Tests that lines of help end at the terminal's width.
#include "app/wrapped_lines.hpp"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::tests {
namespace {

using app::columns_of;
using app::wrapped_lines;

std::vector<std::string> lines_in(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> words_in(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

TEST(WrappedLines, BreakAtBlanks) {
  EXPECT_EQ(wrapped_lines("one two three", {.width = 80}), "one two three");
  EXPECT_EQ(wrapped_lines("one two three", {.width = 8}), "one two\nthree");
  EXPECT_EQ(wrapped_lines("one two three", {.width = 7, .indent = 2}), "one two\n  three");
  EXPECT_EQ(wrapped_lines("one two three", {.width = 9, .start = 4, .indent = 4}), "one\n    two\n    three");
  EXPECT_EQ(wrapped_lines("a\n  b c d\n", {.width = 5}), "a\n  b c\n  d\n") << "the rest of a line keeps its indent";
  EXPECT_EQ(wrapped_lines("a\nb", {.width = 9, .start = 3, .indent = 3}), "a\n   b");
  EXPECT_EQ(wrapped_lines("", {.width = 8}), "");
  EXPECT_EQ(wrapped_lines("\n", {.width = 8}), "\n");
}

TEST(WrappedLines, CountLettersAndNotBytes) {
  EXPECT_EQ(columns_of("8 … 1²"), 6u);
  EXPECT_EQ(wrapped_lines("8 … 1² x", {.width = 8}), "8 … 1² x");
  EXPECT_EQ(wrapped_lines("8 … 1² x", {.width = 7}), "8 … 1²\nx");
}

TEST(WrappedLines, LoseNoWordAndFitWhereWordsDo) {
  const std::string text = "a longer text, whose longest_word_is_this, with  two blanks,\n  and a line of its own: π";
  for (std::size_t width = 25; width < 100; ++width) {
    const std::string broken = wrapped_lines(text, {.width = width, .indent = 4});
    EXPECT_EQ(words_in(broken), words_in(text)) << width;
    for (const std::string& line : lines_in(broken)) EXPECT_LE(columns_of(line), width) << broken;
  }
  EXPECT_EQ(wrapped_lines("a much_too_long b", {.width = 4}), "a\nmuch_too_long\nb");
}

using HelpLines = ProgramTest;

TEST_F(HelpLines, EndWhereTheTerminalDoes) {
  std::string listed = run({"completion", "commands"}).out;
  std::ranges::replace(listed, ';', ' ');
  std::vector<std::string> commands = words_in(listed);
  ASSERT_GT(commands.size(), 10u);
  commands.insert(commands.begin(), "");
  // Standard output is no terminal here: without COLUMNS its width is unknown.
  const std::vector<std::pair<const char*, std::size_t>> terminals = {{"", 80}, {"57", 57}, {"400", 100}};
  for (const std::string& command : commands) {
    std::vector<std::string> words;
    for (const auto& [columns, width] : terminals) {
      const std::vector<std::string> arguments = {command, "--help"};
      const Outcome help =
          run({arguments.begin() + (command.empty() ? 1 : 0), arguments.end()}, {{"COLUMNS", columns}});
      ASSERT_EQ(help.code, 0) << command << ": " << help.err;
      for (const std::string& line : lines_in(help.out)) EXPECT_LE(columns_of(line), width) << command << ": " << line;
      if (words.empty()) words = words_in(help.out);
      EXPECT_EQ(words_in(help.out), words) << command << ": the same words in any width";
    }
  }
}

TEST_F(HelpLines, ShowAnExampleOfEachCommand) {
  std::string listed = run({"completion", "commands"}).out;
  std::ranges::replace(listed, ';', ' ');
  for (const std::string& command : words_in(listed)) {
    const std::string example = "penumbra " + command;
    const std::vector<std::string> lines = lines_in(run({"help", command}, {{"COLUMNS", "100"}}).out);
    const auto head = std::ranges::find(lines, "Example:");
    ASSERT_LT(head - lines.begin() + 1, std::ssize(lines)) << command;
    EXPECT_TRUE(head[1].starts_with("  " + example)) << head[1];
    EXPECT_THAT(run({"man", command}).out, testing::HasSubstr(".SH EXAMPLES\n.nf\n" + example)) << command;
  }
  EXPECT_THAT(run({"help"}).out, testing::Not(testing::HasSubstr("Example:")));
}

}  // namespace
}  // namespace penumbra::tests
