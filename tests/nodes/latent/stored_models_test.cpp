#include <gtest/gtest.h>

#include "nodes/latent/back_constraint.h"
#include "nodes/latent/gmm.h"
#include "nodes/latent/gp_regression.h"
#include "nodes/latent/gpdm.h"
#include "nodes/latent/hmm.h"
#include "nodes/latent/lds.h"
#include "nodes/latent/linear_models.h"
#include "nodes/latent/predictive.h"
#include "nodes/latent/sequence_objective.h"
#include "nodes/latent/sgpdm.h"
#include "tests/nodes/latent/gaussian.h"
#include "tests/nodes/types/changed_members.h"

namespace talkgraph {
namespace {

using testing::gaussian;
using testing::refuses_or_answers;

const Eigen::MatrixXd frames = gaussian(6, 5, 3);

Collected<Track> tracks(Eigen::Index dims) {
  Collected<Track> all;
  for (const char* key : {"a", "b"}) {
    Track t;
    t.values = gaussian(20, dims, static_cast<std::uint64_t>(dims) + static_cast<std::uint64_t>(key[0]));
    all.add(key, t);
  }
  return all;
}

Track track_of(const Eigen::MatrixXd& values) {
  Track t;
  t.values = values;
  return t;
}

TEST(StoredModels, OfTwoStreamsFitTogetherOrAreRefused) {
  Context context;
  for (const auto kind : {BackConstraintKind::none, BackConstraintKind::mlp, BackConstraintKind::kbr}) {
    TrainSgpdm train;
    train.back_constraint = kind;
    train.iterations = 2;
    train.inducing = 10;
    StateData data{"a", {}, {}};
    for (std::uint64_t w = 0; w < 6; ++w) {
      data.audio.push_back(gaussian(4, 5, w));
      data.visual.push_back(gaussian(4, 3, 50 + w));
    }
    const auto use = [](const Sgpdm& m) -> Eigen::MatrixXd {
      Eigen::MatrixXd x = m.latents.topRows(6);
      if (m.back_constraint) x = latent_points(*m.back_constraint, frames);
      SequenceObjective objective(m, frames, true);
      double cost = 0;
      Eigen::VectorXd gradient;
      if (!objective.evaluate(x.reshaped(), cost, &gradient)) throw std::runtime_error("no density");
      Predictive visual;
      visual.compute(m.visual, x);
      return unscaled(m.visual, visual.mean());
    };
    EXPECT_GT(refuses_or_answers<Sgpdm>(train(data, context), use), 60);
  }
}

TEST(StoredModels, OfOneStreamFitTogetherOrAreRefused) {
  Context context;
  TrainGpdm train;
  train.iterations = 2;
  train.inducing = 10;
  const auto use = [](const Gpdm& m) -> Eigen::MatrixXd {
    Predictive f;
    f.compute(m.observations, m.latents);
    return unscaled(m.observations, f.mean());
  };
  EXPECT_GT(refuses_or_answers<Gpdm>(train(tracks(5), context), use), 40);
}

TEST(StoredModels, OfRegressionFitTogetherOrAreRefused) {
  Context context;
  TrainGp train;
  train.iterations = 2;
  train.inducing = 10;
  train.context = 1;
  train.kernel[0].kind = KernelKind::ard;
  const auto use = [](const GpRegression& m) { return PredictGp{}(m, track_of(frames)).track.values; };
  EXPECT_GT(refuses_or_answers<GpRegression>(train(tracks(5), tracks(3), context), use), 40);
}

TEST(StoredModels, OfCanonicalCorrelationsFitTogetherOrAreRefused) {
  Context context;
  const Eigen::MatrixXd other = gaussian(6, 3, 4);
  const auto use_pcca = [&](const Pcca& m) -> Eigen::MatrixXd {
    return m.log_likelihood(frames, other) + m.posterior_mean(frames, other).rowwise().sum();
  };
  EXPECT_GT(refuses_or_answers<Pcca>(TrainPcca{}(tracks(5), tracks(3), context), use_pcca), 25);
  const auto use_cca = [&](const Cca& m) { return ProjectCca{}(m, track_of(frames)).values; };
  EXPECT_GT(refuses_or_answers<Cca>(TrainCca{}(tracks(5), tracks(3), context), use_cca), 12);
}

TEST(StoredModels, WithoutProcessesFitTogetherOrAreRefused) {
  Context context;
  Random random(1);
  TrainPpca ppca;
  ppca.latent_dimension = 2;
  const auto use_ppca = [](const Ppca& m) -> Eigen::MatrixXd {
    return m.log_likelihood(frames) + ProjectPpca{}(m, track_of(frames)).values.rowwise().sum();
  };
  EXPECT_GT(refuses_or_answers<Ppca>(ppca(tracks(5), context), use_ppca), 8);
  for (const auto kind : {CovarianceKind::full, CovarianceKind::diagonal}) {
    TrainGmm gmm;
    gmm.components = 3;
    gmm.covariance = kind;
    EXPECT_GT(refuses_or_answers<Gmm>(gmm(tracks(5), random, context),
                                      [](const Gmm& m) { return GmmResponsibilities{}(m, track_of(frames)).values; }),
              10);
    TrainHmm hmm;
    hmm.states = 3;
    hmm.covariance = kind;
    EXPECT_GT(refuses_or_answers<Hmm>(
                  hmm(tracks(5), random, context),
                  [&](const Hmm& m) { return DecodeHmm{}(m, track_of(frames), context).posteriors.values; }),
              20);
    TrainLds lds;
    lds.latent_dimension = 2;
    lds.covariance = kind;
    lds.iterations = 3;
    EXPECT_GT(
        refuses_or_answers<Lds>(lds(tracks(5), context),
                                [&](const Lds& m) { return SmoothLds{}(m, track_of(frames), context).track.values; }),
        20);
  }
}

}  // namespace
}  // namespace talkgraph
