// SPDX-License-Identifier: Apache-2.0
// Tests that methods behave as the families' tables describe them.
#include "session/methods.hpp"
#include "tests/agreement/support.hpp"

#include <set>

namespace penumbra::tests {
namespace {

/// Returns a floor below a plate below a rectangle light with the given number of samples.
Stage plate_over_floor(std::uint32_t samples, const scenes::AreaLight& light) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {4, 0, 0}, {0, 0, 4});
  add_quad(scene, {0.1, 1, 0.2}, {0.7, 0, 0}, {0, 0, 0.6});
  scene.lights.push_back(light);
  scene.cameras.push_back(camera({0.4, 3, 7}, {0, 0.3, 0}));
  return Stage(scene, 24, 16, light_samples(samples));
}

/// Returns options for maps so small that each method takes only an instant.
visibility::MethodOptions small_maps(const visibility::MethodDescription& method) {
  visibility::MethodOptions options;
  for (const char* name : {"size", "receiverSize"}) {
    if (std::ranges::find(method.options, name, &visibility::OptionDescription::name) != method.options.end())
      options[name] = "32";
  }
  return options;
}

/// Returns whether the method supports only domes.
bool is_of_domes_alone(const visibility::MethodDescription& method) {
  return !method.lights.contains(visibility::LightKind::rectangle);
}

class MethodTable : public DeviceTest {};

TEST_F(MethodTable, MakesWhatItDescribesAndKnowsWhichCountLightSamples) {
  scenes::AreaLight sky;
  sky.name = "sky";
  sky.shape = scenes::Dome{};
  const Stage ceiling_one = plate_over_floor(1, ceiling_light(3, 0.8)),
              ceiling_many = plate_over_floor(16, ceiling_light(3, 0.8)), sky_one = plate_over_floor(1, sky),
              sky_many = plate_over_floor(16, sky);
  for (const visibility::MethodDescription* described : session::all_methods()) {
    visibility::MethodOptions options = small_maps(*described);
    const bool sky_alone = is_of_domes_alone(*described);
    if (sky_alone) options["radius"] = "0.2";
    const Stage &one = sky_alone ? sky_one : ceiling_one, &many = sky_alone ? sky_many : ceiling_many;
    const auto method = session::make_method(described->name, options, device());
    EXPECT_EQ(method->description().name, described->name);
    EXPECT_EQ(method->description().output, session::describe_method(described->name, options).output)
        << described->name;
    const std::vector<float> by_one = run(*method, one).visibility, by_many = run(*method, many).visibility;
    EXPECT_NE(*std::ranges::min_element(by_many), 1) << described->name << " sees no shadow";
    EXPECT_EQ(by_one != by_many, described->counts_light_samples()) << described->name;
  }
}

TEST_F(MethodTable, ListsEachMethodOnceTheDefaultFirst) {
  std::set<std::string> names;
  std::vector<visibility::Family> families;
  for (const visibility::MethodDescription* method : session::all_methods()) {
    EXPECT_TRUE(names.insert(method->name).second) << method->name;
    if (families.empty() || families.back() != method->family) families.push_back(method->family);
  }
  using visibility::Family;
  EXPECT_EQ(families, (std::vector{Family::geometry, Family::image, Family::reference}));
  EXPECT_EQ(session::all_methods()[0]->name, "edge-scatter");
  EXPECT_EQ(session::all_methods()[1]->name, "view-sample") << "the methods of all tables are sorted by precedence";
  EXPECT_EQ(session::ray_judge().name, "raytrace");
}

TEST_F(MethodTable, WarnsWithEachOfItsOptions) {
  std::size_t asked = 0;
  for (const visibility::MethodDescription* method : session::all_methods()) {
    if (method->warning == nullptr) continue;
    for (const visibility::OptionDescription& option : method->options) {
      ++asked;
      EXPECT_NO_THROW(method->warning({{option.name, option.default_value}}, {{"pixelsOnOccluders", 1}}))
          << method->name << ", " << option.name;
    }
  }
  EXPECT_GT(asked, 10U);
}

}  // namespace
}  // namespace penumbra::tests
