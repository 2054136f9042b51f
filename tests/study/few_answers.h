#pragma once

#include "study/answers.h"
#include "study/study.h"

namespace talkgraph::study::test {

/// Ann, two clips real (r1, r2) and two synthetic (s1, s2), in a Turing test "turing" (with a "t" before the clips'
/// names), a perceptual test "opinion" of a scale to 5 (with an "o"; r1 and s1 with recorded, r2 and s2 with static
/// eyes) and, with two choices, of which the first is right, "reading" ("i").
Study small();

/// An answer to the only question of a test; seconds 10 × plays.
Answer answered(std::int64_t participant, const std::string& test, const std::string& clip, int option, int plays = 1);
/// Native ("yes", "no", not to say) and, where it is one, the time of the end; began at 1000 s.
Participant person(std::int64_t id, int native, std::int64_t finished = 0);

/// Three people: 1 and 2 native, 3 not; 1 and 3 finished. All rated, each clip of one kind alike: real 5, 4, 4,
/// synthetic 1, 2, 3.
Answers opinions();

}  // namespace talkgraph::study::test
