#pragma once

#include "nodes/types/trajectory_hmm.h"

namespace talkgraph {

/// A phone among its neighbours, which are empty where there are none.
struct PhoneContext {
  std::string left, phone, right;
  auto operator<=>(const PhoneContext&) const = default;
};

/// A stretch of frames of one phone.
struct PhoneRun {
  PhoneContext context;
  Eigen::Index first = 0, frames = 0;
};
/// The runs of equal labels of sequences that lie one after the other; a phone's neighbours are those in its sequence.
std::vector<PhoneRun> phone_runs(const std::vector<std::string>& labels, const std::vector<std::int64_t>& lengths);

/// Sums over frames of K kinds.
struct FrameSums {
  Eigen::VectorXd counts;
  Eigen::MatrixXd sums, squares;  ///< K × D

  FrameSums(Eigen::Index kinds, Eigen::Index dims);
  /// Rows of frames by their weights.
  void add(Eigen::Index kind, const Eigen::MatrixXd& frames, const Eigen::VectorXd& weights);
};

struct TreeLimits {
  bool neighbours = true;  ///< trees ask about a phone's neighbours, not only about itself
  double occupancy = 1;    ///< least frames of a leaf
  double penalty = 1;      ///< what a split must gain in log-likelihood, in units of D ln N
  Eigen::VectorXd floors;  ///< of variances
};
/// A tree of questions for each position (Odell 1995): the frames of contexts are split by the question, whether a
/// phone is this one or of this viseme, that gains most log-likelihood, for as long as it exceeds what two Gaussians in
/// place of one cost by minimum description length (Shinoda and Watanabe 2000) with N frames at the position. Gaussians
/// have mean 0 and variance 1, until maximise().
TiedGaussians grow_trees(const std::vector<PhoneContext>& contexts, const std::vector<FrameSums>& positions,
                         const TreeLimits& limits);

/// The Gaussian of each position of a phone. To questions about a phone that training never met the answer is no,
/// unless they are about its viseme.
std::vector<Eigen::Index> rows_of(const TiedGaussians& tied, const PhoneContext& context, Eigen::Index positions);

/// The likeliest Gaussians of sums, variances staying above floors. What has no frames stays as it was.
void maximise(TiedGaussians& tied, const FrameSums& sums, const Eigen::VectorXd& floors);

/// ln p(frame | row) of frames T × D, T × rows.
Eigen::MatrixXd log_densities(const TiedGaussians& tied, const std::vector<Eigen::Index>& rows,
                              const Eigen::MatrixXd& frames);

}  // namespace talkgraph
