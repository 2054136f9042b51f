#include "nodes/mapping/context_covariance.h"

#include <algorithm>

#include "nodes/mapping/context_kernel.h"

namespace talkgraph {
namespace {

/// Of some frames of one utterance (rows) with all of another.
Eigen::MatrixXd kernel(const Eigen::RowVectorXd& window, const Eigen::MatrixXd& a,
                       const std::vector<Eigen::Index>& some, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd distance = -2 * a * b.transpose();
  distance.colwise() += a.rowwise().squaredNorm();
  distance.rowwise() += b.rowwise().squaredNorm().transpose();
  const Eigen::Index n = window.size() / 2;
  Eigen::MatrixXd exponent = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(some.size()), b.rows());
  for (Eigen::Index l = -n; l <= n; ++l)
    for (Eigen::Index j = 0; j < b.rows(); ++j) {
      const auto column = distance.col(std::clamp<Eigen::Index>(j + l, 0, b.rows() - 1));
      for (Eigen::Index i = 0; i < exponent.rows(); ++i)
        exponent(i, j) +=
            window[l + n] * column[std::clamp<Eigen::Index>(some[static_cast<std::size_t>(i)] + l, 0, a.rows() - 1)];
    }
  return (-exponent.cwiseMax(0)).array().exp();
}

/// Its upper triangle is not filled.
Eigen::MatrixXd covariance(const ContextGp& model, const std::vector<Eigen::Index>& rows, Context& context) {
  const auto blocks = blocks_of(model, rows);
  Eigen::MatrixXd k(rows.size(), rows.size());
  for (std::size_t j = 0; j < blocks.size(); ++j) {
    context.check_cancelled();
    const ContextBlock& b = blocks[j];
    for (std::size_t i = j; i < blocks.size(); ++i) {
      const ContextBlock& a = blocks[i];
      k.block(a.at, b.at, a.size(), b.size()) = kernel(model.window, a.frames, a.local, b.frames)(Eigen::all, b.local);
    }
    context.progress(0.5 * static_cast<double>(j + 1) / static_cast<double>(blocks.size()));
  }
  return k;
}

}  // namespace

std::vector<ContextBlock> blocks_of(const ContextGp& model, const std::vector<Eigen::Index>& rows) {
  std::vector<ContextBlock> blocks;
  Eigen::Index start = 0;
  std::size_t r = 0;
  for (std::size_t u = 0; u < model.lengths.size(); ++u) {
    const auto length = model.lengths[u];
    ContextBlock block{u, model.frames.middleRows(start, length), static_cast<Eigen::Index>(r), {}};
    for (; r < rows.size() && rows[r] < start + length; ++r) block.local.push_back(rows[r] - start);
    if (!block.local.empty()) blocks.push_back(std::move(block));
    start += length;
  }
  return blocks;
}

Eigen::MatrixXd kernel_with_training(const ContextGp& model, const Eigen::MatrixXd& frames,
                                     const std::vector<Eigen::Index>& some) {
  Eigen::MatrixXd k(static_cast<Eigen::Index>(some.size()), model.frames.rows());
  Eigen::Index start = 0;
  for (const auto length : model.lengths) {
    k.middleCols(start, length) = kernel(model.window, frames, some, model.frames.middleRows(start, length));
    start += length;
  }
  return k;
}

Eigen::MatrixXd covariance_factor(const ContextGp& model, const std::vector<Eigen::Index>& rows, Context& context) {
  Eigen::MatrixXd factor = covariance(model, rows, context);
  factorise(factor, model.noise);
  return factor;
}

}  // namespace talkgraph
