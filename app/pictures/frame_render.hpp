#pragma once

#include "app/light_methods.hpp"
#include "app/output.hpp"
#include "app/runner.hpp"
#include "app/session.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// Where one picture goes; what is empty is not wanted.
struct FrameFiles {
  std::filesystem::path picture, stats, png, bits;

  /// All that are wanted, each with the option that asks for it.
  [[nodiscard]] std::vector<std::pair<const char*, std::filesystem::path>> all() const;
  [[nodiscard]] bool all_there() const;
};

/// How bright the PNG is: stops by which linear values are multiplied, or found from the picture.
struct Exposure {
  enum class Kind { automatic, first, fixed };
  Kind kind = Kind::automatic;
  float stops = 0;  ///< fixed; first: once it is known
};

/// "auto", "first" or a number of stops. Throws UsageError.
Exposure parse_exposure(const std::string& text);

/// The stops that an earlier run wrote into a picture's header; nothing if there is no such picture.
std::optional<float> written_exposure(const std::filesystem::path& picture);

/// What one picture shows, besides what is the same for all.
struct Frame {
  std::optional<std::int64_t> number;  ///< none was asked for
  std::string camera;                  ///< empty: the first
};

/// Renders pictures of one scene after each other. Methods, and what they prepared, are kept from one to the next.
class FrameRenderer {
 public:
  /// All must outlive it.
  FrameRenderer(const RunOptions& options, const MethodWish& wish, DeviceSource& devices, Progress& progress);

  /// Looks at a scene and computes all lights' V and beauty. `read_seconds`: what reading the scene took, of which
  /// nobody waited for anything else.
  void render(scenes::Scene scene, const Frame& frame, const std::filesystem::path& bits, double read_seconds);
  /// Writes what was computed last. `exposure` gets its stops if it is of a sequence's first picture and has none yet.
  /// Returns what stats.json says.
  compare::Stats write(const FrameFiles& files, Exposure& exposure);

  [[nodiscard]] const Session& session() const { return maker_.session(); }

 private:
  /// A method with the scene that it holds.
  struct Kept {
    LightMethod with;
    std::unique_ptr<visibility::Method> method;
    const visibility::SceneFloats* prepared = nullptr;
    std::uint64_t mesh_version = 0;
  };

  void choose_methods();
  Kept& method_for(const LightMethod& wanted);
  void say_warnings();

  const RunOptions& options_;
  const MethodWish& wish_;
  DeviceSource& devices_;
  Progress& progress_;
  SessionMaker maker_;
  std::vector<Kept> kept_;
  std::vector<std::string> said_;  // warnings, once each

  // Of the picture computed last:
  Frame frame_;
  std::vector<LightMethod> chosen_;
  std::vector<MethodLabel> labels_;
  std::vector<std::string> notes_;
  MethodRun run_;
  std::optional<BeautyAccumulator> beauty_;
  std::optional<BitsOutput> bits_;
  double read_seconds_ = 0, bits_seconds_ = 0, busy_seconds_ = 0;
};

}  // namespace penumbra::app
