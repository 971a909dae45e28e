// SPDX-License-Identifier: Apache-2.0
// consumer SCENE.json: renders with the installed library, and prints some results. Replaces operator new, which a
// library must leave to the calling program.

#include <penumbra/penumbra.hpp>

#include <cstdlib>
#include <iostream>
#include <new>

namespace {
std::size_t allocations = 0;
}

void* operator new(std::size_t bytes) {
  ++allocations;
  if (void* const memory = std::malloc(bytes == 0 ? 1 : bytes)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

int main(int count, char** arguments) {
  if (count != 2) return 2;
  penumbra::Scene scene = penumbra::Scene::load(arguments[1]);
  penumbra::Scene made;
  const std::array<penumbra::Vector, 3> positions = {{{-1, 0, 1}, {1, 0, 1}, {0, 0, -1}}};
  const std::array<std::array<std::uint32_t, 3>, 1> triangles = {{{0, 1, 2}}};
  const auto mesh = made.add_mesh("box", positions, triangles);
  made.add_light("key", penumbra::Rectangle{.center = {0, 5, 0}, .half_u = {1, 0, 0}, .half_v = {0, 0, 1}},
                 {.radiance = {10, 10, 10}});
  made.set_camera({.eye = {3, 3, 3}, .target = {0, 0, 0}, .vertical_fov = 45});
  made.set_transform(mesh, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  penumbra::Renderer renderer(std::move(scene));
  const penumbra::Picture a = renderer.render({.width = 64, .height = 64});
  const penumbra::Picture b =
      renderer.render({.width = 64, .height = 64, .method = "edge-scatter", .light_samples = 256});
  std::span<const float> v = a.visibility(0);
  double difference = 0;
  for (std::size_t i = 0; i < v.size(); ++i) difference += std::abs(static_cast<double>(v[i]) - b.visibility(0)[i]);
  renderer.scene().set_light(a.lights()[0], penumbra::Sphere{.center = {0, 4, 0}, .radius = 0.5});
  const penumbra::Picture moved = renderer.render({.width = 64, .height = 64});
  try {
    renderer.render({.method = "nothing"});
    return 1;
  } catch (const penumbra::UsageError& error) {
    std::cout << error.what() << "\n";
  }
  std::cout << "mean difference " << difference / static_cast<double>(v.size()) << ", allocations " << allocations
            << ", version " << penumbra::version() << "\n";
  const bool differs = !std::equal(v.begin(), v.end(), moved.visibility(0).begin());
  return allocations > 0 && differs && difference / static_cast<double>(v.size()) < 0.01 ? 0 : 1;
}
