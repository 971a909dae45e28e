// SPDX-License-Identifier: Apache-2.0
// Builds an Embree scene of chosen triangles, scaled into Embree's range, and converts Embree's errors to exceptions.

#include "reference/embree_scene.hpp"

#include "base/error.hpp"
#include "base/pages.hpp"
#include "base/parallel.hpp"

#include <embree3/rtcore.h>

#include <atomic>
#include <new>
#include <string>
#include <utility>

namespace penumbra::reference {

struct EmbreeScene::Parts {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<std::uint32_t> triangles;
  EmbreeRange range;
  // Shared with Embree, which reads from them; Embree's own arrays would be filled one small memory page at a time.
  UnsetList<glm::vec3> positions;
  UnsetList<mesh::Triangle> corners;
  std::atomic<std::int64_t> bytes = 0, peak_bytes = 0;

  Parts(const visibility::SceneFloats& floats, std::vector<std::uint32_t> chosen)
      : triangles(std::move(chosen)), range(floats, triangles) {}
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
  ~Parts() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  static bool count_memory(void* self, ssize_t change, bool /*after*/) {
    auto& parts = *static_cast<Parts*>(self);
    const std::int64_t now = parts.bytes += change;
    std::int64_t peak = parts.peak_bytes;
    while (now > peak && !parts.peak_bytes.compare_exchange_weak(peak, now)) {
    }
    return true;  // false would make Embree stop with an out-of-memory error
  }

  [[noreturn]] void throw_out_of_memory() const {
    throw ResourceError("Embree ran out of memory at {} MiB for {} triangles; free memory or simplify the scene",
                        bytes >> 20, triangles.size());
  }
  void check(RTCDevice from) const {
    const RTCError error = rtcGetDeviceError(from);
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw_out_of_memory();
    throw ResourceError("Embree failed with error {}{}; check that libembree3 supports this processor",
                        static_cast<int>(error), error == RTC_ERROR_UNSUPPORTED_CPU ? " (unsupported processor)" : "");
  }
};

EmbreeScene::EmbreeScene(const visibility::SceneFloats& scene, std::vector<std::uint32_t> chosen, Filter filter,
                         Build build)
    : parts_(std::make_unique<Parts>(scene, std::move(chosen))) {
  Parts& parts = *parts_;
  parts.device = rtcNewDevice(nullptr);
  if (parts.device == nullptr) {
    parts.check(nullptr);
    throw ResourceError("Embree could not create a device; check that libembree3 supports this processor");
  }
  rtcSetDeviceMemoryMonitorFunction(parts.device, Parts::count_memory, parts_.get());
  parts.scene = rtcNewScene(parts.device);
  parts.check(parts.device);
  const int flags = RTC_SCENE_FLAG_ROBUST | (filter == Filter::by_context ? RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION : 0);
  rtcSetSceneFlags(parts.scene, static_cast<RTCSceneFlags>(flags));
  const RTCBuildQuality quality = build == Build::high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
  rtcSetSceneBuildQuality(parts.scene, quality);

  if (!parts.triangles.empty()) {
    const std::size_t vertices = scene.positions.size(), count = parts.triangles.size();
    try {
      parts.positions.resize(vertices + 1);  // Embree reads sixteen bytes at the last vertex
      parts.corners.resize(count);
    } catch (const std::bad_alloc&) {
      parts.throw_out_of_memory();
    }
    parts.positions.back() = glm::vec3(0);
    for_each_index(vertices, [&](std::size_t i) { parts.positions[i] = parts.range.scaled(scene.positions[i]); });
    for_each_index(count, [&](std::size_t i) { parts.corners[i] = scene.triangles[parts.triangles[i]]; });
    Parts::count_memory(&parts, static_cast<ssize_t>(vertices * sizeof(glm::vec3) + count * sizeof(mesh::Triangle)),
                        false);
    RTCGeometry geometry = rtcNewGeometry(parts.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (geometry != nullptr) {
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, parts.positions.data(), 0,
                                 sizeof(glm::vec3), vertices);
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, parts.corners.data(), 0,
                                 sizeof(mesh::Triangle), count);
      rtcSetGeometryBuildQuality(geometry, quality);
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(parts.scene, geometry);
    }
    rtcReleaseGeometry(geometry);
    parts.check(parts.device);
  }
  rtcCommitScene(parts.scene);
  parts.check(parts.device);
}

EmbreeScene::~EmbreeScene() = default;
EmbreeScene::EmbreeScene(EmbreeScene&& other) noexcept = default;
EmbreeScene& EmbreeScene::operator=(EmbreeScene&& other) noexcept = default;

RTCSceneTy* EmbreeScene::handle() const {
  return parts_->scene;
}
const std::vector<std::uint32_t>& EmbreeScene::triangles() const {
  return parts_->triangles;
}
const EmbreeRange& EmbreeScene::range() const {
  return parts_->range;
}
int EmbreeScene::native_width() const {
  if (rtcGetDeviceProperty(parts_->device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0) return 16;
  return rtcGetDeviceProperty(parts_->device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0 ? 8 : 4;
}
std::uint64_t EmbreeScene::peak_bytes() const {
  return static_cast<std::uint64_t>(parts_->peak_bytes.load());
}
void EmbreeScene::check() const {
  parts_->check(parts_->device);
}

}  // namespace penumbra::reference
