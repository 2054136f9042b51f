#include "nodes/latent/log_likelihood.h"

#include <gtest/gtest.h>

#include "nodes/latent/gmm.h"
#include "nodes/latent/hmm.h"
#include "nodes/latent/lds.h"
#include "nodes/latent/linear_models.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

Track track_of(Eigen::MatrixXd values) { return {std::move(values), Rational(25), 0, {}}; }

/// White noise, of which all models know the density: N(0, I).
Collected<Track> noise() {
  Collected<Track> tracks;
  for (std::uint64_t i = 0; i < 8; ++i) tracks.add(std::to_string(i), track_of(gaussian(500, 2, i + 1)));
  return tracks;
}

std::vector<Value> models() {
  Context context;
  Random random(1);
  TrainPpca ppca;
  ppca.latent_dimension = 1;
  TrainGmm gmm;
  gmm.components = 1;
  TrainHmm hmm;
  hmm.states = 1;
  TrainLds lds;
  lds.latent_dimension = 1;
  return {Value::of(ppca(noise(), context)), Value::of(gmm(noise(), random, context)),
          Value::of(hmm(noise(), random, context)), Value::of(lds(noise(), context))};
}

TEST(LogLikelihood, IsThatOfTheDensityTheDataAreDrawnFrom) {
  Track track = track_of(gaussian(400, 2, 99));
  const double expected = -std::log(2 * 3.14159265358979323846) - 0.5 * track.values.rowwise().squaredNorm().mean();
  for (const Value& model : models()) {
    EXPECT_NEAR(LogLikelihood{}(model, track)->values.at("log_likelihood"), expected, 0.01) << model.type().type.name;
    Track gap = track;
    gap.lost = {0, 7, 8, 399};
    for (const auto t : gap.lost) gap.values.row(t).setConstant(1e3);
    EXPECT_NEAR(LogLikelihood{}(model, gap)->values.at("log_likelihood"), expected, 0.03) << model.type().type.name;
  }
}

TEST(LogLikelihood, OfNoFramesIsNothing) {
  const Value model = models()[0];
  EXPECT_FALSE(LogLikelihood{}(model, Track{}));
  Track lost = track_of(gaussian(2, 2, 1));
  lost.lost = {0, 1};
  EXPECT_FALSE(LogLikelihood{}(model, lost));
}

TEST(LogLikelihood, RefusesWhatHasNone) {
  Track track = track_of(gaussian(5, 2, 1));
  EXPECT_THROW(LogLikelihood{}({}, track), std::runtime_error);
  EXPECT_THROW(LogLikelihood{}(Value::of(track), track), std::runtime_error);
  Track nan = track;
  nan.values(1, 1) = NAN;
  for (const Value& model : models()) {
    EXPECT_THROW(LogLikelihood{}(model, track_of(gaussian(5, 3, 1))), std::runtime_error);
    EXPECT_THROW(LogLikelihood{}(model, nan), std::runtime_error);
    EXPECT_THROW(LogLikelihood{}(model, track_of(1e200 * gaussian(5, 2, 1))), std::runtime_error);
  }
}

}  // namespace
}  // namespace talkgraph
