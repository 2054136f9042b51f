#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace talkgraph {

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
  std::vector<Eigen::Matrix<Eigen::Index, Eigen::Dynamic, 1>> from(static_cast<std::size_t>(frames));
  for (Eigen::Index t = 0; t < frames; ++t) {
    Eigen::VectorXd score = scores(t);
    if (t > 0) {
      const Eigen::MatrixXd& step = steps(t);
      auto& pointers = from[static_cast<std::size_t>(t)];
      pointers.resize(score.size());
      for (Eigen::Index k = 0; k < score.size(); ++k)
        score(k) += (path.scores.back() + step.col(k)).maxCoeff(&pointers(k));
    }
    path.scores.push_back(std::move(score));
  }
  path.states.resize(from.size());
  if (frames > 0) path.scores.back().maxCoeff(&path.states.back());
  for (std::size_t t = path.states.size(); t-- > 1;) path.states[t - 1] = from[t](path.states[t]);
  return path;
}

}  // namespace talkgraph
