#pragma once

#include "app/light_methods.hpp"
#include "app/output.hpp"
#include "app/pictures/exposure.hpp"
#include "app/pictures/frame_files.hpp"
#include "app/pictures/interpolated_areas.hpp"
#include "app/pictures/picture_file.hpp"
#include "app/pictures/picture_mean.hpp"
#include "app/pictures/tev_pictures.hpp"
#include "app/runner.hpp"
#include "app/session.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// What one picture shows, besides what is the same for all.
struct Frame {
  std::optional<double> number;  ///< none was asked for
  std::string camera;            ///< empty: the first
  std::uint32_t pixel_side = 1;  ///< view samples a pixel along each axis
  PixelFilter filter = {};       ///< of these
  /// Error of V up to which exact areas are interpolated (InterpolatedAreas); 0: every view sample is evaluated.
  double pixel_tolerance = kPixelTolerance;
  /// Scenes at other moments, whose mean the picture is; empty: it is that of the one moment. Each is asked for once.
  std::vector<std::function<scenes::Scene()>> moments = {};
  /// The scene is without_meshes(), and has those of the last picture; of one moment and of pixels' centres.
  bool same_meshes = false;
  bool keeps_masks = false;  ///< RenderedFrame::masks; of a picture of one moment and of pixels' centres
  /// Methods evaluate so many rows at once, and no more (RunPlan::band_rows).
  std::uint32_t band_rows = std::numeric_limits<std::uint32_t>::max();
};

/// The numbers of a picture, for each whole light and for all together. Row by row from the top.
struct RenderedFrame {
  std::vector<std::vector<float>> visibility;  ///< V of each light, each pixel
  std::vector<std::vector<glm::vec3>> beauty;  ///< of each light, each pixel; empty where none came
  std::vector<glm::vec3> sum;                  ///< of all lights
  std::vector<float> alpha;
  /// Masks of each light, words_per_mask() words a pixel; empty for a light without masks.
  std::vector<std::vector<std::uint32_t>> masks;
};

/// View samples that are points on surfaces, and what becomes of their numbers before they are written.
struct SurfaceView {
  ViewFinder finder;
  std::function<void(RenderedFrame&, const Session&)> finish;
  std::map<std::string, std::string> attributes;  ///< of OUT.exr, by full name
};

/// Renders pictures of one scene after each other. Methods, and what they prepared, are kept from one to the next; so
/// they are where `progress` throws between bands of rows, which gives a picture up.
class FrameRenderer {
 public:
  /// All must outlive it. Options and wish may change from one picture to the next.
  FrameRenderer(const RunOptions& options, const MethodWish& wish, const render::Machine& machine, Progress& progress);

  /// Scenes will follow one another as frames of an animation do. Before the first.
  void expect_frames() { expects_frames_ = true; }
  /// Pictures are of these view samples, one moment and one sample a pixel. Nothing lies before a surface, so that
  /// translucent ones are not composited. Before the first.
  void look_at_surface(SurfaceView view);
  /// Pictures that are written are shown there as well; it must outlive this object.
  void show_in(TevPictures& tev) { tev_ = &tev; }
  /// Looks at a scene and computes all lights' V and beauty: of it, or the mean of `frame.moments`; then positions,
  /// normals, depths and ids are those of `scene` and of pixels' centres. `read_seconds`: what reading the scene took,
  /// perhaps while the picture before was made; of the first, all since the process began.
  void render(scenes::Scene scene, const Frame& frame, const std::filesystem::path& bits, double read_seconds);
  /// Gives away what was computed last.
  RenderedFrame take();
  /// The content of stats.json for the picture computed last, without the seconds of writing it and the total.
  [[nodiscard]] compare::Stats stats();
  /// Writes what was computed last. `exposure` gets its stops if it is of a sequence's first picture and has none yet.
  /// Returns what stats.json says.
  compare::Stats write(const FrameFiles& files, Exposure& exposure);

  /// Whether Frame::same_meshes can be: a picture has been rendered, and the last one came to its end.
  [[nodiscard]] bool has_meshes() const { return maker_.is_whole(); }

  [[nodiscard]] const Session& session() const { return maker_.session(); }

 private:
  /// A method with the scene that it holds.
  struct Kept {
    LightMethod with;
    std::unique_ptr<visibility::Method> method;
    const visibility::SceneFloats* prepared = nullptr;
    std::uint64_t mesh_version = 0;
    bool used = false;  // for the picture computed last
  };

  /// For the view samples that a session looks at.
  void choose_methods(const Session& session);
  /// Why light samples are looked at that nobody asked for: once in a picture's stats, and once to who reads along.
  void say_notes();
  /// What the picture's lights were done with.
  void label_lights();
  /// Light samples were asked for, and nobody took them.
  void say_unused_samples();
  void run_methods(const std::filesystem::path& bits);
  /// What the chosen methods make of the view samples that are looked at; `bits` may be null.
  MethodRun run_lights(BeautyAccumulator& beauty, BitsOutput* bits);
  void keep_masks(const TileResult& tile);
  /// Composites translucent surfaces (BLEND), each shaded by view samples of its own, over what is behind them.
  void add_panes();
  void mark_lamps();
  void show(SessionMaker& maker, scenes::Scene scene);
  /// Throws UsageError for layers that the picture, which is shown, will not have.
  void check_wanted_layers() const;
  void render_mean(scenes::Scene scene);
  /// What methods look at: the picture's session, or that of more view samples a pixel.
  [[nodiscard]] const Session& lit() const { return fine_ ? fine_->maker.session() : maker_.session(); }
  [[nodiscard]] SessionMaker& lit_maker() { return fine_ ? fine_->maker : maker_; }
  Kept& method_for(const LightMethod& wanted);
  void say_warnings();
  void say_once(const std::vector<std::string>& warnings);
  /// Notes which lights some view sample that is looked at is before.
  void mark_lights();
  /// Once all view samples have been looked at.
  void say_idle_lights();

  /// The session of more view samples a pixel, whose picture is several times as large.
  struct Fine {
    Fine(const RunOptions& given, const render::Machine& machine) : options(given), maker(options, machine) {}
    Fine(const Fine&) = delete;
    Fine& operator=(const Fine&) = delete;
    ~Fine() = default;
    RunOptions options;
    SessionMaker maker;  // refers to these
  };
  /// Messages that have been said, so that each is said once.
  struct Said {
    std::vector<std::string> warnings;
    bool camera = false;
  };
  /// Which method each light gets, of the view samples that are looked at.
  struct Plan {
    std::vector<LightMethod> chosen;
    // The methods that count light samples where something may let light through, of lights that have areas elsewhere.
    std::vector<std::optional<LightMethod>> counting;
    std::vector<visibility::Light> lights;  // as those chosen know them: of areas, without filtered_by
  };
  /// The methods that did the lights of the picture computed last.
  struct Done {
    std::map<std::string, LightMethod> with;  // by name: what counted where anything did, else what gave areas
    std::set<std::string> in_part;            // names of lights that both did
    std::vector<MethodLabel> labels;
    std::vector<std::uint8_t> lights_something;  // of each whole light: a view sample is before it
  };
  /// The picture computed last.
  struct Picture {
    Frame frame;
    std::vector<std::string> notes;
    MethodRun run;
    std::vector<std::vector<glm::vec3>> beauty;     // of each light
    bool layers = false;                            // translucent surfaces are looked at, and not what is behind them
    std::vector<std::vector<std::uint32_t>> masks;  // of each light
    std::vector<float> alpha;                       // of each pixel
    std::vector<std::uint8_t> lamps;  // of each pixel: a translucent body of a light is seen; empty: none is
    std::optional<PictureMean> mean;  // nothing: the picture is that of one moment and of pixels' centres
    std::optional<Mattes> mattes;     // there when that is
    std::optional<BitsOutput> bits;
  };
  /// Seconds that it took. `make`: the device and methods. `beauty`: all that is done with what methods answer, writing
  /// bits included.
  struct Spent {
    double load = 0, make = 0, view = 0, beauty = 0, bits = 0;
  };

  const RunOptions& options_;
  const MethodWish& wish_;
  PictureFormat format_;
  render::Machine machine_;
  Progress& progress_;
  SessionMaker maker_;
  std::optional<Fine> fine_;
  std::vector<Kept> kept_;
  bool expects_frames_ = false;
  std::optional<SurfaceView> surface_;  // nothing: what a camera sees
  TevPictures* tev_ = nullptr;          // none: they are only written
  Said said_;
  Plan plan_;
  Done done_;
  Picture picture_;
  Spent spent_;
  double written_ = 0;  // when the last picture was, since the process began
};

}  // namespace penumbra::app
