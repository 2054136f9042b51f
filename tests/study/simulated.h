#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "graph/json.h"
#include "study/answers.h"

namespace talkgraph::study {

/// Asks a server of this computer; `body` empty: GET. Gives the status, and JSON where there is some. Throws
/// std::runtime_error without an answer.
struct Reply {
  int status = 0;
  Json json;
};
Reply ask(int port, const std::string& path, const Json& body = nullptr);

/// Somebody who takes the study at once, without looking: agrees, gives a profile, loads each clip, answers at random.
/// Now and then a save comes twice, the second time with other answers. Gives what was saved first. `saved` is told of
/// the seconds that each save took.
std::vector<Answer> take_study(
    int port, const std::string& start_path, std::uint64_t seed,
    const std::function<void(double)>& saved = [](double) {});

}  // namespace talkgraph::study
