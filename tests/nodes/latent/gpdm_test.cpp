#include "nodes/latent/gpdm.h"

#include <gtest/gtest.h>

#include <map>

#include "nodes/latent/gpdm_infer.h"
#include "nodes/latent/predictive.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

Track spiral(Eigen::Index frames, double from, std::uint64_t seed) {
  Eigen::MatrixXd path(frames, 3);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const double a = from + 0.3 * static_cast<double>(t);
    path.row(t) << std::cos(a), std::sin(a), 0.3 * std::cos(2 * a);
  }
  Track track;
  track.values = path * gaussian(3, 6, 1) + 0.05 * gaussian(frames, 6, seed);
  return track;
}

Track track_of(Eigen::MatrixXd values) { return {std::move(values), Rational(25), 0, {}}; }

double unexplained(const Gpdm& model, const Eigen::MatrixXd& frames) {
  Predictive p;
  p.compute(model.observations, model.latents);
  return (unscaled(model.observations, p.mean()) - frames).squaredNorm() /
         (frames.rowwise() - frames.colwise().mean()).squaredNorm();
}

TEST(TrainGpdm, FollowsTracksWithAndWithoutDynamics) {
  Collected<Track> tracks;
  tracks.add("a", spiral(30, 0, 2));
  tracks.add("b", spiral(20, 1, 3));
  Eigen::MatrixXd frames(50, 6);
  frames << tracks[0].values, tracks[1].values;
  Context context;
  for (const auto dynamics : {LatentDynamics::none, LatentDynamics::absolute, LatentDynamics::difference}) {
    TrainGpdm train;
    train.dynamics = dynamics;
    const Gpdm model = train(tracks, context);
    EXPECT_EQ(model.lengths, (std::vector<std::int64_t>{30, 20}));
    EXPECT_EQ(model.dynamics.has_value(), dynamics != LatentDynamics::none);
    EXPECT_LT(unexplained(model, frames), 0.05);
    EXPECT_GT(model.log_likelihood, model.trace.front() + 50);
  }
}

TEST(TrainGpdm, StepsDoNotLeadOverLostFrames) {
  Track track = spiral(20, 0, 2);
  track.lost = {0, 7, 8, 19};
  track.values.row(7).setConstant(1e3);
  Context context;
  TrainGpdm train;
  train.iterations = 10;
  const Gpdm model = train({{"a", track}}, context);
  EXPECT_EQ(model.lengths, (std::vector<std::int64_t>{6, 10}));
  EXPECT_EQ(model.trace.size(), 11u);
  EXPECT_EQ(model.ended, "iteration limit");
  EXPECT_LT(model.observations.scale.maxCoeff(), 10);
}

TEST(TrainGpdm, AnswersDegenerateTracks) {
  Context context;
  const TrainGpdm train;
  Track constant = spiral(10, 0, 2);
  constant.values.setConstant(4);
  const Gpdm still = train({{"a", constant}}, context);
  Predictive p;
  p.compute(still.observations, still.latents);
  EXPECT_TRUE(unscaled(still.observations, p.mean()).isApproxToConstant(4, 1e-9));
  const Gpdm one = train({{"a", spiral(1, 0, 2)}}, context);
  EXPECT_TRUE(one.latents.allFinite());
  EXPECT_FALSE(one.dynamics);
  EXPECT_EQ(train({{"empty", Track{}}, {"a", spiral(3, 0, 2)}}, context).lengths, std::vector<std::int64_t>{3});
}

TEST(TrainGpdm, RefusesWhatItCannotTrainOn) {
  Context context;
  const TrainGpdm train;
  EXPECT_THROW(train({}, context), std::runtime_error);
  Track lost = spiral(2, 0, 1), narrow = spiral(4, 0, 1), nan = spiral(4, 0, 1);
  lost.lost = {0, 1};
  EXPECT_THROW(train({{"a", lost}}, context), std::runtime_error);
  narrow.values.conservativeResize(4, 2);
  EXPECT_THROW(train({{"a", spiral(4, 0, 1)}, {"b", narrow}}, context), std::runtime_error);
  nan.values(1, 1) = NAN;
  EXPECT_THROW(train({{"a", nan}}, context), std::runtime_error);
}

const Gpdm& two_spirals(LatentDynamics dynamics) {
  static std::map<LatentDynamics, Gpdm> models;
  if (!models.contains(dynamics)) {
    Context context;
    TrainGpdm train;
    train.dynamics = dynamics;
    train.back_constraint = BackConstraintKind::kbr;
    models[dynamics] = train({{"a", spiral(30, 0, 2)}, {"b", spiral(20, 1, 3)}}, context);
  }
  return models.at(dynamics);
}

TEST(InferGpdm, ReconstructsTracksThatWereNotTrainedOn) {
  Context context;
  const Track truth = spiral(25, 0.5, 9);
  const double variance = (truth.values.rowwise() - truth.values.colwise().mean()).squaredNorm();
  for (const auto form : {LatentDynamics::none, LatentDynamics::absolute, LatentDynamics::difference})
    for (const auto initial : {GpdmStart::nearest, GpdmStart::back_constraint}) {
      InferGpdm infer;
      infer.initial = initial;
      const auto out = infer(two_spirals(form), truth, context);
      EXPECT_LT((out.track.values - truth.values).squaredNorm() / variance, 0.1);
      EXPECT_TRUE((out.deviation.values.array() > 0).all());
      infer.iterations = 0;
      const auto start = infer(two_spirals(form), truth, context);
      EXPECT_NE(out.latents.values, start.latents.values);
      Predictive given;
      given.compute(two_spirals(form).observations, out.latents.values);
      EXPECT_EQ(out.track.values, unscaled(two_spirals(form).observations, given.mean()));
    }
}

TEST(InferGpdm, TakesRunsOfMeasuredFramesByThemselves) {
  Context context;
  const Gpdm& model = two_spirals(LatentDynamics::absolute);
  Track track = spiral(12, 0.5, 9);
  track.lost = {4, 5};
  track.values.row(4).setConstant(1e6);
  const auto out = InferGpdm{}(model, track, context);
  Track head = track, tail = track;
  head.lost = tail.lost = {};
  head.values = track.values.topRows(4);
  tail.values = track.values.bottomRows(6);
  EXPECT_EQ(out.latents.values.topRows(4), InferGpdm{}(model, head, context).latents.values);
  EXPECT_EQ(out.latents.values.bottomRows(6), InferGpdm{}(model, tail, context).latents.values);
  EXPECT_TRUE(out.latents.values.middleRows(4, 2).isZero());
  for (const Track* t : {&out.latents, &out.track, &out.deviation}) EXPECT_EQ(t->lost, track.lost);
  track.lost = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  EXPECT_TRUE(InferGpdm{}(model, track, context).latents.values.isZero());
  EXPECT_EQ(InferGpdm{}(model, track_of(Eigen::MatrixXd(0, 6)), context).track.frames(), 0);
}

TEST(InferGpdm, RefusesWhatItCannotAnswer) {
  Context context;
  Gpdm model = two_spirals(LatentDynamics::none);
  Track track = spiral(5, 0, 1);
  track.values(2, 2) = NAN;
  EXPECT_THROW(InferGpdm{}(model, track, context), std::runtime_error);
  EXPECT_THROW(InferGpdm{}(model, track_of(gaussian(5, 3, 1)), context), std::runtime_error);
  EXPECT_THROW(InferGpdm{}(model, track_of(1e200 * gaussian(5, 6, 1)), context), std::runtime_error);
  model.back_constraint.reset();
  InferGpdm infer;
  infer.initial = GpdmStart::back_constraint;
  EXPECT_THROW(infer(model, spiral(5, 0, 1), context), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
