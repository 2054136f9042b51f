#pragma once

#include <memory>
#include <thread>

#include "study/server.h"

namespace talkgraph::study {

/// A server that runs while this lives.
class RunningServer {
 public:
  explicit RunningServer(const std::filesystem::path& folder, ServerOptions options = at_any_port())
      : server_(folder, std::move(options)), thread_([this] { server_.run(stop_); }) {}
  ~RunningServer() {
    stop_ = true;
    thread_.join();
  }

  static ServerOptions at_any_port() {
    ServerOptions options;
    options.port = 0;
    return options;
  }
  Server* operator->() { return &server_; }
  /// Of a link: what follows the host.
  static std::string path(const std::string& url) { return url.substr(url.find('/', url.find("://") + 3)); }

 private:
  Server server_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace talkgraph::study
