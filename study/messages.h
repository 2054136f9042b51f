#pragma once

#include <map>
#include <string>
#include <vector>

#include "graph/json.h"
#include "study/answers.h"
#include "study/session.h"
#include "study/store.h"

namespace talkgraph::study {

/// What server and page tell each other. What a clip shows, which choice is right and what comes in later tests is not
/// in it. What is read throws a web::Refusal where it is not as expected.

/// {"stage": "consent"} with the texts to agree to.
Json consent_of(const Study& study);
/// Where somebody stands: "consent", "profile", "test" or "done", with what there is to show and to ask.
Json state_of(const Study& study, const Taker& taker);

/// {"age": 1, ...}: an option of each question.
std::map<std::string, int> profile_in(const Json& json, const Study& study);
/// {"clip": "t3", "plays": 2, "answers": {"real": {"option": 0, "seconds": 4.5}, ...}}: which of those shown it is ...
std::size_t clip_in(const Json& json, const std::vector<Showing>& shown);
/// ... and an answer to each question.
std::vector<Answer> answers_in(const Json& json, const Showing& shown);

Json to_json(const Answers& answers);
/// A line an answer.
std::string to_csv(const Answers& answers);

}  // namespace talkgraph::study
