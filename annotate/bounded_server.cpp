#include "annotate/bounded_server.h"

#include <poll.h>

#include <chrono>
#include <thread>

namespace talkgraph::annotate {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
constexpr auto time_to_ask = std::chrono::seconds(3), time_to_take = std::chrono::seconds(60);
constexpr milliseconds look_for_stop(50);
/// Connections that say nothing occupy one each.
constexpr std::size_t threads = 64;

class Connection final : public httplib::Stream {
 public:
  Connection(int socket, std::size_t longest, const std::atomic<bool>& stop)
      : socket_(socket), left_(longest), stop_(stop) {}
  ~Connection() override {
    shutdown(socket_, SHUT_RDWR);
    close(socket_);
  }

  bool is_readable() const override { return wait(POLLIN); }
  bool is_writable() const override { return wait(POLLOUT); }
  ssize_t read(char* to, std::size_t size) override {
    if (size > left_ || !is_readable()) return -1;
    const auto n = recv(socket_, to, size, 0);
    if (n > 0) left_ -= static_cast<std::size_t>(n);
    return n;
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
};

}  // namespace

BoundedServer::BoundedServer(std::size_t longest_request) : longest_request_(longest_request) {
  new_task_queue = [] { return new httplib::ThreadPool(threads); };
}

bool BoundedServer::process_and_close_socket(socket_t socket) {
  Connection connection(socket, longest_request_, *stop_);
  bool closed = false;
  return process_request(connection, true, closed, nullptr);
}

void BoundedServer::run(const std::atomic<bool>& stop) {
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

}  // namespace talkgraph::annotate
