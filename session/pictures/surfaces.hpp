// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/session.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Object and material of each view sample.
class Surfaces {
 public:
  static constexpr std::uint32_t kNothing = 0xffffffffu;

  /// `session` must outlive this object.
  explicit Surfaces(const Session& session);

  [[nodiscard]] std::span<const std::string> objects() const& { return objects_; }  ///< names
  std::span<const std::string> objects() const&& = delete;
  [[nodiscard]] std::span<const std::string> materials() const& { return materials_; }
  std::span<const std::string> materials() const&& = delete;
  /// Return the index of a view sample's object or material, or kNothing.
  [[nodiscard]] std::uint32_t object(std::size_t view_sample) const;
  [[nodiscard]] std::uint32_t material(std::size_t view_sample) const;

 private:
  const Session* session_;
  std::vector<std::string> objects_, materials_;
  std::vector<std::uint32_t> material_of_;  // of each object
};

}  // namespace penumbra::session
