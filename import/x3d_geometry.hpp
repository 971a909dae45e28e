#pragma once

#include "import/assembly.hpp"
#include "import/xml.hpp"

#include <functional>
#include <string_view>

namespace penumbra::mesh {

/// What an X3D geometry node is to a reader of surfaces.
enum class X3dGeometry {
  surface,  ///< its faces were added
  curved,   ///< a sphere, cone, cylinder or disk: polygons of kX3dSides sides were added
  line,     ///< points, lines or letters: no surface, or none that is read
  unknown,
};

inline constexpr int kX3dSides = 48;

/// The node that another names by USE, or the node itself.
using X3dResolve = std::function<pugi::xml_node(const pugi::xml_node&)>;

/// Adds the faces of a geometry node, which is no USE itself, to `part`.
X3dGeometry add_x3d_geometry(const XmlText& xml, const pugi::xml_node& node, const X3dResolve& resolve,
                             AssemblyPart& part);

/// The numbers of an attribute, which blanks and commas part; empty if there is none.
std::vector<double> x3d_reals(const XmlText& xml, const pugi::xml_node& node, const char* name);
/// So many of them, or `fallback` if there is no such attribute.
std::vector<double> x3d_reals(const XmlText& xml, const pugi::xml_node& node, const char* name,
                              std::vector<double> fallback);

}  // namespace penumbra::mesh
