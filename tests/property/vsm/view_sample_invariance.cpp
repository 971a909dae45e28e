// SPDX-License-Identifier: Apache-2.0
// Tests changes that must not alter a single bit of view-sample mapping: the order, winding and first vertex of
// triangles, doubled vertices and faces, the size of tiles, a second run, a scale by a power of two. Also tests changes
// that may alter almost nothing: another scale, another place in the world.

#include "tests/agreement/lattice.hpp"
#include "tests/agreement/support.hpp"
#include "tests/unit/mesh/shuffled.hpp"

#include "render/visibility_buffer.hpp"
#include "scenes/formats/reader.hpp"

namespace penumbra::vsm {
namespace {

using tests::Masks;
using visibility::Light;
using visibility::SampleRequest;
using visibility::SceneFloats;
using visibility::ViewSamples;

struct Picture {
  ViewSamples samples;
  Masks masks;
};

class Invariance : public tests::DeviceTest {
 protected:
  static Picture picture(const scenes::Scene& scene, std::uint32_t size, const SampleRequest& request = {},
                         std::uint32_t rows_at_once = 0) {
    const SceneFloats floats = visibility::make_scene_floats(scene);
    const Light light = visibility::make_light(scene, 0, floats.origin, request);
    render::VisibilityBuffer view(device(), floats);
    ViewSamples samples = view.render(visibility::make_camera(scene.cameras[0], floats.origin, size, size));
    Masks masks = tests::map_view_samples(device(), floats, light, samples, rows_at_once);
    return {std::move(samples), std::move(masks)};
  }

  static scenes::Scene shipped(const std::string& name) {
    return scenes::read_scene(std::string(PENUMBRA_SCENES "/") + name);
  }

  static void expect_same(const Picture& a, const Picture& b, const std::string& what) {
    EXPECT_EQ(a.samples.p, b.samples.p) << what;
    EXPECT_EQ(a.samples.n, b.samples.n) << what;
    EXPECT_EQ(tests::differing_bits(a.masks, b.masks), 0U) << what;
    EXPECT_EQ(a.masks.visibility, b.masks.visibility) << what;
  }
};

/// Returns the triangles in another order, each with another first vertex and often turned over.
scenes::Scene shuffled(const scenes::Scene& scene, std::mt19937& random) {
  scenes::Scene result = scene;
  tests::shuffle_order(result.soup, random);
  tests::shuffle_corners(result.soup, random);
  return result;
}

/// Returns the scene with separate vertices for every triangle, and with a turned-over copy of every third face.
scenes::Scene doubled(const scenes::Scene& scene) {
  scenes::Scene result = scene;
  mesh::TriangleSoup& soup = result.soup;
  soup = {};
  const auto add = [&](const mesh::Triangle& triangle, std::size_t of) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t vertex : triangle) soup.positions.push_back(scene.soup.positions[vertex]);
    soup.triangles.push_back({first, first + 1, first + 2});
    soup.object.push_back(scene.soup.object[of]);
    soup.source_face.push_back(scene.soup.source_face[of]);
  };
  for (std::size_t i = 0; i < scene.soup.triangles.size(); ++i) {
    const mesh::Triangle& triangle = scene.soup.triangles[i];
    add(triangle, i);
    if (i % 3 == 0) add({triangle[1], triangle[0], triangle[2]}, i);
  }
  return result;
}

TEST_F(Invariance, OrderWindingAndDoublesOfTriangles) {
  std::mt19937 random(5);
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    tests::LatticeSoup soup(seed, 3);
    SampleRequest request;
    scenes::Scene scene = lattice_scene(soup, request);
    // A face that casts shadow and its copy that does not could each be seen first, so all objects cast shadow here.
    for (scenes::Object& object : scene.objects) object.casts_shadow = true;
    for (scenes::Object& object : scene.objects) object.emits.reset();
    const Picture plain = picture(scene, 48, request);
    expect_same(plain, picture(shuffled(scene, random), 48, request), "shuffled, seed " + std::to_string(seed));
    expect_same(plain, picture(doubled(scene), 48, request), "doubled, seed " + std::to_string(seed));
  }
  for (const char* name : {"contact.json", "self-shadow.json"}) {
    const scenes::Scene scene = shipped(name);
    const Picture plain = picture(scene, 96);
    expect_same(plain, picture(shuffled(scene, random), 96), std::string(name) + " shuffled");
    expect_same(plain, picture(doubled(scene), 96), std::string(name) + " doubled");
  }
}

TEST_F(Invariance, AnotherRunAndSmallTiles) {
  for (const char* name : {"contact.json", "bunny.json"}) {
    const scenes::Scene scene = shipped(name);
    const SceneFloats floats = visibility::make_scene_floats(scene);
    render::VisibilityBuffer view(device(), floats);
    const ViewSamples samples = view.render(visibility::make_camera(scene.cameras[0], floats.origin, 100, 75));
    for (const SampleRequest& request :
         {SampleRequest{}, SampleRequest{50, 0, 0, visibility::SamplePattern::sobol, 1}}) {
      const Light light = visibility::make_light(scene, 0, floats.origin, request);
      for (const char* engine : {"vulkan", "native"}) {
        if (engine == std::string("native") && request.pattern != SampleRequest{}.pattern)
          continue;  // these run on the device
        const auto method = make_view_sample(device(), {{"engine", engine}});
        const Masks whole = tests::run(*method, floats, light, samples);
        for (const std::uint32_t rows : {0U, 1U, 3U, 16U, 37U}) {
          const Masks again = tests::run(*method, floats, light, samples, rows);
          EXPECT_EQ(tests::differing_bits(whole, again), 0U) << name << " in tiles of " << rows;
          EXPECT_EQ(whole.visibility, again.visibility) << name << " in tiles of " << rows;
        }
        const Masks fresh = tests::map_view_samples(device(), floats, light, samples);
        EXPECT_EQ(tests::differing_bits(whole, fresh), 0U) << name;
      }
    }
  }
}

TEST_F(Invariance, OneMethodForManyMeshesLightsAndViews) {
  // Data in buffers made for something larger or smaller must not affect the next answer.
  for (const char* engine : {"vulkan", "native"}) {
    const auto method = make_view_sample(device(), {{"engine", engine}});
    for (const std::uint32_t size : {64U, 9U, 40U}) {
      for (const char* name : {"contact.json", "parallel-square.json", "thin.json"}) {
        const scenes::Scene scene = shipped(name);
        const tests::Stage stage(scene, size, size, {size, 0, 0, visibility::SamplePattern::rows, 0});
        const Masks used = tests::run(*method, stage.floats, stage.light, stage.samples);
        const Masks fresh = tests::map_view_samples(device(), stage.floats, stage.light, stage.samples);
        EXPECT_EQ(tests::differing_bits(used, fresh), 0U) << name << " " << size;
      }
    }
  }
}

TEST_F(Invariance, LightsOnTheOneEngineAndTheOther) {
  // One method, with alternating lights: rows on the processor, and points that form no rows on the device, while the
  // view stays.
  const auto method = make_view_sample(device(), {{"engine", "native"}});
  const scenes::Scene scene = shipped("contact.json");
  const tests::Stage stage(scene, 40, 40, {64, 0, 0, visibility::SamplePattern::rows, 0});
  const tests::Stage other(scene, 40, 40, {50, 0, 0, visibility::SamplePattern::sobol, 1});
  method->prepare_mesh(stage.floats);
  method->prepare_light(other.light);
  method->prepare_view(stage.samples);
  for (const tests::Stage* at : {&stage, &other, &stage, &other}) {
    method->prepare_light(at->light);
    method->evaluate({0, stage.samples.height});
    Masks masks;
    masks.words_per_pixel = at->light.words_per_mask();
    masks.words.resize(stage.samples.size() * masks.words_per_pixel);
    method->read_masks(masks.words);
    const Masks expected = tests::map_view_samples(device(), stage.floats, at->light, stage.samples);
    EXPECT_EQ(tests::differing_bits(expected, masks), 0U);
  }
}

TEST_F(Invariance, ScaleByAPowerOfTwo) {
  for (const char* name : {"contact.json", "fusion.json"}) {
    const scenes::Scene scene = shipped(name);
    const Picture plain = picture(scene, 96);
    for (const double scale : {0x1p-10, 0x1p10, 0x1p-30, 0x1p30}) {
      const Picture other = picture(tests::moved(scene, scale), 96);
      EXPECT_EQ(plain.samples.triangle, other.samples.triangle) << name << " scale " << scale;
      EXPECT_EQ(tests::differing_bits(plain.masks, other.masks), 0U) << name << " scale " << scale;
    }
  }
}

TEST_F(Invariance, AnotherScaleAndPlace) {
  struct Case {
    double scale;
    glm::dvec3 offset;
  };
  for (const char* name : {"contact.json", "fusion.json", "bunny.json"}) {
    const scenes::Scene scene = shipped(name);
    const Picture plain = picture(scene, 128);
    std::size_t pairs = 0;
    for (const std::int32_t triangle : plain.samples.triangle) pairs += triangle < 0 ? 0 : 256;
    for (const auto& [scale, offset] :
         {Case{0.001, glm::dvec3(0)}, Case{1000, glm::dvec3(0)}, Case{1, glm::dvec3(1000, -500, 2000)}}) {
      const Picture other = picture(tests::moved(scene, scale, offset), 128);
      const std::size_t differing = tests::differing_bits(plain.masks, other.masks);
      EXPECT_LE(static_cast<double>(differing), 2e-5 * static_cast<double>(pairs))
          << name << " scale " << scale << " offset " << offset.x << ": " << differing << " of " << pairs;
    }
  }
}

}  // namespace
}  // namespace penumbra::vsm
