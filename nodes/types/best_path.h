#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace talkgraph {

/// The state of the frame before that each state of a frame is best reached from.
using Origins = Eigen::Matrix<Eigen::Index, Eigen::Dynamic, 1>;

/// The states of T frames that lead to the state `last` of the last one; origins of the first frame are not read. T is
/// at least 1.
inline std::vector<Eigen::Index> trace_back(const std::vector<Origins>& from, Eigen::Index last) {
  std::vector<Eigen::Index> states(from.size(), last);
  for (std::size_t t = states.size(); t-- > 1;) states[t - 1] = from[t](states[t]);
  return states;
}

/// A state for each of T frames.
struct BestPath {
  std::vector<Eigen::Index> states;     ///< T
  std::vector<Eigen::VectorXd> scores;  ///< of the best path to each state of each frame
};

/// The path of the greatest sum of scores, by Viterbi's algorithm. scores(t) gives those of the states of frame t, of
/// which there is at least one; steps(t) those of passing from each state of frame t − 1 (rows) to each of frame t. Of
/// equals the lower state.
template <class Scores, class Steps>
BestPath best_path(Eigen::Index frames, Scores scores, Steps steps) {
  BestPath path;
  std::vector<Origins> from(static_cast<std::size_t>(frames));
  for (Eigen::Index t = 0; t < frames; ++t) {
    Eigen::VectorXd score = scores(t);
    if (t > 0) {
      const Eigen::MatrixXd& step = steps(t);
      Origins& origins = from[static_cast<std::size_t>(t)];
      origins.resize(score.size());
      for (Eigen::Index k = 0; k < score.size(); ++k)
        score(k) += (path.scores.back() + step.col(k)).maxCoeff(&origins(k));
    }
    path.scores.push_back(std::move(score));
  }
  if (frames == 0) return path;
  Eigen::Index last = 0;
  path.scores.back().maxCoeff(&last);
  path.states = trace_back(from, last);
  return path;
}

}  // namespace talkgraph
