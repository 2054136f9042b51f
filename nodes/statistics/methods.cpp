#include "nodes/statistics/methods.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>

#include "nodes/statistics/sequence_scores.h"
#include "nodes/statistics/signed_rank.h"

namespace talkgraph {
namespace {

/// A score that methods are ranked by.
struct Ranking {
  std::string score;
  double sign;  ///< 1 if the larger is better, -1 if the smaller
};

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// One score of all methods, and their pairs tested by it.
struct MethodScores {
  std::vector<SequenceScores> by_method;
  std::vector<double> differences, p, effects;  ///< of each pair: mean; of its test, p corrected over the pairs
};

/// What all tables are made of.
struct Comparison {
  const CompareMethods& settings;
  const Collected<Table>& methods;
  std::optional<std::size_t> against = {};
  std::vector<bool> tested = {};            ///< of each method
  Pairs pairs = {};                         ///< of those tested
  std::vector<std::string> described = {};  ///< scores
  std::vector<Ranking> rankings = {};
  std::map<std::string, MethodScores> scores = {};  ///< those described and those ranked by
};

SignedRank test_of(const std::vector<double>& differences) {
  return differences.empty() ? SignedRank{.p = NAN, .effect = NAN} : signed_rank(differences);
}

std::size_t place_of(const Collected<Table>& methods, const std::string& name) {
  const auto& keys = methods.keys();
  const auto at = std::find(keys.begin(), keys.end(), name);
  if (at == keys.end())
    throw std::runtime_error(fmt::format("there is no method \"{}\"; there are {}", name, fmt::join(keys, ", ")));
  return static_cast<std::size_t>(at - keys.begin());
}

Pairs pairs_of(const std::vector<bool>& tested) {
  Pairs pairs;
  for (std::size_t i = 0; i < tested.size(); ++i)
    for (std::size_t j = i + 1; j < tested.size(); ++j)
      if (tested[i] && tested[j]) pairs.emplace_back(i, j);
  return pairs;
}

std::vector<Ranking> rankings_of(const CompareMethods& settings, const Collected<Table>& methods) {
  std::vector<Ranking> rankings;
  std::vector<std::string> names;
  for (const double sign : {1.0, -1.0})
    for (const auto& score : sign > 0 ? settings.larger_better : settings.smaller_better) {
      if (std::find(names.begin(), names.end(), score) != names.end())
        throw std::runtime_error(fmt::format("methods are ranked by \"{}\" twice", score));
      names.push_back(score);
      rankings.push_back({score, sign});
    }
  scores_of(methods, names);
  return rankings;
}

MethodScores method_scores(const Comparison& c, const std::string& name) {
  MethodScores scores;
  for (std::size_t i = 0; i < c.methods.size(); ++i) scores.by_method.push_back(sequence_scores(c.methods[i], name));
  for (const auto& [i, j] : c.pairs) {
    const auto differences = paired_differences(scores.by_method[i], scores.by_method[j]);
    const SignedRank test = test_of(differences);
    scores.differences.push_back(mean_of(differences));
    scores.p.push_back(test.p);
    scores.effects.push_back(test.effect);
  }
  scores.p = corrected(scores.p, c.settings.correction);
  return scores;
}

Comparison comparison_of(const CompareMethods& settings, const Collected<Table>& methods) {
  Comparison c{.settings = settings, .methods = methods};
  c.tested.assign(methods.size(), true);
  if (!settings.against.empty()) c.against = place_of(methods, settings.against);
  for (const auto& name : settings.aside) c.tested[place_of(methods, name)] = false;
  c.pairs = pairs_of(c.tested);
  c.described = scores_of(methods, settings.scores);
  c.rankings = rankings_of(settings, methods);
  std::set<std::string> wanted(c.described.begin(), c.described.end());
  for (const auto& ranking : c.rankings) wanted.insert(ranking.score);
  for (const auto& name : wanted) c.scores[name] = method_scores(c, name);
  return c;
}

/// Of each method's test against one, corrected over the methods.
std::vector<double> p_against(const Comparison& c, const std::vector<SequenceScores>& by_method) {
  std::vector<double> p(by_method.size(), NAN);
  for (std::size_t i = 0; i < p.size(); ++i)
    if (c.tested[i] && i != *c.against) p[i] = test_of(paired_differences(by_method[i], by_method[*c.against])).p;
  return corrected(p, c.settings.correction);
}

Table described(const Comparison& c, Random& random) {
  const CompareMethods& settings = c.settings;
  Table out{settings.title, "method", {}, c.methods.keys(), std::vector<std::vector<double>>(c.methods.size())};
  for (const auto& name : c.described) {
    for (const char* what : {"", " std", " low", " high"}) out.columns.push_back(name + what);
    const auto& by_method = c.scores.at(name).by_method;
    for (std::size_t i = 0; i < by_method.size(); ++i) {
      const auto values = values_of(by_method[i]);
      const auto [low, high] = settings.interval == IntervalKind::student
                                   ? student_interval(values, settings.confidence)
                                   : bootstrap_interval(values, settings.confidence, settings.samples, random);
      out.cells[i].insert(out.cells[i].end(), {mean_of(values), deviation_of(values), low, high});
    }
    if (!c.against) continue;
    out.columns.push_back(name + " p");
    const auto p = p_against(c, by_method);
    for (std::size_t i = 0; i < p.size(); ++i) out.cells[i].push_back(p[i]);
  }
  out.columns.emplace_back("sequences");
  for (std::size_t i = 0; i < c.methods.size(); ++i)
    out.cells[i].push_back(static_cast<double>(c.methods[i].rows.size()));
  return out;
}

Table paired(const Comparison& c) {
  Table out{c.settings.title + ": differences", "pair", {}, {}, std::vector<std::vector<double>>(c.pairs.size())};
  for (const auto& [i, j] : c.pairs) out.rows.push_back(c.methods.key(i) + " - " + c.methods.key(j));
  for (const auto& name : c.described) {
    for (const char* what : {"", " p", " effect"}) out.columns.push_back(name + what);
    const auto& [by_method, differences, p, effects] = c.scores.at(name);
    for (std::size_t k = 0; k < c.pairs.size(); ++k)
      out.cells[k].insert(out.cells[k].end(), {differences[k], p[k], effects[k]});
  }
  return out;
}

/// The best score of each sequence that a tested method has.
SequenceScores best_scores(const std::vector<SequenceScores>& scores, const std::vector<bool>& tested, double sign) {
  SequenceScores best;
  for (std::size_t i = 0; i < scores.size(); ++i)
    for (const auto& [sequence, value] : scores[i])
      if (tested[i]) {
        const auto at = best.emplace(sequence, value).first;
        if (sign * value > sign * at->second) at->second = value;
      }
  return best;
}

/// The scores of sequences that all ranked methods have: those that are tested and have any.
std::vector<SequenceScores> shared_scores(const std::vector<SequenceScores>& scores, const std::vector<bool>& tested) {
  std::map<std::string, std::size_t> methods;  // that have a sequence
  std::size_t ranked = 0;
  for (std::size_t i = 0; i < scores.size(); ++i)
    if (tested[i] && !scores[i].empty()) {
      ++ranked;
      for (const auto& [sequence, value] : scores[i]) ++methods[sequence];
    }
  std::vector<SequenceScores> shared(scores.size());
  for (std::size_t i = 0; i < scores.size(); ++i)
    for (const auto& entry : scores[i])
      if (tested[i] && methods[entry.first] == ranked) shared[i].insert(entry);
  return shared;
}

/// The mean of each method over what all have, turned so that the larger is better; -∞ of those that are not ranked.
std::vector<double> ranked_means(const std::vector<SequenceScores>& scores, const std::vector<bool>& tested,
                                 double sign) {
  std::vector<double> means;
  for (const auto& shared : shared_scores(scores, tested))
    means.push_back(shared.empty() ? -INFINITY : sign * mean_of(values_of(shared)));
  return means;
}

std::vector<std::size_t> best_first(const std::vector<double>& means) {
  std::vector<std::size_t> order(means.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return means[a] > means[b]; });
  return order;
}

/// The methods that are tested, the best by the first ranking first; as they are if there is none.
std::vector<std::size_t> first_ranked(const Comparison& c) {
  const auto means = c.rankings.empty()
                         ? std::vector<double>(c.methods.size())
                         : ranked_means(c.scores.at(c.rankings[0].score).by_method, c.tested, c.rankings[0].sign);
  auto order = best_first(means);
  std::erase_if(order, [&](std::size_t i) { return !c.tested[i]; });
  return order;
}

double value_or_nan(const SequenceScores& scores, const std::string& sequence) {
  const auto found = scores.find(sequence);
  return found == scores.end() ? NAN : found->second;
}

Table by_sequence(const Comparison& c) {
  Table out{c.settings.title + ": each sequence", "sequence", {}, {}, {}};
  std::set<std::string> seen;
  for (std::size_t i = 0; i < c.methods.size(); ++i)
    for (const auto& sequence : c.methods[i].rows)
      if (seen.insert(sequence).second) out.rows.push_back(sequence);
  out.cells.resize(out.rows.size());
  const auto add = [&](const std::string& column, const SequenceScores& scores) {
    out.columns.push_back(column);
    for (std::size_t r = 0; r < out.rows.size(); ++r) out.cells[r].push_back(value_or_nan(scores, out.rows[r]));
  };
  for (const auto& [name, sign] : c.rankings) {
    const auto& by_method = c.scores.at(name).by_method;
    add(name, best_scores(by_method, c.tested, sign));
    for (const std::size_t i : best_first(ranked_means(by_method, c.tested, sign)))
      add(name + ": " + c.methods.key(i), by_method[i]);
  }
  return out;
}

/// Of each method: how far behind the best, p of that, sequences won.
std::vector<std::vector<double>> standings(const Comparison& c, const Ranking& ranking) {
  const auto& [by_method, differences, p, effects] = c.scores.at(ranking.score);
  std::vector<std::vector<double>> cells(by_method.size(), {NAN, NAN, 0});
  const auto shared = shared_scores(by_method, c.tested);
  const auto means = ranked_means(by_method, c.tested, ranking.sign);
  const auto best = static_cast<std::size_t>(std::max_element(means.begin(), means.end()) - means.begin());
  for (std::size_t i = 0; i < by_method.size(); ++i)
    if (means[i] > -INFINITY)
      cells[i][0] = mean_of(ranking.sign > 0 ? paired_differences(shared[best], shared[i])
                                             : paired_differences(shared[i], shared[best]));
  for (std::size_t k = 0; k < c.pairs.size(); ++k)
    if (const auto [i, j] = c.pairs[k]; means[best] > -INFINITY && (i == best || j == best))
      cells[i == best ? j : i][1] = p[k];
  const auto bests = best_scores(by_method, c.tested, ranking.sign);
  for (std::size_t i = 0; i < by_method.size(); ++i)
    for (const auto& [sequence, value] : by_method[i]) cells[i][2] += same_score(value, value_or_nan(bests, sequence));
  return cells;
}

Table behind_best(const Comparison& c) {
  Table out{c.settings.title + ": behind the best, and sequences won", "method", {}, {}, {}};
  const auto order = first_ranked(c);
  for (const std::size_t i : order) out.rows.push_back(c.methods.key(i));
  out.cells.resize(out.rows.size());
  for (const auto& ranking : c.rankings) {
    for (const char* what : {" behind", " behind p", " won"}) out.columns.push_back(ranking.score + what);
    const auto cells = standings(c, ranking);
    for (std::size_t row = 0; row < order.size(); ++row)
      out.cells[row].insert(out.cells[row].end(), cells[order[row]].begin(), cells[order[row]].end());
  }
  return out;
}

}  // namespace

CompareMethods::Out CompareMethods::operator()(const Collected<Table>& sequences, Random& random) const {
  const Comparison c = comparison_of(*this, sequences);
  return {described(c, random), paired(c), by_sequence(c), behind_best(c)};
}

void describe(Description<CompareMethods>& d) {
  d.type("statistics.methods")
      .version(4)
      .summary("one table of all methods: means, spread, confidence intervals, significance");
  d.source("Student 1908; Efron 1979; Wilcoxon 1945; Holm 1979; Benjamini & Hochberg 1995");
  d.input("sequences", "an object of named tables of evaluate.sequences, one a method");
  d.output("table", &CompareMethods::Out::table,
           "a row a method; of each score x: x, x std, x low, x high, x p; sequences: how many the method has");
  d.output("pairs", &CompareMethods::Out::pairs, "a row a pair of methods; of each score x: x, x p, x effect");
  d.output("sequences", &CompareMethods::Out::sequences,
           "a row a sequence; of each score x to rank by: x, the best of all methods, and x: METHOD, the best first");
  d.output(
      "best", &CompareMethods::Out::best,
      "a row a method, from the best by the first score to rank by; of each such score x: x behind, x behind p, x won; "
      "x behind: how far the mean is behind the best method's, over the sequences that all have; x won: sequences in "
      "which no other method is better");
  d.param("scores", &CompareMethods::scores).doc("which, in the order of the columns; empty: all");
  d.param("against", &CompareMethods::against)
      .doc("method that each other is tested against by Wilcoxon's signed-rank test over sequences; empty: none");
  d.param("aside", &CompareMethods::aside).doc("methods that are described, not tested, such as the recorded face");
  d.param("larger_better", &CompareMethods::larger_better)
      .doc("scores to rank by, better the larger they are: what `sequences` and `best` tell of");
  d.param("smaller_better", &CompareMethods::smaller_better).doc("scores to rank by, better the smaller they are");
  d.param("confidence", &CompareMethods::confidence).within(0.5, 0.999).doc("of the intervals");
  d.param("interval", &CompareMethods::interval)
      .doc("of the mean: Student's t, or quantiles of bootstrap samples, which need no normal scores");
  d.param("samples", &CompareMethods::samples).within(100, 1000000).doc("of the bootstrap");
  d.param("correction", &CompareMethods::correction).doc("of the p-values of a score for testing many methods");
  d.param("title", &CompareMethods::title).doc("heading of the tables");
}

}  // namespace talkgraph
