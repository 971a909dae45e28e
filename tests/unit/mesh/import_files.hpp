#pragma once

#include "base/error.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace penumbra::test {

/// A test with a folder of its own, which goes with it.
class FileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "penumbra-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, std::string_view content) const {
    const auto path = folder_ / name;
    std::ofstream(path, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
    return path;
  }
  std::filesystem::path folder_;
};

/// Little-endian bytes of numbers, one after the other; Swap turns them big-endian.
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

/// The message of the InputError that `call` throws; "" with a failure if it throws none.
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

}  // namespace penumbra::test
