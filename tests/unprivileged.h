#pragma once

#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace talkgraph::test {

/// While it lives, files are opened as by a user whom their rights hold for, even if root runs the test.
class Unprivileged {
 public:
  Unprivileged() { become(user_ == 0 ? 65534 : user_); }
  Unprivileged(const Unprivileged&) = delete;
  ~Unprivileged() noexcept(false) { become(user_); }

 private:
  static void become(uid_t user) {
    if (seteuid(user) != 0) throw std::system_error(errno, std::generic_category(), "seteuid");
  }
  uid_t user_ = geteuid();
};

}  // namespace talkgraph::test
