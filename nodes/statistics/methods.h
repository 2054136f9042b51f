#pragma once

#include "graph/description.h"
#include "graph/random.h"
#include "nodes/statistics/correction.h"
#include "nodes/statistics/intervals.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Compares methods by their scores of each sequence. Tests are Wilcoxon's signed-rank test, sequence by sequence
/// (signed_rank.h), over the sequences that have both scores; NaN where none has. Throws std::runtime_error if the
/// tables' columns differ, a sequence is there twice, a score is infinite or unknown, a method named here is not there,
/// or methods are ranked by a score twice.
struct CompareMethods {
  std::vector<std::string> scores = {};  ///< columns, in their order; empty: all
  std::string against = {};
  std::vector<std::string> aside = {};
  std::vector<std::string> larger_better = {};   ///< scores to rank methods by
  std::vector<std::string> smaller_better = {};  ///< scores to rank methods by
  double confidence = 0.95;
  IntervalKind interval = IntervalKind::student;
  int samples = 10000;
  Correction correction = Correction::holm;
  std::string title = "Scores";

  struct Out {
    /// A row a method. Of each score:
    ///   x         mean over the sequences that have it
    ///   x std     standard deviation of a sample
    ///   x low, x high  confidence interval of the mean
    ///   x p       of the test against the method `against`, corrected over the methods for this score; NaN for that
    ///             method and those of `aside`. Not there if `against` is empty.
    /// The last column is the number of sequences.
    Table table;
    /// A row a pair "A - B" of methods, those of `aside` left out. Of each score:
    ///   x         mean of the difference
    ///   x p       of the test, corrected over the pairs for this score
    ///   x effect  matched-pairs rank-biserial correlation: 1 if A's score is the larger one in every sequence
    Table pairs;
    /// A row a sequence that any method has. Of each ranked score x:
    ///   x           the best of all methods, those of `aside` left out
    ///   x: METHOD   of each method, from the best mean to the worst as in `best`, then of those of `aside`; NaN if
    ///               it has none
    Table sequences;
    /// A row a method, those of `aside` left out, the best by the first ranked score first. Of each ranked score, the
    /// best method being that of the best mean over the sequences that all these methods have:
    ///   x behind    mean difference to the best method over those sequences; 0 of the best one, NaN if there are none
    ///   x behind p  as in `pairs`, corrected over all of them, for the same scores chose the best; NaN of the best one
    ///   x won       sequences in which no other method is better
    Table best;
  };
  Out operator()(const Collected<Table>& sequences, Random& random) const;
};
void describe(Description<CompareMethods>& d);

}  // namespace talkgraph
