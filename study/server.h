#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace talkgraph::study {

struct ServerOptions {
  std::string listen = "127.0.0.1";  ///< address
  int port = 8018;                   ///< 0: any free one
  std::string url = "";              ///< by which people reach it; empty: the address and port
  /// Told how long each save took, seconds, from the request read to its answer ready. Called by any threads.
  std::function<void(double)> saved = [](double) {};
  /// Told of what keeps answers from being kept.
  std::function<void(const std::string&)> warn = [](const std::string&) {};
};

/// Serves the page on which people take a study, and keeps what they answer. On a loopback address only requests to
/// this computer, or to the host of `url`, are answered; nothing of a request but what was answered is kept.
///
///   GET  /start/TOKEN                   the page, for anybody
///   POST /start/TOKEN/consent           makes a participant: {"link": "p/TOKEN"}
///   GET  /p/TOKEN                       the page, of one participant
///   GET  /p/TOKEN/state                 what comes next, as the other two give as well (study/messages.h); /start too
///   POST /p/TOKEN/consent, profile, answers
///   GET  /p/TOKEN/clips/ID.webm, .mp4   clips of this participant, whole or a range
///   GET  /report/TOKEN                  counts; /report/TOKEN/answers.json, answers.csv
///
/// All POST requests may be repeated: what is kept stays as it is. 503: the database or a file cannot be used now.
class Server {
 public:
  /// Throws std::runtime_error if the study cannot be read, a clip of it is missing, its answers cannot be kept, or the
  /// port cannot be had.
  Server(const std::filesystem::path& folder, ServerOptions options);
  ~Server();

  std::string start_url() const;
  std::string report_url() const;
  /// The link of a new participant. Throws std::runtime_error where no more may come.
  std::string invite();
  int port() const;

  void run(const std::atomic<bool>& stop);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace talkgraph::study
