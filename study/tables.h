#pragma once

#include <string>
#include <vector>

#include "nodes/types/report.h"
#include "study/findings.h"

namespace talkgraph::study {

// Shares are from 0 to 1; NaN marks what there is not enough of.

/// Of a Turing test's answers, a row a speaker and, if there are several, all of them: "synthetic as real", "real as
/// synthetic", each with Wilson's interval ("x low", "x high") and how many answers ("x answers").
Table confusions(const Measure& measure, double confidence);

/// A row a comparison: mean over people, "x std" and "x people" of either side, their difference, Cohen's h of mean
/// shares, p and effects.
Table table_of(const std::vector<Comparison>& comparisons, const Measure& measure);

/// A row 1, 2, 3 or more plays: "real" and "synthetic", means of people's mean scores, with "x std", the interval of
/// the mean ("x low", "x high") and "x answers".
Table by_plays(const Measure& measure, double confidence);

/// How many took part, finished, and count here.
Table progress(const Findings& findings);

/// How many gave which answers to two questions of the profile, two by two in their order; the last alone if they are
/// odd.
std::vector<Table> demographics(const Findings& findings);

/// A row a test, and the whole study, of those who finished it: median and quartiles of the minutes, of which pauses in
/// the whole study are part; medians of seconds and plays of a clip.
Table times(const Findings& findings);

/// Every table there is something in, by a name of letters, digits, "-" and ".".
std::vector<std::pair<std::string, Table>> tables_of(const Findings& findings);

}  // namespace talkgraph::study
