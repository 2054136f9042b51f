#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "annotate/project.h"

namespace talkgraph::annotate {

/// Serves the page on which a person annotates a project, on this computer alone (127.0.0.1). Requests that name
/// another host or come from a page of another origin are refused, so that no site in the same browser reaches it.
///
///   GET  /api/project               scheme and frames, each with its KEY
///   GET  /api/frames                key, state and tag of every frame
///   GET  /api/frames/KEY            points, state ("new", "draft", "done", "broken"), tag; of a new or broken one
///                                   points to begin with; of a broken one the reason
///   GET  /api/frames/KEY/begin      points to begin with, whatever its state
///   GET  /api/frames/KEY/picture    PNG
///   PUT  /api/frames/KEY            {"points": [[x, y], ...], "done": ...}; If-Match: the tag that was changed
///
/// A PUT answers 412 with what is there if the frame has another tag by now, and 404 if this project has no such frame:
/// a page that another project has made changes nothing here.
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
