#include "nodes/latent/sgpdm.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <stdexcept>

#include "nodes/latent/linear_models.h"

namespace talkgraph {

namespace {

void check(const StateData& data) {
  const auto fail = [&](const std::string& what) { throw std::runtime_error("state \"" + data.label + "\": " + what); };
  const auto require_finite = [&](const Eigen::MatrixXd& window, const char* stream, std::size_t number) {
    for (Eigen::Index t = 0; t < window.rows(); ++t)
      if (!window.row(t).allFinite())
        fail(
            fmt::format("frame {} of {} window {} has a value that is not finite; where values are missing (NaN), "
                        "latent.mrd learns from the others",
                        t, stream, number));
  };
  if (data.audio.size() != data.visual.size())
    fail(fmt::format("{} audio windows but {} visual", data.audio.size(), data.visual.size()));
  if (data.audio.empty()) fail("no training windows; map it to a shorter label (context.windows)");
  for (std::size_t i = 0; i < data.audio.size(); ++i) {
    const auto &y = data.audio[i], &z = data.visual[i];
    if (y.rows() != z.rows() || y.rows() == 0)
      fail(fmt::format("window {} has {} audio frames and {} visual", i, y.rows(), z.rows()));
    if (y.cols() == 0 || z.cols() == 0)
      fail(fmt::format("window {} has no {} dimensions", i, y.cols() ? "visual" : "audio"));
    if (y.cols() != data.audio[0].cols() || z.cols() != data.visual[0].cols())
      fail(fmt::format("window {} has {} audio and {} visual dimensions, but window 0 has {} and {}", i, y.cols(),
                       z.cols(), data.audio[0].cols(), data.visual[0].cols()));
    require_finite(y, "audio", i);
    require_finite(z, "visual", i);
  }
}

Eigen::MatrixXd stacked(const std::vector<Eigen::MatrixXd>& windows) {
  Eigen::Index n = 0;
  for (const auto& window : windows) n += window.rows();
  Eigen::MatrixXd all(n, windows[0].cols());
  n = 0;
  for (const auto& window : windows) {
    all.middleRows(n, window.rows()) = window;
    n += window.rows();
  }
  return all;
}

Eigen::MatrixXd averaged_ppca(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z, Eigen::Index d) {
  const Eigen::MatrixXd a = fit_ppca(y, d).posterior_mean(y);
  Eigen::MatrixXd b = fit_ppca(z, d).posterior_mean(z);
  for (Eigen::Index c = 0; c < d; ++c)
    if (a.col(c).dot(b.col(c)) < 0) b.col(c) = -b.col(c);
  return 0.5 * (a + b);
}

/// Of as many dimensions as both streams have.
Eigen::MatrixXd shared_start(LatentStart start, const Eigen::MatrixXd& y, const Eigen::MatrixXd& z, Eigen::Index d) {
  if (start == LatentStart::ppca) return averaged_ppca(y, z, d);
  const Pcca pcca = fit_pcca(y, z, d);
  if (start == LatentStart::pcca) return pcca.posterior_mean(y, z);
  return 0.5 * ((y.rowwise() - pcca.mean_y) * pcca.directions_y + (z.rowwise() - pcca.mean_z) * pcca.directions_z);
}

/// Beyond those, principal components of what they leave of the larger stream.
Eigen::MatrixXd start_values(LatentStart start, const Eigen::MatrixXd& y, const Eigen::MatrixXd& z, Eigen::Index d) {
  const Eigen::Index shared = std::min({d, y.cols(), z.cols()});
  Eigen::MatrixXd x = shared_start(start, y, z, shared);
  if (shared == d) return x;
  const Eigen::MatrixXd& larger = y.cols() > z.cols() ? y : z;
  const Eigen::MatrixXd left = larger - x * x.completeOrthogonalDecomposition().solve(larger);
  Eigen::MatrixXd all(x.rows(), d);
  all << x, fit_ppca(left, d - shared).posterior_mean(left);
  return all;
}

}  // namespace

Sgpdm TrainSgpdm::operator()(const StateData& data, Context& context) const {
  check(data);
  Sgpdm model;
  model.label = data.label;
  for (const auto& window : data.audio) model.lengths.push_back(window.rows());

  std::vector<TrainingStream> streams{{"audio", stacked(data.audio), audio_scaling},
                                      {"visual", stacked(data.visual), visual_scaling}};
  const double dy = static_cast<double>(streams[0].frames.cols()), dz = static_cast<double>(streams[1].frames.cols());
  if (likelihood_bias) {
    streams[0].weight = std::max(1.0, dz / dy);
    streams[1].weight = std::max(1.0, dy / dz);
  }
  const auto start = [&](const std::vector<Eigen::MatrixXd>& scaled, Eigen::Index d) {
    return start_values(initial, scaled[0], scaled[1], d);
  };
  TrainedLatents trained = train_latents(*this, "state \"" + data.label + "\"", streams, model.lengths, start, context);

  model.audio_frames = std::move(trained.first_frames);
  model.audio = std::move(trained.processes[0]);
  model.visual = std::move(trained.processes[1]);
  model.iterations = trained.report.iterations;
  trained.move_to(model);
  return model;
}

void describe(Description<TrainSgpdm>& d) {
  d.type("latent.sgpdm").version(4).stored();
  d.summary("trains the shared Gaussian process dynamical model of one state's audio and visual windows");
  d.source("Thesis §4.3.3-4.3.4, §5.1.2, Eqns 4.65-4.70, corrected as in docs/method.md §4");
  d.input("windows", "training windows of one state")
      .output("model", "audio and visual processes of one latent trajectory");
  d.param("initial", &TrainSgpdm::initial)
      .doc("start values of the latent points: posterior mean of PCCA, average of PPCA or of canonical projections");
  d.param("audio_scaling", &TrainSgpdm::audio_scaling).doc("as visual_scaling, of the audio frames");
  d.param("visual_scaling", &TrainSgpdm::visual_scaling)
      .doc("per_dimension gives every dimension the same weight; common keeps the ratios of their variances");
  d.param("likelihood_bias", &TrainSgpdm::likelihood_bias)
      .doc("the stream of fewer dimensions weighs larger / smaller dimension");
  describe_training(d);
}

}  // namespace talkgraph
