#include "nodes/mapping/context_frames.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nodes/speech/place.h"
#include "tests/nodes/mapping/context_corpus.h"

namespace talkgraph {
namespace {

using testing::track;

const PhoneTrack phones{{{"b", 0.0, 0.05}, {"ih", 0.05, 0.12}, {"zh", 0.12, 0.2}}};

TEST(ContextFrames, PhoneSharesByHand) {
  const Eigen::MatrixXd shares = phone_shares(phones, {"b", "ih"}, track(Eigen::MatrixXd::Zero(4, 1)));
  Eigen::MatrixXd expected(4, 2);
  expected << 1, 0, 0.25, 0.75, 0, 1, 0, 0;
  EXPECT_LT((shares - expected).norm(), 1e-12);
}

TEST(ContextFrames, EndOfSpeechByHand) {
  const Track sound = track(Eigen::MatrixXd::Zero(4, 1));
  EXPECT_EQ(end_of_speech({{{"b", 0.0, 0.1}, {"sil", 0.1, 0.4}}}, sound), 0.1);
  EXPECT_EQ(end_of_speech({{{"sil", 0.0, 0.16}}}, sound), sound.time(4));
  EXPECT_EQ(end_of_speech({}, sound), sound.time(4));
}

TEST(ContextFrames, JoinPlacesIfTheyAreCompared) {
  ContextGp model;
  model.audio_mean = model.audio_scale = Eigen::RowVectorXd::Ones(1);
  model.place_time = 0.5;
  model.map = Eigen::MatrixXd::Identity(3, 3);
  const Track audio = track(Eigen::MatrixXd::Ones(4, 1));
  EXPECT_EQ(context_frames(model, audio, phones, 3).rightCols(2), places(audio, 0.2, 0.5).topRows(3));
}

TEST(ContextFrames, ByHand) {
  ContextGp model;
  model.audio_mean = Eigen::RowVector2d(1, 5);
  model.audio_scale = Eigen::RowVector2d(2, 0);
  model.phones = {"b", "ih"};
  model.map = Eigen::Vector4d(1, 1, 10, 100);
  Eigen::MatrixXd audio(3, 2);
  audio << 1, 7, 1.5, 7, 3, 7;
  const Eigen::MatrixXd frames = context_frames(model, track(audio), phones, 2);
  ASSERT_EQ(frames.rows(), 2);
  EXPECT_NEAR(frames(0, 0), 10, 1e-12);
  EXPECT_NEAR(frames(1, 0), 1 + 2.5 + 75, 1e-12);
}

}  // namespace
}  // namespace talkgraph
