// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/formats/scenes_ahead.hpp"
#include "session/light_methods.hpp"
#include "session/output.hpp"
#include "session/pictures/exposure.hpp"
#include "session/pictures/faint_lights.hpp"
#include "session/pictures/frame_files.hpp"
#include "session/pictures/interpolated_areas.hpp"
#include "session/pictures/picture_file.hpp"
#include "session/pictures/picture_mean.hpp"
#include "session/pictures/still_areas.hpp"
#include "session/pictures/tev_pictures.hpp"
#include "session/runner.hpp"
#include "session/session.hpp"
#include "visibility/all_triangles.hpp"
#include "visibility/frame_memory.hpp"

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

namespace penumbra::session {

/// Scene of a picture, and the time of reading it.
struct PictureScene {
  scenes::Scene scene;
  scenes::Instances instances = {};  ///< instances that have no copies
  double seconds = 0;
  std::shared_ptr<scenes::ScenesAhead> ahead = {};  ///< the picture's other moments, read with the scene; null: none
};

/// Content of one picture in addition to the options common to all pictures.
struct Frame {
  std::optional<double> number;  ///< nullopt: not requested
  std::string camera;            ///< empty: the first
  std::uint32_t pixel_side = 1;  ///< view samples of a pixel along each axis
  PixelFilter filter = {};       ///< weights of these view samples
  /// Error of V up to which exact areas are interpolated (InterpolatedAreas); 0: every view sample is evaluated.
  double pixel_tolerance = kPixelTolerance;
  /// Scenes at other moments, whose mean is the picture; empty: a picture of one moment. Each function is called once.
  std::vector<std::function<PictureScene()>> moments = {};
  /// Instances of the scene, which are not in its soup; null: none.
  const scenes::Instances* instances = nullptr;
  /// The scene was made by without_meshes() and uses the meshes of the last picture; only for one moment and pixels'
  /// centres.
  bool same_meshes = false;
  /// A light is left out of view samples where its unshadowed light is at most this share of all lights' (FaintLights);
  /// 0: nowhere.
  double light_cutoff = 0;
  bool keeps_masks = false;  ///< fill RenderedFrame::masks; only for a picture of one moment and pixels' centres
  /// Number of view samples of a band, approximately, if a pixel has several (FrameRenderer::mean_bands).
  std::uint64_t band_samples = std::uint64_t{1} << 21;
  /// Largest number of rows that methods evaluate at once (RunPlan::band_rows).
  std::uint32_t band_rows = std::numeric_limits<std::uint32_t>::max();
};

/// Numbers of a picture, for each whole light and for all together. Row by row from the top.
struct RenderedFrame {
  std::vector<std::vector<float>> visibility;  ///< V of each light, each pixel
  std::vector<std::vector<glm::vec3>> beauty;  ///< of each light, each pixel; empty for lights without results
  std::vector<glm::vec3> sum;                  ///< sum over all lights
  std::vector<float> alpha;
  /// Masks of each light, words_per_mask() words a pixel; empty for a light without masks.
  std::vector<std::vector<std::uint32_t>> masks;
};

/// View samples that are points on surfaces, and a function that is applied to their results before these are written.
struct SurfaceView {
  ViewFinder finder;
  std::function<void(RenderedFrame&, const Session&)> finish;
  std::map<std::string, std::string> attributes;  ///< of OUT.exr, by full name
};

/// Renders pictures of one scene one after another. Methods and their prepared data are kept from picture to picture,
/// even if `progress` throws between bands of rows, which cancels a picture.
class FrameRenderer {
 public:
  /// All arguments must outlive this object. Options and wish may change from one picture to the next.
  FrameRenderer(const RunOptions& options, const MethodWish& wish, const render::Machine& machine, Progress& progress);

  /// Prepares for scenes that follow one another as frames of an animation. To be called before the first picture.
  void expect_frames() { expects_frames_ = true; }
  /// Gives methods the previous pictures of the same camera (visibility::RemembersFrames), from the next picture on.
  void remember_frames() { memories_.emplace(); }
  /// Forgets all previous pictures.
  void forget_frames() {
    if (memories_) memories_.emplace();
  }
  /// Renders pictures at these view samples, of one moment and one sample a pixel. No surface lies in front of these
  /// points, so translucent surfaces are not composited. To be called before the first picture.
  void look_at_surface(SurfaceView view);
  /// Also shows written pictures in `tev`, which must outlive this object.
  void show_in(TevPictures& tev) { tev_ = &tev; }
  /// Computes V and beauty of all lights: for `scene`, or the mean of `frame.moments`; in the latter case positions,
  /// normals, depths and ids are those of `scene` and of pixels' centres. `read_seconds`: time spent reading this scene
  /// (may overlap the previous picture); for the first picture, time since the start of the process.
  void render(scenes::Scene scene, const Frame& frame, const std::filesystem::path& bits, double read_seconds);
  /// Returns the numbers of the last picture, by move.
  RenderedFrame take();
  /// Returns the content of stats.json for the last picture, without the seconds of writing and the total.
  [[nodiscard]] compare::Stats stats();
  /// Writes the last picture. Sets the stops of `exposure` if this is a sequence's first picture and the stops are
  /// unknown. Returns the content of stats.json.
  compare::Stats write(const FrameFiles& files, Exposure& exposure);

  /// Returns whether Frame::same_meshes is permitted: a picture has been rendered, and the last one was completed.
  [[nodiscard]] bool has_meshes() const { return maker_.is_whole(); }

  [[nodiscard]] const Session& session() const { return maker_.session(); }

 private:
  /// Method with its scene.
  struct Kept {
    LightMethod with;
    std::unique_ptr<visibility::Method> method;
    const visibility::SceneFloats* prepared = nullptr;
    std::uint64_t mesh_version = 0;
    bool used = false;  // for the last picture
  };

  /// Chooses the methods for the view samples of a session.
  void choose_methods(const Session& session);
  /// Adds notes about light samples used without a request: once to a picture's stats, and once to the log.
  void say_notes();
  /// Describes how many view samples, moments and points of a lens the picture is averaged over; empty for one alone.
  void note_means(std::map<std::string, std::string>& attributes) const;
  /// Describes the methods that the picture's lights were computed with.
  void label_lights();
  /// Warns if light samples were requested, and no method used them.
  void say_unused_samples();
  void run_methods(const std::filesystem::path& bits);
  /// Runs the chosen methods at the current view samples; `bits` may be null.
  MethodRun run_lights(BeautyAccumulator& beauty, BitsOutput* bits);
  /// Finds the lights that are left out of the current view samples; counts them once a picture.
  FaintLights leave_out_faint(const BeautyAccumulator& beauty);
  /// Adds the cost of other moments of the same lights to the cost of this one.
  static void add_times(MethodRun& to, const MethodRun& before);
  /// Throws ResourceError if the masks that the picture keeps need more memory than there is.
  void require_room_for_masks() const;
  void keep_masks(const TileResult& tile);
  /// Returns the previous pictures for the current view samples; null if there are none, or the picture is a mean.
  visibility::FrameMemory* memory();
  /// Returns the names of the whole lights whose V is written to no file and read by no other code.
  [[nodiscard]] std::vector<std::string> lights_without_v() const;
  /// Composites translucent surfaces (BLEND), each shaded at its own view samples, over the surfaces behind.
  void add_panes();
  void mark_lamps();
  void show(SessionMaker& maker, scenes::Scene scene, const scenes::Instances* instances);
  void note_seconds(const SessionMaker& maker);
  /// Returns whether the picture is of a scene with instances, and can be rendered in bands.
  [[nodiscard]] bool shows_in_bands(const std::filesystem::path& bits) const;
  /// Renders bands of rows, each with as many rows as memory allows for the part of the scene that matters to them.
  void render_in_bands(const scenes::Scene& scene);
  /// Returns whether the picture is of a scene with instances, and the method can be given all triangles apart from the
  /// scene (session::passes_triangles).
  [[nodiscard]] bool passes_triangles() const;
  /// Renders a scene that contains only what pixels see; the method is given all triangles apart from it.
  void render_passing(const scenes::Scene& scene, const std::filesystem::path& bits);
  /// Throws UsageError for requested layers that the current picture will not have.
  void check_wanted_layers() const;
  void render_mean(scenes::Scene scene, bool by_lens);
  /// Rows of the picture whose means are computed together, and the rows of view samples that these take.
  struct MeanBand {
    visibility::Tile pixels, samples;
  };
  /// Divides a picture with several view samples a pixel into bands, so that memory holds the view samples of one at a
  /// time; one band if a method of its lights may look at the whole picture. The means are the same bits.
  [[nodiscard]] std::vector<MeanBand> mean_bands() const;
  /// Returns whether the picture's camera has a lens and the picture several view samples a pixel to look through it.
  /// Warns if they are too few.
  bool has_lens(const scenes::Scene& scene);
  /// Session that methods evaluate: the picture's, or the one with more view samples a pixel or through a lens.
  [[nodiscard]] const Session& lit() const { return fine_ ? fine_->maker.session() : maker_.session(); }
  [[nodiscard]] SessionMaker& lit_maker() { return fine_ ? fine_->maker : maker_; }
  Kept& method_for(const LightMethod& wanted);
  void say_warnings();
  /// Throws ResourceError, with the method's name, if the requested method needs a Vulkan device and there is none.
  void require_device() const;
  void say_once(const std::vector<std::string>& warnings);
  /// Marks the lights in front of which there is a view sample.
  void mark_lights();
  /// Warns about lights without effect; to be called after all view samples were processed.
  void say_idle_lights();

  /// Session with more view samples a pixel, whose picture is several times as large, or through a lens.
  struct Fine {
    Fine(const RunOptions& given, const render::Machine& machine) : options(given), maker(options, machine) {}
    Fine(const Fine&) = delete;
    Fine& operator=(const Fine&) = delete;
    ~Fine() = default;
    RunOptions options;
    SessionMaker maker;  // refers to these
  };
  /// Messages already logged, so that each is logged once.
  struct Said {
    std::vector<std::string> warnings;
    bool camera = false;
  };
  /// Methods of each light, for the current view samples.
  struct Plan {
    std::vector<LightMethod> chosen;
    // Methods with light samples, used at pixels with translucent surfaces or holes in between, for lights with areas
    // elsewhere.
    std::vector<std::optional<LightMethod>> counting;
    std::vector<visibility::Light> lights;  // lights given to the chosen methods: for areas, without filtered_by
  };
  /// Methods of the lights of the last picture.
  struct Done {
    std::map<std::string, LightMethod> with;  // by name: the method with light samples if used anywhere, else the
                                              // method for areas
    std::set<std::string> in_part;            // names of lights with both methods
    std::vector<MethodLabel> labels;
    std::vector<std::uint8_t> lights_something;  // of each whole light: whether a view sample is in front of the light
  };
  /// The last picture.
  struct Picture {
    Frame frame;
    std::vector<std::string> notes;
    std::optional<compare::LightCutoff> cutoff;  // present if lights may be left out
    MethodRun run;
    std::vector<std::vector<glm::vec3>> beauty;     // of each light
    bool in_bands = false;                          // the current view samples are those of some rows alone
    std::optional<visibility::Tile> own_rows;       // those of these rows that no other band has; nullopt: all
    const visibility::AllTriangles* all = nullptr;  // given to methods if the session has only a part; else null
    bool layers = false;                            // translucent surfaces are evaluated, not the surfaces behind them
    std::vector<std::vector<std::uint32_t>> masks;  // of each light
    std::vector<float> alpha;                       // of each pixel
    std::vector<std::uint8_t> lamps;    // for each pixel, 1: a light's translucent body is seen; empty: nowhere
    std::optional<PictureMean> mean;    // nullopt: the picture is of one moment and of pixels' centres
    std::optional<Mattes> mattes;       // present if mattes are requested
    std::optional<StillMoments> still;  // for several moments, pixels' centres and areas
    std::optional<BitsOutput> bits;
  };
  /// Seconds of the picture. `make`: the device and methods. `beauty`: all processing of methods' results, including
  /// writing bits.
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
  std::optional<std::map<std::string, visibility::FrameMemory>> memories_;  // by camera; nullopt: not remembered
  std::optional<SurfaceView> surface_;                                      // nullopt: view samples of a camera
  TevPictures* tev_ = nullptr;                                              // nullptr: pictures are only written
  Said said_;
  Plan plan_;
  Done done_;
  Picture picture_;
  Spent spent_;
  double written_ = 0;  // end of writing the last picture, in seconds since the start of the process
};

}  // namespace penumbra::session
