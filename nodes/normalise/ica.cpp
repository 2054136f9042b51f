#include "nodes/normalise/ica.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "nodes/normalise/rows.h"

namespace talkgraph {
namespace {

/// x̃ = Λ^(−½) Pᵀ (x − mean), and the way back.
struct Whitening {
  Eigen::RowVectorXd mean;
  Eigen::MatrixXd forth;  ///< K × D
  Eigen::MatrixXd back;   ///< D × K
  double total;           ///< variance of all dimensions
};

Whitening whiten(const Eigen::MatrixXd& rows, int components) {
  Whitening w;
  w.mean = rows.colwise().mean();
  const Eigen::MatrixXd x = rows.rowwise() - w.mean;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(x.cols(), x.cols());
  covariance.selfadjointView<Eigen::Lower>().rankUpdate(x.transpose(), 1 / static_cast<double>(x.rows()));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
  const auto& variances = eigen.eigenvalues();
  w.total = variances.sum();
  if (!(w.total > 1e-20 * w.mean.squaredNorm()) || w.total == 0)
    throw std::runtime_error("the tracks do not vary: they have no independent components");
  auto count = (variances.array() > 1e-10 * variances.maxCoeff()).count();
  if (components > 0) count = std::min<Eigen::Index>(count, components);
  const auto vectors = eigen.eigenvectors().rightCols(count);
  const Eigen::VectorXd deviations = variances.tail(count).cwiseSqrt();
  w.forth = deviations.cwiseInverse().asDiagonal() * vectors.transpose();
  w.back = vectors * deviations.asDiagonal();
  return w;
}

std::vector<Eigen::Index> by_variance(const Eigen::MatrixXd& mixing) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(mixing.cols()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const Eigen::RowVectorXd variances = mixing.colwise().squaredNorm();
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return variances(a) > variances(b); });
  return order;
}

/// The largest entry of each column of A is made positive.
void fix_signs(IndependentComponents& c) {
  for (Eigen::Index k = 0; k < c.count(); ++k) {
    Eigen::Index at = 0;
    c.mixing.col(k).cwiseAbs().maxCoeff(&at);
    if (c.mixing(at, k) > 0) continue;
    c.mixing.col(k) *= -1;
    c.unmixing.row(k) *= -1;
  }
}

}  // namespace

LearnIca::Out LearnIca::operator()(const Collected<Track>& tracks, Random& random, Context& context) const {
  const Eigen::MatrixXd rows = measured_rows(tracks);
  if (rows.rows() <= rows.cols())
    throw std::runtime_error(
        fmt::format("{} frames are too few for independent components of {} dimensions: give more recordings",
                    rows.rows(), rows.cols()));
  const auto whitening = whiten(rows, components);
  const Eigen::MatrixXd white = whitening.forth * (rows.rowwise() - whitening.mean).transpose();
  const auto found = FastIca{decorrelation, contrast, a1, iterations, tolerance}(white, random);
  const auto order = by_variance(whitening.back * found.directions.transpose());

  Out out;
  out.components.mean = whitening.mean;
  out.components.mixing = (whitening.back * found.directions.transpose())(Eigen::all, order);
  out.components.unmixing = (found.directions * whitening.forth)(order, Eigen::all);
  fix_signs(out.components);
  out.convergence = {"Independent components", "component", {"variance", "kurtosis", "iterations", "change"}, {}, {}};
  const Eigen::ArrayXXd u = (found.directions * white).array();
  Eigen::Index unsettled = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto k = order[i];
    out.convergence.rows.push_back(std::to_string(i + 1));
    out.convergence.cells.push_back(
        {out.components.mixing.col(static_cast<Eigen::Index>(i)).squaredNorm() / whitening.total,
         u.row(k).square().square().mean() - 3, static_cast<double>(found.iterations(k)), found.change(k)});
    unsettled += found.change(k) >= tolerance;
  }
  if (unsettled > 0)
    context.warn(
        fmt::format("{} of {} independent components have not settled after {} iterations: they may be as "
                    "good as Gaussian; look at \"change\" in the table, allow more iterations, or keep fewer "
                    "components",
                    unsettled, order.size(), iterations));
  return out;
}

void describe(Description<LearnIca>& d) {
  d.type("normalise.ica")
      .version(1)
      .summary("learns independent components of tracks (FastICA)")
      .source("Thesis Appendix A, Eqn 3.38; Hyvärinen 1999");
  d.input("tracks", "to learn from, lost frames left out")
      .output("components", &LearnIca::Out::components,
              "u = A⁻¹ (c − mean), numbered from 1 by the variance they bring")
      .output("convergence", &LearnIca::Out::convergence,
              "a row a component: share of the variance, excess kurtosis, iterations, last change");
  d.param("decorrelation", &LearnIca::decorrelation).doc("all components at once, or one after the other");
  d.param("contrast", &LearnIca::contrast).doc("what non-Gaussianity is measured by: log cosh, or exp(−u²/2)");
  d.param("a1", &LearnIca::a1).within(1, 2).doc("scale inside log cosh");
  d.param("components", &LearnIca::components)
      .at_least(0)
      .doc("how many, the directions of largest variance being kept in whitening; 0: as many as there are dimensions");
  d.param("iterations", &LearnIca::iterations).at_least(1).doc("at most");
  d.param("tolerance", &LearnIca::tolerance)
      .within(0, 1)
      .doc("change of a direction, 1 − cosine, under which it has settled");
}

}  // namespace talkgraph
