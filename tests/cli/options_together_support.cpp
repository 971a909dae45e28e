// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/options_together.hpp"

#include "base/exr.hpp"
#include "base/image.hpp"
#include "base/png.hpp"
#include "tests/unit/bits_reader.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

namespace penumbra::tests {
namespace {

using nlohmann::json;

constexpr const char* kRectangle = R"({"center": [0, 4, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]})";

json light(const std::string& name, const std::string& kind, const std::string& shape) {
  return {{"name", name}, {kind, json::parse(shape)}, {"radiance", {10, 9, 8}}};
}

json scene_of(double scale, std::vector<json> lights) {
  json scene = json::parse(R"({"format": "penumbra-scene/1", "size": [12, 8],
    "camera": {"eye": [2, 3, 6], "target": [0, 0.5, 0], "up": [0, 1, 0], "verticalFov": 45},
    "meshes": [
      {"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [4, 0, 0], "halfV": [0, 0, -4]}},
      {"name": "wedge", "triangles": [[-1,1,-1, 1,1,-1, 0,1.5,1], [-1,1,-1, 0,1.5,1, -1,0.2,1]]}]})");
  scene["lights"] = std::move(lights);
  const std::function<void(json&)> multiply = [&](json& value) {
    if (value.is_number()) value = value.get<double>() * scale;
    if (!value.is_array()) return;
    for (json& element : value) multiply(element);
  };
  for (const char* key : {"eye", "target"}) multiply(scene["camera"][key]);
  for (json& mesh : scene["meshes"]) {
    if (mesh.contains("triangles")) multiply(mesh["triangles"]);
    if (!mesh.contains("quad")) continue;
    for (json& vector : mesh["quad"]) multiply(vector);
  }
  for (json& one : scene["lights"]) {
    if (!one.contains("rectangle")) continue;
    for (json& vector : one["rectangle"]) multiply(vector);
  }
  return scene;
}

bool finite_or_null(const json& value) {
  return value.is_null() || (value.is_number() && std::isfinite(value.get<double>()));
}

/// Returns whether the value is null or a number of at least 0.
bool not_negative(const json& value) {
  return value.is_null() || (value.is_number() && value.get<double>() >= 0);
}

}  // namespace

std::vector<LitScene> write_lit_scenes(const std::filesystem::path& folder, bool many) {
  const json key = light("key", "rectangle", kRectangle);
  json textured =
      light("window", "rectangle", R"({"center": [1, 4, 1], "halfU": [0.5, 0.1, 0], "halfV": [0, 0, 0.5]})");
  Image8 image{4, 2, {}};
  for (std::uint8_t i = 0; i < 8; ++i) image.pixels.push_back({static_cast<std::uint8_t>(30 * i), 200, 90});
  write_png(folder / "window.png", image);
  textured["texture"] = "window.png";
  textured["twoSided"] = true;
  const json disk = light("rim", "disk", R"({"center": [2, 5, 0], "normal": [0, -1, 0], "radius": 0.4})");
  const json polygon = light("poly", "polygon", "[[0, 5, 0], [1, 5, 0], [0, 5, 1]]");
  const json bulb = light("bulb", "sphere", R"({"center": [0, 4, 2], "radius": 0.2})");
  const json oval = light("oval", "ellipse", R"({"center": [1, 5, 0], "halfU": [0.4, 0, 0], "halfV": [0, 0.1, 0.2]})");
  const json sun = light("sun", "sun", R"({"direction": [0.3, -1, -0.2], "angle": 4})");
  struct Made {
    std::string name;
    json scene;
  };
  const json fill = light("fill", "rectangle", R"({"center": [2, 3, 1], "halfU": [0, 0.3, 0], "halfV": [0, 0, 0.2]})");
  std::vector<Made> made = {{"rectangle", scene_of(1, {key, fill})},
                            {"textured", scene_of(1, {textured, disk, polygon})},
                            {"bulb", scene_of(1, {bulb, key})},
                            {"tiny", scene_of(std::ldexp(1.0, -60), {key, fill})}};
  if (many) {
    json nothing = scene_of(1, {key, fill});
    nothing["camera"]["target"] = {4, 9, 12};
    made.insert(made.end(), {{"huge", scene_of(std::ldexp(1.0, 36), {key, fill})},
                             {"disk", scene_of(1, {disk, polygon, oval})},
                             {"sunny", scene_of(1, {sun, key})},
                             {"window", scene_of(1, {textured, key})},
                             {"nothing", nothing}});
  }
  std::vector<LitScene> scenes;
  for (const auto& [name, scene] : made) {
    LitScene one{name, (folder / (name + ".json")).string(), {}};
    std::ofstream(one.file) << scene.dump();
    for (const json& l : scene["lights"]) {
      for (const char* kind : {"rectangle", "disk", "ellipse", "polygon", "sphere", "sun"}) {
        if (l.contains(kind)) one.lights.emplace_back(kind);
      }
      one.texture |= l.contains("texture");
    }
    scenes.push_back(one);
  }
  return scenes;
}

bool MethodTable::can_do(const json& method, const LitScene& scene, const std::string& pattern) const {
  const std::vector<std::string> kinds = method.at("lights");
  const bool rows = pattern.empty() || pattern == "rows" || pattern == "grid";
  return std::ranges::all_of(scene.lights,
                             [&](const std::string& kind) { return std::ranges::count(kinds, kind) > 0; }) &&
         (!scene.texture || method.at("textures").get<bool>()) && (rows || method.at("anyPattern").get<bool>());
}

Row::Row(const std::vector<Factor>& factors, const Choices& choices) {
  for (std::size_t i = 0; i < factors.size(); ++i) {
    if (choices[i]) values_[factors[i].name] = factors[i].values[*choices[i]];
  }
}

const std::string& Row::operator[](const std::string& factor) const {
  static const std::string none;
  const auto found = values_.find(factor);
  return found == values_.end() ? none : found->second;
}

std::vector<std::string> values_to_try(const json& option, bool default_by_name) {
  if (option.contains("choices")) {
    std::vector<std::string> values = option.at("choices");
    if (!default_by_name) std::erase(values, option.at("default").get<std::string>());
    values.insert(values.begin(), "");  // not given
    return values;
  }
  const json& range = option.at("range");
  const auto least = range.at("least").get<double>(), most = range.at("most").get<double>();
  const double more = std::min(most, 2 * least + 1.5);
  if (range.at("whole").get<bool>()) {
    return {std::to_string(std::lround(least)), std::to_string(static_cast<long>(more))};
  }
  return {std::to_string(least), std::to_string(more)};
}

bool options_exclude(const std::string& method, const std::map<std::string, std::string>& options,
                     const LitScene& scene, const Row& row) {
  const auto is = [&](const char* key, const char* value) {
    const auto found = options.find(key);
    return found != options.end() && found->second == value;
  };
  const auto is_planar = [](const std::string& kind) { return kind != "sphere" && kind != "sun"; };
  const bool all_planar = std::ranges::all_of(scene.lights, is_planar);
  const bool looks_through_camera = (options.contains("fit") && !is("fit", "receivers")) || is("reproject", "on");
  if (looks_through_camera && !all_planar) return true;
  const bool projected = options.contains("projection") && !is("projection", "window");
  if (projected && options.contains("fit") && !is("fit", "receivers")) return true;  // these need maps of all receivers
  if (method == "edge-scatter") {
    return is("engine", "vulkan") && (is("rows", "exact") || !all_planar);
  }
  if (method == "view-sample") {
    const bool on_device = is("engine", "vulkan"), sintorn = is("variant", "sintorn");
    return (on_device && (sintorn || !all_planar)) || (sintorn && std::ranges::count(scene.lights, "sphere") > 0);
  }
  if (method == "depth-complexity") {
    const bool forest = is("variant", "forest"), on_device = forest || is("variant", "laine") || is("crop", "off"),
               searches = is("search", "kd-tree") || is("search", "hemicube");
    return (forest && options.contains("crop")) ||
           (!forest && (options.contains("counter-bits") || options.contains("as"))) ||
           (on_device && is("engine", "native")) ||
           ((on_device || is("engine", "vulkan") || searches) && !all_planar) ||
           (searches && (on_device || is("engine", "vulkan")));
  }
  const bool circle = is("projection", "paraboloid");
  const bool faces = circle || (options.contains("fit") && !is("fit", "receivers") && !is("fit", "view"));
  if (method == "vssm" || method == "forward-map") return faces && is("rasteriser", "opengl");
  if (method == "shadow-map" || method == "pcf" || method == "pcss") {
    const auto is_set = [&](const char* key) { return options.contains(key) && std::stod(options.at(key)) != 0; };
    const bool offset = is_set("offsetFactor") || is_set("offsetUnits");
    const bool mean = is("test", "mean"), taps = is_set("taps"), keep = is_set("keep");
    const bool receivers = !options.contains("fit") || is("fit", "receivers");
    return (faces && (is("rasteriser", "opengl") || is("test", "id") || is("test", "object"))) ||
           (keep && (taps || mean || (options.contains("weights") && !is("weights", "equal")))) ||
           (mean && (taps || is("weights", "bilinear"))) ||
           (options.contains("history") && !is("history", "1") && (circle || !receivers)) ||
           (is("reproject", "on") && (circle || !receivers)) ||
           (offset && (circle || is("fit", "logpsm") || (options.contains("depth") && !is("depth", "first")))) ||
           (is("weights", "bilinear") && taps) ||
           (method == "pcf" && faces && is("size", "8") && !options.contains("window"));  // the default window is wider
  }
  if (method == "bitmask") return options.contains("subsample") && !is("subsample", "1") && !row["bits"].empty();
  if (method == "backproject") return is("form", "sphere") && scene.texture;
  if (method == "soft-irregular") return is("fusion", "union") && !is("umbra", "layers");
  if (method == "soft-shadow-map")
    return (is("form", "scatter") && is("precision", "fp16")) ||
           (is("patches", "bottom") && (is("passes", "2") || (options.contains("depth") && !is("depth", "first"))));
  return false;
}

std::map<std::string, std::string> options_of(const Row& row, const json& method) {
  std::map<std::string, std::string> options;
  for (const json& option : method.at("options")) {
    const auto name = option.at("name").get<std::string>();
    const std::string& value = row[method.at("name").get<std::string>() + "." + name];
    if (!value.empty()) options[name] = value;
  }
  return options;
}

void expect_whole_picture(const std::string& path, bool all_pixels) {
  const ExrFile picture = read_exr(path);
  for (const auto& [name, values] : picture.floats) {
    const bool visibility = name == "V" || name.ends_with(".V");
    const auto wrong = std::ranges::count_if(values, [&](float value) {
      if (visibility && std::isnan(value)) return all_pixels;
      return visibility ? !(value >= 0 && value <= 1) : !std::isfinite(value);
    });
    EXPECT_EQ(wrong, 0) << path << " " << name;
  }
  for (const char* attribute : {"penumbra.method", "penumbra.output", "penumbra.version"}) {
    EXPECT_TRUE(picture.attributes.contains(attribute)) << path << " " << attribute;
  }
}

void expect_whole_png(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  ASSERT_GT(bytes.size(), 20U) << path;
  EXPECT_EQ(bytes.substr(1, 3), "PNG") << path;
  EXPECT_NE(bytes.find("IEND", bytes.size() - 12), std::string::npos) << path;
}

void expect_whole_bits(const std::string& path) {
  const tests::BitsFile bits = tests::read_bits(path);
  EXPECT_EQ(bits.light_points.size(), bits.sample_count);
  EXPECT_EQ(bits.masks.size(), std::size_t{bits.width} * bits.height * bits.words_per_mask());
  const std::uint32_t rest = bits.sample_count % 32;
  for (std::size_t i = 0; i < bits.triangle.size(); ++i) {
    const std::uint32_t last = bits.masks[(i + 1) * bits.words_per_mask() - 1];
    if (rest != 0) {
      EXPECT_EQ(last >> rest, 0U) << path << " pixel " << i;
    }
  }
}

void expect_sane_stats(const json& stats) {
  for (const auto& [name, seconds] : stats.at("seconds").items()) EXPECT_TRUE(not_negative(seconds)) << name;
  const json& seconds = stats.at("seconds");
  if (!seconds.at("shadow").is_null()) {
    EXPECT_NEAR(seconds.at("shadow").get<double>(),
                seconds.at("light").get<double>() + seconds.at("evaluate").get<double>(), 1e-12);
  }
  for (const json& light : stats.at("lights")) {
    const bool area = light.at("quantity") == "area";
    EXPECT_EQ(light.at("lightSamples") == 0, area) << light;
    EXPECT_EQ(light.at("samplePattern").is_null(), area) << light;
  }
  EXPECT_GT(stats.at("size").at(0).get<int>() * stats.at("size").at(1).get<int>(), 0);
  EXPECT_FALSE(stats.at("device").get<std::string>().empty());
  for (const json& pass : stats.at("passes")) EXPECT_TRUE(not_negative(pass.at("milliseconds"))) << pass;
}

void expect_sane_metrics(const json& metrics) {
  expect_sane_stats(metrics.at("reference"));
  for (const json& method : metrics.at("methods")) {
    SCOPED_TRACE(method.dump());
    expect_sane_stats(method);
    EXPECT_TRUE(method.at("failure").is_null());
    for (const char* errors : {"error", "horizonError", "beautyError"}) {
      if (method.at(errors).is_null()) continue;
      for (const auto& [name, value] : method.at(errors).items()) EXPECT_TRUE(value.is_number()) << errors << name;
    }
    if (!method.at("error").is_null()) {
      const json& error = method.at("error");
      EXPECT_LE(error.at("mean").get<double>(), error.at("rmse").get<double>() + 1e-12);
      EXPECT_LE(error.at("rmse").get<double>(), error.at("max").get<double>() + 1e-12);
      EXPECT_LE(error.at("max").get<double>(), 1);
    }
    const bool counted = !method.at("pairsAll").is_null();
    for (const char* key : {"pairs", "pairsDiffering", "pairsDecided", "pairsZeroPredicate", "pairsMethodRight"}) {
      EXPECT_EQ(method.at(key).is_null(), !counted) << key;
    }
    EXPECT_TRUE(finite_or_null(method.at("pairsDecidedShare")));
    if (!counted) continue;
    const auto count = [&](const char* key) { return method.at(key).get<std::uint64_t>(); };
    EXPECT_LE(count("pairs"), count("pairsAll"));
    EXPECT_LE(count("pairsDiffering"), count("pairsAll"));
    EXPECT_LE(count("pairsDecided"), count("pairsDiffering"));
    EXPECT_EQ(count("pairsDecided"), count("pairsMethodRight") + count("pairsReferenceRight"));
  }
}

}  // namespace penumbra::tests
