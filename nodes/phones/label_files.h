#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "nodes/types/phones.h"

namespace talkgraph {

/// HTK label file: a line "start end label" each, times in 100 ns.
std::string htk_labels(const std::vector<Interval>& intervals);

/// A tier of a TextGrid.
struct LabelTier {
  std::string name;
  std::vector<Interval> intervals;
};
/// Praat TextGrid in the long text format; gaps become empty intervals.
std::string text_grid(const std::vector<LabelTier>& tiers);

/// CSV with the columns start, end (seconds) and label.
std::string csv_labels(const std::vector<Interval>& intervals);

// Readers. `name` stands in the error messages (std::runtime_error), which say
// the line. Intervals must be in order and not overlap.

/// Further columns (scores) are taken no notice of.
std::vector<Interval> parse_htk_labels(std::string_view text, const std::string& name);
/// The interval tiers of a TextGrid, long or short text format, UTF-8; empty labels
/// become "sil".
std::vector<LabelTier> parse_text_grid(std::string_view text, const std::string& name);
std::vector<Interval> parse_csv_labels(std::string_view text, const std::string& name);

}  // namespace talkgraph
