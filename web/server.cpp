#include "web/server.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>

namespace talkgraph::web {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
constexpr auto time_to_ask = std::chrono::seconds(3), time_to_take = std::chrono::seconds(60);
constexpr milliseconds look_for_stop(50);
/// Connections that say nothing occupy one each.
constexpr std::size_t threads = 64;
constexpr std::size_t longest_head = 1 << 15;

class Connection final : public httplib::Stream {
 public:
  Connection(int socket, std::size_t longest, const std::atomic<bool>& stop)
      : socket_(socket), left_(longest), stop_(stop) {}
  ~Connection() override {
    shutdown(socket_, SHUT_RDWR);
    close(socket_);
  }

  bool is_readable() const override { return taken_ < there_ || wait(POLLIN); }
  bool is_writable() const override { return wait(POLLOUT); }
  ssize_t read(char* to, std::size_t size) override {
    if (taken_ == there_ && !fill()) return -1;
    const auto n = std::min(size, there_ - taken_);
    std::copy_n(bytes_.data() + taken_, n, to);
    taken_ += n;
    return static_cast<ssize_t>(n);
  }
  ssize_t write(const char* from, std::size_t size) override {
    if (!answers_) until_ = Clock::now() + time_to_take;
    answers_ = true;
    return is_writable() ? send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT) : -1;
  }
  // Nobody reads addresses.
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return socket_; }

 private:
  /// The library asks for single bytes.
  bool fill() {
    if (left_ == 0 || !is_readable()) return false;
    const auto n = recv(socket_, bytes_.data(), std::min(bytes_.size(), left_), 0);
    if (n <= 0) return false;
    left_ -= static_cast<std::size_t>(n);
    taken_ = 0;
    there_ = static_cast<std::size_t>(n);
    return true;
  }
  bool wait(short event) const {
    pollfd what{socket_, event, 0};
    while (!stop_ && Clock::now() < until_)
      if (poll(&what, 1, look_for_stop.count()) > 0) return true;
    return false;
  }

  const int socket_;
  std::size_t left_;
  const std::atomic<bool>& stop_;
  Clock::time_point until_ = Clock::now() + time_to_ask;
  bool answers_ = false;
  std::array<char, 4096> bytes_;
  std::size_t taken_ = 0, there_ = 0;
};

httplib::Headers headers(const std::string& policy) {
  return {
      {"Content-Security-Policy", "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; " +
                                      policy + "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
      {"X-Content-Type-Options", "nosniff"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Referrer-Policy", "no-referrer"},
      {"Cache-Control", "no-store"},
  };
}

/// A length bounds a body.
void check_kind(const httplib::Request& request) {
  for (const char* name : {"Content-Encoding", "Transfer-Encoding"})
    if (request.has_header(name)) throw Refusal(400, fmt::format("a request with {} is not served", name));
}

}  // namespace

Server::Server(ServerOptions options) : options_(std::move(options)) {
  new_task_queue = [] { return new httplib::ThreadPool(threads); };
  set_default_headers(headers(options_.policy));
  set_payload_max_length(options_.longest_body);
  set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
    try {
      options_.check(request);
      check_kind(request);
      return HandlerResponse::Unhandled;
    } catch (const Refusal&) {
      answer_failure(response, std::current_exception());
      return HandlerResponse::Handled;
    }
  });
  set_exception_handler([](const httplib::Request&, httplib::Response& response, const std::exception_ptr& failure) {
    answer_failure(response, failure);
  });
  // The library would let several servers share a port.
  set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
}

std::optional<int> Server::bind(const std::string& address, int port) {
  const int got = port == 0 ? bind_to_any_port(address) : bind_to_port(address, port) ? port : -1;
  if (got < 0) return std::nullopt;
  ::listen(svr_sock_, SOMAXCONN);  // The library lets five wait.
  return got;
}

bool Server::process_and_close_socket(socket_t socket) {
  Connection connection(socket, options_.longest_body + longest_head, *stop_);
  bool closed = false;
  // The library cuts any answer by ranges, wherever they lie: who serves ranges reads the header.
  return process_request(connection, true, closed, [](httplib::Request& request) { request.ranges.clear(); });
}

void Server::run(const std::atomic<bool>& stop) {
  stop_ = &stop;
  std::atomic<bool> ended = false;
  std::thread watch([&] {
    while (!ended) {
      if (stop) this->stop();
      std::this_thread::sleep_for(look_for_stop);
    }
  });
  listen_after_bind();
  ended = true;
  watch.join();
}

std::string host_of(const httplib::Request& request) {
  const auto host = request.get_header_value("Host");
  return host.substr(0, host.starts_with('[') ? host.find(']') + 1 : host.find(':'));
}

void answer(httplib::Response& response, const Json& json, int status) {
  response.status = status;
  response.set_content(json.dump(), "application/json");
}

void answer_failure(httplib::Response& response, const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const Refusal& e) {
    answer(response, {{"error", e.what()}}, e.status);
  } catch (const std::invalid_argument& e) {
    answer(response, {{"error", e.what()}}, 400);
  } catch (const std::exception& e) {
    answer(response, {{"error", e.what()}}, 500);
  }
}

Json parse(const std::string& body, int deepest, const std::string& expected) {
  const auto bounded = [&](int depth, Json::parse_event_t, const Json&) {
    if (depth > deepest) throw Refusal(400, expected);
    return true;
  };
  auto json = Json::parse(body, bounded, false);
  if (json.is_discarded()) throw Refusal(400, expected);
  return json;
}

}  // namespace talkgraph::web
