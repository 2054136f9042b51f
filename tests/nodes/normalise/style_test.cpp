#include "nodes/normalise/style.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nodes/evaluate/explained.h"
#include "nodes/face/geometry.h"
#include "nodes/face/pca.h"
#include "nodes/normalise/ica.h"
#include "nodes/speaker/face.h"
#include "nodes/speaker/renderer.h"

namespace talkgraph {
namespace {

/// The built-in speaker's face saying phones drawn at random, as shape parameters, with all that moved it.
struct Speaker {
  Collected<Track> shapes, articulators, head, sound;
  Collected<FaceTrack> faces;
};

PhoneTrack babble(double seconds, Random& random) {
  static const std::vector<std::string> phones = {"aa", "iy", "uw", "ae", "ow", "p", "m",  "f", "th", "t",
                                                  "s",  "sh", "l",  "r",  "w",  "k", "eh", "d", "n",  "ih"};
  PhoneTrack track;
  for (double t = 0; t < seconds;) {
    const double end = t + random.uniform(0.05, 0.18);
    track.phones.push_back({phones[random.below(phones.size())], t, end});
    t = end;
  }
  return track;
}

/// What a recogniser of phones would hear: the phones around each frame, one number each, with noise.
Eigen::MatrixXd heard(const PhoneTrack& phones, std::int64_t frames, Random& random) {
  std::map<std::string, Eigen::Index> column;
  for (const char* p :
       {"aa", "iy", "uw", "ae", "ow", "p", "m", "f", "th", "t", "s", "sh", "l", "r", "w", "k", "eh", "d", "n", "ih"})
    column.emplace(p, std::ssize(column));
  Eigen::MatrixXd out(frames, std::ssize(column));
  for (double& v : out.reshaped()) v = 0.1 * random.normal();
  for (std::int64_t n = 0; n < frames; ++n)
    for (const auto& p : phones.phones)
      if (p.start <= (double(n) + 0.5) / 25 && (double(n) + 0.5) / 25 < p.end) out(n, column.at(p.label)) += 1;
  return out;
}

Track track(Eigen::MatrixXd values, std::vector<std::string> names = {}) {
  return {std::move(values), Rational(25), 0.02, std::move(names)};
}

Speaker speaker(int clips) {
  constexpr std::int64_t frames = 150;
  const auto points = face::landmarks();
  Random random(5);
  Speaker out;
  std::vector<Shape> marks;
  for (int clip = 0; clip < clips; ++clip) {
    const auto key = std::to_string(clip);
    const auto phones = babble(6, random);
    const auto mouth = articulate(phones, Rational(25), frames, {});
    const auto head = head_motion(frames, Rational(25), random);
    Eigen::MatrixXd a(frames, 3), h(frames, 4);
    for (std::int64_t n = 0; n < frames; ++n) {
      const auto& m = mouth[std::size_t(n)];
      const auto& g = head[std::size_t(n)];
      a.row(n) << m.jaw, m.width, m.protrusion;
      h.row(n) << g.yaw, g.pitch, g.blink, g.brow;
      marks.push_back(face::picture_landmarks(points, {m, g}, 288));
    }
    out.articulators.add(key, track(a, {"jaw", "width", "protrusion"}));
    out.head.add(key, track(h, {"yaw", "pitch", "blink", "brow"}));
    out.sound.add(key, track(heard(phones, frames, random)));
  }
  const auto aligned = procrustes(marks, 120);
  Eigen::MatrixXd columns(2 * marks[0].rows(), std::ssize(marks));
  for (Eigen::Index i = 0; i < columns.cols(); ++i) columns.col(i) = flatten(aligned.shapes[std::size_t(i)]);
  const auto modes = pca(columns, 0.999);
  const Eigen::MatrixXd b = (columns.colwise() - modes.mean).transpose() * modes.modes;
  for (int clip = 0; clip < clips; ++clip) {
    out.shapes.add(std::to_string(clip), track(b.middleRows(clip * frames, frames)));
    FaceTrack face;
    const auto from = aligned.poses.begin() + clip * frames;
    face.poses.assign(from, from + frames);
    out.faces.add(std::to_string(clip), face);
  }
  return out;
}

Eigen::RowVectorXd share(const Collected<Track>& truth, const Collected<Track>& by) {
  const auto rows = paired_rows(truth, by);
  return explained_share(rows.truth, rows.by, 5, 1e-9);
}

TEST(Style, IcaRemovesTheBuiltInSpeakersHeadMotionAndLeavesTheSpeech) {
  const auto s = speaker(20);
  Random random(1);
  Context context;
  const auto components = LearnIca{}(s.shapes, random, context).components;
  const auto ranking = RankStyle{}(components, s.shapes, s.sound, s.faces);
  Collected<Track> speech;
  for (std::size_t i = 0; i < s.shapes.size(); ++i)
    speech.add(s.shapes.key(i), RemoveStyle{}(components, s.shapes[i], &ranking).normalised);

  const auto head_before = share(s.head, s.shapes), head_after = share(s.head, speech);
  const auto mouth_before = share(s.articulators, s.shapes), mouth_after = share(s.articulators, speech);
  SCOPED_TRACE((std::stringstream() << "head " << head_before << " -> " << head_after << "\nmouth " << mouth_before
                                    << " -> " << mouth_after)
                   .str());
  EXPECT_GT(head_before.minCoeff(), 0.99);
  EXPECT_LT(head_after.maxCoeff(), 0.05);
  EXPECT_GT(mouth_before.minCoeff(), 0.95);
  EXPECT_GT((mouth_after - mouth_before).minCoeff(), -0.05);
}

TEST(RankStyle, PutsFirstWhatTheSoundDoesNotExplain) {
  Random random(2);
  Eigen::MatrixXd sound(3000, 2), u(3000, 3);
  for (Eigen::Index t = 0; t < 3000; ++t) {
    sound.row(t) << random.normal(), random.normal();
    u.row(t) << std::sin(0.01 * double(t)), sound(t, 0), 0.6 * sound(t, 1) + 0.8 * random.normal();
  }
  IndependentComponents c{Eigen::RowVectorXd::Zero(3), Eigen::Vector3d(3, 2, 1).asDiagonal(),
                          Eigen::Vector3d(1 / 3.0, 0.5, 1).asDiagonal()};
  const Collected<Track> tracks{{"a", track(u * c.mixing.transpose())}}, heard{{"a", track(sound)}};
  const auto by_sound = RankStyle{}(c, tracks, heard, {});
  EXPECT_EQ(by_sound.rows, (std::vector<std::string>{"1", "3", "2"}));
  EXPECT_NEAR(by_sound.cells[0][0], 1, 1e-3);
  EXPECT_NEAR(by_sound.cells[0][1], 9.0 / 14, 1e-12);
  EXPECT_NEAR(by_sound.cells[1][2], 0.36, 0.05);
  EXPECT_NEAR(by_sound.cells[2][2], 1, 0.02);
  EXPECT_TRUE(std::isnan(by_sound.cells[0][4]));
  RankStyle speed;
  speed.by = StyleSign::speed;
  EXPECT_EQ(speed(c, tracks, heard, {}).rows[0], "1");
  FaceTrack face;
  for (Eigen::Index t = 0; t < 3000; ++t) face.poses.push_back({1, 0, 5 * u(t, 2), 0});
  RankStyle pose;
  pose.by = StyleSign::pose;
  const auto by_pose = pose(c, tracks, heard, {{"a", face}});
  EXPECT_EQ(by_pose.rows[0], "3");
  EXPECT_NEAR(by_pose.cells[0][4], 1, 0.02);
  EXPECT_THROW(pose(c, tracks, heard, {}), std::runtime_error);
  EXPECT_THROW(RankStyle{}(c, tracks, {{"b", track(sound)}}, {}), std::runtime_error);
  Eigen::MatrixXd noise(3000, 2);
  for (double& v : noise.reshaped()) v = random.normal();
  EXPECT_THROW(RankStyle{}(c, tracks, {{"a", track(noise)}}, {}), std::runtime_error) << "all would be style";
  EXPECT_EQ(speed(c, tracks, {{"a", track(noise)}}, {}).rows[0], "1");
}

TEST(RemoveStyle, LeavesSomeSpeech) {
  const IndependentComponents c{Eigen::RowVectorXd::Zero(2), Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Identity()};
  const Track t = track((Eigen::MatrixXd(2, 2) << 1, 2, 3, 4).finished());
  const Table all{"", "component", {"style"}, {"2", "1"}, {{1}, {0.95}}},
      one{"", "component", {"style"}, {"2", "1"}, {{1}, {0.5}}};
  EXPECT_EQ(RemoveStyle{}(c, t, &one).normalised.values, (Eigen::MatrixXd(2, 2) << 1, 0, 3, 0).finished());
  EXPECT_THROW(RemoveStyle{}(c, t, &all), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
