// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/assembly.hpp"
#include "import/xml.hpp"

#include <functional>
#include <string_view>

namespace penumbra::import {

/// Kind of an X3D geometry node.
enum class X3dGeometry {
  surface,  ///< a surface, whose faces were added
  curved,   ///< a sphere, cone, cylinder or disk: polygons of kX3dSides sides were added
  line,     ///< points, lines or letters: not a surface, or not supported
  unknown,
};

inline constexpr int kX3dSides = 48;

/// Returns the node that another refers to by USE, or the node itself.
using X3dResolve = std::function<pugi::xml_node(const pugi::xml_node&)>;

/// Adds the faces of a geometry node, which must not be a USE, to `part`.
X3dGeometry add_x3d_geometry(const XmlText& xml, const pugi::xml_node& node, const X3dResolve& resolve,
                             AssemblyPart& part);

/// Returns the numbers of an attribute, separated by blanks and commas; empty if there is none.
std::vector<double> x3d_reals(const XmlText& xml, const pugi::xml_node& node, const char* name);
/// Returns the numbers of an attribute, as many as `fallback` has, or `fallback` if there is no such attribute.
std::vector<double> x3d_reals(const XmlText& xml, const pugi::xml_node& node, const char* name,
                              std::vector<double> fallback);

}  // namespace penumbra::import
