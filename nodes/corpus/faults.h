#pragma once

#include <stdexcept>
#include <string>

#include "nodes/types/recording.h"

namespace talkgraph {

inline constexpr auto lenient_doc =
    "labels, landmarks and tracks that cannot be read are left out without an error; talkgraph corpus check looks a "
    "corpus over so";

/// Calls `read`; what it cannot read is a fault of the recording.
template <class Read>
void attempt(Recording& recording, const Read& read) try {
  read();
} catch (const std::runtime_error& e) {
  recording.faults.emplace_back(e.what());
}

/// The faults of a recording, a line each; empty if it has none.
std::string faults_text(const Recording& recording);

/// Throws std::runtime_error with the faults of a recording, if it has any.
void refuse_faults(const Recording& recording);

}  // namespace talkgraph
