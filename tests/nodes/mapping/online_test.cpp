#include <gtest/gtest.h>

#include "nodes/context/decode.h"
#include "nodes/context/segment_online.h"
#include "nodes/context/train.h"
#include "nodes/context/windows.h"
#include "nodes/latent/sgpdm.h"
#include "nodes/mapping/ssgpdm.h"
#include "nodes/mapping/ssgpdm_synthesise.h"
#include "nodes/phones/mark_pauses.h"
#include "nodes/smooth/lowpass_online.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

struct Speech {
  FrameLabels labels;
  Track audio, visual;
};

/// Silence, random phones a few frames each, with a pause among them, silence.
Speech speech(std::uint64_t seed, int frames = 60) {
  Random random(seed);
  Speech s;
  s.audio.values = 0.3 * gaussian(frames, 4, seed);
  s.visual.values = 0.1 * gaussian(frames, 3, seed + 1000);
  std::string phone = "sil";
  for (int t = 0; t < frames; ++t) {
    if (t >= 5 && random.uniform() < 0.4) phone = random.below(8) == 0 ? "sil" : std::string(1, "abc"[random.below(3)]);
    if (t > frames - 8) phone = "sil";
    s.labels.labels.push_back(phone);
    const auto place = static_cast<unsigned char>(phone[0]);
    s.audio.values.row(t) += gaussian(1, 4, place);
    s.visual.values.row(t) += gaussian(1, 3, place + 500);
  }
  return s;
}

struct Learnt {
  Vlmm contexts;
  Ssgpdm states;
};
const Learnt& learnt() {
  static const Learnt all = [] {
    Collected<FrameLabels> labels;
    Collected<Track> audio, visual;
    for (std::uint64_t i = 0; i < 8; ++i) {
      const Speech s = speech(i);
      labels.add(std::to_string(i), MarkPauses{}(s.labels));
      audio.add(std::to_string(i), s.audio);
      visual.add(std::to_string(i), s.visual);
    }
    Learnt l{ContextTrain{.order = 3, .prune = 0}(labels), {}};
    auto windows = ContextWindows{}(l.contexts, labels, audio, visual);
    Context context;
    TrainSgpdm train;
    train.latent_dimension = 2;
    train.iterations = 5;
    Collected<Sgpdm> states;
    while (auto state = windows.next()) states.add(state->key, train(state->value, context));
    l.states = AssembleSsgpdm{}(states);
    return l;
  }();
  return all;
}

constexpr int delay = 1;

Eigen::MatrixXd as_it_comes(const Speech& s, double lookahead) {
  const FrameLabels marked = MarkPauses{0.12}(s.labels);
  const auto cut =
      ContextSegmentOnline{.lookahead = lookahead}(learnt().contexts, ContextDecode{}(learnt().contexts, marked));
  Context context;
  const Track face = SynthesiseSsgpdm{}(learnt().states, s.audio, cut.segments, context).visual;
  return LowpassOnline{5, delay}(face, &cut.latency).track.values;
}

/// The first frames of one, then frames of the other.
Speech joined(const Speech& first, const Speech& other, Eigen::Index frames) {
  Speech s = other;
  std::copy_n(first.labels.labels.begin(), frames, s.labels.labels.begin());
  s.audio.values.topRows(frames) = first.audio.values.topRows(frames);
  return s;
}

class Online : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(LookAheads, Online, ::testing::Values(0, 40, 100, 200, 400));

TEST_P(Online, AnswersDependOnNothingBeyondTheLookAheadAndTheDelay) {
  const Speech s = speech(100);
  const auto ahead = static_cast<Eigen::Index>(GetParam() / 40) + delay;
  const Eigen::MatrixXd answer = as_it_comes(s, GetParam());
  for (std::uint64_t future = 0; future < 12; ++future) {
    const auto t = static_cast<Eigen::Index>(4 * future);
    const Speech other = joined(s, speech(200 + future, future % 2 ? 60 : 63), t + ahead + 1);
    EXPECT_EQ(as_it_comes(other, GetParam()).topRows(t + 1), answer.topRows(t + 1)) << t;
  }
}

TEST_P(Online, FollowsTheFace) {
  const Speech s = speech(101);
  const auto answer = as_it_comes(s, GetParam());
  const Eigen::MatrixXd centred = s.visual.values.rowwise() - s.visual.values.colwise().mean();
  EXPECT_LT((answer - s.visual.values).squaredNorm(), 0.6 * centred.squaredNorm());
}

TEST(OfflineSegments, KnowTheFuture) {
  const Speech s = speech(100);
  const auto offline = [&](const Speech& given) {
    const auto contexts = ContextDecode{}(learnt().contexts, MarkPauses{}(given.labels));
    Context context;
    return SynthesiseSsgpdm{}(learnt().states, given.audio, ContextSegment{}(learnt().contexts, contexts), context)
        .visual.values;
  };
  const Eigen::MatrixXd answer = offline(s);
  bool same = true;
  for (std::uint64_t future = 0; future < 12; ++future)
    same = same && offline(joined(s, speech(200 + future), 31)).topRows(30) == answer.topRows(30);
  EXPECT_FALSE(same) << "else the test above says nothing";
}

}  // namespace
}  // namespace talkgraph
