#include "nodes/statistics/methods.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

#include "nodes/statistics/sequence_scores.h"
#include "nodes/statistics/signed_rank.h"

namespace talkgraph {
namespace {

double p_of(const std::vector<double>& differences) { return differences.empty() ? NAN : signed_rank(differences).p; }

void require_method(const Collected<Table>& methods, const std::string& name) {
  if (!methods.find(name))
    throw std::runtime_error(
        fmt::format("there is no method \"{}\"; there are {}", name, fmt::join(methods.keys(), ", ")));
}

Table described(const CompareMethods& settings, const Collected<Table>& methods, const std::vector<bool>& tested,
                const std::vector<std::string>& names, Random& random) {
  Table out{settings.title, "method", {}, methods.keys(), std::vector<std::vector<double>>(methods.size())};
  for (const auto& name : names) {
    for (const char* what : {"", " std", " low", " high"}) out.columns.push_back(name + what);
    std::vector<double> p(methods.size(), NAN);
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const SequenceScores scores = sequence_scores(methods[i], name);
      const auto values = values_of(scores);
      const auto [low, high] = settings.interval == IntervalKind::student
                                   ? student_interval(values, settings.confidence)
                                   : bootstrap_interval(values, settings.confidence, settings.samples, random);
      out.cells[i].insert(out.cells[i].end(), {mean_of(values), deviation_of(values), low, high});
      if (!settings.against.empty() && tested[i] && methods.key(i) != settings.against)
        p[i] = p_of(paired_differences(scores, sequence_scores(*methods.find(settings.against), name)));
    }
    if (settings.against.empty()) continue;
    out.columns.push_back(name + " p");
    p = corrected(p, settings.correction);
    for (std::size_t i = 0; i < methods.size(); ++i) out.cells[i].push_back(p[i]);
  }
  out.columns.emplace_back("sequences");
  for (std::size_t i = 0; i < methods.size(); ++i) out.cells[i].push_back(static_cast<double>(methods[i].rows.size()));
  return out;
}

/// Tests of pairs of methods by one score.
struct PairTests {
  std::vector<std::vector<double>> differences;
  std::vector<double> p;  ///< corrected over the pairs
};

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

Pairs pairs_of(const std::vector<bool>& tested) {
  Pairs pairs;
  for (std::size_t i = 0; i < tested.size(); ++i)
    for (std::size_t j = i + 1; j < tested.size(); ++j)
      if (tested[i] && tested[j]) pairs.emplace_back(i, j);
  return pairs;
}

std::vector<SequenceScores> scores_by_method(const Collected<Table>& methods, const std::string& name) {
  std::vector<SequenceScores> scores;
  for (std::size_t i = 0; i < methods.size(); ++i) scores.push_back(sequence_scores(methods[i], name));
  return scores;
}

PairTests test_pairs(const Pairs& pairs, const std::vector<SequenceScores>& scores, Correction correction) {
  PairTests tests;
  for (const auto& [i, j] : pairs) {
    tests.differences.push_back(paired_differences(scores[i], scores[j]));
    tests.p.push_back(p_of(tests.differences.back()));
  }
  tests.p = corrected(tests.p, correction);
  return tests;
}

Table paired(const CompareMethods& settings, const Collected<Table>& methods, const Pairs& pairs,
             const std::vector<std::string>& names) {
  Table out{settings.title + ": differences", "pair", {}, {}, std::vector<std::vector<double>>(pairs.size())};
  for (const auto& [i, j] : pairs) out.rows.push_back(methods.key(i) + " - " + methods.key(j));
  for (const auto& name : names) {
    for (const char* what : {"", " p", " effect"}) out.columns.push_back(name + what);
    const auto [differences, p] = test_pairs(pairs, scores_by_method(methods, name), settings.correction);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const double effect = differences[k].empty() ? NAN : signed_rank(differences[k]).effect;
      out.cells[k].insert(out.cells[k].end(), {mean_of(differences[k]), p[k], effect});
    }
  }
  return out;
}

/// A score that methods are ranked by.
struct Ranking {
  std::string score;
  double sign;  ///< 1 if the larger is better, -1 if the smaller
};

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

/// The mean of each method, turned so that the larger is better; -∞ of those that are not ranked.
std::vector<double> ranked_means(const std::vector<SequenceScores>& scores, const std::vector<bool>& tested,
                                 double sign) {
  std::vector<double> means;
  for (std::size_t i = 0; i < scores.size(); ++i)
    means.push_back(tested[i] && !scores[i].empty() ? sign * mean_of(values_of(scores[i])) : -INFINITY);
  return means;
}

std::vector<std::size_t> best_first(const std::vector<double>& means) {
  std::vector<std::size_t> order(means.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return means[a] > means[b]; });
  return order;
}

/// All methods, the best by the first ranking first; as they are if there is none.
std::vector<std::size_t> first_ranked(const Collected<Table>& methods, const std::vector<bool>& tested,
                                      const std::vector<Ranking>& rankings) {
  if (rankings.empty()) return best_first(std::vector<double>(methods.size()));
  const auto& [name, sign] = rankings[0];
  return best_first(ranked_means(scores_by_method(methods, name), tested, sign));
}

double value_or_nan(const SequenceScores& scores, const std::string& sequence) {
  const auto found = scores.find(sequence);
  return found == scores.end() ? NAN : found->second;
}

Table by_sequence(const CompareMethods& settings, const Collected<Table>& methods, const std::vector<bool>& tested,
                  const std::vector<Ranking>& rankings) {
  Table out{settings.title + ": each sequence", "sequence", {}, {}, {}};
  std::set<std::string> seen;
  for (std::size_t i = 0; i < methods.size(); ++i)
    for (const auto& sequence : methods[i].rows)
      if (seen.insert(sequence).second) out.rows.push_back(sequence);
  out.cells.resize(out.rows.size());
  const auto add = [&](const std::string& column, const SequenceScores& scores) {
    out.columns.push_back(column);
    for (std::size_t r = 0; r < out.rows.size(); ++r) out.cells[r].push_back(value_or_nan(scores, out.rows[r]));
  };
  for (const auto& [name, sign] : rankings) {
    const auto scores = scores_by_method(methods, name);
    add(name, best_scores(scores, tested, sign));
    for (const std::size_t i : best_first(ranked_means(scores, tested, sign)))
      add(name + ": " + methods.key(i), scores[i]);
  }
  return out;
}

Table behind_best(const CompareMethods& settings, const Collected<Table>& methods, const std::vector<bool>& tested,
                  const Pairs& pairs, const std::vector<Ranking>& rankings) {
  Table out{settings.title + ": behind the best, and sequences won", "method", {}, {}, {}};
  std::vector<std::vector<double>> cells(methods.size());
  for (const auto& [name, sign] : rankings) {
    for (const char* what : {" behind", " behind p", " won"}) out.columns.push_back(name + what);
    const auto scores = scores_by_method(methods, name);
    const auto tests = test_pairs(pairs, scores, settings.correction);
    const auto means = ranked_means(scores, tested, sign);
    const auto best = static_cast<std::size_t>(std::max_element(means.begin(), means.end()) - means.begin());
    std::vector<double> behind(methods.size(), NAN), p(methods.size(), NAN);
    if (best < means.size() && means[best] > -INFINITY) behind[best] = 0;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto [i, j] = pairs[k];
      if (i != best && j != best) continue;
      const std::size_t other = i == best ? j : i;
      const double difference = mean_of(tests.differences[k]);
      behind[other] = (i == best) == (sign > 0) ? difference : 0 - difference;  // never -0
      p[other] = tests.p[k];
    }
    const auto bests = best_scores(scores, tested, sign);
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const auto won = std::count_if(scores[i].begin(), scores[i].end(), [&](const auto& score) {
        return same_score(score.second, value_or_nan(bests, score.first));
      });
      cells[i].insert(cells[i].end(), {behind[i], p[i], static_cast<double>(won)});
    }
  }
  for (const std::size_t i : first_ranked(methods, tested, rankings))
    if (tested[i]) out.rows.push_back(methods.key(i)), out.cells.push_back(std::move(cells[i]));
  return out;
}

}  // namespace

CompareMethods::Out CompareMethods::operator()(const Collected<Table>& sequences, Random& random) const {
  if (!against.empty()) require_method(sequences, against);
  std::vector<bool> tested(sequences.size(), true);
  for (const auto& name : aside) {
    require_method(sequences, name);
    for (std::size_t i = 0; i < sequences.size(); ++i)
      if (sequences.key(i) == name) tested[i] = false;
  }
  const auto names = scores_of(sequences, scores);
  const auto rankings = rankings_of(*this, sequences);
  const Pairs pairs = pairs_of(tested);
  return {described(*this, sequences, tested, names, random), paired(*this, sequences, pairs, names),
          by_sequence(*this, sequences, tested, rankings), behind_best(*this, sequences, tested, pairs, rankings)};
}

void describe(Description<CompareMethods>& d) {
  d.type("statistics.methods")
      .version(3)
      .summary("one table of all methods: means, spread, confidence intervals, significance");
  d.source("Student 1908; Efron 1979; Wilcoxon 1945; Holm 1979; Benjamini & Hochberg 1995");
  d.input("sequences", "an object of named tables of evaluate.sequences, one a method");
  d.output("table", &CompareMethods::Out::table, "a row a method; of each score x: x, x std, x low, x high, x p");
  d.output("pairs", &CompareMethods::Out::pairs, "a row a pair of methods; of each score x: x, x p, x effect");
  d.output("sequences", &CompareMethods::Out::sequences,
           "a row a sequence; of each score x to rank by: x, the best of all methods, and x: METHOD, the best first");
  d.output("best", &CompareMethods::Out::best,
           "a row a method, from the best by the first score to rank by; of each such score x: x behind the best "
           "method's, x behind p, x won: sequences");
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
