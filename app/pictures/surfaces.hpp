#pragma once

#include "app/session.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// Which object, and which material, each view sample shows.
class Surfaces {
 public:
  static constexpr std::uint32_t kNothing = 0xffffffffu;

  /// `session` must outlive it.
  explicit Surfaces(const Session& session);

  [[nodiscard]] std::span<const std::string> objects() const& { return objects_; }  ///< names
  std::span<const std::string> objects() const&& = delete;
  [[nodiscard]] std::span<const std::string> materials() const& { return materials_; }
  std::span<const std::string> materials() const&& = delete;
  /// What a view sample shows: an index into these, or kNothing.
  [[nodiscard]] std::uint32_t object(std::size_t view_sample) const;
  [[nodiscard]] std::uint32_t material(std::size_t view_sample) const;

 private:
  const Session* session_;
  std::vector<std::string> objects_, materials_;
  std::vector<std::uint32_t> material_of_;  // each object
};

}  // namespace penumbra::app
