// SPDX-License-Identifier: Apache-2.0
// Writes Cryptomatte layers (Friedman, Jones: "Cryptomatte specification" 1.2, 2018; MurmurHash3, Appleby 2011).

#include "session/pictures/cryptomatte.hpp"

#include "session/pictures/surfaces.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>

namespace penumbra::session {
namespace {

std::uint32_t id_bits(std::string_view name) {
  const std::uint32_t hash = murmur3(name);
  const std::uint32_t exponent = hash >> 23 & 255;
  return exponent == 0 || exponent == 255 ? hash ^ (1u << 23) : hash;
}

}  // namespace

std::uint32_t murmur3(std::string_view text) {
  constexpr std::uint32_t kFirst = 0xcc9e2d51, kSecond = 0x1b873593;
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  const auto mixed = [](std::uint32_t k) { return std::rotl(k * kFirst, 15) * kSecond; };
  std::uint32_t hash = 0;
  std::size_t at = 0;
  for (; at + 4 <= text.size(); at += 4) {
    hash ^= mixed(byte(at) | byte(at + 1) << 8 | byte(at + 2) << 16 | byte(at + 3) << 24);
    hash = std::rotl(hash, 13) * 5 + 0xe6546b64;
  }
  std::uint32_t rest = 0;
  for (std::size_t i = text.size(); i-- > at;) rest = rest << 8 | byte(i);
  hash ^= mixed(rest);
  hash ^= static_cast<std::uint32_t>(text.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6b;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35;
  return hash ^ hash >> 16;
}

float cryptomatte_id(std::string_view name) {
  return std::bit_cast<float>(id_bits(name));
}

void Cryptomatte::take_names(std::span<const std::string> names) {
  nlohmann::json manifest = nlohmann::json::object();
  for (const std::string& name : names) {
    numbers_.push_back(cryptomatte_id(name));
    manifest[name] = fmt::format("{:08x}", id_bits(name));
  }
  manifest_ = manifest.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Cryptomatte::Cryptomatte(std::string layer, std::span<const std::string> names, NameOf name_of)
    : layer_(std::move(layer)), name_of_(std::move(name_of)) {
  take_names(names);
}

Cryptomatte::Cryptomatte(std::string layer, const MatteShares& shares) : layer_(std::move(layer)), shares_(&shares) {
  take_names(shares.names());
}

ExrValues Cryptomatte::channel(std::size_t rank, bool is_coverage) const {
  if (shares_ != nullptr) {
    return [this, rank, is_coverage](std::size_t first, std::span<float> values) {
      std::size_t x = first % shares_->width(), y = first / shares_->width();
      for (float& value : values) {
        const std::span<const MatteShares::Share> here = shares_->of_pixel(x, y);
        value = rank >= here.size() ? 0.0f : is_coverage ? here[rank].part : numbers_[here[rank].name];
        if (++x < shares_->width()) continue;
        x = 0;
        ++y;
      }
    };
  }
  if (rank != 0) return [](std::size_t /*first*/, std::span<float> values) { std::ranges::fill(values, 0.0f); };
  return [this, is_coverage](std::size_t first, std::span<float> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::uint32_t name = name_of_(first + i);
      values[i] = name == Surfaces::kNothing ? 0.0f : is_coverage ? 1.0f : numbers_[name];
    }
  };
}

void Cryptomatte::add_to(ExrImage& image) const {
  const std::size_t ranks = shares_ != nullptr ? kRanks : 2;
  for (std::size_t rank = 0; rank < ranks; ++rank) {
    const char* const letters = rank % 2 == 0 ? "RG" : "BA";
    const std::string group = fmt::format("{}{:02}.", layer_, rank / 2);
    image.channels.push_back({group + letters[0], channel(rank, false)});
    image.channels.push_back({group + letters[1], channel(rank, true)});
  }
  const std::string key = fmt::format("cryptomatte/{:.7}/", fmt::format("{:08x}", murmur3(layer_)));
  image.attributes[key + "name"] = layer_;
  image.attributes[key + "hash"] = "MurmurHash3_32";
  image.attributes[key + "conversion"] = "uint32_to_float32";
  image.attributes[key + "manifest"] = manifest_;
}

}  // namespace penumbra::session
