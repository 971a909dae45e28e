// SPDX-License-Identifier: Apache-2.0
// Tests maps that are fitted to a camera's view: the aliasing error, and every fit's shadows texel by texel.
// map_fit_forms.cpp holds the closed forms.

#include "maps/host/aliasing.hpp"
#include "maps/host/face_fit.hpp"
#include "tests/analytic/maps/centre_maps.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace penumbra::tests {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class FittedMaps : public MapsTest {
 protected:
  static constexpr std::uint32_t kSize = 256;

  struct Plate {
    glm::dvec3 middle, u, v;
  };
  /// Plates of a scene with a long floor, a camera near its end, and a light high up.
  static std::vector<Plate> plates() {
    std::vector<Plate> plates;
    int k = 0;
    for (const double z : {3.0, 0.5, -2.5, -7.0, -13.0}) {
      for (const double x : {-2.4, 0.3, 2.5}) {
        plates.push_back({{x + 0.05 * k++, 0.8, z}, {0.4, 0, 0.1}, {0.05, 0.1, -0.4}});
      }
    }
    return plates;
  }
  static scenes::Scene floor_and_plates(double half_light = 0.5) {
    scenes::Scene scene;
    add_quad(scene, {0, 0, -8}, {9, 0, 0}, {0, 0, -14});
    for (const Plate& plate : plates()) add_quad(scene, plate.middle, plate.u, plate.v);
    scene.lights.push_back(ceiling_light(14, half_light));
    scene.cameras.push_back(camera({0, 1.5, 7}, {0, 0.3, 0}));
    return scene;
  }
  static visibility::MethodOptions options(const std::string& fit, const visibility::MethodOptions& more = {}) {
    visibility::MethodOptions all = more;
    all["fit"] = fit;
    if (!all.contains("size")) all["size"] = fmt::format("{}", kSize);
    return all;
  }
  static std::map<std::string, std::uint64_t> counters(const Stage& stage, visibility::MethodOptions given) {
    given["aliasing"] = "count";
    const auto method = maps::make_shadow_map(device(), given);
    run(*method, stage);
    return method->counters();
  }
  static double storage(const std::map<std::string, std::uint64_t>& counters) {
    return static_cast<double>(counters.at("neededTexels")) / static_cast<double>(counters.at("aliasingPixels"));
  }
};

// A texel stores what its centre sees: for every fit, V on the floor must be that of the plates in the direction of the
// texel's centre, except where an outline passes within the rasteriser's 1/256 texel (and rounding) of it.
TEST_F(FittedMaps, EveryTexelSaysWhatItsCentreSees) {
  const Stage stage(floor_and_plates(), 96, 72, light_samples(1));
  const maps::LightBasis basis = maps::light_basis(stage.light, stage.floats);
  const glm::dvec3 origin(stage.floats.origin);
  const auto sees_light = [&](const glm::dvec3& direction, double most) {
    return std::ranges::none_of(plates(), [&](const Plate& plate) {
      const glm::dvec3 normal = glm::cross(plate.u, plate.v), middle = plate.middle - origin - basis.center;
      const double t = glm::dot(normal, middle) / glm::dot(normal, direction);
      if (!(t > 0 && t < most)) return false;
      const glm::dvec3 at = t * direction - middle;
      const double s = glm::dot(glm::cross(at, plate.v), normal), r = glm::dot(glm::cross(plate.u, at), normal);
      return std::max(std::abs(s), std::abs(r)) <= glm::dot(normal, normal);
    });
  };
  using maps::Fit;
  const std::map<std::string, Fit> fits{{"view", Fit::view},      {"cascades", Fit::cascades},
                                        {"tiles", Fit::tiles},    {"lispsm", Fit::lispsm},
                                        {"tsm", Fit::tsm},        {"psm", Fit::psm},
                                        {"logpsm", Fit::logpsm},  {"faces", Fit::faces},
                                        {"cube", Fit::receivers}, {"paraboloid", Fit::receivers}};
  for (const auto& [name, fit] : fits) {
    for (const std::string body : {"visible", "frustum"}) {
      const bool of_receivers = fit == Fit::receivers;  // independent of what the camera sees
      if (of_receivers && body == "frustum") continue;
      const maps::ViewFit choice{.fit = fit,
                                 .body = body == "visible" ? maps::ViewBody::visible : maps::ViewBody::frustum};
      std::vector<maps::FittedFace> faces;
      const glm::vec3 centre(basis.center);
      if (name == "cube") {
        faces = maps::faces_of(
            maps::fit_views(stage.floats, stage.light, basis, std::span(&centre, 1), {.size = kSize, .hemicube = true})
                .views.front());
        ASSERT_EQ(faces.size(), 5U);
      } else if (name == "paraboloid") {
        faces = {maps::paraboloid_face(0, kSize, 1)};
      } else if (fit == Fit::view) {
        const auto points =
            maps::body_points(stage.floats, stage.light, basis, stage.samples, choice.body, 0, kInfinity);
        faces = maps::faces_of(
            maps::fit_views(stage.floats, stage.light, basis, std::span(&centre, 1), {.size = kSize, .body = &points})
                .views.front());
      } else {
        faces = maps::fit_faces(stage.floats, stage.light, basis, stage.samples, {.fit = choice, .size = kSize});
      }
      const Masks found =
          run(maps::make_shadow_map, stage,
              of_receivers ? options("receivers", {{"projection", name}}) : options(name, {{"body", body}}));
      std::size_t asked = 0, open = 0, dark = 0, wrong = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        if (stage.samples.triangle[i] < 0 || stage.samples.triangle[i] > 1) continue;  // the floor
        const auto receiver = maps::seen_receiver(stage.samples, i, basis, false);
        ASSERT_TRUE(receiver);
        const maps::FittedFace* face = maps::face_for(faces, *receiver);
        ASSERT_NE(face, nullptr) << name << ", pixel " << i;
        const glm::dvec2 at = *face->place(receiver->e) * double{kSize};
        std::set<bool> answers;
        constexpr double kStep = 1.0 / 128;
        for (const double x : {-kStep, 0.0, kStep}) {
          for (const double y : {-kStep, 0.0, kStep}) {
            const glm::dvec2 cell = glm::floor(at + glm::dvec2(x, y)), middle = cell + 0.5 + glm::dvec2(x, y);
            const glm::dvec3 e = face->direction(middle / double{kSize});
            const glm::dvec3 direction = e.x * basis.u + e.y * basis.v + e.z * basis.n;
            answers.insert(sees_light(direction, 0.99 * receiver->e.z / e.z));
          }
        }
        ++asked;
        if (answers.size() > 1) {
          ++open;
          continue;
        }
        dark += *answers.begin() ? 0 : 1;
        wrong += (found.visibility[i] == 1.0F) != *answers.begin() ? 1 : 0;
      }
      EXPECT_EQ(wrong, 0U) << name << ", " << body;
      EXPECT_GT(asked, 3000U);
      EXPECT_GT(dark, asked / 50);
      EXPECT_LT(open, asked / 50) << name;
    }
  }
}

// Eisemann et al. 2009, section 3.2: fitting spends no texels on what is not visible; slices and warps spend them near
// the eye, tiles where pixels need them.
TEST_F(FittedMaps, EveryFitAliasesLessThanTheOneBefore) {
  const Stage stage(floor_and_plates(), 96, 72, light_samples(1));
  const auto receivers = counters(stage, options("receivers")), view = counters(stage, options("view"));
  EXPECT_EQ(receivers.at("aliasingPixels"), view.at("aliasingPixels"));
  EXPECT_LT(storage(view), 0.97 * storage(receivers));
  for (const char* fit : {"lispsm", "tsm", "psm", "logpsm", "faces", "cascades"}) {
    const auto found = counters(stage, options(fit));
    EXPECT_LT(storage(found), 0.5 * storage(view)) << fit;
    EXPECT_LT(found.at("aliasingWorstThousandths"), view.at("aliasingWorstThousandths")) << fit;
  }
  // Slices in the logarithm of depth are better than equal ones, and with a warp in each they are better still.
  const auto slices = counters(stage, options("cascades")),
             equal = counters(stage, options("cascades", {{"split", "uniform"}})),
             warped = counters(stage, options("lispsm", {{"cascades", "4"}}));
  EXPECT_LT(storage(slices), storage(equal));
  EXPECT_LT(storage(warped), storage(slices));
  // Sixteen tiles of a quarter of the width have as many texels as one map.
  const visibility::MethodOptions small{{"size", "64"}};
  const auto tiles = counters(stage, options("tiles", small));
  EXPECT_LE(tiles.at("mapFaces"), 16U);
  EXPECT_LT(tiles.at("undersampledPixels"), counters(stage, options("view")).at("undersampledPixels"));
}

// Eisemann et al. 2009, equation 3.2, factor by factor, for pixels where eye, light and the texel's side are in the
// plane x = 0.
TEST_F(FittedMaps, TheAliasingErrorIsEquation32) {
  const Stage stage(floor_and_plates(), 96, 72, light_samples(1));
  const maps::LightBasis basis = maps::light_basis(stage.light, stage.floats);
  const glm::vec3 centre(basis.center);
  const auto fitted = maps::fit_views(stage.floats, stage.light, basis, std::span(&centre, 1), {.size = kSize});
  const maps::FittedFace face = maps::faces_of(fitted.views.front()).front();
  const visibility::PinholeCamera& camera = stage.samples.camera;
  const auto& side = fitted.views.front().side[0];
  // The light's axis that is along world z.
  const int along = std::abs(basis.u.z) > 0.5 ? 0 : 1;
  std::size_t checked = 0;
  for (std::uint32_t y = 0; y < 72; ++y) {
    const std::size_t pixel = std::size_t{y} * 96 + 47;  // next to the middle column
    if (stage.samples.triangle[pixel] < 0 || stage.samples.triangle[pixel] > 1) continue;
    const glm::dvec3 p(stage.samples.p[pixel]), to_eye = camera.eye - p, to_light = basis.center - p;
    const double resolution = 72.0 / kSize;  // pixels per side over texels per side
    const double parametrisation = 1;        // dG/dt of a uniform map
    // Widths of both image planes over their distances: W_l n_e / (W_e n_l).
    const double light_width = static_cast<double>(side.upper[along] - side.lower[along]);
    const double views = light_width / (2 * camera.tan_half_fov);
    // Distances along the axes (the paper: "d_e corresponds to z"), and the beams' angles to the axes.
    const double light_depth = -glm::dot(basis.n, to_light), eye_depth = -glm::dot(camera.forward, to_eye);
    const double distances = light_depth / eye_depth;
    const double beams = light_depth / glm::length(to_light) / (eye_depth / glm::length(to_eye));
    const double light_cosine = glm::dot(to_light, glm::dvec3(0, 1, 0)) / glm::length(to_light);
    const double eye_cosine = glm::dot(to_eye, glm::dvec3(0, 1, 0)) / glm::length(to_eye);
    const double m = resolution * parametrisation * views * distances * beams * eye_cosine / light_cosine;
    const auto receiver = maps::seen_receiver(stage.samples, pixel, basis, false);
    ASSERT_TRUE(receiver);
    const glm::dvec2 found = maps::aliasing_error(face, *receiver, stage.samples, pixel, basis, kSize);
    EXPECT_NEAR(found[along], m, 0.01 * m) << y;
    ++checked;
  }
  EXPECT_GT(checked, 30U);
}

/// A floor, a ball, and a wall that reaches above the light: what the camera sees needs a hemicube.
scenes::Scene ball_and_wall(bool two_sided) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, -3});
  add_object(scene, "ball", sphere({0.3, 1, 0.2}, 0.6, 12));
  add_quad(scene, {3, 2.5, 0}, {0, 2.5, 0}, {0, 0, 3});
  scene.lights.push_back(ceiling_light(4, 0.3));
  scene.lights.back().two_sided = two_sided;
  scene.cameras.push_back(camera({-3, 3, 6}, {0.5, 1.5, 0}));
  return scene;
}

// All fits compute the same quantity: their results differ from those of maps fitted to all receivers about as much as
// the latter differ from finer ones.
TEST_F(FittedMaps, HemicubesFiltersAndLayersAgree) {
  for (const bool two_sided : {false, true}) {
    const Stage stage(ball_and_wall(two_sided), 40, 40, light_samples(1));
    struct Case {
      Factory make;
      visibility::MethodOptions more;
      double tolerance;
    };
    std::vector<Case> cases{{maps::make_shadow_map, {{"depth", two_sided ? "dual" : "first"}}, 0.15}};
    if (!two_sided) {
      // pcf's window is measured in texels, whose sizes differ: hard shadows are blurred by different amounts.
      cases.push_back({maps::make_pcf, {{"window", "3"}}, 0.15});
      cases.push_back({maps::make_pcss, {{"blockerSamples", "16"}, {"filterSamples", "16"}}, 0.08});
      // Windows on sideways and warped faces, against those of a hemicube for all receivers.
      cases.push_back({maps::make_vssm, {{"depth", "dual"}}, 0.08});
    }
    for (const Case& one : cases) {
      visibility::MethodOptions fine = one.more;
      fine["size"] = "256";
      const Masks right = run(one.make, stage, fine);
      for (const char* fit : {"view", "cascades", "tiles", "lispsm", "tsm", "psm", "logpsm", "faces"}) {
        visibility::MethodOptions given = fine;
        given["fit"] = fit;
        const Masks found = run(one.make, stage, given);
        const double off = rmse(
            stage, [](std::size_t) { return true; },
            [&](std::size_t i) { return static_cast<double>(found.visibility[i] - right.visibility[i]); });
        EXPECT_LT(off, one.tolerance) << fit << (two_sided ? ", two-sided" : "");
      }
      for (const char* projection : {"cube", "paraboloid"}) {
        visibility::MethodOptions given = fine;
        given["projection"] = projection;
        const Masks found = run(one.make, stage, given);
        const double off = rmse(
            stage, [](std::size_t) { return true; },
            [&](std::size_t i) { return static_cast<double>(found.visibility[i] - right.visibility[i]); });
        EXPECT_LT(off, one.tolerance) << projection << (two_sided ? ", two-sided" : "");
        const bool same = off == 0;
        EXPECT_TRUE(same || projection != std::string("cube")) << "the wall makes it one anyway";
      }
    }
  }
}

// For every fit every receiver is in a map, in a room whose walls reach through the light's plane, with objects above
// the light. Results equal those of maps of all receivers, except at outlines: no more pixels differ than with maps of
// all receivers and texels four times as wide.
TEST_F(FittedMaps, NoReceiverIsOutsideWhereTheLightsPlaneCutsWalls) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {4, 0, 0}, {0, 0, -4});   // floor
  add_quad(scene, {-3, 3, 0}, {0, 3, 0}, {0, 0, 4});   // a wall from 0 to 6
  add_quad(scene, {0, 3, -4}, {0, 3, 0}, {-4, 0, 0});  // another
  add_quad(scene, {0, 6, 0}, {0, 0, -4}, {4, 0, 0});   // ceiling, above the light
  for (int k = 0; k < 16; ++k) {                       // small boards, flat and upright
    const double x = -2.6 + 1.3 * (k % 4), z = -2.7 + 1.2 * (k / 4 % 4);
    add_quad(scene, {x, 0.9 + 0.1 * (k % 3), z}, {0.25, 0, 0}, {0, 0, -0.25});
    add_quad(scene, {-2.4, 1.2 + 0.6 * (k % 4), z}, {0, 0.15, 0}, {0, 0, 0.2});
  }
  scene.lights.push_back(ceiling_light(4, 0.2));
  scene.cameras.push_back(camera({3, 2.5, 4}, {-2, 2.2, -2}));
  const Stage stage(scene, 96, 72, light_samples(1));
  const Masks all = run(maps::make_shadow_map, stage, {{"size", "256"}});
  const auto differing = [&](const Masks& found) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) count += found.visibility[i] != all.visibility[i] ? 1 : 0;
    return count;
  };
  const std::size_t most = differing(run(maps::make_shadow_map, stage, {{"size", "64"}}));
  std::size_t dark = 0, lit = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (stage.samples.triangle[i] < 0) continue;
    ++(all.visibility[i] == 0 ? dark : lit);
  }
  EXPECT_GT(dark, 400U);
  EXPECT_GT(lit, 2000U);
  EXPECT_GT(most, 50U);
  const visibility::MethodOptions circle = options("receivers", {{"projection", "paraboloid"}});
  EXPECT_EQ(counters(stage, circle).at("outsidePixels"), 0U);
  EXPECT_LE(differing(run(maps::make_shadow_map, stage, circle)), most);
  for (const char* fit : {"view", "cascades", "tiles", "lispsm", "tsm", "psm", "logpsm", "faces"}) {
    for (const char* body : {"visible", "frustum"}) {
      const visibility::MethodOptions choice = options(fit, {{"body", body}});
      EXPECT_EQ(counters(stage, choice).at("outsidePixels"), 0U) << fit << ", " << body;
      EXPECT_LE(differing(run(maps::make_shadow_map, stage, choice)), most) << fit << ", " << body;
    }
  }
}

// Tiles that are cut as long as a cut changes the picture: like any tiles they show the same as maps of all receivers,
// with fewer wrong pixels than one map of the same size; they do not depend on how many rows are evaluated at once.
TEST_F(FittedMaps, QueriedTilesAreCutWhereShadowsEnd) {
  const Stage stage(floor_and_plates(), 96, 72, light_samples(1));
  const Masks right = run(maps::make_shadow_map, stage, options("view", {{"size", "4096"}}));
  const auto off = [&](const Masks& found) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) count += found.visibility[i] != right.visibility[i] ? 1 : 0;
    return count;
  };
  const visibility::MethodOptions small{{"size", "64"}, {"tiles", "40"}, {"refine", "queried"}, {"changed", "0"}};
  const auto method = maps::make_shadow_map(device(), options("tiles", small));
  const Masks found = run(*method, stage);
  const auto counters = method->counters();
  EXPECT_GT(counters.at("queriedPictures"), 2U);
  EXPECT_GT(counters.at("mapFaces"), 10U);
  EXPECT_LE(counters.at("mapFaces"), 40U);
  EXPECT_LT(2 * off(found), off(run(maps::make_shadow_map, stage, options("view", {{"size", "64"}}))));
  EXPECT_EQ(run(*method, stage, 7).visibility, found.visibility);
}

TEST_F(FittedMaps, WhatNoFitCanDoIsRefused) {
  EXPECT_THROW(maps::make_shadow_map(device(), {{"fit", "psm"}, {"rasteriser", "opengl"}}), UsageError);
  EXPECT_THROW(maps::make_shadow_map(device(), {{"fit", "tiles"}, {"test", "id"}}), UsageError);
  EXPECT_THROW(maps::make_vssm(device(), {{"fit", "cascades"}, {"rasteriser", "opengl"}}), UsageError);
  EXPECT_THROW(maps::make_vssm(device(), {{"fit", "view"}, {"projection", "paraboloid"}}), UsageError);
  EXPECT_THROW(maps::make_pcf(device(), {{"fit", "view"}, {"projection", "cube"}}), UsageError);
  EXPECT_THROW(maps::make_pcf(device(), {{"projection", "paraboloid"}, {"rasteriser", "opengl"}}), UsageError);
  EXPECT_THROW(maps::make_pcf(device(), {{"projection", "paraboloid"}, {"offsetUnits", "8"}}), UsageError);
  EXPECT_THROW(maps::make_shadow_map(device(), {{"projection", "paraboloid"}, {"test", "id"}}), UsageError);
}

// aliasing=show draws 1/m where the aliasing error m exceeds 1.
TEST_F(FittedMaps, TheErrorsPictureIsItsInverse) {
  const Stage stage(floor_and_plates(), 48, 36, light_samples(1));
  const auto method = maps::make_vssm(device(), {{"fit", "view"}, {"size", "64"}, {"aliasing", "show"}});
  const Masks found = run(*method, stage, 7);
  const auto under = method->counters().at("undersampledPixels");
  EXPECT_EQ(static_cast<std::uint64_t>(std::ranges::count_if(found.visibility, [](float v) { return v < 1; })), under);
  EXPECT_GT(under, 200U);
  const float darkest = *std::ranges::min_element(found.visibility);
  EXPECT_NEAR(1000 / static_cast<double>(darkest),
              static_cast<double>(method->counters().at("aliasingWorstThousandths")), 1);
}

}  // namespace
}  // namespace penumbra::tests
