#pragma once

#include <cstdint>

#include "nodes/types/phone_chain.h"

namespace talkgraph {

/// The chain of sequences of labels, one after the other, `lengths` of them each, at least 1: first phones and
/// transitions counted, each once more.
PhoneChain phone_chain(const std::vector<std::string>& labels, const std::vector<std::int64_t>& lengths);

}  // namespace talkgraph
