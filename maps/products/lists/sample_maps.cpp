// SPDX-License-Identifier: Apache-2.0
// Renders and keeps the maps of all light samples on the device, with integer weights of the samples.

#include "maps/products/lists/sample_maps.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace penumbra::maps {

std::vector<std::uint32_t> integer_weights(const visibility::Light& light) {
  std::vector<std::uint32_t> weights(light.sample_count(), 1);
  // The weights add up to 2^24: each is off by at most 2^-25 of the light, in total 0.00012 for 4096 samples.
  std::ranges::transform(light.weights, weights.begin(),
                         [](double weight) { return static_cast<std::uint32_t>(std::lround(std::ldexp(weight, 24))); });
  return weights;
}

void SamplePoints::make(const MapSource& source) {
  const std::vector<std::uint32_t> weights = integer_weights(source.light);
  std::vector<glm::vec3> points;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const glm::dvec3 at = source.basis.local(source.light.points[i]);
    points.emplace_back(at.x, at.y, weights[i]);
  }
  render::grow(*device_, points_, "sample points", points.size() * sizeof(glm::vec3));
  points_->write<glm::vec3>(points);
}

void SampleMaps::make(const MapSource& source) {
  const FittedViews fitted =
      fit_views(source.scene, source.light, source.basis, source.light.points, {.size = source.size});
  count_ = source.light.sample_count();
  faces_ = fitted.faces;
  const std::uint32_t faces = std::max(faces_, 1u);
  check_faces_fit(*device_, source.size, faces);
  const std::vector<std::uint32_t> weights = integer_weights(source.light);
  total_ = std::accumulate(weights.begin(), weights.end(), 0u);
  render::grow(*device_, weights_, "sample weights", weights.size() * sizeof(std::uint32_t));
  weights_->write<std::uint32_t>(weights);
  render::grow(*device_, views_, "sample views", fitted.views.size() * sizeof(gpu::LightView));
  views_->write<gpu::LightView>(fitted.views);

  per_buffer_ =
      static_cast<std::uint32_t>(std::clamp<std::uint64_t>(faces_per_buffer(*device_, source.size) / faces, 1, count_));
  maps_.resize((count_ + per_buffer_ - 1) / per_buffer_);
  for (const Part& part : parts()) {
    std::unique_ptr<render::Buffer>& buffer = maps_[part.first / per_buffer_];
    render::grow(*device_, buffer, "maps of samples",
                 std::uint64_t{part.count} * faces * source.size * source.size * sizeof(float));
    render::Commands commands(*device_);
    std::uint32_t recorded = 0;
    for (std::uint32_t k = 0; k < part.count && faces_ > 0; ++k) {
      source.casters.record(commands, fitted.views[part.first + k], source.basis, source.light.index, *buffer,
                            std::uint64_t{k} * faces_);
      recorded += faces_;
      if (recorded < kFacesPerSubmission) continue;
      source.times.add(commands.submit());
      recorded = 0;
    }
    source.times.add(commands.submit());
  }
  source.counters["sampleMaps"] = count_;
  source.counters["sampleMapFaces"] = std::uint64_t{count_} * faces_;
}

std::vector<SampleMaps::Part> SampleMaps::parts(std::uint32_t most) const {
  std::vector<Part> parts;
  for (std::uint32_t first = 0; first < count_;) {
    const std::uint32_t in_buffer = first % per_buffer_;
    const std::uint32_t count = std::min({per_buffer_ - in_buffer, count_ - first, most});
    parts.push_back({maps_[first / per_buffer_].get(), first, count, in_buffer * faces_});
    first += count;
  }
  return parts;
}

std::uint64_t SampleMaps::memory_bytes() const {
  std::uint64_t bytes = 0;
  for (const std::unique_ptr<render::Buffer>& buffer : maps_) bytes += buffer ? buffer->bytes() : 0;
  for (const auto* buffer : {&views_, &weights_}) bytes += *buffer ? (*buffer)->bytes() : 0;
  return bytes;
}

}  // namespace penumbra::maps
