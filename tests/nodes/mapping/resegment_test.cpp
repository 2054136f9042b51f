#include "nodes/mapping/resegment.h"

#include <gtest/gtest.h>

#include <numbers>

#include "nodes/context/train.h"
#include "nodes/context/windows.h"
#include "nodes/latent/predictive.h"
#include "nodes/latent/sgpdm.h"
#include "nodes/mapping/ssgpdm.h"
#include "nodes/mapping/start_values.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

/// Runs of phones whose sound and face move about places of their own.
struct Utterance {
  FrameLabels labels;
  Track audio, visual;
};
Utterance utterance(const std::string& letters, std::uint64_t seed) {
  Utterance u;
  const auto frames = std::ssize(letters);
  u.audio.values = 0.3 * gaussian(frames, 4, seed);
  u.visual.values = 0.3 * gaussian(frames, 3, seed + 1000);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const char c = letters[static_cast<std::size_t>(t)];
    u.labels.labels.emplace_back(1, c);
    const auto place = static_cast<unsigned char>(c);
    u.audio.values.row(t) += 3 * gaussian(1, 4, place);
    u.visual.values.row(t) += 3 * gaussian(1, 3, place + 500);
  }
  return u;
}

FrameLabels labels_of(const std::string& letters) {
  FrameLabels f;
  for (const char c : letters) f.labels.emplace_back(1, c);
  return f;
}

std::string str(const FrameLabels& f) {
  std::string s;
  for (const auto& label : f.labels) s += label;
  return s;
}

const Ssgpdm& model() {
  static const Ssgpdm m = [] {
    Collected<FrameLabels> labels;
    Collected<Track> audio, visual;
    for (std::uint64_t i = 0; i < 8; ++i) {
      const Utterance u = utterance(i % 2 ? "aaabbbbccaabbb" : "ccccaabbbccaaa", i);
      labels.add(std::to_string(i), u.labels);
      audio.add(std::to_string(i), u.audio);
      visual.add(std::to_string(i), u.visual);
    }
    auto windows = ContextWindows{.states = StateKind::phones}(ContextTrain{}(labels), labels, audio, visual);
    Context context;
    TrainSgpdm train;
    train.latent_dimension = 2;
    Collected<Sgpdm> states;
    while (auto state = windows.next()) states.add(state->key, train(state->value, context));
    return AssembleSsgpdm{}(states);
  }();
  return m;
}

const std::string truth = "aaabbbbccaaa";

TEST(Resegment, FindsTheBoundariesThatMoved) {
  const Utterance u = utterance(truth, 99);
  Context context;
  for (const std::string given : {"aaaabbbccaaa", "abbbbbccccaa", truth.c_str()}) {
    const auto seen = Resegment{}(model(), labels_of(given), u.audio, &u.visual, context);
    EXPECT_EQ(str(seen.labels), truth) << given;
    EXPECT_GE(seen.scores.values.at("objective"), seen.scores.values.at("before"));
    double moved = 0;
    for (std::size_t t = 0; t < truth.size(); ++t) moved += given[t] != truth[t];
    EXPECT_NEAR(seen.scores.values.at("moved"), moved / 12, 1e-12);
    EXPECT_EQ(str(Resegment{}(model(), labels_of(given), u.audio, nullptr, context).labels), truth) << "by sound alone";
  }
}

// A phone whose sound is so far away that no other one can have made it.
TEST(Resegment, DoesNotSayALikelihoodBeforeThatIsNotFinite) {
  constexpr double far = 1e160;
  Ssgpdm distant = model();
  distant.states.at("b").audio.mean.array() += far;
  Utterance u = utterance("aaabbb", 93);
  u.audio.values.bottomRows(3).array() += far;
  Context context;
  const auto out = Resegment{}(distant, labels_of("aaaabb"), u.audio, &u.visual, context);
  EXPECT_EQ(str(out.labels), "aaabbb");
  EXPECT_TRUE(std::isfinite(out.scores.values.at("objective")));
  EXPECT_FALSE(out.scores.values.contains("before"));
}

TEST(Resegment, MovesNoBoundaryFurtherThanItsReach) {
  const Utterance u = utterance(truth, 98);
  Context context;
  const Resegment near{.reach = 1};
  EXPECT_EQ(str(near(model(), labels_of("abbbbbbccaaa"), u.audio, &u.visual, context).labels), "aabbbbbccaaa");
  EXPECT_EQ(str(Resegment{.reach = 0}(model(), labels_of("aaaabbbccaaa"), u.audio, &u.visual, context).labels),
            "aaaabbbccaaa");
}

// Every segmentation by itself: that of the greatest likelihood, with reach 0, is what dynamic programming finds.
TEST(Resegment, IsTheBestOfAllSegmentations) {
  Context context;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Utterance u = utterance("aabbbc", 50 + seed);
    u.audio.values += 3 * gaussian(6, 4, 70 + seed);
    const FrameLabels given = labels_of("aabbcc");
    const auto found = Resegment{}(model(), given, u.audio, &u.visual, context);
    double best = -1e300;
    std::string likeliest;
    for (std::size_t a = 1; a <= 4; ++a)
      for (std::size_t b = std::max<std::size_t>(a + 1, 2); b <= 5; ++b) {
        const std::string candidate = std::string(a, 'a') + std::string(b - a, 'b') + std::string(6 - b, 'c');
        const double value = Resegment{.reach = 0}(model(), labels_of(candidate), u.audio, &u.visual, context)
                                 .scores.values.at("objective");
        if (value > best) likeliest = candidate;
        best = std::max(best, value);
      }
    EXPECT_EQ(str(found.labels), likeliest);
    EXPECT_NEAR(found.scores.values.at("objective"), best, 1e-9 * std::abs(best));
  }
}

TEST(Resegment, ObjectivesAreInTheFeaturesOwnUnits) {
  Context context;
  const Utterance u = utterance(truth, 97);
  const auto value = [&](const Ssgpdm& m, const Track& audio, const Track& visual) {
    return Resegment{}(m, u.labels, audio, &visual, context).scores.values.at("objective");
  };
  const double plain = value(model(), u.audio, u.visual);
  Ssgpdm louder = model(), larger = model();
  for (auto& [label, state] : louder.states) state.audio.mean *= 10, state.audio.scale *= 10;
  for (auto& [label, state] : larger.states) state.visual.mean *= 10, state.visual.scale *= 10;
  Track audio = u.audio, visual = u.visual;
  audio.values *= 10;
  visual.values *= 10;
  EXPECT_NEAR(plain - value(louder, audio, u.visual), 4 * std::log(10), 1e-8);
  EXPECT_NEAR(plain - value(larger, u.audio, visual), 3 * std::log(10), 1e-8);
}

// Of one run, at the latent points that the search starts from.
TEST(Resegment, ObjectiveIsWhatSynthesisMaximises) {
  Context context;
  const Utterance u = utterance("aaaa", 12);
  const Sgpdm& state = model().states.at("a");
  const Eigen::MatrixXd heard = scaled(state.audio, u.audio.values), x = nearest_window(state, heard);
  Predictive predictive;
  const auto density = [&](const GaussianProcess& gp, const Eigen::MatrixXd& at, const Eigen::MatrixXd& of) {
    predictive.compute(gp, at);
    return predictive.log_density(scaled(gp, of)) - static_cast<double>(of.rows()) * gp.scale.array().log().sum();
  };
  const auto d = static_cast<double>(x.cols());
  const double first = -0.5 * (d * std::log(2 * std::numbers::pi * state.first_variance) +
                               x.row(0).squaredNorm() / state.first_variance);
  const double dynamics = first + density(*state.dynamics, x.topRows(3), x.bottomRows(3));
  const double sum = density(state.audio, x, u.audio.values) + density(state.visual, x, u.visual.values) +
                     state.dynamics_bias * dynamics;
  const auto found = Resegment{.reach = 0, .iterations = 0}(model(), u.labels, u.audio, &u.visual, context);
  EXPECT_NEAR(found.scores.values.at("objective"), sum / 4, 1e-8);
}

TEST(Resegment, KeepsLabelsOfLostFramesAndOfNone) {
  Context context;
  Utterance u = utterance(truth, 96);
  u.visual.lost = {3};
  const FrameLabels given = labels_of("aaaabbbccaaa");
  EXPECT_EQ(Resegment{}(model(), given, u.audio, &u.visual, context).labels.labels, given.labels);
  EXPECT_TRUE(
      Resegment{}(model(), {}, Track{Eigen::MatrixXd(0, 4), 25, 0, {}}, nullptr, context).labels.labels.empty());
  EXPECT_EQ(str(Resegment{}(model(), labels_of("a"), utterance("a", 1).audio, nullptr, context).labels), "a");
}

TEST(Resegment, TakesTheCommonBeginningOfTwoFramesAndRefusesMore) {
  Context context;
  const Utterance u = utterance(truth, 95);
  EXPECT_EQ(str(Resegment{}(model(), labels_of(truth + "aq"), u.audio, &u.visual, context).labels), truth + "aq");
  EXPECT_THROW(Resegment{}(model(), labels_of(truth + "aaa"), u.audio, &u.visual, context), std::runtime_error);
  EXPECT_THROW(Resegment{}(Ssgpdm{}, u.labels, u.audio, &u.visual, context), std::runtime_error);
  EXPECT_THROW(Resegment{}(model(), u.labels, u.visual, &u.visual, context), std::runtime_error);
  Utterance nan = u;
  nan.audio.values(2, 1) = NAN;
  EXPECT_THROW(Resegment{}(model(), nan.labels, nan.audio, nullptr, context), std::runtime_error);
}

TEST(Resegment, AnswersPhonesWithoutAState) {
  Context context;
  const Utterance u = utterance(truth, 94);
  const auto out = Resegment{}(model(), labels_of("aaabbbbqqaaa"), u.audio, nullptr, context);
  EXPECT_EQ(out.labels.labels.size(), 12u);
  EXPECT_TRUE(std::isfinite(out.scores.values.at("objective")));
}

}  // namespace
}  // namespace talkgraph
