#pragma once

#include <httplib.h>

#include <atomic>

namespace talkgraph::annotate {

/// A server whose connections are bounded, however slowly their other ends write and read: one request each, of so many
/// bytes, whole within seconds, its answer taken within a minute; none outlives a stop.
class BoundedServer : public httplib::Server {
 public:
  /// Counts the bytes of a request, head and body.
  explicit BoundedServer(std::size_t longest_request);

  /// Serves until the flag is raised.
  void run(const std::atomic<bool>& stop);

 private:
  bool process_and_close_socket(socket_t socket) override;

  const std::size_t longest_request_;
  const std::atomic<bool>* stop_ = nullptr;
};

}  // namespace talkgraph::annotate
