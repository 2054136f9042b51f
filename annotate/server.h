#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "annotate/project.h"

namespace talkgraph::annotate {

/// Serves the page on which a person annotates a project, on this computer alone (127.0.0.1). Requests that name
/// another host or come from a page of another origin are refused, so that no site in the same browser reaches it.
///
///   GET  /api/project             scheme and frames
///   GET  /api/frames              state and tag of every frame
///   GET  /api/frames/N            points, state ("new", "draft", "done"), tag; of a new one, points to begin with
///   GET  /api/frames/N/begin      points to begin with, whatever its state
///   GET  /api/frames/N/picture    PNG
///   PUT  /api/frames/N            {"points": [[x, y], ...], "done": ...}; If-Match: the tag that was changed
///
/// A PUT answers 412 with what is there if the frame has another tag by now.
class Server {
 public:
  /// Port 0: any free one. Throws std::runtime_error if the port is taken.
  Server(Project& project, int port);
  ~Server();

  int port() const { return port_; }
  std::string url() const;
  /// Serves until the flag is raised.
  void run(const std::atomic<bool>& stop);

 private:
  struct State;
  const std::unique_ptr<State> state_;
  int port_ = 0;
};

}  // namespace talkgraph::annotate
