#include "nodes/mapping/resegment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "nodes/context/automaton.h"
#include "nodes/latent/predictive.h"
#include "nodes/latent/scg.h"
#include "nodes/latent/sequence_objective.h"
#include "nodes/latent/sequences.h"
#include "nodes/mapping/ssgpdm.h"
#include "nodes/mapping/start_values.h"
#include "nodes/types/best_path.h"

namespace talkgraph {

namespace {

constexpr double impossible = -std::numeric_limits<double>::infinity();

double log_volume(const GaussianProcess& gp) { return gp.scale.array().log().sum(); }

/// max_X of the objective of synthesis, the visual frames being known too, in their own units.
double best_objective(const Sgpdm& state, const Eigen::MatrixXd& audio, const std::optional<Eigen::MatrixXd>& visual,
                      int iterations) {
  const Eigen::MatrixXd heard = scaled(state.audio, audio);
  SequenceObjective objective(state, heard, true);
  double volume = log_volume(state.audio);
  if (visual) {
    objective.see(scaled(state.visual, *visual));
    volume += log_volume(state.visual);
  }
  Eigen::VectorXd x = nearest_window(state, heard).reshaped();
  ScaledConjugateGradients optimiser;
  optimiser.iterations = iterations;
  const OptimiserReport report = optimiser.minimise(objective, x);
  const double value = -report.cost - static_cast<double>(audio.rows()) * volume;
  return report.reason != StopReason::failed && std::isfinite(value) ? value : impossible;
}

/// Boundaries of runs: that between run i − 1 and run i has number i.
class BoundarySearch {
 public:
  BoundarySearch(const Resegment& node, const Ssgpdm& model, const std::vector<Unit>& runs,
                 const Eigen::MatrixXd& audio, const std::optional<Eigen::MatrixXd>& visual)
      : node_(node), model_(model), runs_(runs), audio_(audio), visual_(visual) {
    for (const Unit& run : runs) given_.push_back(run.start);
    given_.push_back(audio.rows());
    for (std::size_t b = 0; b < given_.size(); ++b) candidates_.push_back(candidates(b));
  }

  /// The first frame of each run, and the number of frames.
  std::vector<Eigen::Index> likeliest(const Context& context) {
    const auto nothing = [&](Eigen::Index b) {
      return Eigen::VectorXd::Zero(std::ssize(candidates_[static_cast<std::size_t>(b)])).eval();
    };
    const auto steps = [&](Eigen::Index b) {
      context.check_cancelled();
      return scores_of(static_cast<std::size_t>(b) - 1);
    };
    const BestPath path = best_path(std::ssize(given_), nothing, steps);
    best_ = path.scores.back().maxCoeff();
    std::vector<Eigen::Index> found;
    for (std::size_t b = 0; b < given_.size(); ++b)
      found.push_back(candidates_[b][static_cast<std::size_t>(path.states[b])]);
    return found;
  }
  double best() const { return best_; }      ///< ln p of the boundaries found
  double before() const { return before_; }  ///< of those given

 private:
  std::vector<Eigen::Index> candidates(std::size_t b) const {
    if (b == 0 || b + 1 == given_.size()) return {given_[b]};
    std::vector<Eigen::Index> all;
    const Eigen::Index last = std::min(audio_.rows() - 1, given_[b] + node_.reach);
    for (Eigen::Index at = std::max<Eigen::Index>(1, given_[b] - node_.reach); at <= last; ++at) all.push_back(at);
    return all;
  }
  /// ln p of a run from each of its beginnings (rows) to each of its ends.
  Eigen::MatrixXd scores_of(std::size_t run) {
    const auto &from = candidates_[run], &to = candidates_[run + 1];
    Eigen::MatrixXd scores(std::ssize(from), std::ssize(to));
    for (Eigen::Index i = 0; i < scores.rows(); ++i)
      for (Eigen::Index j = 0; j < scores.cols(); ++j) {
        const Eigen::Index begin = from[static_cast<std::size_t>(i)], end = to[static_cast<std::size_t>(j)];
        scores(i, j) = end > begin ? score(runs_[run].symbol, begin, end - begin) : impossible;
        if (begin == given_[run] && end == given_[run + 1]) before_ += scores(i, j);
      }
    return scores;
  }
  double score(const std::string& phone, Eigen::Index begin, Eigen::Index length) const {
    const Eigen::MatrixXd heard = audio_.middleRows(begin, length);
    std::optional<Eigen::MatrixXd> seen;
    if (visual_) seen = visual_->middleRows(begin, length);
    return best_objective(state_for(model_, phone, heard.colwise().mean()), heard, seen, node_.iterations);
  }

  const Resegment& node_;
  const Ssgpdm& model_;
  const std::vector<Unit>& runs_;
  const Eigen::MatrixXd& audio_;
  const std::optional<Eigen::MatrixXd>& visual_;
  std::vector<Eigen::Index> given_;
  std::vector<std::vector<Eigen::Index>> candidates_;
  double best_ = 0, before_ = 0;
};

void check(const Ssgpdm& model, const Track& audio, const Track* visual) {
  if (model.states.empty()) throw std::runtime_error("the switching model has no states; train it first");
  const Sgpdm& any = model.states.begin()->second;
  require_frames_of(audio, any.audio.mean.size(), "the switching model");
  if (visual) require_frames_of(*visual, any.visual.mean.size(), "the switching model");
}

}  // namespace

Resegment::Out Resegment::operator()(const Ssgpdm& model, const FrameLabels& labels, const Track& audio,
                                     const Track* visual, Context& context) const {
  check(model, audio, visual);
  const auto given = static_cast<Eigen::Index>(labels.labels.size());
  const Eigen::Index frames = std::min({given, audio.frames(), visual ? visual->frames() : given});
  if (std::max({given, audio.frames(), visual ? visual->frames() : given}) - frames > 2)
    throw std::runtime_error(fmt::format("{} labels, {} audio frames, {} visual frames: bring all to one rate", given,
                                         audio.frames(), visual ? visual->frames() : 0));
  Out out{labels, {}};
  if (frames == 0 || !audio.lost.empty() || (visual && !visual->lost.empty())) return out;

  const std::vector<Unit> runs = units({labels.labels.begin(), labels.labels.begin() + frames}, true);
  std::optional<Eigen::MatrixXd> seen;
  if (visual) seen = visual->values.topRows(frames);
  const Eigen::MatrixXd heard = audio.values.topRows(frames);
  BoundarySearch search(*this, model, runs, heard, seen);
  const std::vector<Eigen::Index> boundaries = search.likeliest(context);
  if (!std::isfinite(search.best()))
    throw std::runtime_error(
        "no segmentation has a finite likelihood: the model holds values that are not finite, or the frames are far "
        "from all that it was trained on");
  double moved = 0;
  for (std::size_t run = 0; run < runs.size(); ++run)
    for (Eigen::Index t = boundaries[run]; t < boundaries[run + 1]; ++t) {
      std::string& label = out.labels.labels[static_cast<std::size_t>(t)];
      moved += label != runs[run].symbol;
      label = runs[run].symbol;
    }
  const double n = static_cast<double>(frames);
  out.scores.values = {{"objective", search.best() / n}, {"moved", moved / n}};
  if (std::isfinite(search.before())) out.scores.values["before"] = search.before() / n;
  return out;
}

void describe(Description<Resegment>& d) {
  d.type("mapping.resegment").version(2).stored();
  d.summary("moves the boundaries of phones to where a switching model of phones finds speech likeliest");
  d.source("Thesis §5.1.3, the E-step of EM");
  d.input("model", "whose states are phones")
      .input("labels", "phones at the video rate")
      .input("audio", "speech features at that rate")
      .input("visual", "visual parameters at that rate; without them the sound alone counts");
  d.output("labels", &Resegment::Out::labels, "the same phones in the same order");
  d.output("scores", &Resegment::Out::scores,
           "objective a frame, before: that of the labels given if it is finite, moved: the share of frames that "
           "changed");
  d.param("reach", &Resegment::reach).at_least(0).unit("frames").doc("a boundary moves by no more");
  d.param("iterations", &Resegment::iterations)
      .at_least(0)
      .doc("limit of scaled conjugate gradients for the latent points of a run");
}

}  // namespace talkgraph
