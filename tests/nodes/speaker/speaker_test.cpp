#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>

#include "graph/graph.h"
#include "graph/registry.h"
#include "nodes/speaker/articulation.h"
#include "nodes/speaker/builtin.h"
#include "nodes/speaker/face.h"
#include "nodes/speaker/head_motion.h"
#include "nodes/speaker/register.h"
#include "nodes/speaker/renderer.h"
#include "nodes/speaker/sentences.h"

namespace talkgraph {
namespace {

using face::Moment;

constexpr int upper_inner = 62, lower_inner = 66, left_corner = 48, right_corner = 54;

double opening(const Shape& s) { return (s.row(lower_inner) - s.row(upper_inner)).norm(); }
double mouth_width(const Shape& s) { return (s.row(right_corner) - s.row(left_corner)).norm(); }

Shape shape_of(const Articulators& a, const HeadMotion& head = {}) {
  return face::picture_landmarks(face::landmarks(), {a, head}, 288);
}

/// One phone for 0.3 s between silences, in its middle.
Articulators middle_of(const std::string& phone) {
  const PhoneTrack track{{{"sil", 0, 0.4}, {phone, 0.4, 0.7}, {"sil", 0.7, 1.1}}};
  return articulate(track, Rational(20), 22, {})[10];
}

const face::Renderer& renderer() {
  static const face::Renderer one(288, 1);
  return one;
}

double mean_grey(const cv::Mat& picture, const Eigen::RowVector2d& at, int radius) {
  const cv::Rect box(static_cast<int>(std::lround(at.x())) - radius, static_cast<int>(std::lround(at.y())) - radius,
                     2 * radius + 1, 2 * radius + 1);
  const auto mean = cv::mean(picture(box));
  return (mean[0] + mean[1] + mean[2]) / 3;
}

TEST(Articulation, LipsCloseOnBilabials) {
  for (const auto* phone : {"p", "b", "m"}) EXPECT_LT(opening(shape_of(middle_of(phone))), 0.05) << phone;
}

TEST(Articulation, OpenVowelsOpenAndRoundedVowelsNarrowTheMouth) {
  const auto aa = shape_of(middle_of("aa")), iy = shape_of(middle_of("iy")), uw = shape_of(middle_of("uw"));
  EXPECT_GT(opening(aa), 10);
  EXPECT_GT(opening(aa), 2 * opening(iy));
  EXPECT_GT(mouth_width(iy), 1.3 * mouth_width(uw));
}

TEST(Articulation, LipMeetsTeethOnFAndTheTongueShowsOnTh) {
  EXPECT_EQ(middle_of("f").bite, 1);
  EXPECT_LT(opening(shape_of(middle_of("f"))), 3);
  EXPECT_EQ(middle_of("th").tongue_out, 1);
  EXPECT_EQ(middle_of("aa").tongue_out, 0);
}

TEST(Articulation, RoundingIsAnticipated) {
  const auto before = [](const std::string& vowel) {
    const PhoneTrack track{{{"sil", 0, 0.5}, {"t", 0.5, 0.6}, {vowel, 0.6, 0.9}, {"sil", 0.9, 1.2}}};
    return articulate(track, Rational(50), 60, {})[27].protrusion;
  };
  EXPECT_GT(before("uw"), before("iy") + 0.15);
}

TEST(Articulation, EffortOpensTheMouthButNotOnBilabials) {
  const PhoneTrack track{{{"sil", 0, 0.3}, {"aa", 0.3, 0.6}, {"m", 0.6, 0.8}, {"sil", 0.8, 1}}};
  const auto soft = articulate(track, Rational(25), 25, {0.8}), loud = articulate(track, Rational(25), 25, {1.2});
  EXPECT_GT(opening(shape_of(loud[11])), opening(shape_of(soft[11])) + 2);
  EXPECT_EQ(loud[17].closure, 1);
}

TEST(Articulation, UnknownPhoneIsAnError) {
  EXPECT_THROW(articulate({{{"qq", 0, 1}}}, Rational(25), 25, {}), std::runtime_error);
}

TEST(Articulation, NoPhonesIsAMouthAtRest) {
  const auto still = articulate({}, Rational(25), 3, {});
  ASSERT_EQ(still.size(), 3u);
  for (const auto& a : still) {
    EXPECT_EQ(a.jaw, 0);
    EXPECT_EQ(a.closure, 0);
  }
  EXPECT_TRUE(articulate({}, Rational(25), 0, {}).empty());
}

TEST(HeadMotion, BlinksWhateverIsSaid) {
  Random a(1), b(1), c(2);
  const auto one = head_motion(500, Rational(25), a), same = head_motion(500, Rational(25), b);
  const auto other = head_motion(500, Rational(25), c);
  int blinks = 0;
  double difference = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].blink, same[i].blink);
    EXPECT_LT(std::abs(one[i].dx), 8);
    EXPECT_LT(std::abs(one[i].roll), 0.06);
    blinks += one[i].blink > 0.9 && (i == 0 || one[i - 1].blink <= 0.9);
    difference += std::abs(one[i].dx - other[i].dx);
  }
  EXPECT_GE(blinks, 3);
  EXPECT_LE(blinks, 12);
  EXPECT_GT(difference, 1);
}

TEST(Face, LidsDoNotMoveLipsNorLipsLids) {
  HeadMotion shut;
  shut.blink = 1;
  const Articulators open = middle_of("aa");
  const auto rest = shape_of({}), blink = shape_of({}, shut), speech = shape_of(open);
  EXPECT_EQ(blink.bottomRows(20), rest.bottomRows(20));
  EXPECT_LT((speech.middleRows(36, 12) - rest.middleRows(36, 12)).cwiseAbs().maxCoeff(), 0.1);
  EXPECT_GT(rest(40, 1) - rest(38, 1), 6);
  EXPECT_NEAR(blink(41, 1), blink(37, 1), 0.05);
}

TEST(Face, LandmarksAreMirroredAtRestAndScaleWithThePicture) {
  const auto rest = shape_of({});
  ASSERT_EQ(rest.rows(), 68);
  EXPECT_NEAR(rest(0, 0) + rest(16, 0), 2 * rest(8, 0), 0.1);
  EXPECT_NEAR(rest(36, 0) + rest(45, 0), 2 * rest(8, 0), 0.1);
  EXPECT_NEAR(rest(48, 1), rest(54, 1), 0.05);
  const auto large = face::picture_landmarks(face::landmarks(), {}, 576);
  EXPECT_LT(((large.array() + 0.5) / 2 - (rest.array() + 0.5)).abs().maxCoeff(), 0.03);
}

TEST(Face, InnerMouthIsDarkLipsAreRedAndLidsHideTheEyes) {
  Moment open{middle_of("aa"), {}}, shut{{}, {}};
  shut.head.blink = 1;
  const auto a = renderer().draw(open, 0), b = renderer().draw(shut, 0), c = renderer().draw({}, 0);
  ASSERT_EQ(a.size(), cv::Size(360, 288));
  const auto s = face::picture_landmarks(face::landmarks(), open, 288);
  const Eigen::RowVector2d inside = 0.35 * s.row(upper_inner) + 0.65 * s.row(lower_inner);
  EXPECT_LT(mean_grey(a, inside, 2), 0.6 * mean_grey(a, s.row(30), 2));
  const Eigen::RowVector2d lip = 0.5 * (s.row(lower_inner) + s.row(57));
  const auto pixel = a.at<cv::Vec3b>(static_cast<int>(std::lround(lip.y())), static_cast<int>(std::lround(lip.x())));
  EXPECT_GT(pixel[2], 1.3 * pixel[1]);
  const auto t = face::picture_landmarks(face::landmarks(), {}, 288);
  const Eigen::RowVector2d pupil = 0.25 * (t.row(37) + t.row(38) + t.row(40) + t.row(41));
  EXPECT_GT(mean_grey(b, pupil, 2), mean_grey(c, pupil, 2) + 20);
}

TEST(Face, HeadMotionCarriesThePictureAlong) {
  Moment moved;
  moved.head.dx = 6;
  const auto a = renderer().draw({}, 0), b = renderer().draw(moved, 0);
  const cv::Rect face_box(140, 90, 80, 110);
  const double shifted = cv::norm(a(face_box), b(face_box + cv::Point(6, 0)), cv::NORM_L1);
  EXPECT_LT(shifted, 0.5 * cv::norm(a(face_box), b(face_box), cv::NORM_L1));
}

TEST(Face, EveryHeightOfPictureIsDrawn) {
  const face::Renderer large(400, 2);
  EXPECT_EQ(large.draw({middle_of("th"), {}}, 99).size(), cv::Size(500, 400));
}

TEST(Sentences, AreManyAndDistinct) {
  std::set<std::string_view> all;
  for (std::size_t i = 0; i < speaker_sentence_count(); ++i) all.insert(speaker_sentence(i));
  EXPECT_EQ(all.size(), speaker_sentence_count());
  EXPECT_GE(all.size(), 300u);
}

TEST(BuiltinSpeaker, ImpossibleNumbersAreRefusedWhenAGraphIsChecked) {
  Registry registry;
  register_speaker(registry);
  const auto complaints = [&](const std::string& params) {
    Diagnostics diagnostics;
    const std::string graph =
        R"({"nodes": {"r": {"type": "speaker.builtin", "params": )" + params + R"(}}, "outputs": {"r": "r"}})";
    load_graph_text("g.json", graph, registry, diagnostics);
    return diagnostics.str();
  };
  EXPECT_EQ(complaints(R"({"sentences": 5, "held_out": 2, "validation": 2})"), "");
  EXPECT_THAT(complaints(R"({"sentences": 5, "held_out": 5})"),
              testing::HasSubstr("g.json:1:55: error: node \"r\": 5 held out and"));
  EXPECT_THAT(complaints(R"({"height": 301})"), testing::HasSubstr("height must be even, got 301"));
  EXPECT_THAT(complaints(R"({"sentences": "x", "held_out": 50})"), testing::Not(testing::HasSubstr("held out")));
}

TEST(BuiltinSpeaker, ImpossibleNumbersAreRefused) {
  BuiltinSpeaker node;
  node.sentences = 10;
  EXPECT_THROW(node(), std::invalid_argument);
  node.held_out = 0;
  EXPECT_NO_THROW(node());
  node.sentences = 100000;
  EXPECT_THROW(node(), std::invalid_argument);
  node.sentences = 10;
  node.height = 289;
  EXPECT_THROW(node(), std::invalid_argument);
}

#ifdef TALKGRAPH_ESPEAK

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const Eigen::Map<const Eigen::ArrayXd> x(a.data(), static_cast<Eigen::Index>(a.size()));
  const Eigen::Map<const Eigen::ArrayXd> y(b.data(), static_cast<Eigen::Index>(b.size()));
  const Eigen::ArrayXd u = x - x.mean(), v = y - y.mean();
  return (u * v).sum() / std::sqrt(u.square().sum() * v.square().sum());
}

std::vector<Item<Recording>> all_of(const BuiltinSpeaker& node) {
  std::vector<Item<Recording>> all;
  auto stream = node();
  while (auto item = stream.next()) all.push_back(std::move(*item));
  return all;
}

BuiltinSpeaker few(std::int64_t sentences, std::int64_t seed = 1) {
  BuiltinSpeaker node;
  node.sentences = sentences;
  node.held_out = 1;
  node.seed = seed;
  return node;
}

TEST(BuiltinSpeaker, SplitsKeysAndParts) {
  auto node = few(6);
  node.held_out = 2;
  node.validation = 1;
  const auto all = all_of(node);
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[0].key, "s001");
  EXPECT_EQ(all[2].value.split, "train");
  EXPECT_EQ(all[3].value.split, "validation");
  EXPECT_EQ(all[4].value.split, "test");
  const auto& r = all[5].value;
  EXPECT_EQ(r.split, "test");
  EXPECT_EQ(r.id, "s006");
  EXPECT_TRUE(r.transcript && r.words && r.phones && r.landmarks);
  EXPECT_EQ(r.landmarks->scheme, "ibug68");
}

TEST(BuiltinSpeaker, TellsWhatMovedTheFace) {
  const auto all = all_of(few(2));
  const auto& r = all[0].value;
  ASSERT_TRUE(r.visual);
  EXPECT_EQ(r.visual->frames(), r.video().source->frames());
  EXPECT_EQ(std::ssize(r.visual->names), r.visual->dimension());
  std::vector<double> jaw, open;
  for (Eigen::Index t = 0; t < r.visual->frames(); ++t) {
    jaw.push_back(r.visual->values(t, 0));
    open.push_back(opening(r.landmarks->frames[static_cast<std::size_t>(t)]));
  }
  EXPECT_GT(correlation(jaw, open), 0.8);
}

TEST(BuiltinSpeaker, IsMarkedInEveryScheme) {
  auto node = few(2);
  const auto usual = *all_of(node)[0].value.landmarks;
  node.points = SpeakerPoints::face56;
  const auto lips = *all_of(node)[0].value.landmarks;
  node.points = SpeakerPoints::ibug69;
  const auto demnow = *all_of(node)[0].value.landmarks;
  EXPECT_EQ(lips.scheme, "face56");
  EXPECT_EQ(demnow.scheme, "ibug69");
  for (std::size_t t = 0; t < usual.frames.size(); ++t) {
    ASSERT_EQ(lips.frames[t].rows(), 56);
    EXPECT_EQ(lips.frames[t].topRows(36), usual.frames[t].topRows(36));
    EXPECT_EQ(lips.frames[t].bottomRows(20), usual.frames[t].bottomRows(20));
    ASSERT_EQ(demnow.frames[t].rows(), 69);
    EXPECT_EQ(demnow.frames[t].topRows(68), usual.frames[t]);
    EXPECT_LT(demnow.frames[t](68, 1), demnow.frames[t].topRows(68).col(1).minCoeff() - 5);
  }
}

TEST(BuiltinSpeaker, SoundPicturesAndLabelsAreEquallyLong) {
  auto node = few(2);
  node.fps = Rational(30000, 1001);
  node.sample_rate = 16000;
  for (const auto& item : all_of(node)) {
    const auto audio = item.value.audio();
    const auto video = item.value.video();
    const double seconds = static_cast<double>(video.source->frames()) / node.fps.value();
    EXPECT_EQ(audio.rate, 16000);
    EXPECT_NEAR(audio.seconds(), seconds, 1e-4);
    EXPECT_DOUBLE_EQ(item.value.phones->phones.front().start, 0);
    EXPECT_DOUBLE_EQ(item.value.phones->phones.back().end, seconds);
    EXPECT_DOUBLE_EQ(item.value.words->words.back().end, seconds);
    EXPECT_EQ(static_cast<std::int64_t>(item.value.landmarks->frames.size()), video.source->frames());
    EXPECT_LE(audio.samples.cwiseAbs().maxCoeff(), 1);
    EXPECT_GT(audio.samples.cwiseAbs().maxCoeff(), 0.1);
  }
}

TEST(BuiltinSpeaker, TheSameSeedIsTheSameSpeakerAnotherIsNot) {
  const auto a = all_of(few(3)), b = all_of(few(3)), c = all_of(few(3, 2));
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto &x = a[i].value, &y = b[i].value;
    EXPECT_EQ(x.landmarks->frames, y.landmarks->frames);
    EXPECT_EQ(x.video().source->key(), y.video().source->key());
    EXPECT_NE(x.video().source->key(), c[i].value.video().source->key());
    EXPECT_LE((x.audio().samples - y.audio().samples).cwiseAbs().maxCoeff(), 1.0 / 32768);
  }
}

TEST(BuiltinSpeaker, LandmarksStandOn64thsOfAPixel) {
  const auto shape = all_of(few(2))[0].value.landmarks->frames[10];
  EXPECT_EQ((shape * 64).array().round().matrix(), shape * 64);
}

TEST(BuiltinSpeaker, LipsAreClosedWithinBilabials) {
  int frames = 0;
  for (const auto& item : all_of(few(20))) {
    const auto& track = *item.value.landmarks;
    for (const auto& p : item.value.phones->phones) {
      if ((p.label != "p" && p.label != "b" && p.label != "m") || p.end - p.start < 0.05) continue;
      for (std::size_t n = 0; n < track.frames.size(); ++n) {
        const double t = (static_cast<double>(n) + 0.5) / 25;
        if (t < p.start || t > p.start + 0.8 * (p.end - p.start)) continue;
        EXPECT_LT(opening(track.frames[n]), 1) << item.key << " " << p.label << " at " << t;
        ++frames;
      }
    }
  }
  EXPECT_GT(frames, 30);
}

TEST(BuiltinSpeaker, TheMouthOpensWithTheSound) {
  std::vector<double> loud, open;
  for (const auto& item : all_of(few(8))) {
    const auto audio = item.value.audio();
    const auto& track = *item.value.landmarks;
    for (std::size_t n = 0; n < track.frames.size(); ++n) {
      const auto from = static_cast<Eigen::Index>(static_cast<double>(n) / 25 * audio.rate);
      const auto count =
          std::min<Eigen::Index>(static_cast<Eigen::Index>(audio.rate / 25), audio.samples.size() - from);
      loud.push_back(std::sqrt(audio.samples.segment(from, count).squaredNorm() / static_cast<double>(count)));
      open.push_back(opening(track.frames[n]));
    }
  }
  EXPECT_GT(correlation(loud, open), 0.5);
}

TEST(BuiltinSpeaker, VideoReadsTheSameWhoeverElseReads) {
  const auto video = all_of(few(2))[0].value.video();
  ASSERT_EQ(video.source->size(), cv::Size(360, 288));
  const auto alone = video.read_all();
  for (const std::size_t behind : {0, 1, 3, 9}) {
    auto one = video.source->open(), two = video.source->open();
    cv::Mat a, b;
    for (std::size_t t = 0; t < 20; ++t) {
      ASSERT_TRUE(one->next(a));
      EXPECT_EQ(cv::norm(a, alone[t], cv::NORM_INF), 0);
      a.setTo(0);
      if (t < behind) continue;
      ASSERT_TRUE(two->next(b));
      EXPECT_EQ(cv::norm(b, alone[t - behind], cv::NORM_INF), 0);
    }
  }
}

#endif

}  // namespace
}  // namespace talkgraph
