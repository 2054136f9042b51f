#include "nodes/mapping/ssgpdm.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "nodes/latent/sequence_objective.h"
#include "nodes/latent/sgpdm.h"
#include "nodes/mapping/register.h"
#include "nodes/mapping/ssgpdm_synthesise.h"
#include "tests/nodes/latent/gaussian.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::gaussian;

constexpr double pi = 3.14159265358979323846;

/// A smooth path on a closed curve; the state tells which half it is on.
Eigen::MatrixXd curve(const Eigen::VectorXd& angle, Eigen::Index dims, std::uint64_t seed) {
  Eigen::MatrixXd basis(angle.size(), 4);
  basis << angle.array().cos(), angle.array().sin(), (2 * angle).array().cos(), (2 * angle).array().sin();
  return basis * gaussian(4, dims, seed);
}

StateData half(const std::string& label, double centre, int windows, int length) {
  Random random(7);
  StateData data{label, {}, {}};
  for (int w = 0; w < windows; ++w) {
    Eigen::VectorXd angle(length);
    const double from = centre + 0.8 * random.normal();
    for (int t = 0; t < length; ++t) angle[t] = from + 0.25 * t;
    const auto seed = static_cast<std::uint64_t>(100 + w);
    data.audio.push_back(curve(angle, 8, 1) + 0.05 * gaussian(length, 8, seed));
    data.visual.push_back(curve(angle, 6, 2) + 0.05 * gaussian(length, 6, seed + 500));
  }
  return data;
}

Collected<Sgpdm> trained() {
  Context context;
  TrainSgpdm train;
  train.latent_dimension = 2;
  train.iterations = 40;
  Collected<Sgpdm> states;
  for (const auto& data : {half("a", 0, 20, 1), half("b-a", 1, 20, 3), half("b", pi, 25, 4), half("c", 2 * pi, 1, 1)})
    states.add(data.label, train(data, context));
  return states;
}

const Ssgpdm& model() {
  static const Ssgpdm m = AssembleSsgpdm{}(trained());
  return m;
}

SegmentTrack segments_of(const std::vector<std::pair<std::string, int>>& parts) {
  SegmentTrack s;
  for (const auto& [label, length] : parts) {
    s.segments.push_back({label, s.frames, length});
    s.frames += length;
  }
  return s;
}

struct Speech {
  Track audio, visual;
};
Speech speech(int frames, double from = pi - 1) {
  Eigen::VectorXd angle(frames);
  for (int t = 0; t < frames; ++t) angle[t] = from + 0.25 * t;
  Speech s;
  s.audio.values = curve(angle, 8, 1) + 0.05 * gaussian(frames, 8, 900);
  s.audio.start = 0.02;
  s.visual.values = curve(angle, 6, 2);
  return s;
}

TEST(Ssgpdm, FindsAStateForEveryLabel) {
  const auto label_of = [](const std::string& label, double angle) {
    return state_for(model(), label, curve(Eigen::VectorXd::Constant(1, angle), 8, 1).row(0)).label;
  };
  EXPECT_EQ(label_of("b-a", 0), "b-a");
  EXPECT_EQ(label_of("x-b-a", 0), "b-a");
  EXPECT_EQ(label_of("x-y-a", 0), "a");
  EXPECT_EQ(label_of("zz", pi), "b");
  EXPECT_EQ(model().ending.at("a"), "b-a");
}

TEST(Ssgpdm, TakesAnyStateThatEndsInThePhone) {
  Collected<Sgpdm> states;
  const auto all = trained();
  states.add("b-a", all[1]);
  states.add("b", all[2]);
  EXPECT_EQ(state_for(AssembleSsgpdm{}(states), "a", Eigen::RowVectorXd::Zero(8)).label, "b-a");
}

TEST(Ssgpdm, RefusesNoStatesTwinsAndMixedDimensions) {
  EXPECT_THROW(AssembleSsgpdm{}({}), std::runtime_error);
  auto states = trained();
  states.add("a again", states[0]);
  EXPECT_THROW(AssembleSsgpdm{}(states), std::runtime_error);
  Collected<Sgpdm> mixed = trained();
  Sgpdm other = mixed[0];
  other.label = "other";
  other.visual.mean = Eigen::RowVectorXd::Zero(2);
  mixed.add("other", other);
  EXPECT_THROW(AssembleSsgpdm{}(mixed), std::runtime_error);
}

TEST(Synthesis, FollowsTheTruthWithEveryMethod) {
  const auto s = speech(8);
  Context context;
  for (const auto method : {LatentSearch::optimise, LatentSearch::predict, LatentSearch::initial})
    for (const auto initial : {LatentInitial::frame, LatentInitial::window}) {
      SynthesiseSsgpdm node;
      node.method = method;
      node.initial = initial;
      const auto out = node(model(), s.audio, segments_of({{"b", 4}, {"b", 4}}), context);
      const double variance = (s.visual.values.rowwise() - s.visual.values.colwise().mean()).squaredNorm();
      const double error = (out.visual.values - s.visual.values).squaredNorm() / variance;
      EXPECT_LT(error, method == LatentSearch::predict ? 0.5 : 0.15);
      EXPECT_EQ(out.visual.start, 0.02);
      EXPECT_EQ(out.visual.names, std::vector<std::string>{});
      EXPECT_TRUE((out.deviation.values.array() > 0).all());
    }
}

TEST(Synthesis, AnswersUnknownLabelsAndAnySegmentLength) {
  const auto s = speech(30);
  Context context;
  const auto out = SynthesiseSsgpdm{}(
      model(), s.audio, segments_of({{"q-b", 1}, {"b", 2}, {"b", 9}, {"nobody", 4}, {"a", 3}, {"c", 5}, {"b-a", 6}}),
      context);
  EXPECT_EQ(out.visual.frames(), 30);
  EXPECT_TRUE(out.visual.values.allFinite());
  EXPECT_TRUE(out.deviation.values.allFinite());
}

TEST(Synthesis, OfOneFrameAndOfNone) {
  Context context;
  EXPECT_EQ(SynthesiseSsgpdm{}(model(), speech(1).audio, segments_of({{"b", 1}}), context).visual.frames(), 1);
  Track empty;
  const auto out = SynthesiseSsgpdm{}(model(), empty, SegmentTrack{}, context);
  EXPECT_EQ(out.visual.frames(), 0);
  EXPECT_EQ(out.visual.dimension(), 6);
}

TEST(Synthesis, SmoothnessReducesTheJumpAtABoundary) {
  const auto s = speech(8);
  Context context;
  const auto jump = [&](double smoothness) {
    SynthesiseSsgpdm node;
    node.smoothness = smoothness;
    node.iterations = 100;
    const auto z = node(model(), s.audio, segments_of({{"b", 4}, {"b-a", 3}, {"b", 1}}), context).visual.values;
    return (z.row(4) - z.row(3)).norm() + (z.row(7) - z.row(6)).norm();
  };
  EXPECT_LT(jump(1), jump(0));
  EXPECT_LT(jump(30), 0.9 * jump(0));
}

/// Negative log-likelihood of a segment's audio and of the latent points that a method finds for it.
double cost_of(LatentSearch method, const Sgpdm& state, const Eigen::MatrixXd& audio) {
  SynthesiseSsgpdm node;
  node.method = method;
  const Eigen::VectorXd points = segment_latents(node, state, audio, {}).reshaped();
  SequenceObjective objective(state, audio, audio.rows() > 1);
  double cost = 0;
  EXPECT_TRUE(objective.evaluate(points, cost, nullptr));
  return cost;
}

TEST(Synthesis, OptimisationRaisesTheLikelihood) {
  for (const auto& [label, frames] : {std::pair("b", 4), std::pair("b", 6), std::pair("b-a", 3), std::pair("a", 1)}) {
    const Sgpdm& state = state_for(model(), label, Eigen::RowVectorXd::Zero(8));
    Eigen::MatrixXd audio = speech(frames, label[0] == 'b' ? pi - 0.5 : 0).audio.values;
    audio = (audio.rowwise() - state.audio.mean).array().rowwise() / state.audio.scale.array();
    EXPECT_LT(cost_of(LatentSearch::optimise, state, audio), cost_of(LatentSearch::initial, state, audio) - 0.1)
        << label << " " << frames;
  }
}

TEST(Synthesis, GivesTheSameTwice) {
  const auto s = speech(4);
  Context context;
  const auto segments = segments_of({{"b", 4}});
  EXPECT_EQ(SynthesiseSsgpdm{}(model(), s.audio, segments, context).visual.values,
            SynthesiseSsgpdm{}(model(), s.audio, segments, context).visual.values);
}

TEST(Synthesis, UsesTheCommonBeginningOfTwoFramesAndNoMore) {
  const auto s = speech(8);
  Context context;
  EXPECT_EQ(SynthesiseSsgpdm{}(model(), s.audio, segments_of({{"b", 4}, {"b", 6}}), context).visual.frames(), 8);
  EXPECT_EQ(SynthesiseSsgpdm{}(model(), s.audio, segments_of({{"b", 6}}), context).visual.frames(), 6);
  EXPECT_THROW(SynthesiseSsgpdm{}(model(), s.audio, segments_of({{"b", 5}}), context), std::runtime_error);
}

TEST(Synthesis, RefusesWrongDimensionsGapsAndNan) {
  Context context;
  auto s = speech(8);
  SegmentTrack gap = segments_of({{"b", 4}, {"b", 4}});
  gap.segments[1].start = 5;
  EXPECT_THROW(SynthesiseSsgpdm{}(model(), s.audio, gap, context), std::runtime_error);
  EXPECT_THROW(SynthesiseSsgpdm{}(model(), s.visual, segments_of({{"b", 8}}), context), std::runtime_error);
  s.audio.values(2, 2) = NAN;
  EXPECT_THROW(SynthesiseSsgpdm{}(model(), s.audio, segments_of({{"b", 8}}), context), std::runtime_error);
  EXPECT_THROW(SynthesiseSsgpdm{}(Ssgpdm{}, s.audio, segments_of({{"b", 8}}), context), std::runtime_error);
}

TEST(Ssgpdm, SynthesisesTheSameAfterSavingAndLoading) {
  Ssgpdm saved = model(), loaded;
  const test::TemporaryFolder folder;
  const auto path = folder.file("ssgpdm.h5");
  write_hdf5(path, [&](Archive& ar) { fields(ar, saved); });
  fields(*hdf5_reader(path), loaded);
  const auto s = speech(8);
  Context context;
  const auto parts = segments_of({{"b", 4}, {"q-a", 4}});
  EXPECT_EQ(SynthesiseSsgpdm{}(saved, s.audio, parts, context).visual.values,
            SynthesiseSsgpdm{}(loaded, s.audio, parts, context).visual.values);
}

TEST(Mapping, RegistersItsNodes) {
  Registry registry;
  register_mapping(registry);
  EXPECT_TRUE(registry.find("mapping.ssgpdm"));
  EXPECT_TRUE(registry.find("mapping.ssgpdm_synthesise"));
}

}  // namespace
}  // namespace talkgraph
