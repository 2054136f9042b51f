#include "nodes/statistics/groups.h"

#include "nodes/statistics/intervals.h"
#include "nodes/statistics/rank_sum.h"
#include "nodes/statistics/sequence_scores.h"

namespace talkgraph {

Table CompareGroups::operator()(const Collected<Table>& groups) const {
  Table out{title, "groups", {}, {}, {}};
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < groups.size(); ++i)
    for (std::size_t j = i + 1; j < groups.size(); ++j) {
      pairs.emplace_back(i, j);
      out.rows.push_back(groups.key(i) + " - " + groups.key(j));
    }
  out.cells.resize(pairs.size());
  for (const auto& score : scores_of(groups, scores)) {
    for (const char* what : {"", " p", " effect"}) out.columns.push_back(score + what);
    std::vector<double> differences, p, effects;
    for (const auto& [i, j] : pairs) {
      const auto a = values_of(sequence_scores(groups[i], score)), b = values_of(sequence_scores(groups[j], score));
      const RankSum test = rank_sum(a, b, static_cast<std::size_t>(exact_up_to));
      differences.push_back(mean_of(a) - mean_of(b));
      p.push_back(test.p);
      effects.push_back(test.effect);
    }
    p = corrected(p, correction);
    for (std::size_t k = 0; k < pairs.size(); ++k)
      out.cells[k].insert(out.cells[k].end(), {differences[k], p[k], effects[k]});
  }
  return out;
}

void describe(Description<CompareGroups>& d) {
  d.type("statistics.groups").summary("every pair of independent groups by Wilcoxon's rank-sum test");
  d.source("Thesis §6.3.4; Wilcoxon 1945; Mann & Whitney 1947; Holm 1979; Benjamini & Hochberg 1995");
  d.input("groups", "an object of named tables, one a group; their rows are not paired");
  d.output("table", "a row a pair of groups; of each score x: x, the difference of means, x p, x effect");
  d.param("scores", &CompareGroups::scores).doc("which, in the order of the columns; empty: all");
  d.param("exact_up_to", &CompareGroups::exact_up_to)
      .within(0, 200)
      .doc("values of two groups in all for which p is exact, ties included; above, of the tie-corrected normal");
  d.param("correction", &CompareGroups::correction).doc("of the p-values of a score for testing many pairs");
  d.param("title", &CompareGroups::title).doc("heading of the table");
}

}  // namespace talkgraph
