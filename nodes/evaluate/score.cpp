#include "nodes/evaluate/score.h"

#include <cmath>
#include <stdexcept>

#include "nodes/types/paired.h"

namespace talkgraph {
namespace {

double deviation(const Eigen::VectorXd& x) { return std::sqrt((x.array() - x.mean()).square().mean()); }

/// More than rounding of a constant.
bool varies(const Eigen::VectorXd& x) { return deviation(x) > 1e-12 * x.cwiseAbs().maxCoeff(); }

/// The rows that count, of the common beginning.
std::vector<Eigen::Index> counted(const Track& truth, Eigen::Index frames, const Mask* speech) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index t = 0; t < frames; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const bool marked = !speech || (i < speech->frames.size() && speech->frames[i]);
    if (marked && !truth.is_lost(t)) rows.push_back(t);
  }
  return rows;
}

}  // namespace

double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (!varies(a) || !varies(b)) return 0;
  return ((a.array() - a.mean()) * (b.array() - b.mean())).mean() / (deviation(a) * deviation(b));
}

double range_of_motion(const Eigen::VectorXd& truth, const Eigen::VectorXd& predicted) {
  return varies(truth) ? deviation(predicted) / deviation(truth) : NAN;
}

ScoredFrames scored_frames(const Track& truth, const Track& predicted, const Mask* speech) {
  if (truth.dimension() != predicted.dimension() || truth.dimension() == 0)
    throw std::runtime_error("truth has " + std::to_string(truth.dimension()) + " dimensions, the prediction " +
                             std::to_string(predicted.dimension()));
  const auto frames =
      common_frames("the sequence", truth.frames(), "frames of the truth", predicted.frames(), "of the prediction");
  if (speech) common_frames("the sequence", frames, "frames", std::ssize(speech->frames), "marks of speech");
  const auto rows = counted(truth, frames, speech);
  ScoredFrames both{truth.values(rows, Eigen::all), predicted.values(rows, Eigen::all)};
  if (!both.truth.allFinite() || !both.predicted.allFinite())
    throw std::runtime_error("NaN or infinite values cannot be scored");
  return both;
}

std::optional<Scores> Score::operator()(const Track& truth, const Track& predicted, const Mask* speech) const {
  const auto [z, p] = scored_frames(truth, predicted, speech);
  if (z.rows() == 0) return {};
  const Eigen::MatrixXd error = (z - p).cwiseAbs();
  double acc = 0;
  for (Eigen::Index d = 0; d < z.cols(); ++d) acc += correlation(z.col(d), p.col(d));
  const double amse = error.array().square().mean(), of_mean = z.array().square().mean();
  Scores s;
  s.values["amse"] = amse;
  s.values["amse_share"] = of_mean > 0 ? amse / of_mean : NAN;
  s.values["acc"] = acc / static_cast<double>(z.cols());
  s.values["l1"] = error.mean();
  s.values["l2"] = std::sqrt(amse);
  s.values["linf"] = error.rowwise().maxCoeff().mean();
  s.values["range"] = range_of_motion(z.col(0), p.col(0));
  return s;
}

void describe(Description<Score>& d) {
  d.type("evaluate.score").summary("AMSE, ACC and other scores of one sequence").source("Thesis §6.2, Eqns 6.5 to 6.9");
  d.input("truth", "normalised")
      .input("predicted", "normalised")
      .input("speech", "frames that count")
      .output("scores",
              "acc: correlation with the recorded parameters over frames, mean over dimensions, 1 at best; amse: "
              "squared error, mean over frames and dimensions; amse_share: amse / that of predicting the mean, 0 at "
              "best; l1: absolute error, mean over frames and dimensions; l2: root of amse; linf: largest absolute "
              "error of a frame, mean over frames; range: standard deviation of the first dimension / the recorded "
              "one's, 1 at best, less if the face moves too little");
}

}  // namespace talkgraph
