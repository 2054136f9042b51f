#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// How well phones were found: one row over all phones of all sequences, and a row for each sequence.
struct AlignmentTables {
  Table table;
  Table sequences;
};

/// How far phones that were found start from where they do. Phones are paired within each sequence by
/// least edit distance, pauses left out; pairs of one label are compared:
///   phones        in the truth
///   different     phones of the truth that were not found or found as others, and phones found
///                 that it lacks, per phone of the truth
///   right time    share of the time of the truth's phones in which the phone found is the same
///   median        median of |start found − true start|, ms
///   bias          median of start found − true start, ms
///   within 10 ms, within 20 ms, within 50 ms   shares of the pairs
/// NaN where there is no phone or no pair. A sequence for which nothing was found has all its phones
/// different. Memory is one byte for each pair of phones of a sequence. Throws std::invalid_argument
/// where phones were found for a sequence that has no truth.
struct ScoreAlignment {
  AlignmentTables operator()(const Collected<PhoneTrack>& truth, const Collected<PhoneTrack>& found) const;
};
void describe(Description<ScoreAlignment>& d);

}  // namespace talkgraph
