#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "study/answers.h"
#include "study/database.h"
#include "study/study.h"

namespace talkgraph::study {

/// How far somebody is who takes part.
struct Taker {
  std::int64_t id = 0;
  std::uint64_t seed = 0;  ///< of what this person is shown
  bool agreed = false;     ///< to take part
  bool started = false;    ///< the profile is given
  std::size_t clips = 0;   ///< answered
};

/// What people answer, in FOLDER/answers.db. Every change is made whole or not at all and on the disk when the call
/// returns; one that was made already changes nothing. Any number of threads may call. Throws DatabaseError where the
/// database cannot be used: nothing is changed then.
class Store {
 public:
  /// Makes the database with the first call. Throws std::runtime_error if it was begun with another study: other tests,
  /// questions, options or clips; what they are called and told may change.
  Store(const std::filesystem::path& folder, const Study& study);

  /// Parts of links: 32 hexadecimal digits of the system's generator.
  const std::string& start_token() const { return start_; }
  const std::string& report_token() const { return report_; }

  /// Makes room for somebody, who may have agreed already, and gives the token of the link. Nothing, where no more may
  /// come.
  std::optional<std::string> invite(bool agreed = false);
  std::optional<Taker> find(const std::string& token) const;
  void agree(const Taker& taker);
  void keep_profile(const Taker& taker, const std::map<std::string, int>& profile);
  /// Answers about a clip; `clips`: how many this person answered before it. False where that is no longer so. The
  /// last clip's finish the study.
  bool keep(const Taker& taker, std::size_t clips, const std::vector<Answer>& answers, bool last);

  struct Counts {
    std::int64_t invited = 0, started = 0, finished = 0, answers = 0;
  };
  Counts counts() const;

 private:
  struct Change {
    const std::function<void()>& make;
    bool done = false;
    std::exception_ptr failure = nullptr;
  };

  /// Changes that wait at the same time share a transaction, and so a sync of the disk.
  void change(const std::function<void()>& make);
  void make_all(const std::vector<Change*>& changes);

  Database database_;
  std::mutex mutex_;
  std::condition_variable turn_;
  std::vector<Change*> waiting_;
  bool busy_ = false;

  mutable std::mutex reading_;
  Database reader_;
  std::string start_, report_;
};

/// All that was kept, also while it is served. Throws std::runtime_error where there is none or it cannot be read.
Answers read_answers(const std::filesystem::path& folder);

}  // namespace talkgraph::study
