// SPDX-License-Identifier: Apache-2.0
// Disks: circles given by a radius, with axes chosen around the normal.

#include "visibility/axes_around.hpp"
#include "visibility/lights/kinds/light_kinds.hpp"

#include <glm/geometric.hpp>

#include <numbers>
#include <variant>

namespace penumbra::visibility {
namespace {

void make_disk(const scenes::LightShape& shape, const LightBuilder& to) {
  const auto& [center, normal, radius] = std::get<scenes::Disk>(shape);
  to.light.radius = radius;
  const double length = glm::length(normal);
  if (!(radius > 0)) to.refuse_zero_area(" (its radius is not positive)");
  if (!(length > 0)) to.refuse_zero_area(" (its normal is zero)");
  to.light.area = std::numbers::pi * radius * radius;
  const Axes axes = axes_around(normal / length);
  to.add_round(center, radius * axes.u, radius * axes.v);
}

}  // namespace

const LightBehaviour kDiskBehaviour{make_disk, is_round_above_horizon, circle_form_factor};

}  // namespace penumbra::visibility
