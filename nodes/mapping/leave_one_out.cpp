#include "nodes/mapping/leave_one_out.h"

#include <Eigen/Cholesky>
#include <stdexcept>

#include "nodes/mapping/context_covariance.h"
#include "nodes/mapping/context_training.h"

namespace talkgraph {
namespace {

/// (L Lᵀ)⁻¹ of `size` rows and columns from number `at` on.
Eigen::MatrixXd inverse_block(const Eigen::MatrixXd& factor, Eigen::Index at, Eigen::Index size) {
  const auto from = factor.rows() - at;
  const Eigen::MatrixXd columns =
      factor.bottomRightCorner(from, from).triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(from, size));
  return columns.transpose() * columns;
}

}  // namespace

std::vector<HeldOut> leave_one_out(const TrainContextGp& node, const Collected<Track>& audio,
                                   const Collected<PhoneTrack>& phones, const Collected<Track>& visual,
                                   Context& context) {
  const auto [model, utterances, rows, z] = context_training(node, audio, phones, visual);
  if (utterances.size() < 2) throw std::runtime_error("one utterance only: there are no others to learn from");
  const Eigen::MatrixXd factor = covariance_factor(model, rows, context);
  const auto lower = factor.triangularView<Eigen::Lower>();
  const Eigen::MatrixXd weights = lower.adjoint().solve(lower.solve(z));
  std::vector<HeldOut> held;
  for (const auto& u : utterances) held.push_back({u.key, {}, Eigen::MatrixXd(0, z.cols())});
  for (const ContextBlock& block : blocks_of(model, rows)) {
    context.check_cancelled();
    const auto size = block.size();
    const auto inverse = inverse_block(factor, block.at, size).llt();
    auto& out = held[block.utterance];
    out.frames = block.local;
    out.predicted =
        (z.middleRows(block.at, size) - inverse.solve(weights.middleRows(block.at, size))).rowwise() + model.mean;
    context.progress(0.5 + 0.5 * static_cast<double>(block.at + size) / static_cast<double>(rows.size()));
  }
  return held;
}

}  // namespace talkgraph
