// SPDX-License-Identifier: Apache-2.0
// Tests what holds for every filter and any input (V in [0, 1] even for degenerate input, 1 where nothing is near, the
// same bytes for any order of triangles) and where filters are known to be wrong.

#include "base/error.hpp"
#include "maps/filters/methods.hpp"
#include "maps/products/light_shape.hpp"
#include "mesh/shapes/broken_meshes.hpp"
#include "tests/agreement/differences.hpp"
#include "tests/analytic/maps/centre_maps.hpp"
#include "tests/unit/mesh/shuffled.hpp"
#include "tests/unit/textured_lights_support.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <utility>

namespace penumbra::tests {
namespace {

struct Filter {
  std::string name;
  Factory make;
  visibility::MethodOptions options;
};

std::vector<Filter> all_filters(const std::string& size) {
  std::vector<Filter> all{{"pcf", maps::make_pcf, {{"size", size}}},
                          {"pcf off", maps::make_pcf, {{"size", size}, {"receiverPlane", "off"}, {"window", "4"}}},
                          {"pcss", maps::make_pcss, {{"size", size}}},
                          {"convolution", maps::make_convolution, {{"size", size}}}};
  for (const char* depth : {"second", "midpoint", "dual"}) {
    all.push_back({fmt::format("vssm {}", depth), maps::make_vssm, {{"size", size}, {"depth", depth}}});
    all.push_back({fmt::format("occlusion-textures {}", depth),
                   maps::make_occlusion_textures,
                   {{"size", size}, {"depth", depth}}});
    all.push_back({fmt::format("convolution {}", depth), maps::make_convolution, {{"size", size}, {"depth", depth}}});
  }
  for (const char* filter : {"sat", "mip", "n-buffer"}) {
    for (const char* moments : {"vsm", "lvsm", "evsm", "csm", "esm"}) {
      all.push_back({fmt::format("vssm {} {}", moments, filter),
                     maps::make_vssm,
                     {{"size", size}, {"moments", moments}, {"filter", filter}, {"terms", "3"}}});
    }
    all.push_back({fmt::format("occlusion-textures {}", filter),
                   maps::make_occlusion_textures,
                   {{"size", size}, {"filter", filter}}});
  }
  return all;
}

class Filters : public MapsTest {
 protected:
  /// Methods are made once: their pipelines take longer than small pictures.
  static void expect_shares(const std::vector<Stage>& stages, const std::string& size) {
    for (const Filter& filter : all_filters(size)) {
      const auto method = filter.make(device(), filter.options);
      for (std::size_t i = 0; i < stages.size(); ++i) {
        const Masks found = run(*method, stages[i]);
        const auto is_share = [](float v) { return v >= 0 && v <= 1; };  // no NaN either
        EXPECT_TRUE(std::ranges::all_of(found.visibility, is_share))
            << filter.name << " of size " << size << ", stage " << i;
      }
    }
  }
};

/// A floor with what `add` puts above it.
template <typename Add>
scenes::Scene above_a_floor(const scenes::AreaLight& light, const Add& add) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
  add(scene);
  scene.lights.push_back(light);
  scene.cameras.push_back(camera({0.3, 3, 4}, {0, 0.5, 0}));
  return scene;
}

TEST_F(Filters, DegenerateInputGivesAShareOfTheLight) {
  const auto nothing = [](scenes::Scene& /*scene*/) {};
  const auto through_the_light = [](scenes::Scene& scene) {
    add_object(scene, "needle", {{glm::dvec3(-0.3, 0, 0), glm::dvec3(0.1, 3, 0.2), glm::dvec3(0.4, 0.2, -0.5)}});
    add_quad(scene, {0, 2, 0}, {0.3, 0, 0}, {0, 0, 0.3});  // in the light's own plane
  };
  const auto around_the_light = [](scenes::Scene& scene) { add_object(scene, "shell", sphere({0, 2, 0}, 0.7, 4)); };
  const auto beside_the_window = [](scenes::Scene& scene) {
    add_quad(scene, {5, 1, 0}, {2, 0, 0}, {0, 0, 2}).receives_shadow = false;
  };
  scenes::AreaLight two_sided = ceiling_light(2, 0.5);
  two_sided.two_sided = true;
  const scenes::AreaLight point = ceiling_light(2, 1e-6), large = ceiling_light(2, 20);
  std::vector<Stage> stages;
  const auto add = [&](const scenes::Scene& scene) { stages.emplace_back(scene, 12, 12, light_samples(1)); };
  for (const scenes::AreaLight& light : {ceiling_light(2, 0.5), two_sided, point, large}) {
    add(above_a_floor(light, nothing));
    add(above_a_floor(light, through_the_light));
  }
  add(above_a_floor(ceiling_light(2, 0.5), around_the_light));
  add(above_a_floor(ceiling_light(2, 0.5), beside_the_window));
  scenes::Scene empty = above_a_floor(two_sided, nothing);  // no caster at all
  empty.objects[0].casts_shadow = false;
  add(empty);
  for (const char* size : {"8", "37"}) expect_shares(stages, size);
}

TEST_F(Filters, SoupsAndBrokenMeshesGiveAShareOfTheLight) {
  std::vector<Stage> stages;
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    const mesh::LatticeSoup soup{.triangles = 40, .cells = 3, .seed = seed, .center = {0, 1, 0}};
    stages.emplace_back(with_a_floor(mesh::make_lattice_soup(soup)), 12, 12, light_samples(1));
  }
  std::vector<std::string> defects;
  for (const mesh::DefectName& defect : mesh::broken_defects()) defects.emplace_back(defect.name);
  stages.emplace_back(with_a_floor(mesh::make_broken_mesh({defects, 1, {0, 1, 0}, 1}).soup), 16, 16, light_samples(1));
  expect_shares(stages, "32");
}

// With no caster in a window V is exactly 1.
TEST_F(Filters, WhereNothingIsNearVIsOne) {
  const auto board = [](scenes::Scene& scene) { add_quad(scene, {-1.2, 0.3, 0}, {0.3, 0, 0}, {0, 0, 0.3}); };
  const Stage stage(above_a_floor(ceiling_light(2, 0.3), board), 32, 32, light_samples(1),
                    grid_samples(32, {1.0, 0, 0}, {0.9, 0, 0}, {0, 0, 0.9}, {0, 1, 0}));
  for (const Filter& filter : all_filters("128")) {
    if (filter.name.find("csm") != std::string::npos) continue;  // its series rings
    if (filter.name.find("mip") != std::string::npos) continue;  // texels of its level are as large as the window
    const Masks found = run(filter.make, stage, filter.options);
    EXPECT_EQ(*std::ranges::min_element(found.visibility), 1.0F) << filter.name;
  }
}

// Methods without light points count the points of a pattern of 64 that are above a receiver's plane. Nothing casts
// here.
TEST_F(Filters, TheHorizonLeavesItsShareOfThePattern) {
  const auto boards = [](scenes::Scene& scene) {
    scene.objects[0].casts_shadow = false;
    for (const double x : {-0.6, 0.2, 0.5}) {
      add_quad(scene, {x, 1.2, 0}, {0.3, 1.1, 0}, {0.2, 0, 0.5}).casts_shadow = false;
    }
    add_object(scene, "sphere", sphere({1.3, 1, 0.6}, 0.6, 12)).casts_shadow = false;  // has planes of all orientations
  };
  scenes::Scene scene = above_a_floor(ceiling_light(3, 0.8), boards);
  scene.cameras.front() = camera({3, 2.5, 2}, {0, 1.2, 0}, 60);
  const Stage stage(scene, 32, 32, light_samples(1));
  const maps::LightBasis basis = maps::light_basis(stage.light);
  const std::vector<glm::vec2> pattern = maps::light_pattern(stage.light, basis, 64);
  for (const Filter& filter : all_filters("16")) {
    if (filter.name.find("vssm") == std::string::npos && filter.name.find("occlusion") == std::string::npos &&
        filter.name.find("convolution") == std::string::npos) {
      continue;
    }
    const Masks found = run(filter.make, stage, filter.options);
    std::size_t cut = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!visibility::is_receiver(stage.floats, stage.light, stage.samples, i)) continue;
      const glm::dvec3 d = basis.local(glm::dvec3(stage.samples.p[i])), n(stage.samples.n[i]);
      const glm::dvec3 m = -glm::dvec3(glm::dot(basis.u, n), glm::dot(basis.v, n), glm::dot(basis.n, n));
      double least = 0, most = 0;
      for (const glm::vec2& point : pattern) {
        const double above = glm::dot(m, d - glm::dvec3(point, 0));
        least += above > 1e-5 ? 1 : 0;
        most += above > -1e-5 ? 1 : 0;
      }
      EXPECT_GE(found.visibility[i] * 64, least) << filter.name << ", pixel " << i;
      EXPECT_LE(found.visibility[i] * 64, most) << filter.name << ", pixel " << i;
      cut += least > 0 && most < 64 ? 1 : 0;
    }
    EXPECT_GT(cut, 50U);
  }
}

TEST_F(Filters, OrderAndWindingOfTrianglesChangeNoByte) {
  const auto solids = [](scenes::Scene& scene) {
    add_object(scene, "sphere", sphere({0.2, 0.7, 0.1}, 0.4, 6));
    add_quad(scene, {-0.6, 0.5, 0}, {0.3, 0.2, 0}, {0, 0, 0.4});
  };
  scenes::Scene scene = above_a_floor(ceiling_light(2, 0.3), solids), turned = scene;
  std::mt19937 random(7);
  shuffle_order(turned.soup, random, 2);  // the floor's triangles stay first
  shuffle_corners(turned.soup, random);
  const Stage first(scene, 32, 32, light_samples(1)), second(turned, 32, 32, light_samples(1));
  for (const Filter& filter : all_filters("64")) {
    EXPECT_EQ(run(filter.make, first, filter.options).visibility, run(filter.make, second, filter.options).visibility)
        << filter.name;
  }
}

TEST_F(Filters, TilesChangeNoByte) {
  const auto solids = [](scenes::Scene& scene) { add_object(scene, "sphere", sphere({0.2, 0.7, 0.1}, 0.4, 6)); };
  const Stage stage(above_a_floor(ceiling_light(2, 0.3), solids), 32, 32, light_samples(1));
  for (const Filter& filter : all_filters("64")) {
    const auto method = filter.make(device(), filter.options);
    EXPECT_EQ(run(*method, stage).visibility, run(*method, stage, 5).visibility) << filter.name;
  }
}

// Eisemann et al. 2009, figures 5.3 and 5.4: a filter takes everything in its window for a blocker, even what stands
// beside the light.
TEST_F(Filters, BlockersBesideTheLightDarkenWhatTheyDoNotShade) {
  // A tall wall along x = 1: the floor next to it sees every point of the light.
  const auto wall = [](scenes::Scene& scene) { add_quad(scene, {1, 1.2, 0}, {0, 1.2, 0}, {0, 0, 2}); };
  const Stage stage(above_a_floor(ceiling_light(4, 0.8), wall), 32, 32, light_samples(1),
                    grid_samples(32, {0, 0, 0}, {0.95, 0, 0}, {0, 0, 0.5}, {0, 1, 0}));
  const auto dark = [&](const Factory& make) {
    const Masks found = run(make, stage, {{"size", "512"}});
    return static_cast<double>(std::ranges::count_if(found.visibility, [](float v) { return v < 0.95F; })) / 1024;
  };
  const double taps = dark(maps::make_pcss), moments = dark(maps::make_vssm), sampled = dark(maps::make_accumulate);
  fmt::print("lit pixels beside a wall darker than 0.95: pcss {:.3f}, vssm {:.3f}, accumulate {:.3f}\n", taps, moments,
             sampled);
  EXPECT_GT(taps, 0.01);
  EXPECT_GT(moments, 0.01);
  EXPECT_EQ(sampled, 0);
}

// Eisemann et al. 2009, figure 5.3: two heights are averaged to one, whose window is wider than the lower blocker's:
// light appears in the umbra.
TEST_F(Filters, BlockersAtTwoHeightsLightTheUmbra) {
  const auto boards = [](scenes::Scene& scene) {
    add_quad(scene, {-0.35, 3, 0}, {0.25, 0, 0}, {0, 0, 3}).receives_shadow = false;
    add_quad(scene, {-2.25, 0.5, 0}, {2.75, 0, 0}, {0, 0, 3}).receives_shadow = false;  // up to x = 0.5
  };
  const Stage stage(above_a_floor(ceiling_light(4, 0.5), boards), 32, 32, light_samples(1),
                    grid_samples(32, {0, 0, 0}, {0.49, 0, 0}, {0, 0, 0.49}, {0, 1, 0}));
  // The lower board alone hides the whole light up to x (1 − 1/8) + 0.5/8 = 0.5, that is, at every sample here.
  const auto lit = [&](const Factory& make) {
    const Masks found = run(make, stage, {{"size", "512"}});
    return static_cast<double>(std::ranges::count_if(found.visibility, [](float v) { return v > 0.05F; })) / 1024;
  };
  const double taps = lit(maps::make_pcss), moments = lit(maps::make_vssm);
  fmt::print("umbra pixels lighter than 0.05: pcss {:.3f}, vssm {:.3f}\n", taps, moments);
  EXPECT_GT(taps, 0.01);
  EXPECT_GT(moments, 0.01);
}

// Eisemann et al. 2009, section 5.2.2.1: a search with few taps differs from pixel to pixel.
TEST_F(Filters, FewTapsAreFarFromMany) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {4, 0, 0}, {0, 0, 4});
  add_object(scene, "sphere", sphere({0, 2, 0}, 1, 12));
  scene.lights.push_back(ceiling_light(5, 1));
  scene.cameras.push_back(camera({0, 1, 3}, {0, 0, 0}));
  const Stage stage(scene, 32, 32, light_samples(1), grid_samples(32, {0, 0, 0}, {2.5, 0, 0}, {0, 0, 2.5}, {0, 1, 0}));
  const auto with = [&](const char* taps) {
    return run(maps::make_pcss, stage, {{"size", "512"}, {"blockerSamples", taps}, {"filterSamples", taps}});
  };
  const Masks many = with("1024"), some = with("256"), few = with("16");
  const auto error = [&](const Masks& found) {
    return rmse(
        stage, [](std::size_t) { return true; },
        [&](std::size_t i) { return found.visibility[i] - many.visibility[i]; });
  };
  fmt::print("pcss against 1024 taps: 16 taps {:.4f}, 256 taps {:.4f}\n", error(few), error(some));
  EXPECT_GT(error(few), 2 * error(some));
}

/// A floor under a board and a light that may have a texture; only boards, because pcss has further errors in other
/// scenes.
scenes::Scene board_under(std::optional<scenes::Texture> texture) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, -3});
  add_quad(scene, {0.2, 2, 0.1}, {0.5, 0, 0}, {0, 0, -0.4});
  scene.lights.push_back(ceiling_light(4, 1));
  scene.lights.front().texture = std::move(texture);
  scene.cameras.push_back(camera({0, 6, 6}, {0, 0, 0}, 50));
  return scene;
}

// A constant texture changes no byte; under a texture that is bright on one half of the light only, V is that half's.
// (PcssFormulas.TexturesWeighTaps tests the weights of single taps.)
TEST_F(Filters, PcssWeighsTapsByTheTexture) {
  constexpr std::uint32_t kSize = 512;
  const visibility::MethodOptions options{
      {"size", fmt::format("{}", kSize)}, {"blockerSamples", "1024"}, {"filterSamples", "1024"}};
  const auto stage_of = [](std::optional<scenes::Texture> texture) {
    return Stage(board_under(std::move(texture)), 40, 40, light_samples(4));
  };
  const auto v_of = [&](const Stage& stage) { return run(maps::make_pcss, stage, options).visibility; };
  const Stage plain = stage_of({});
  EXPECT_EQ(v_of(plain), v_of(stage_of(constant_texture(3, 2, glm::vec3(0.3F, 0.5F, 0.1F)))));
  for (const bool upper : {false, true}) {
    // Bright where x > 0, or where z > 0: the texture's right column, or its first row.
    const Stage stage = stage_of(texture_of(upper ? 1 : 2, upper ? 2 : 1, [&](std::uint32_t x, std::uint32_t y) {
      return glm::vec3((upper ? y == 0 : x == 1) ? 1.0F : 0.0F);
    }));
    const std::vector<float> found = v_of(stage);
    const glm::dvec2 lower(upper ? -1 : 0, upper ? 0 : -1), wide = glm::dvec2(1) - lower;
    // The window holds the floor, 3/4, and the taps' reach beside it. On the light a texel is f = 2 · 4 / (4 − 2) times
    // as large, and each of the board's four edges is off by half a texel; corners are snapped to 1/256 texel. Taps
    // nearer to an edge than that are undecided, all others are known.
    const maps::LightBasis basis = maps::light_basis(stage.light);
    const glm::dvec2 side = 2.0 * (0.75 + maps::half_extent(stage.light, basis) / maps::half_width(stage.light));
    const glm::dvec2 beside = (0.5 + 1.0 / 256) * 4 * side / (kSize - 2.0);
    std::vector<glm::dvec2> taps;  // on the bright half
    for (const glm::vec2& tap : maps::light_pattern(stage.light, basis, 1024)) {
      const glm::dvec3 l = static_cast<double>(tap.x) * basis.u + static_cast<double>(tap.y) * basis.v;
      if (glm::all(glm::greaterThan(glm::dvec2(l.x, l.z), lower))) taps.emplace_back(l.x, l.z);
    }
    double worst = 0, bound = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (stage.samples.triangle[i] < 0 || stage.samples.triangle[i] > 1) continue;  // the floor's two triangles
      const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
      const glm::dvec2 at(p.x, p.z), middle = at + (glm::dvec2(0.2, 0.1) - at) * 2.0, half(1, 0.8);
      const auto hidden = [&](const glm::dvec2& reach) {
        const auto in_front = [&](const glm::dvec2& tap) {
          return glm::all(glm::lessThan(glm::abs(tap - middle), reach));
        };
        return static_cast<double>(std::ranges::count_if(taps, in_front)) / static_cast<double>(taps.size());
      };
      const double darkest = 1 - hidden(half + beside), lightest = 1 - hidden(half - beside);
      EXPECT_GE(found[i], darkest - 1e-6) << i;
      EXPECT_LE(found[i], lightest + 1e-6) << i;
      const glm::dvec2 from = glm::clamp(middle - half, lower, glm::dvec2(1)),
                       to = glm::clamp(middle + half, lower, glm::dvec2(1));
      const double exact = 1 - (to.x - from.x) * (to.y - from.y) / (wide.x * wide.y);
      worst = std::max(worst, std::abs(static_cast<double>(found[i]) - exact));
      bound = std::max({bound, std::abs(darkest - exact), std::abs(lightest - exact)});
    }
    fmt::print("pcss, half of the light black: off by {:.4f} of {:.4f}\n", worst, bound);
    RecordProperty(upper ? "upper half" : "right half", fmt::format("{:.4f} of {:.4f}", worst, bound));
    EXPECT_LT(bound, 0.04) << "2 % of the light's width move V by 0.01 to 0.02";
  }
}

// Filters that cannot weight taps refuse textures, and name filters that can.
TEST_F(Filters, ATextureIsWeighedOrRefused) {
  const Stage stage(board_under(constant_texture(2, 2, glm::vec3(1))), 8, 8, light_samples(1));
  for (const Filter& filter : all_filters("16")) {
    const auto method = filter.make(device(), filter.options);
    method->prepare_mesh(stage.floats);
    EXPECT_EQ(method->description().textures, filter.name == "pcss") << filter.name;
    if (method->description().textures) {
      method->prepare_light(stage.light);
    } else {
      EXPECT_THROW(method->prepare_light(stage.light), InputError) << filter.name;
    }
  }
}

// If all taps lie on black texels, V is undefined.
TEST_F(Filters, PcssWithoutATapOnTheBrightTexelIsRefused) {
  const Stage stage(board_under(texture_of(
                        64, 64, [](std::uint32_t x, std::uint32_t y) { return glm::vec3(x + y == 0 ? 1.0F : 0.0F); })),
                    8, 8, light_samples(4096));
  const auto method = maps::make_pcss(device(), {{"size", "16"}, {"filterSamples", "4"}});
  method->prepare_mesh(stage.floats);
  EXPECT_THROW(method->prepare_light(stage.light), InputError);
}

}  // namespace
}  // namespace penumbra::tests
