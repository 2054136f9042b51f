#include "nodes/statistics/methods.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
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

Table paired(const CompareMethods& settings, const Collected<Table>& methods, const std::vector<bool>& tested,
             const std::vector<std::string>& names) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < methods.size(); ++i)
    for (std::size_t j = i + 1; j < methods.size(); ++j)
      if (tested[i] && tested[j]) pairs.emplace_back(i, j);
  Table out{settings.title + ": differences", "pair", {}, {}, std::vector<std::vector<double>>(pairs.size())};
  for (const auto& [i, j] : pairs) out.rows.push_back(methods.key(i) + " - " + methods.key(j));
  for (const auto& name : names) {
    for (const char* what : {"", " p", " effect"}) out.columns.push_back(name + what);
    std::vector<SequenceScores> scores;
    for (std::size_t i = 0; i < methods.size(); ++i) scores.push_back(sequence_scores(methods[i], name));
    std::vector<std::vector<double>> differences;
    std::vector<double> p;
    for (const auto& [i, j] : pairs) {
      differences.push_back(paired_differences(scores[i], scores[j]));
      p.push_back(p_of(differences.back()));
    }
    p = corrected(p, settings.correction);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const double effect = differences[k].empty() ? NAN : signed_rank(differences[k]).effect;
      out.cells[k].insert(out.cells[k].end(), {mean_of(differences[k]), p[k], effect});
    }
  }
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
  return {described(*this, sequences, tested, names, random), paired(*this, sequences, tested, names)};
}

void describe(Description<CompareMethods>& d) {
  d.type("statistics.methods").summary("one table of all methods: means, spread, confidence intervals, significance");
  d.source("Student 1908; Efron 1979; Wilcoxon 1945; Holm 1979; Benjamini & Hochberg 1995");
  d.input("sequences", "an object of named tables of evaluate.sequences, one a method");
  d.output("table", &CompareMethods::Out::table, "a row a method; of each score x: x, x std, x low, x high, x p");
  d.output("pairs", &CompareMethods::Out::pairs, "a row a pair of methods; of each score x: x, x p, x effect");
  d.param("scores", &CompareMethods::scores).doc("which, in the order of the columns; empty: all");
  d.param("against", &CompareMethods::against)
      .doc("method that each other is tested against by Wilcoxon's signed-rank test over sequences; empty: none");
  d.param("aside", &CompareMethods::aside).doc("methods that are described, not tested, such as the recorded face");
  d.param("confidence", &CompareMethods::confidence).within(0.5, 0.999).doc("of the intervals");
  d.param("interval", &CompareMethods::interval)
      .doc("of the mean: Student's t, or quantiles of bootstrap samples, which need no normal scores");
  d.param("samples", &CompareMethods::samples).within(100, 1000000).doc("of the bootstrap");
  d.param("correction", &CompareMethods::correction).doc("of the p-values of a score for testing many methods");
  d.param("title", &CompareMethods::title).doc("heading of the tables");
}

}  // namespace talkgraph
