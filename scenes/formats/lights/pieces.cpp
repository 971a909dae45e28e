// SPDX-License-Identifier: Apache-2.0
// Lights in pieces in files: a list of shapes of other kinds, which emit as one light. A piece has no cone.

#include "base/assert.hpp"
#include "base/error.hpp"
#include "scenes/formats/lights/light_formats.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <type_traits>
#include <variant>

namespace penumbra::scenes {
namespace {

LightShape read_pieces(const nlohmann::json& list) {
  Pieces pieces;
  const auto add = [&](auto&& shape) {
    if constexpr (std::is_constructible_v<Pieces::Piece, decltype(shape)>)
      pieces.pieces.emplace_back(std::forward<decltype(shape)>(shape));
    else
      PENUMBRA_ASSERT(false, "a piece of a shape that has passed the schema: {}", list.dump());
  };
  for (const nlohmann::json& value : list) std::visit(add, read_light_shape(value));
  return pieces;
}

LightShape shape_of(const Pieces::Piece& piece) {
  return std::visit([](const auto& shape) { return LightShape(shape); }, piece);
}

void write_pieces(const LightShape& shape, TextStream& text) {
  const std::vector<Pieces::Piece>& pieces = std::get<Pieces>(shape).pieces;
  text.print("[");
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    text.print("{}{{", i > 0 ? ", " : "");
    write_light_shape(shape_of(pieces[i]), text);
    text.print("}}");
  }
  text.print("]");
}

void check_pieces(const LightShape& shape, const std::string& where) {
  const std::vector<Pieces::Piece>& pieces = std::get<Pieces>(shape).pieces;
  if (pieces.empty()) throw InputError("{}: there are no pieces; a light needs at least one", where);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    check_light_shape(shape_of(pieces[i]), fmt::format("{}/{}", where, i));
    const auto* sphere = std::get_if<Sphere>(&pieces[i]);
    if (sphere != nullptr && sphere->cone)
      throw InputError("{}/{}: a piece has no cone; make it a light of its own", where, i);
  }
}

}  // namespace

const LightFormat kPiecesFormat{.read = read_pieces, .write = write_pieces, .check = check_pieces};

}  // namespace penumbra::scenes
