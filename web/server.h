#pragma once

#include <httplib.h>

#include <atomic>
#include <exception>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "graph/json.h"

namespace talkgraph::web {

/// What a request is refused with.
struct Refusal : std::runtime_error {
  Refusal(int status, const std::string& what) : std::runtime_error(what), status(status) {}
  int status;
};

struct ServerOptions {
  std::size_t longest_body = 1 << 14;  ///< bytes
  std::string policy;                  ///< of content, beside what is forbidden always: "img-src 'self'"
  /// Throws a Refusal for a request that is not to be served.
  std::function<void(const httplib::Request&)> check = [](const httplib::Request&) {};
};

/// A server whose connections are bounded, however slowly their other ends write and read: one request each, of so many
/// bytes, whole within seconds, its answer taken within a minute; none outlives a stop. Bodies come as they are, with
/// their length. What is thrown is answered as JSON: {"error": ...}. Its pages may use their own scripts, styles and
/// requests, and nothing from elsewhere.
class Server : public httplib::Server {
 public:
  explicit Server(ServerOptions options);

  /// The port, where 0 is any free one; nothing if it cannot be had.
  std::optional<int> bind(const std::string& address, int port);
  /// Serves until the flag is raised.
  void run(const std::atomic<bool>& stop);

 private:
  bool process_and_close_socket(socket_t socket) override;

  const ServerOptions options_;
  const std::atomic<bool>* stop_ = nullptr;
};

/// The name in the header Host, without a port.
std::string host_of(const httplib::Request& request);

void answer(httplib::Response& response, const Json& json, int status = 200);
/// A Refusal by its status, an invalid argument by 400, all else by 500.
void answer_failure(httplib::Response& response, const std::exception_ptr& failure);

/// JSON nested no deeper than that. Throws a Refusal that says what is expected.
Json parse(const std::string& body, int deepest, const std::string& expected);

}  // namespace talkgraph::web
