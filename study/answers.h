#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace talkgraph::study {

/// Somebody who took part; nothing tells who.
struct Participant {
  std::int64_t id = 0;
  std::map<std::string, int> profile;  ///< option chosen, by question
  std::vector<std::string> tests;      ///< in the order they were given
  std::int64_t started = 0;            ///< seconds of the epoch
  std::int64_t finished = 0;           ///< 0: not yet
};

/// One question answered about one clip.
struct Answer {
  std::int64_t participant = 0;
  std::string test, clip, question;
  int option = 0;
  int position = 0;    ///< of the clip in the test as this person had it, from 0
  int plays = 0;       ///< how often the clip ran to its end; 1: no replay
  double seconds = 0;  ///< from the clip's first sight to the answer
  std::int64_t given = 0;
};

/// All there is, ordered by participant, then by when it was given.
struct Answers {
  std::vector<Participant> participants;
  std::vector<Answer> answers;
};

}  // namespace talkgraph::study
