// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/view/live_renderer.hpp"
#include "app/view/space_view.hpp"
#include "network/page_server.hpp"
#include "scenes/scene.hpp"
#include "session/options.hpp"

#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace penumbra::app {

/// Scene in a browser: the page's server, and the renderer of its pictures. All open pages show, and change, one state.
class LiveView final : public network::PageHandler {
 public:
  LiveView(session::RunOptions options, WholeScene whole, network::ServerPlace place);

  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;
  ~LiveView() override { server_->stop(); }

  [[nodiscard]] std::string address() const { return server_->address(); }
  [[nodiscard]] LiveRenderer& renderer() { return *renderer_; }

  void opened(network::ClientId client) override;
  void message(network::ClientId client, std::string_view text) override;
  void closed(network::ClientId) override {}

 private:
  void do_message(network::ClientId client, const nlohmann::json& message);
  void send_state(network::ClientId except);

  std::string methods_, error_scale_;  // JSON
  std::mutex sending_;  // held from reading a state until it is sent, so that an older state is never sent last
  std::unique_ptr<network::PageServer> server_;
  std::unique_ptr<LiveRenderer> renderer_;  // calls the server, therefore destroyed first
  std::unique_ptr<SpaceView> space_;
};

/// Returns the page as served.
std::string view_page();

}  // namespace penumbra::app
