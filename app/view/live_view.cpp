// SPDX-License-Identifier: Apache-2.0
// Connects the page's server with the renderer.

#include "app/view/live_view.hpp"

#include "app/view/message_text.hpp"
#include "app/view/page.hpp"
#include "base/error.hpp"
#include "compare/error_picture.hpp"
#include "network/requests.hpp"
#include "session/method_list.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <utility>

namespace penumbra::app {

using nlohmann::json;
using nlohmann::ordered_json;

namespace {

/// Returns the colours of signed errors from the darkest to the brightest, in equal steps of colour depth.
ordered_json error_scale() {
  auto colors = ordered_json::array();
  const auto dark = compare::error_colors(false), bright = compare::error_colors(true);
  for (std::size_t i = dark.size(); i-- > 1;) colors.push_back(dark[i]);
  for (const Color8& color : bright) colors.push_back(color);
  return colors;
}

}  // namespace

std::string view_page() {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\" data-frame=\"0\" data-exact=\"false\" data-ms=\"\" "
      "data-method=\"\">\n<head>\n"
      "<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Penumbra</title>\n<link rel=\"icon\" href=\"data:,\">\n<style "
      "nonce=\"@NONCE@\">\n{}</style>\n</head>\n<body>\n{}"
      "<script nonce=\"@NONCE@\">\n{}</script>\n</body>\n</html>\n",
      kViewStyle, kViewMarkup, kViewScript);
}

LiveView::LiveView(session::RunOptions options, WholeScene whole, network::ServerPlace place)
    : methods_(message_text(session::methods_json()["methods"])), error_scale_(message_text(error_scale())) {
  network::ServerOptions serving;
  serving.place = std::move(place);
  serving.token = network::make_token();
  serving.page = view_page();
  constexpr const char* kBytes = "application/octet-stream";
  serving.files = {
      {"/scene.json", "application/json", "scene.json", [this](std::string_view) { return renderer_->scene_text(); }},
      {"/scene/picture", "image/x-exr", "picture.exr",
       [this](std::string_view target) {
         return renderer_->light_picture(network::parameter_of(target, "light").value_or(""));
       }},
      {"/three.js", "text/javascript", "", [](std::string_view) { return std::string(kThreeScript); }},
      {"/space/meshes", kBytes, "", [this](std::string_view) { return space_->meshes(); }},
      {"/space/defects", kBytes, "", [this](std::string_view) { return space_->defects(); }},
      {"/space/shadows", kBytes, "", [this](std::string_view target) { return space_->shadows(target); }}};
  server_ = std::make_unique<network::PageServer>(std::move(serving), *this);
  renderer_ = std::make_unique<LiveRenderer>(
      std::move(options), std::move(whole),
      LiveEvents{.frame = [this](std::shared_ptr<const std::string> frame) { server_->send_frame(std::move(frame)); },
                 .say = [this](std::string_view level,
                               const std::string& text) { server_->send_to_all(message_text(saying(level, text))); },
                 .reloaded = [this] { send_state(0); },
                 .says_shown = true});
  space_ = std::make_unique<SpaceView>(*renderer_);
}

/// renderer_ is set: a client needs the token, which is in the address that is printed only afterwards.
void LiveView::opened(network::ClientId client) {
  server_->send(client, fmt::format(R"({{"type": "hello", "client": {}, "methods": {}, "errorColors": {}}})", client,
                                    methods_, error_scale_));
  server_->send(client, message_text(renderer_->state()));
  renderer_->show_again();
}

void LiveView::send_state(network::ClientId except) {
  const std::lock_guard lock(sending_);
  server_->send_newest(message_text(renderer_->state()), except);
}

void LiveView::message(network::ClientId client, std::string_view text) {
  try {
    do_message(client, parse_message(text));
  } catch (const Error& error) {
    server_->send(client, message_text(saying("error", error.what())));
    server_->send(client, message_text(renderer_->state()));
  }
}

void LiveView::do_message(network::ClientId client, const json& message) {
  const auto type = message.find("type");
  if (message.is_object() && type != message.end() && *type == "taken") {
    server_->taken(client);
    return renderer_->shown();
  }
  if (message.is_object() && type != message.end() && *type == "pixel") {
    const auto place = [&](const char* key) {
      const auto found = message.find(key);
      if (found == message.end() || !found->is_number_unsigned() || found->get<std::uint64_t>() > UINT32_MAX)
        throw InputError("message \"pixel\": {} is a pixel's number", key);
      return found->get<std::uint32_t>();
    };
    return server_->send(client, message_text(renderer_->pixel(place("x"), place("y"))));
  }
  if (renderer_->apply(message, client) == LiveChange::nothing) return;
  const auto moving = message.find("moving");
  const bool is_moving = moving != message.end() && moving->is_boolean() && moving->get<bool>();
  if (*type == "still") return;
  send_state(is_moving ? client : 0);  // the dragging client already has this state
}

}  // namespace penumbra::app
