#include "nodes/evaluate/lip_reading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "nodes/evaluate/lip_reader.h"
#include "tests/nodes/types/changed_members.h"

namespace talkgraph {
namespace {

const std::vector<std::string> kPhones = {"aa", "b", "f", "iy", "sil"};

/// What is said, and a face that shows it: a phone of its own corner, which it nears as it goes on, under noise.
struct Said {
  Track track;
  FrameLabels labels;
};
Said speak(std::uint64_t seed, double noise, int phones = 20) {
  Random random(seed);
  Said said;
  std::vector<Eigen::RowVector3d> rows;
  std::string before;
  for (int p = 0; p < phones; ++p) {
    const std::size_t phone = p == 0 ? 4 : random.below(5);
    if (kPhones[phone] == before) continue;
    before = kPhones[phone];
    const auto length = 2 + random.below(4);
    for (std::uint64_t t = 0; t < length; ++t) {
      said.labels.labels.push_back(before);
      Eigen::RowVector3d frame = Eigen::RowVector3d::Zero();
      frame(static_cast<Eigen::Index>(phone) % 3) = phone < 3 ? 1 : -1;
      frame *= 0.5 + 0.5 * static_cast<double>(t) / static_cast<double>(length - 1);
      for (double& x : frame) x += noise * random.normal();
      rows.push_back(frame);
    }
  }
  said.track.values.resize(std::ssize(rows), 3);
  for (std::size_t t = 0; t < rows.size(); ++t) said.track.values.row(static_cast<Eigen::Index>(t)) = rows[t];
  return said;
}

LipReader train(const TrainLipReader& node = {}, double noise = 0.1) {
  Collected<Track> tracks;
  Collected<FrameLabels> labels;
  for (std::uint64_t s = 0; s < 30; ++s) {
    Said said = speak(s, noise);
    if (s == 0) said.track.lost = {3, 4, 5};
    for (const auto t : said.track.lost) said.track.values.row(t).setConstant(100);
    tracks.add(std::to_string(s), said.track);
    labels.add(std::to_string(s), said.labels);
  }
  Random random(1);
  Context context;
  return node(tracks, labels, random, context);
}

TEST(TrainLipReader, ReadsFacesOfTheKindItSaw) {
  const LipReader reader = train();
  EXPECT_EQ(reader.units, kPhones);
  for (std::uint64_t s = 100; s < 105; ++s) {
    const Said said = speak(s, 0.1);
    EXPECT_GE(ScoreLipReading{}(reader, said.track, said.labels)->values.at("phone_accuracy"), 0.9);
    Said still = said;
    still.track.values.setZero();
    EXPECT_LE(ScoreLipReading{}(reader, still.track, still.labels)->values.at("phone_accuracy"), 0.5);
  }
}

TEST(TrainLipReader, MakesALeftToRightNetworkOfProbabilities) {
  const LipReader reader = train({.states = 2});
  const Hmm& network = reader.network;
  ASSERT_EQ(network.states(), 10);
  EXPECT_NEAR(network.start.sum(), 1, 1e-12);
  for (Eigen::Index i = 0; i < 10; ++i) {
    EXPECT_NEAR(network.transitions.row(i).sum(), 1, 1e-12) << i;
    EXPECT_EQ(reader.unit_of[static_cast<std::size_t>(i)], i / 2);
    EXPECT_EQ(network.transitions(i - i % 2 + 1, i - i % 2), 0) << "there is no way back";
  }
  // "aa" nears x = 1: its second state is farther on. Runs have 3.5 frames on average: 2.5 steps stay, one leaves.
  EXPECT_LT(network.observations[0].means(0, 0) + 0.1, network.observations[1].means(0, 0));
  for (std::size_t i = 1; i < network.trace.size(); ++i) EXPECT_GE(network.trace[i], network.trace[i - 1] - 1e-6);
  double entered = 0, left = 0;
  for (Eigen::Index j = 2; j < 10; ++j) left += network.transitions(1, j);
  for (Eigen::Index j = 2; j < 4; ++j) entered += network.transitions(1, j) / left;
  EXPECT_NEAR(entered, 0.25, 0.1) << "four phones may follow, all alike";
}

TEST(TrainLipReader, FindsTheParametersOfItsOwnModel) {
  // One state a phone, deviation 0.3 about its corner: all that is learnt has a closed form.
  Random random(7);
  Collected<Track> tracks;
  Collected<FrameLabels> labels;
  std::map<std::string, std::vector<double>> seen;
  double runs = 0, frames = 0;
  for (int s = 0; s < 10; ++s) {
    Track track;
    FrameLabels said;
    for (int run = 0; run < 20; ++run) {
      const std::string phone = run % 2 ? "b" : "aa";
      for (std::uint64_t t = 0, n = 1 + random.below(4); t < n; ++t) said.labels.push_back(phone);
    }
    track.values.resize(std::ssize(said.labels), 1);
    for (Eigen::Index t = 0; t < track.frames(); ++t) {
      const std::string& phone = said.labels[static_cast<std::size_t>(t)];
      track.values(t, 0) = (phone == "b" ? 1 : -1) + 0.3 * random.normal();
      seen[phone].push_back(track.values(t, 0));
      if (t > 0 && said.labels[static_cast<std::size_t>(t) - 1] == "b") {
        ++frames;
        runs += phone == "aa";
      }
    }
    tracks.add(std::to_string(s), track);
    labels.add(std::to_string(s), said);
  }
  Context context;
  const LipReader reader = TrainLipReader{.states = 1}(tracks, labels, random, context);
  const auto& b = seen["b"];
  const Eigen::Map<const Eigen::VectorXd> values(b.data(), std::ssize(b));
  const double mean = values.mean(), variance = (values.array() - mean).square().mean();
  EXPECT_NEAR(reader.network.observations[1].means(0, 0), mean, 1e-9);
  EXPECT_NEAR(reader.network.observations[1].covariances[0](0, 0), variance, 1e-9);
  EXPECT_NEAR(reader.network.transitions(1, 0), runs / frames, 1e-9);
  EXPECT_NEAR(reader.network.start(0), 11 / 12.0, 1e-9) << "ten begin with aa; each counts once more";
}

TEST(TrainLipReader, LearnsVisemesAndMixtures) {
  const LipReader reader = train({.units = LipUnits::visemes, .mixture = 2});
  EXPECT_EQ(reader.units, (std::vector<std::string>{"1", "10", "12", "2", "sil"}));
  EXPECT_EQ(reader.network.observations[0].components(), 2);
  const Said said = speak(200, 0.1);
  auto s = ScoreLipReading{.name = "viseme"}(reader, said.track, said.labels)->values;
  EXPECT_GE(s["viseme_correct"], 0.9);
  EXPECT_EQ(s.size(), 2U);
}

TEST(TrainLipReader, SaysWhereItCannotLearn) {
  Random random(1);
  Context context;
  const auto learn = [&](const Collected<Track>& tracks, const Collected<FrameLabels>& labels) {
    return TrainLipReader{}(tracks, labels, random, context);
  };
  const Said said = speak(1, 0.1);
  EXPECT_THROW(learn({}, {}), std::runtime_error);
  EXPECT_THROW(learn({{"a", said.track}}, {}), std::runtime_error) << "no labels";
  EXPECT_THROW(learn({{"a", said.track}}, {{"a", {{"sil"}, Rational(25)}}}), std::runtime_error) << "other lengths";
  FrameLabels odd = said.labels;
  odd.labels[2] = "hello";
  EXPECT_THROW(learn({{"a", said.track}}, {{"a", odd}}), std::runtime_error);
  Said broken = said;
  broken.track.values(1, 1) = NAN;
  EXPECT_THROW(learn({{"a", broken.track}}, {{"a", said.labels}}), std::runtime_error);
  const FrameLabels one{std::vector<std::string>(said.labels.labels.size(), "sil"), Rational(25)};
  EXPECT_EQ(learn({{"a", said.track}}, {{"a", one}}).units, std::vector<std::string>{"sil"});
}

/// Phones of one state at 0, 10, 20, 30 and pauses at −10, all ways alike.
LipReader plain_reader() {
  LipReader reader{{"aa", "b", "f", "iy", "sil"}, {0, 1, 2, 3, 4}, false, {}};
  reader.network.start = Eigen::VectorXd::Constant(5, 0.2);
  reader.network.transitions = Eigen::MatrixXd::Constant(5, 5, 0.2);
  for (const double at : {0.0, 10.0, 20.0, 30.0, -10.0})
    reader.network.observations.push_back(
        {Eigen::VectorXd::Ones(1), Eigen::MatrixXd::Constant(1, 1, at), {Eigen::MatrixXd::Ones(1, 1)}});
  return reader;
}

Track showing(const std::vector<double>& values) {
  Track track;
  track.values = Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
  return track;
}

std::pair<double, double> correct_and_accuracy(const std::vector<double>& face, const std::vector<std::string>& said) {
  auto s = ScoreLipReading{}(plain_reader(), showing(face), {said, Rational(25)})->values;
  return {s["phone_correct"], s["phone_accuracy"]};
}

TEST(ScoreLipReading, CountsLikeHtk) {
  using Both = std::pair<double, double>;
  const std::vector<std::string> said = {"sil", "aa", "aa", "b", "iy", "sil"};
  EXPECT_EQ(correct_and_accuracy({-10, 0, 0, 10, 30, -10}, said), Both(1, 1));
  EXPECT_EQ(correct_and_accuracy({-10, 0, 0, 0, 30, -10}, said), Both(2 / 3.0, 2 / 3.0)) << "b is missing";
  EXPECT_EQ(correct_and_accuracy({-10, 0, 0, 20, 30, -10}, said), Both(2 / 3.0, 2 / 3.0)) << "f for b";
  EXPECT_EQ(correct_and_accuracy({20, 0, 20, 10, 30, 20}, said), Both(1, 0)) << "three extra";
  EXPECT_EQ(correct_and_accuracy({-10, -10, -10, -10, -10, -10}, said), Both(0, 0));
  EXPECT_EQ(correct_and_accuracy({20, 0, 20, 0, 20, 0}, {"sil", "b", "b", "b", "b", "sil"}), Both(0, -5));
  EXPECT_FALSE(ScoreLipReading{}(plain_reader(), showing({1, 2}), {{"sil", "breath"}, Rational(25)}));
}

TEST(ReadLips, MayBeHeldBack) {
  const Track face = showing({0, 0, 6, 0, 0});
  EXPECT_EQ(read_lips(plain_reader(), face, 0), (std::vector<std::string>{"aa", "aa", "b", "aa", "aa"}));
  // b is 10 nats likelier there; reading it takes two units more.
  EXPECT_EQ(read_lips(plain_reader(), face, -5.1), std::vector<std::string>(5, "aa"));
}

TEST(ReadLips, LeavesLostFramesToTheirNeighbours) {
  Track face = showing({0, 0, 20, 0, 0});
  face.lost = {2};
  LipReader reader = plain_reader();
  reader.network.transitions.setConstant(0.1);
  reader.network.transitions.diagonal().setConstant(0.6);
  EXPECT_EQ(read_lips(reader, face, 0), std::vector<std::string>(5, "aa"));
  EXPECT_TRUE(read_lips(reader, showing({}), 0).empty());
}

TEST(ScoreLipReading, RefusesWhatDoesNotFit) {
  const FrameLabels said{{"aa", "b"}, Rational(25)};
  EXPECT_THROW(ScoreLipReading{}(plain_reader(), showing({0, 0, 0, 0, 0}), said), std::runtime_error);
  EXPECT_THROW(ScoreLipReading{}(plain_reader(), showing({0, NAN}), said), std::runtime_error);
  EXPECT_THROW(ScoreLipReading{}(plain_reader(), speak(1, 0).track, speak(1, 0).labels), std::runtime_error);
  EXPECT_THROW(ScoreLipReading{}(plain_reader(), showing({0, 1}), {{"aa", "x"}, Rational(25)}), std::runtime_error);
}

TEST(LipReader, IsRefusedIfItsMembersDoNotFit) {
  const Track face = showing({0, 10, 20});
  const auto refused = testing::refuses_or_answers<LipReader>(plain_reader(), [&](const LipReader& reader) {
    const auto units = read_lips(reader, face, 0);
    return Eigen::MatrixXd(Eigen::MatrixXd::Constant(1, 1, static_cast<double>(units.size())));
  });
  EXPECT_GT(refused, 10);
}

TEST(LipUnit, IsAPhoneOrItsViseme) {
  EXPECT_EQ(lip_unit("b", false), "b");
  EXPECT_EQ(lip_unit("b", true), "1");
  EXPECT_EQ(lip_unit("lead_sil", true), "sil");
  EXPECT_EQ(lip_unit("breath", false), "sil");
  EXPECT_THROW(lip_unit("hello", false), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
