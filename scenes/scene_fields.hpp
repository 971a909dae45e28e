// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/instances.hpp"
#include "scenes/scene.hpp"

#include <concepts>
#include <tuple>
#include <type_traits>

/// Fields of a scene that the import helper sends, in this order: named once for sender and receiver. Object::lit_by
/// and AreaLight::texture belong to formats that the helper does not read; Scene::sources are sent separately.
namespace penumbra::scenes {

template <typename T, typename Part>
concept Is = std::same_as<std::remove_const_t<T>, Part>;

auto fields_of(Is<Rectangle> auto& shape) {
  return std::tie(shape.center, shape.half_u, shape.half_v);
}
auto fields_of(Is<Disk> auto& shape) {
  return std::tie(shape.center, shape.normal, shape.radius);
}
auto fields_of(Is<Polygon> auto& shape) {
  return std::tie(shape.vertices);
}
auto fields_of(Is<Cone> auto& cone) {
  return std::tie(cone.direction, cone.inner, cone.outer, cone.smooth);
}
auto fields_of(Is<Sphere> auto& shape) {
  return std::tie(shape.center, shape.radius, shape.cone);
}
auto fields_of(Is<Ellipse> auto& shape) {
  return std::tie(shape.center, shape.half_u, shape.half_v);
}
auto fields_of(Is<Sun> auto& shape) {
  return std::tie(shape.direction, shape.angle);
}
auto fields_of(Is<Dome> auto& shape) {
  return std::tie(shape.up, shape.rotate, shape.half, shape.sampled, shape.image);
}
auto fields_of(Is<Pieces> auto& shape) {
  return std::tie(shape.pieces);
}
auto fields_of(Is<AreaLight> auto& light) {
  return std::tie(light.name, light.shape, light.radiance, light.two_sided, light.unshaded_by, light.visible);
}
auto fields_of(Is<PictureUse> auto& use) {
  return std::tie(use.picture, use.wrap_s, use.wrap_t, use.nearest);
}
auto fields_of(Is<Alpha> auto& alpha) {
  return std::tie(alpha.mode, alpha.factor, alpha.cutoff);
}
auto fields_of(Is<Object> auto& object) {
  return std::tie(object.name, object.color, object.casts_shadow, object.receives_shadow, object.emits, object.material,
                  object.picture, object.alpha);
}
auto fields_of(Is<Picture> auto& picture) {
  return std::tie(picture.file, picture.width, picture.height, picture.texels);
}
auto fields_of(Is<ThinLens> auto& lens) {
  return std::tie(lens.radius, lens.focus_distance);
}
auto fields_of(Is<Camera> auto& camera) {
  return std::tie(camera.name, camera.eye, camera.target, camera.up, camera.vertical_fov, camera.height, camera.aspect,
                  camera.shift, camera.lens);
}
auto fields_of(Is<VertexLooks> auto& looks) {
  return std::tie(looks.normals, looks.colors, looks.places);
}
auto fields_of(Is<Motion> auto& motion) {
  return std::tie(motion.first, motion.last);
}
auto fields_of(Is<Scene> auto& scene) {
  return std::tie(scene.name, scene.width, scene.height, scene.soup, scene.looks, scene.objects, scene.pictures,
                  scene.lights, scene.cameras, scene.origin, scene.motion, scene.warnings);
}

auto fields_of(Is<SharedMesh> auto& mesh) {
  return std::tie(mesh.soup, mesh.normals, mesh.colors, mesh.places);
}
auto fields_of(Is<Placement> auto& placement) {
  return std::tie(placement.to_world, placement.offset_last);
}
auto fields_of(Is<Instance> auto& instance) {
  return std::tie(instance.mesh, instance.object, instance.placement, instance.soup_before);
}
auto fields_of(Is<Instances> auto& instances) {
  return std::tie(instances.meshes, instances.all);
}

template <typename T>
concept HasFields = requires(T& part) {
  fields_of(part);
};

/// Types that are sent as stored in memory, lists of them in one piece.
template <typename T>
concept IsNumber = std::is_trivially_copyable_v<T> && !HasFields<T>;

}  // namespace penumbra::scenes
