// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.hpp"
#include "mesh/import.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>  // also declares mkdtemp
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>

namespace penumbra::test {

/// Returns the message of the InputError that `call` throws; "" and a test failure if it throws none.
template <typename Call>
std::string input_error(Call call) {
  try {
    call();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const InputError& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not an InputError: " << error.what();
  }
  return "";
}

/// A test that has its own folder, deleted afterwards.
class FileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "penumbra-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, std::string_view content) const {
    auto path = folder_ / name;
    std::ofstream(path, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
    return path;
  }
  /// Expects that a mesh file of this content is refused with a message that has its path and these words.
  void expect_refused(const std::string& name, std::string_view content,
                      std::initializer_list<std::string> words) const {
    SCOPED_TRACE(name);
    const auto path = write(name, content);
    const std::string message = input_error([&] { mesh::import_mesh(path); });
    EXPECT_THAT(message, ::testing::HasSubstr(path.string()));
    for (const std::string& word : words) EXPECT_THAT(message, ::testing::HasSubstr(word));
  }
  std::filesystem::path folder_;
};

/// Returns the position of a corner of one of the soup's triangles.
inline glm::dvec3 corner(const mesh::TriangleSoup& soup, std::size_t triangle, std::size_t i) {
  return soup.positions[soup.triangles[triangle][i]];
}

/// Returns the little-endian bytes of numbers, one after the other; big-endian with Swap.
template <bool Swap = false, typename... Numbers>
std::string bytes_of(Numbers... numbers) {
  std::string all;
  const auto append = [&](auto number) {
    std::string one(reinterpret_cast<const char*>(&number), sizeof(number));
    all += Swap ? std::string(one.rbegin(), one.rend()) : one;
  };
  (append(numbers), ...);
  return all;
}

}  // namespace penumbra::test
