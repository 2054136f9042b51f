#include "nodes/mapping/windowed_cca.h"

#include <fmt/format.h>

#include <tuple>

#include "nodes/latent/linear_models.h"
#include "nodes/latent/sequences.h"
#include "nodes/mapping/scaling.h"
#include "nodes/speech/stack.h"
#include "nodes/types/paired.h"

namespace talkgraph {

namespace {

/// Every frame with its neighbours; lost where one of them is.
Track windows_of(Eigen::MatrixXd frames, std::int64_t context, std::vector<std::int64_t> lost = {}) {
  Track track;
  track.values = std::move(frames);
  track.lost = std::move(lost);
  const int n = static_cast<int>(context);
  return Stack{n, n}(track);
}

/// Audio and visual windows, side by side.
Sequences training_windows(const WindowedCca& model, const Collected<Track>& tracks) {
  const Eigen::Index dims = model.audio.mean.size();
  Collected<Track> windows;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Eigen::MatrixXd& frames = tracks[i].values;
    const Track heard = windows_of(scaled(model.audio, frames.leftCols(dims)), model.context);
    Track both =
        windows_of(scaled(model.visual, frames.rightCols(frames.cols() - dims)), model.context, tracks[i].lost);
    const Eigen::MatrixXd seen = std::move(both.values);
    both.values.resize(seen.rows(), heard.dimension() + seen.cols());
    both.values << heard.values, seen;
    windows.add(tracks.key(i), std::move(both));
  }
  return measured_runs(windows);
}

}  // namespace

WindowedCca TrainWindowedCca::operator()(const Collected<Track>& audio, const Collected<Track>& visual,
                                         Context& context) const {
  const JoinedStreams both = side_by_side(audio, visual);
  WindowedCca model;
  model.context = this->context;
  std::tie(model.audio, model.visual) = split(scaling_of(measured_runs(both.tracks).frames), both.audio);

  const Eigen::MatrixXd windows = training_windows(model, both.tracks).frames;
  const Eigen::Index frames = 2 * model.context + 1;
  const auto heard = windows.leftCols(frames * both.audio),
             shown = windows.rightCols(frames * model.visual.mean.size());
  const Cca cca = fit_cca(heard, shown, dimensions);
  model.audio_mean = cca.mean_y;
  model.visual_mean = cca.mean_z;
  model.directions = cca.directions_y;
  model.correlations = cca.correlations;
  // Variates are orthonormal over the training windows.
  const Eigen::MatrixXd variates = (heard.rowwise() - cca.mean_y) * cca.directions_y;
  model.weights = variates.transpose() * (shown.rowwise() - cca.mean_z);
  context.log(fmt::format("{} windows of {} + {} dimensions: canonical correlations from {:.3f} to {:.3f}",
                          windows.rows(), heard.cols(), shown.cols(), cca.correlations.maxCoeff(),
                          cca.correlations.minCoeff()));
  return model;
}

Track SynthesiseWindowedCca::operator()(const WindowedCca& model, const Track& audio) const {
  require_frames_of(audio, model.audio.mean.size(), "the canonical correlations");
  const Eigen::MatrixXd heard = windows_of(scaled(model.audio, audio.values), model.context).values;
  const Eigen::MatrixXd shown =
      ((heard.rowwise() - model.audio_mean) * model.directions * model.weights).rowwise() + model.visual_mean;
  const Eigen::Index frames = audio.frames(), dims = model.visual.mean.size(), reach = model.context;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(frames, dims);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const Eigen::Index first = std::max<Eigen::Index>(t - reach, 0), last = std::min(t + reach, frames - 1);
    for (Eigen::Index s = first; s <= last; ++s)
      sum.row(t) += shown.row(s).segment((t - s + model.context) * dims, dims);
    sum.row(t) /= static_cast<double>(last - first + 1);
  }
  return {restored(model.visual, sum), audio.rate, audio.start, {}, {}};
}

void describe(Description<TrainWindowedCca>& d) {
  d.type("mapping.windowed_cca").version(1).stored();
  d.summary("canonical correlations of windows of sound and face, and regression from the sound's variates");
  d.source("Theobald and Wilkinson 2007; thesis §4.3.1, Eqn 4.50");
  d.input("audio", "speech features at the video rate of the training sequences")
      .input("visual", "visual parameters of the training sequences")
      .output("model", "directions and weights");
  d.param("context", &TrainWindowedCca::context).within(0, 50).unit("frames").doc("neighbours on each side");
  d.param("dimensions", &TrainWindowedCca::dimensions)
      .at_least(1)
      .doc("canonical variates; those beyond the rank of the windows are zero");
}

void describe(Description<SynthesiseWindowedCca>& d) {
  d.type("mapping.windowed_cca_synthesise").version(1);
  d.summary("visual parameters by regression from canonical variates of the sound's windows");
  d.source("Theobald and Wilkinson 2007; thesis §4.3.1");
  d.input("model", "of mapping.windowed_cca")
      .input("audio", "speech features at the video rate")
      .output("visual", "visual parameters");
}

}  // namespace talkgraph
