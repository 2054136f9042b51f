#include "nodes/mapping/tied_gaussians.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "nodes/types/visemes.h"

namespace talkgraph {

namespace {

using Members = std::vector<Eigen::Index>;

const std::string& phone_at(const PhoneContext& context, std::int64_t place) {
  if (place < 0) return context.left;
  return place > 0 ? context.right : context.phone;
}

bool answer(const ContextNode& question, const PhoneContext& context) {
  const std::string& phone = phone_at(context, question.place);
  return question.viseme < 0 ? phone == question.phone : viseme(phone) == question.viseme;
}

std::vector<ContextNode> questions_about(const std::vector<PhoneContext>& contexts, bool neighbours) {
  std::vector<ContextNode> questions;
  for (const std::int64_t place : neighbours ? std::vector{0, -1, 1} : std::vector{0}) {
    std::set<std::string> phones;
    std::set<std::int64_t> visemes;
    for (const PhoneContext& c : contexts) {
      const std::string& phone = phone_at(c, place);
      phones.insert(phone);
      if (const auto shape = viseme(phone)) visemes.insert(*shape);
    }
    for (const auto shape : visemes) questions.push_back({.place = place, .viseme = shape, .phone = {}});
    for (const auto& phone : phones) questions.push_back({.place = place, .phone = phone});
  }
  return questions;
}

/// Log-likelihood of each kind's frames under its own Gaussian; 0 of none.
Eigen::VectorXd log_likelihoods(const FrameSums& s, const Eigen::VectorXd& floors) {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(s.counts.size());
  for (Eigen::Index k = 0; k < all.size(); ++k) {
    if (s.counts(k) <= 0) continue;
    const Eigen::ArrayXd mean = s.sums.row(k).transpose() / s.counts(k),
                         spread = s.squares.row(k).transpose().array() / s.counts(k) - mean.square(),
                         variance = spread.max(floors.array());
    all(k) = -0.5 * s.counts(k) * ((2 * std::numbers::pi * variance).log() + spread / variance).sum();
  }
  return all;
}

/// Sums over kinds of what each row of weights has of them.
FrameSums merged(const Eigen::MatrixXd& weights, const FrameSums& s, const Members& kinds) {
  FrameSums m(0, 0);
  m.counts = weights * s.counts(kinds);
  m.sums = weights * s.sums(kinds, Eigen::all);
  m.squares = weights * s.squares(kinds, Eigen::all);
  return m;
}

FrameSums difference(const FrameSums& all, const FrameSums& parts) {
  FrameSums d(0, 0);
  d.counts = all.counts(0) - parts.counts.array();
  d.sums = (-parts.sums).rowwise() + all.sums.row(0);
  d.squares = (-parts.squares).rowwise() + all.squares.row(0);
  return d;
}

class Grower {
 public:
  Grower(const std::vector<PhoneContext>& contexts, const TreeLimits& limits)
      : limits_(limits), questions_(questions_about(contexts, limits.neighbours)) {
    answers_.resize(std::ssize(questions_), std::ssize(contexts));
    for (Eigen::Index c = 0; c < answers_.cols(); ++c)
      for (Eigen::Index q = 0; q < answers_.rows(); ++q)
        answers_(q, c) = answer(questions_[static_cast<std::size_t>(q)], contexts[static_cast<std::size_t>(c)]);
  }

  /// The tree of a position.
  void grow(std::size_t root, const FrameSums& contexts) {
    least_gain_ = limits_.penalty * static_cast<double>(contexts.sums.cols()) * std::log(contexts.counts.sum());
    Members all(static_cast<std::size_t>(contexts.counts.size()));
    std::iota(all.begin(), all.end(), 0);
    grow(root, contexts, all);
  }

  std::vector<ContextNode> nodes;
  Eigen::Index leaves = 0;

 private:
  /// From a node to which the `members` of contexts lead.
  void grow(std::size_t node, const FrameSums& contexts, const Members& members) {
    const Eigen::Index question = best_question(contexts, members);
    if (question < 0) {
      nodes[node].row = leaves++;
      return;
    }
    const std::size_t yes = nodes.size();
    nodes[node] = questions_[static_cast<std::size_t>(question)];
    nodes[node].yes = static_cast<std::int64_t>(yes);
    nodes[node].no = static_cast<std::int64_t>(yes + 1);
    nodes.resize(yes + 2);
    Members answered[2];
    for (const Eigen::Index m : members) answered[answers_(question, m) > 0].push_back(m);
    grow(yes, contexts, answered[1]);
    grow(yes + 1, contexts, answered[0]);
  }

  /// The first of equals, but for rounding; -1 if none gains enough.
  Eigen::Index best_question(const FrameSums& contexts, const Members& members) const {
    const FrameSums here = merged(Eigen::RowVectorXd::Ones(std::ssize(members)), contexts, members),
                    yes = merged(answers_(Eigen::all, members), contexts, members), no = difference(here, yes);
    const Eigen::VectorXd split = log_likelihoods(yes, limits_.floors) + log_likelihoods(no, limits_.floors);
    double most = log_likelihoods(here, limits_.floors)(0) + least_gain_;
    Eigen::Index best = -1;
    for (Eigen::Index q = 0; q < split.size(); ++q) {
      const bool gains = split(q) > most + 1e-9 * std::abs(most);
      if (!gains || std::min(yes.counts(q), no.counts(q)) < limits_.occupancy) continue;
      most = split(q);
      best = q;
    }
    return best;
  }

  const TreeLimits& limits_;
  std::vector<ContextNode> questions_;
  Eigen::MatrixXd answers_;  ///< of questions about contexts
  double least_gain_ = 0;
};

}  // namespace

std::vector<PhoneRun> phone_runs(const std::vector<std::string>& labels, const std::vector<std::int64_t>& lengths) {
  std::vector<PhoneRun> runs;
  for (std::size_t first = 0; const auto length : lengths) {
    const std::size_t before = runs.size(), end = first + static_cast<std::size_t>(length);
    for (std::size_t t = first; t < end; ++t) {
      const bool goes_on = t > first && labels[t] == labels[t - 1];
      if (!goes_on) runs.push_back({{t > first ? labels[t - 1] : "", labels[t], ""}, static_cast<Eigen::Index>(t), 0});
      ++runs.back().frames;
    }
    for (std::size_t i = before + 1; i < runs.size(); ++i) runs[i - 1].context.right = runs[i].context.phone;
    first = end;
  }
  return runs;
}

FrameSums::FrameSums(Eigen::Index kinds, Eigen::Index dims)
    : counts(Eigen::VectorXd::Zero(kinds)),
      sums(Eigen::MatrixXd::Zero(kinds, dims)),
      squares(Eigen::MatrixXd::Zero(kinds, dims)) {}

void FrameSums::add(Eigen::Index kind, const Eigen::MatrixXd& frames, const Eigen::VectorXd& weights) {
  counts(kind) += weights.sum();
  sums.row(kind) += weights.transpose() * frames;
  squares.row(kind) += weights.transpose() * frames.cwiseAbs2();
}

TiedGaussians grow_trees(const std::vector<PhoneContext>& contexts, const std::vector<FrameSums>& positions,
                         const TreeLimits& limits) {
  Grower grower(contexts, limits);
  grower.nodes.resize(positions.size());
  for (std::size_t s = 0; s < positions.size(); ++s) grower.grow(s, positions[s]);
  const Eigen::Index dims = positions.empty() ? 0 : positions[0].sums.cols();
  return {std::move(grower.nodes), Eigen::MatrixXd::Zero(grower.leaves, dims),
          Eigen::MatrixXd::Ones(grower.leaves, dims)};
}

std::vector<Eigen::Index> rows_of(const TiedGaussians& tied, const PhoneContext& context, Eigen::Index positions) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index s = 0; s < positions; ++s) {
    const ContextNode* node = &tied.nodes[static_cast<std::size_t>(s)];
    while (node->yes > 0) node = &tied.nodes[static_cast<std::size_t>(answer(*node, context) ? node->yes : node->no)];
    rows.push_back(node->row);
  }
  return rows;
}

void maximise(TiedGaussians& tied, const FrameSums& sums, const Eigen::VectorXd& floors) {
  for (Eigen::Index row = 0; row < tied.means.rows(); ++row) {
    const double count = sums.counts(row);
    if (count <= 1e-12) continue;
    tied.means.row(row) = sums.sums.row(row) / count;
    tied.variances.row(row) =
        (sums.squares.row(row) / count - tied.means.row(row).cwiseAbs2()).cwiseMax(floors.transpose());
  }
}

Eigen::MatrixXd log_densities(const TiedGaussians& tied, const std::vector<Eigen::Index>& rows,
                              const Eigen::MatrixXd& frames) {
  Eigen::MatrixXd logs(frames.rows(), std::ssize(rows));
  for (Eigen::Index s = 0; s < logs.cols(); ++s) {
    const Eigen::Index row = rows[static_cast<std::size_t>(s)];
    const auto variances = tied.variances.row(row);
    const double constant = (2 * std::numbers::pi * variances.array()).log().sum();
    const Eigen::MatrixXd away = (frames.rowwise() - tied.means.row(row)).cwiseAbs2();
    logs.col(s) = -0.5 * ((away * variances.cwiseInverse().transpose()).array() + constant);
  }
  return logs;
}

}  // namespace talkgraph
