// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/light_basis.hpp"
#include "maps/host/scene_space.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/method_options.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Fits of maps to the view of a camera (Eisemann et al. 2009, section 3.2; docs/map-fits.md): options, the fitted
/// body, and the closed forms of the papers.
namespace penumbra::maps {

/// Region covered by a map's texels.
enum class Fit : std::uint8_t {
  receivers,  ///< all objects that receive shadow, independent of the camera: map_fit.hpp
  view,       ///< receivers seen by the camera, in one window
  cascades,   ///< the same in slices of depth, each with a window (Engel 2006, Zhang et al. 2006)
  tiles,      ///< a quadtree of windows, finer where pixels need it (Giegl and Wimmer 2007, Lefohn et al. 2007)
  lispsm,     ///< a perspective along the view, n = (z_n + sqrt(z_n z_f)) / sin γ (Wimmer et al. 2004)
  tsm,        ///< the same, n from a region in focus (Martin and Tan 2004)
  psm,        ///< the camera's own perspective (Stamminger and Drettakis 2002)
  logpsm,     ///< a perspective from the eye and a logarithm along the view (Lloyd et al. 2008)
  faces,      ///< the faces of the camera's frustum, each with its own perspective (Kozlov 2004, Lloyd et al. 2006)
};
/// Spacing of the depths between cascades.
enum class Split : std::uint8_t { logarithmic, practical, pseudo_near, uniform };
/// Body of a fit: the receivers in the camera's frustum, or the parts of them visible at pixels.
enum class ViewBody : std::uint8_t { frustum, visible };

inline constexpr visibility::ChoiceOption kFit{
    "fit",
    {{"receivers", Fit::receivers},
     {"view", Fit::view},
     {"cascades", Fit::cascades},
     {"tiles", Fit::tiles},
     {"lispsm", Fit::lispsm},
     {"tsm", Fit::tsm},
     {"psm", Fit::psm},
     {"logpsm", Fit::logpsm},
     {"faces", Fit::faces}},
    Fit::receivers,
    "region over which texels are spread: all receivers; the camera's view, in one window, in slices of depth or in "
    "tiles; a perspective of the view; or the faces of its frustum, each with a perspective"};
/// The same option for methods that look up kernels of texels in one window or hemicube.
inline constexpr visibility::ChoiceOption kWindowFit{
    "fit",
    {{"receivers", Fit::receivers}, {"view", Fit::view}},
    Fit::receivers,
    "region over which texels are spread: all receivers, or the part of them that the camera sees; with all casters "
    "that can shade it"};
inline constexpr visibility::ChoiceOption kViewBody{
    "body",
    {{"visible", ViewBody::visible}, {"frustum", ViewBody::frustum}},
    ViewBody::visible,
    "region that a map covers: the visible points, or the receivers in the camera's frustum"};
inline constexpr auto kSnap = visibility::flag_option(
    "snap", false, "fit=view: texels keep their positions while the camera moves, and are up to 1.2 times as wide");
inline constexpr visibility::IntegerOption kCascades{
    "cascades", 0, 8, 0, "number of slices of depth, each with a map; 0: 4 for fit=cascades, 1 for the warps"};
inline constexpr visibility::ChoiceOption kSplit{"split",
                                                 {{"logarithmic", Split::logarithmic},
                                                  {"practical", Split::practical},
                                                  {"pseudo-near", Split::pseudo_near},
                                                  {"uniform", Split::uniform}},
                                                 Split::logarithmic,
                                                 "distribution of slices over depth: logarithmic, between logarithmic "
                                                 "and equal, logarithmic from a pseudo-near plane on, or equal"};
inline constexpr visibility::RealOption kSplitShare{"splitShare", 0, 1, 0.5,
                                                    "split=practical: weight of the logarithmic distribution; "
                                                    "pseudo-near: distance of the plane, as a share of all depths"};
inline constexpr visibility::IntegerOption kTiles{"tiles", 1, 64, 16, "fit=tiles: largest number of maps"};
/// Reason to cut a tile in four.
enum class Refine : std::uint8_t {
  needed,   ///< pixels are smaller than texels (fitted and resolution-matched maps)
  queried,  ///< the last cut changed pixels (queried virtual shadow maps, Giegl and Wimmer 2007)
};
inline constexpr visibility::ChoiceOption kRefine{
    "refine",
    {{"needed", Refine::needed}, {"queried", Refine::queried}},
    Refine::needed,
    "fit=tiles: cut a tile where pixels need finer texels, or while a cut changes the picture"};
inline constexpr visibility::IntegerOption kChanged{
    "changed", 0, 65536, 4, "refine=queried: number of changed pixels in a tile that do not yet require another cut"};
inline constexpr visibility::RealOption kFocus{
    "focus", 0.01, 0.99, 0.25, "fit=tsm: the nearest share of depths, which gets four fifths of the map"};

/// Use of a map's aliasing error (aliasing.hpp).
enum class AliasingUse : std::uint8_t { off, count, show };
inline constexpr visibility::ChoiceOption kAliasing{
    "aliasing",
    {{"off", AliasingUse::off}, {"count", AliasingUse::count}, {"show", AliasingUse::show}},
    AliasingUse::off,
    "count: adds the aliasing error m of the maps to the counters; show: V is 1/m, at most 1, in place of visibility"};

/// Projection of a map fitted to receivers.
enum class Projection : std::uint8_t {
  window,      ///< a window of directions, or a hemicube's five faces where a window would be too wide
  cube,        ///< five faces of a hemicube, even if a narrow window is sufficient
  paraboloid,  ///< one face, a half space in a circle (Brabec et al. 2002)
};
inline constexpr visibility::ChoiceOption kProjection{
    "projection",
    {{"window", Projection::window}, {"cube", Projection::cube}, {"paraboloid", Projection::paraboloid}},
    Projection::window,
    "fit=receivers: a window of directions (five faces where it would be too wide), always the five faces of half a "
    "cube, or a half space in the circle of a paraboloid"};
/// Values of all options above.
struct ViewFit {
  Fit fit = Fit::receivers;
  Projection projection = Projection::window;
  ViewBody body = ViewBody::visible;
  bool snap = false;
  std::uint32_t cascades = 0;
  Split split = Split::logarithmic;
  double split_share = kSplitShare.otherwise;
  std::uint32_t tiles = kTiles.otherwise;
  Refine refine = Refine::needed;
  std::uint32_t changed = kChanged.otherwise;
  double focus = kFocus.otherwise;
  AliasingUse aliasing = AliasingUse::off;

  /// Returns whether the fit depends on the camera.
  [[nodiscard]] bool sees_camera() const { return fit != Fit::receivers; }
  /// Returns whether there are faces other than a window or a hemicube (face_fit.hpp).
  [[nodiscard]] bool has_faces() const {
    return (fit != Fit::receivers && fit != Fit::view) || projection == Projection::paraboloid;
  }
  /// Returns whether there are faces that no rasteriser draws, for which each texel tests each triangle.
  [[nodiscard]] bool asks_triangles() const { return fit == Fit::logpsm || projection == Projection::paraboloid; }
  /// Returns whether tiles depend on pictures made with other tiles (queried_tiles.hpp).
  [[nodiscard]] bool queries() const { return fit == Fit::tiles && refine == Refine::queried; }
  [[nodiscard]] std::uint32_t slices() const {
    if (fit == Fit::tiles) return 1;
    return cascades != 0 ? cascades : fit == Fit::cascades ? 4U : 1U;
  }
};

/// Returns all options above, as listed by `methods`.
std::vector<visibility::OptionDescription> view_fit_descriptions();
/// Returns the options of methods with kWindowFit.
std::vector<visibility::OptionDescription> window_fit_descriptions();
/// Returns the fit as an option, such as "fit=tsm" or "projection=paraboloid".
std::string words_of(const ViewFit& fit);
/// Returns the values of the options that the method has, and defaults of all others.
ViewFit view_fit(std::span<const visibility::OptionDescription> options, const visibility::ParsedOptions& parsed);

/// Point that a fit must contain.
struct BodyPoint {
  glm::dvec3 p;      ///< in scene floats
  double depth = 0;  ///< along the view axis
};

/// Returns points whose convex hull on either side of the light's plane contains all receivers of the light seen by the
/// camera between these depths. Polygons in a frustum that are cut by the light's plane have points close to the plane
/// on both of its sides, whose directions from the light's centre are beyond every window.
std::vector<BodyPoint> body_points(const visibility::SceneFloats& scene, const visibility::Light& light,
                                   const LightBasis& basis, const visibility::ViewSamples& samples, ViewBody body,
                                   double from, double to, const SceneSpace& space = {});

/// Returns the n + 1 depths that bound the slices, the first near and the last far (Eisemann et al. 2009, section
/// 3.2.3.1). 0 < near ≤ far.
std::vector<double> split_depths(const ViewFit& fit, double near, double far, std::uint32_t slices);

/// Returns n_opt of Wimmer et al. 2004: the distance of the perspective's centre in front of the nearest visible point
/// for which the errors along the warped axis are equal at both ends. 0 < near ≤ far are depths along the view axis at
/// the ends of a map's axis across the light's rays, and `sine` is the sine of the angle γ between the view and the
/// light: the ends are (far − near) / sine from each other.
double lispsm_distance(double near, double far, double sine);

/// Returns the distance of the perspective's centre from the nearest point such that, of points up to `length` behind
/// the nearest, the one at the distance `focus` is mapped to four fifths of the map (Martin and Tan 2004, η). Infinite
/// if that point is there, or nearer, without a perspective.
double tsm_distance(double length, double focus);

/// Window of `size` texels with positions at multiples of their width: the width is increased to one of the steps
/// 2^(k/4), and `lower` is the start of the window.
struct SnappedSpan {
  double lower, texel;
};
SnappedSpan snapped(double lower, double upper, std::uint32_t size);

}  // namespace penumbra::maps
