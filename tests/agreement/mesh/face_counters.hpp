// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Counts of surfaces (faces with three corners or more) in mesh files, by code that shares nothing with the readers.
namespace penumbra::test {

using FaceCount = std::optional<std::uint64_t>;  ///< nullopt if the counter cannot handle this file

/// Counts the file's surfaces, each as often as the file places it. Throws std::exception for a damaged file.
using FaceCounter = FaceCount (*)(const std::filesystem::path& file);

/// The counters, by file extension in lower case.
const std::map<std::string, FaceCounter>& face_counters();

// Code that the counters share.

std::string bytes_of_file(const std::filesystem::path& file);
/// Returns the text in UTF-8, whatever the file's byte order mark.
std::string text_of_file(const std::filesystem::path& file);
std::vector<std::string_view> lines_of(std::string_view text);
std::vector<std::string_view> words_of(std::string_view text, std::string_view blanks = " \t\r\n\v\f");

FaceCount count_3ds(const std::filesystem::path& file);
FaceCount count_gltf(const std::filesystem::path& file);
FaceCount count_lwo(const std::filesystem::path& file);
FaceCount count_md2(const std::filesystem::path& file);
FaceCount count_ms3d(const std::filesystem::path& file);
FaceCount count_ply(const std::filesystem::path& file);
FaceCount count_stl(const std::filesystem::path& file);

}  // namespace penumbra::test
