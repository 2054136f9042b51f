#include "nodes/mapping/ssgpdm.h"

#include <gtest/gtest.h>
#include <time.h>

#include <filesystem>
#include <functional>

#include "nodes/latent/compact.h"
#include "nodes/latent/predictive.h"
#include "nodes/latent/sequence_objective.h"
#include "nodes/latent/sgpdm.h"
#include "nodes/mapping/register.h"
#include "nodes/mapping/ssgpdm_synthesise.h"
#include "nodes/mapping/start_values.h"
#include "tests/nodes/latent/gaussian.h"
#include "tests/nodes/types/changed_members.h"
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
    const auto seed = 100 + static_cast<std::uint64_t>(w);
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

/// The model with the given dynamics and a back-constraint in every state.
Ssgpdm constrained(LatentDynamics dynamics) {
  Context context;
  TrainSgpdm train;
  train.latent_dimension = 2;
  train.iterations = 40;
  train.dynamics = dynamics;
  train.back_constraint = BackConstraintKind::kbr;
  train.kbr_inverse_width = 0.1;
  Collected<Sgpdm> states;
  states.add("b", train(half("b", pi, 25, 4), context));
  return AssembleSsgpdm{}(states);
}

TEST(Synthesis, FollowsTheTruthFromEveryStartWithEveryDynamics) {
  const auto s = speech(8);
  Context context;
  const double variance = (s.visual.values.rowwise() - s.visual.values.colwise().mean()).squaredNorm();
  for (const auto dynamics : {LatentDynamics::none, LatentDynamics::absolute, LatentDynamics::difference,
                              LatentDynamics::time, LatentDynamics::phase}) {
    const Ssgpdm states = constrained(dynamics);
    for (const auto initial :
         {LatentInitial::frame, LatentInitial::window, LatentInitial::back_constraint, LatentInitial::hmm})
      for (const auto method : {LatentSearch::optimise, LatentSearch::initial}) {
        SynthesiseSsgpdm node;
        node.method = method;
        node.initial = initial;
        const auto out = node(states, s.audio, segments_of({{"b", 4}, {"b", 4}}), context);
        EXPECT_LT((out.visual.values - s.visual.values).squaredNorm() / variance, 0.2);
      }
    // These windows begin anywhere on the curve, which time does not tell.
    if (dynamics == LatentDynamics::time || dynamics == LatentDynamics::phase) continue;
    SynthesiseSsgpdm predict;
    predict.method = LatentSearch::predict;
    const auto out = predict(states, s.audio, segments_of({{"b", 4}, {"b", 4}}), context);
    EXPECT_LT((out.visual.values - s.visual.values).squaredNorm() / variance, 0.5);
  }
}

TEST(Synthesis, RefusesABackConstraintThatIsNotThere) {
  Context context;
  SynthesiseSsgpdm node;
  node.initial = LatentInitial::back_constraint;
  try {
    node(model(), speech(4).audio, segments_of({{"b", 4}}), context);
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("state \"b\" has no back-constraint"), std::string::npos) << e.what();
  }
}

/// ln p of a path through training points, Eqns 4.81 and 4.82.
double path_score(const Sgpdm& state, const Eigen::MatrixXd& audio, const Eigen::MatrixXd& x) {
  Predictive f, h;
  f.compute(state.audio, x);
  double score = f.log_density(audio) - 0.5 * (static_cast<double>(x.cols()) * std::log(2 * pi * state.first_variance) +
                                               x.row(0).squaredNorm() / state.first_variance);
  if (state.dynamics && x.rows() > 1) {
    h.compute(*state.dynamics, x.topRows(x.rows() - 1));
    score += h.log_density(x.bottomRows(x.rows() - 1));
  }
  return score;
}

/// The same of dynamics of time: every point by itself.
double timed_path_score(const Sgpdm& state, const Eigen::MatrixXd& audio, const Eigen::MatrixXd& x) {
  Predictive f, h;
  f.compute(state.audio, x);
  h.compute(*state.dynamics, Eigen::VectorXd::LinSpaced(x.rows(), 0, static_cast<double>(x.rows() - 1)));
  return f.log_density(audio) + h.log_density(x);
}

TEST(StartValues, OfTheHiddenMarkovModelInTimeAreTheBestOfAllPaths) {
  Context context;
  TrainSgpdm train;
  train.latent_dimension = 2;
  train.dynamics = LatentDynamics::time;
  Sgpdm state = train(half("b", pi, 25, 4), context);
  state.latents = state.latents({0, 5, 10, 20, 41, 62, 83}, Eigen::all).eval();
  const Eigen::MatrixXd audio = scaled(state.audio, speech(3).audio.values);
  const Eigen::MatrixXd found = likeliest_path(state, audio, 0);
  double best = -1e300;
  Eigen::MatrixXd x(3, 2);
  for (Eigen::Index i = 0; i < 7; ++i)
    for (Eigen::Index j = 0; j < 7; ++j)
      for (Eigen::Index k = 0; k < 7; ++k) {
        x << state.latents.row(i), state.latents.row(j), state.latents.row(k);
        best = std::max(best, timed_path_score(state, audio, x));
      }
  EXPECT_NEAR(timed_path_score(state, audio, found), best, 1e-9 * std::abs(best));
}

TEST(Synthesis, PredictsWhatTheDynamicsOfTimeSay) {
  Context context;
  TrainSgpdm train;
  train.latent_dimension = 2;
  train.dynamics = LatentDynamics::phase;
  const Sgpdm state = train(half("b", pi, 25, 4), context);
  SynthesiseSsgpdm node;
  node.method = LatentSearch::predict;
  const Eigen::MatrixXd x = segment_latents(node, state, scaled(state.audio, speech(5).audio.values), {}).points;
  Predictive h;
  h.compute(*state.dynamics, Eigen::VectorXd::LinSpaced(5, 0.1, 0.9));
  EXPECT_LT((x - h.mean()).bottomRows(4).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT((x - h.mean()).row(0).norm(), 1e-6) << "the first is optimised";
}

TEST(StartValues, OfTheHiddenMarkovModelAreTheBestOfAllPaths) {
  const Sgpdm& full = model().states.at("b");
  Sgpdm state = full;
  state.latents = full.latents({0, 5, 10, 20, 40, 61, 83}, Eigen::all);
  Eigen::MatrixXd audio = speech(3).audio.values;
  audio = scaled(state.audio, audio);
  const Eigen::MatrixXd found = likeliest_path(state, audio, 0);
  double best = -1e300;
  Eigen::MatrixXd x(3, state.latents.cols());
  for (Eigen::Index i = 0; i < 7; ++i)
    for (Eigen::Index j = 0; j < 7; ++j)
      for (Eigen::Index k = 0; k < 7; ++k) {
        x << state.latents.row(i), state.latents.row(j), state.latents.row(k);
        best = std::max(best, path_score(state, audio, x));
      }
  EXPECT_NEAR(path_score(state, audio, found), best, 1e-9 * std::abs(best));
}

TEST(StartValues, OfTheHiddenMarkovModelMayUseASubset) {
  const Sgpdm& state = model().states.at("b");
  const Eigen::MatrixXd audio = scaled(state.audio, speech(6).audio.values);
  const Eigen::MatrixXd all = likeliest_path(state, audio, 0), some = likeliest_path(state, audio, 20);
  EXPECT_EQ(some, likeliest_path(state, audio, 20));
  EXPECT_GE(path_score(state, audio, all), path_score(state, audio, some));
  EXPECT_EQ(all, likeliest_path(state, audio, 100));
  EXPECT_EQ(likeliest_path(state, audio.topRows(1), 1).rows(), 1);
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

TEST(Synthesis, GivesTheLatentPointsItFound) {
  const auto s = speech(8);
  Context context;
  const auto out = SynthesiseSsgpdm{}(model(), s.audio, segments_of({{"q-b", 3}, {"b-a", 5}}), context);
  ASSERT_EQ(out.states.segments.size(), 2u);
  EXPECT_EQ(out.states.frames, 8);
  EXPECT_EQ(out.states.segments[0].label, "b") << "the state that answered";
  EXPECT_EQ(out.states.segments[1].start, 3);
  Predictive visual;
  for (const auto& segment : out.states.segments) {
    const Sgpdm& state = model().states.at(segment.label);
    visual.compute(state.visual, out.latents.values.middleRows(segment.start, segment.length));
    EXPECT_EQ(unscaled(state.visual, visual.mean()), out.visual.values.middleRows(segment.start, segment.length));
  }
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
  const Eigen::VectorXd points = segment_latents(node, state, audio, {}).points.reshaped();
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

TEST(Synthesis, KeepsLostFramesMarked) {
  auto s = speech(8);
  Context context;
  s.audio.lost = {2, 7};
  const auto out = SynthesiseSsgpdm{}(model(), s.audio, segments_of({{"b", 7}}), context);
  for (const Track* track : {&out.visual, &out.deviation, &out.latents})
    EXPECT_EQ(track->lost, (std::vector<std::int64_t>{2}));
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

std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

TEST(Synthesis, OfAModelThatHoldsNanNamesStateAndSegment) {
  Context context;
  const auto s = speech(8);
  const auto parts = segments_of({{"b", 4}, {"q-a", 4}});
  for (const auto method : {LatentSearch::optimise, LatentSearch::initial})
    for (const auto stream : {&Sgpdm::audio, &Sgpdm::visual}) {
      Ssgpdm broken = model();
      (broken.states.at("a").*stream).weights.setConstant(NAN);
      SynthesiseSsgpdm node;
      node.method = method;
      const std::string error = error_of([&] { node(broken, s.audio, parts, context); });
      const bool unseen = method == LatentSearch::initial && stream == &Sgpdm::audio;
      EXPECT_EQ(error.find("segment \"q-a\" from frame 4 on: state \"a\"") == 0, !unseen) << error;
    }
}

TEST(Synthesis, SaysHowManySegmentsConverged) {
  const auto s = speech(8);
  const auto logged = [&](int iterations) {
    Context context;
    std::string said;
    context.on_log = [&](std::string_view message) { said = message; };
    SynthesiseSsgpdm node;
    node.iterations = iterations;
    node(model(), s.audio, segments_of({{"b", 4}, {"b-a", 4}}), context);
    return said;
  };
  EXPECT_EQ(logged(1), "0 of 2 segments converged within 1 iterations");
  EXPECT_EQ(logged(1000), "2 of 2 segments converged within 1000 iterations");
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

TEST(Ssgpdm, ThatIsDamagedIsRefusedOrAnswers) {
  const auto s = speech(8);
  const auto parts = segments_of({{"b", 4}, {"q-a", 4}});
  const auto use = [&](const Ssgpdm& m) {
    Context context;
    return SynthesiseSsgpdm{}(m, s.audio, parts, context).visual.values;
  };
  EXPECT_GT(testing::refuses_or_answers<Ssgpdm>(model(), use), 100);
}

TEST(Ssgpdm, ThatIsDamagedSaysWhichMemberOfWhichState) {
  testing::MemoryArchive archive;
  Ssgpdm saved = model(), loaded;
  fields(archive, saved);
  auto& sizes = std::get<std::vector<std::int64_t>>(archive.members.at("states/visual.weights/sizes"));
  std::swap(sizes[2], sizes[3]);
  archive.loads = true;
  const std::string error = error_of([&] { fields(archive, loaded); });
  EXPECT_EQ(error.find("the stored state \"b\" is damaged: its \"visual.weights\" is 6 × "), 0u) << error;
}

#ifdef __SANITIZE_ADDRESS__
constexpr double slower = 20;
#else
constexpr double slower = 1;
#endif

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

TEST(Synthesis, OptimisesSevenFramesInAStateOfTwoHundredInTwoMilliseconds) {
  Context context;
  TrainSgpdm train;
  const Sgpdm state = train(half("b", pi, 40, 5), context);
  ASSERT_EQ(state.latents.rows(), 200);
  const Eigen::MatrixXd audio = scaled(state.audio, speech(7).audio.values);
  double least = 1;
  for (int i = 0; i < 20; ++i) {
    const double start = cpu_seconds();
    segment_latents(SynthesiseSsgpdm{}, state, audio, {});
    least = std::min(least, cpu_seconds() - start);
  }
  RecordProperty("microseconds", static_cast<int>(1e6 * least));
  EXPECT_LT(least, 2e-3 * slower);
}

/// A state of that many frames, in windows of five, with numbers as training leaves them.
Sgpdm random_state(const std::string& label, Eigen::Index frames, Random& random) {
  const auto draw = [&](Eigen::Index rows, Eigen::Index cols, int bits = 16) {
    return rounded(Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return random.normal(); }), bits);
  };
  const Eigen::Index d = std::min<Eigen::Index>(5, std::max<Eigen::Index>(1, frames - 1));
  Sgpdm s;
  s.label = label;
  s.latents = draw(frames, d, 20);
  s.audio_frames = draw(frames, 20, 12);
  for (Eigen::Index left = frames; left > 0; left -= 5) s.lengths.push_back(std::min<Eigen::Index>(left, 5));
  const auto process = [&](Kernel kernel, Eigen::Index inputs, Eigen::Index outputs) {
    kernel.terms.push_back(WhiteTerm{0.4, 1e-3});
    const Eigen::Index k = std::min<Eigen::Index>(inputs, 100);
    return GaussianProcess{kernel,
                           inputs == frames && frames <= 100 ? s.latents : draw(k, d, 20),
                           draw(k, outputs),
                           {},
                           draw(k, k).triangularView<Eigen::Lower>(),
                           draw(1, outputs).row(0),
                           draw(1, outputs).row(0)};
  };
  s.audio = process({{RbfTerm{}, BiasTerm{}}}, frames, 20);
  s.visual = process({{RbfTerm{}, BiasTerm{}}}, frames, 33);
  const auto steps = frames - static_cast<Eigen::Index>(s.lengths.size());
  if (steps > 0) s.dynamics = process({{RbfTerm{}, LinearTerm{}}}, steps, d);
  s.trace.assign(21, -1000.5);
  return s;
}

/// Frames of a state at a share of all states, in the order of their size: the built-in speaker's 270 sentences.
Eigen::Index occupancy(double share) {
  const std::vector<std::pair<double, double>> at = {{0, 10},    {0.05, 14}, {0.1, 15},   {0.25, 21},  {0.5, 30},
                                                     {0.75, 52}, {0.9, 160}, {0.95, 364}, {0.99, 678}, {1, 1000}};
  std::size_t i = 1;
  while (at[i].first < share) ++i;
  const double along = (share - at[i - 1].first) / (at[i].first - at[i - 1].first);
  return std::lround(at[i - 1].second + along * (at[i].second - at[i - 1].second));
}

TEST(Ssgpdm, OfTwoThousandStatesIsASmallFileThatLoadsInASecond) {
  Random random(1);
  Ssgpdm saved, loaded;
  Eigen::Index frames = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::string label = "a-b-" + std::to_string(i);
    frames += occupancy((i + 0.5) / 2000);
    saved.states.emplace(label, random_state(label, occupancy((i + 0.5) / 2000), random));
  }
  const test::TemporaryFolder folder;
  const auto path = folder.file("ssgpdm.h5");
  write_hdf5(path, [&](Archive& ar) { fields(ar, saved); });
  const double start = cpu_seconds();
  fields(*hdf5_reader(path), loaded);
  const double seconds = cpu_seconds() - start,
               megabytes = 1e-6 * static_cast<double>(std::filesystem::file_size(path));
  RecordProperty("frames", static_cast<int>(frames));
  RecordProperty("kilobytes", static_cast<int>(1e3 * megabytes));
  RecordProperty("milliseconds", static_cast<int>(1e3 * seconds));
  EXPECT_LT(megabytes, 60);
  EXPECT_LT(seconds, 1 * slower);
  ASSERT_EQ(loaded.states.size(), 2000u);
  for (const auto& [label, state] : saved.states) {
    const Sgpdm& same = loaded.states.at(label);
    EXPECT_EQ(same.latents, state.latents);
    EXPECT_EQ(same.visual.root, state.visual.root);
    EXPECT_EQ(same.audio.basis, state.audio.basis);
    EXPECT_EQ(same.dynamics.has_value(), state.dynamics.has_value());
  }
}

TEST(Mapping, RegistersItsNodes) {
  Registry registry;
  register_mapping(registry);
  EXPECT_TRUE(registry.find("mapping.ssgpdm"));
  EXPECT_TRUE(registry.find("mapping.ssgpdm_synthesise"));
  EXPECT_TRUE(registry.find("mapping.context_gp"));
  EXPECT_TRUE(registry.find("mapping.context_gp_predict"));
}

}  // namespace
}  // namespace talkgraph
