// SPDX-License-Identifier: Apache-2.0
// Uploads and draws faces fitted to a camera (docs/map-fits.md).

#include "maps/host/camera_faces.hpp"

#include "maps/host/map_method.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace penumbra::maps {

std::uint32_t CameraFaces::fit(const render::Device& device, const Source& source, const FaceFitOptions& options,
                               gpu::LightView& view) {
  return take(device, source, fit_faces(source.scene, source.light, source.basis, source.samples, options),
              options.size, view);
}

std::uint32_t CameraFaces::take(const render::Device& device, const Source& source, std::vector<FittedFace> faces,
                                std::uint32_t size, gpu::LightView& view) {
  faces_ = std::move(faces);
  const visibility::PinholeCamera& camera = source.samples.camera;
  const glm::dvec4 depth = source.space.plane({camera.forward, -glm::dot(camera.forward, camera.eye)}),
                   divisor = source.space.divisor();
  return make(device,
              {.forward = glm::vec3(depth),
               .offset = static_cast<float>(depth.w),
               .divisor = glm::vec3(divisor),
               .divisor_offset = static_cast<float>(divisor.w),
               .count = 0},
              source.basis, size, view);
}

std::uint32_t CameraFaces::take_paraboloids(const render::Device& device, const LightBasis& basis, std::uint32_t size,
                                            std::uint32_t spare, gpu::LightView& view) {
  faces_.clear();
  for (int side = 0; side < 2; ++side) {
    if (view.side[side].face_count > 0) faces_.push_back(paraboloid_face(side, size, spare));
  }
  // A paraboloid has points at all depths: its look-ups do not choose a face by depth.
  return make(device, {.forward = glm::vec3(0), .offset = 1, .divisor = glm::vec3(0), .divisor_offset = 1, .count = 0},
              basis, size, view);
}

std::uint32_t CameraFaces::make(const render::Device& device, gpu::FaceTable table, const LightBasis& basis,
                                std::uint32_t size, gpu::LightView& view) {
  std::uint32_t first = 0;
  for (int side = 0; side < 2; ++side) {
    const auto count = static_cast<std::uint32_t>(std::ranges::count(faces_, side, &FittedFace::side));
    view.side[side] = {.lower = {}, .upper = {}, .first_face = first, .face_count = count};
    first += count;
  }

  table.count = first;
  std::vector<std::uint32_t> words = push_words(table);
  pushes_.clear();
  for (const FittedFace& face : faces_) {
    const std::vector<std::uint32_t> more = push_words(face.rounded());
    words.insert(words.end(), more.begin(), more.end());
    FacePush& push = pushes_.emplace_back();
    if (face.ratio > 0 || face.circle) {
      push.logarithmic = logarithmic_push(face, view, basis, size);
    } else {
      push.plain = face_push(face, view, basis, size);
    }
  }
  // Look-ups read the first face even if there is none.
  words.resize(std::max(words.size(), (sizeof(gpu::FaceTable) + sizeof(gpu::FittedFace)) / sizeof(std::uint32_t)));
  render::grow(device, table_, "fitted faces", words.size() * sizeof(std::uint32_t));
  table_->write<std::uint32_t>(words);
  return first;
}

void CameraFaces::record(const CasterMaps& casters, render::Commands& commands, std::int32_t light_index,
                         const render::Buffer& maps, visibility::PassTimes& times) const {
  for (std::size_t first = 0; first < pushes_.size(); first += kFacesPerSubmission) {
    if (first != 0) times.add(commands.submit());
    const std::size_t count = std::min<std::size_t>(kFacesPerSubmission, pushes_.size() - first);
    casters.record(commands, std::span(pushes_).subspan(first, count), light_index, maps, first);
  }
}

void CameraFaces::record_behind(const CasterMaps& casters, render::Commands& commands, std::int32_t light_index,
                                const render::Buffer& maps, std::uint64_t first_face,
                                visibility::PassTimes& times) const {
  for (std::size_t first = 0; first < pushes_.size(); first += kFacesPerSubmission) {
    if (first != 0) times.add(commands.submit());
    const std::size_t count = std::min<std::size_t>(kFacesPerSubmission, pushes_.size() - first);
    casters.record_behind(commands, std::span(pushes_).subspan(first, count), light_index, maps, first_face + first,
                          first_face - pushes_.size() + first);
  }
}

}  // namespace penumbra::maps
