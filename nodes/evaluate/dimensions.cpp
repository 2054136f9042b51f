#include "nodes/evaluate/dimensions.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include "nodes/evaluate/score.h"
#include "nodes/evaluate/summary.h"

namespace talkgraph {
namespace {

Scores scores_of(const Eigen::VectorXd& truth, const Eigen::VectorXd& predicted) {
  const Eigen::ArrayXd error = (truth - predicted).array().abs();
  const double mse = error.square().mean();
  return {{{"acc", correlation(truth, predicted)},
           {"l1", error.mean()},
           {"l2", std::sqrt(mse)},
           {"mse", mse},
           {"linf", error.maxCoeff()},
           {"range", range_of_motion(truth, predicted)}}};
}

ScoredFrames scored_frames_of(const std::string& sequence, const Track& truth, const Track& predicted,
                              const Mask& speech) try {
  return scored_frames(truth, predicted, &speech);
} catch (const std::runtime_error& e) {
  throw std::runtime_error(sequence + ": " + e.what());
}

}  // namespace

Table ScoreDimensions::operator()(const Collected<Track>& truth, const Collected<Track>& predicted,
                                  const Collected<Mask>& speech) const {
  std::vector<Collected<Scores>> dimensions;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const std::string& key = truth.key(i);
    const Track* p = predicted.find(key);
    const Mask* m = speech.find(key);
    if (!p || !m) continue;
    const auto [z, said] = scored_frames_of(key, truth[i], *p, *m);
    if (z.rows() == 0) continue;
    if (dimensions.empty()) dimensions.resize(static_cast<std::size_t>(z.cols()));
    if (std::ssize(dimensions) != z.cols())
      throw std::runtime_error(key + ": has " + std::to_string(z.cols()) + " dimensions, sequences before " +
                               std::to_string(dimensions.size()));
    for (Eigen::Index d = 0; d < z.cols(); ++d)
      dimensions[static_cast<std::size_t>(d)].add(key, scores_of(z.col(d), said.col(d)));
  }
  const Summary summary{{"acc", "l1", "l2", "mse", "linf", "range"}};
  Table table{title, "dimension", summary({}).columns, {}, {}};
  for (const auto& scores : dimensions) {
    table.rows.push_back(std::to_string(table.rows.size() + 1));
    table.cells.push_back(summary(scores).cells[0]);
  }
  return table;
}

void describe(Description<ScoreDimensions>& d) {
  d.type("evaluate.dimensions").summary("errors and correlation of each dimension by itself");
  d.source("Thesis §6.2.1, Eqns 6.1 to 6.4");
  d.input("truth", "normalised")
      .input("predicted", "normalised, by the same keys")
      .input("speech", "frames that count")
      .output("table", "a row a dimension; mean and std over sequences of acc, l1, l2, mse, linf, range");
  d.param("title", &ScoreDimensions::title).doc("heading of the table");
}

}  // namespace talkgraph
