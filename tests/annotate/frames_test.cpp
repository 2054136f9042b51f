#include "annotate/frames.h"

#include <set>

#include "tests/nodes/media/media_test.h"

namespace talkgraph::annotate {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

Clip clip(const std::string& id, int frames, std::optional<PhoneTrack> phones = {}) {
  return {id, [frames] { return test_video(frames, 25); }, std::move(phones)};
}

std::vector<std::pair<std::size_t, std::int64_t>> numbers(const std::vector<Frame>& frames) {
  std::vector<std::pair<std::size_t, std::int64_t>> all;
  for (const auto& frame : frames) all.emplace_back(frame.clip, frame.number);
  return all;
}

/// Each phone 0.2 s long.
PhoneTrack spoken(const std::vector<std::string>& labels) {
  PhoneTrack track;
  for (const auto& label : labels) {
    const double start = track.phones.empty() ? 0 : track.phones.back().end;
    track.phones.push_back({label, start, start + 0.2});
  }
  return track;
}

TEST(ChooseFrames, TakesEveryPhoneInItsMiddleTheMostFrequentFirst) {
  const std::vector<Clip> clips = {clip("a", 25, spoken({"sil", "b", "aa", "b", "sil"})),
                                   clip("b", 10, spoken({"sil", "aa"})), clip("c", 50)};
  const auto frames = choose_frames(clips, 4, 7);
  ASSERT_THAT(frames, SizeIs(4));
  EXPECT_EQ(frames[0].phone, "sil");
  EXPECT_EQ(frames[1].phone, "aa");
  EXPECT_EQ(frames[2].phone, "b");
  EXPECT_EQ(frames[3].phone, "sil");
  for (const auto& frame : frames) {
    ASSERT_LT(frame.clip, 2u) << "clip c has no phones";
    EXPECT_EQ(frame.number % 5, 2) << "phones take five frames";
    const auto& phones = clips[frame.clip].phones->phones;
    EXPECT_EQ(phones[static_cast<std::size_t>(frame.number / 5)].label, frame.phone);
  }
}

TEST(ChooseFrames, GivesTheSameAgainAndFewerAreTheFirstOfMore) {
  const std::vector<std::vector<Clip>> corpora = {
      {clip("a", 40), clip("b", 60)},
      {clip("a", 25, spoken({"sil", "b", "aa", "b", "sil"})), clip("b", 10, spoken({"m", "m"}))}};
  for (const auto& clips : corpora) {
    const auto all = numbers(choose_frames(clips, 6, 3));
    EXPECT_EQ(numbers(choose_frames(clips, 6, 3)), all);
    EXPECT_EQ(numbers(choose_frames(clips, 4, 3)), decltype(all)(all.begin(), all.begin() + 4));
    EXPECT_NE(numbers(choose_frames(clips, 6, 4)), all);
    EXPECT_EQ(std::set(all.begin(), all.end()).size(), 6u);
  }
}

TEST(ChooseFrames, LieEvenlyInTimeWithoutPhones) {
  for (const int count : {5, 8, 13, 20}) {
    auto frames = numbers(choose_frames({clip("a", 1000)}, count, 1));
    std::sort(frames.begin(), frames.end());
    std::int64_t widest = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) widest = std::max(widest, frames[i].second - frames[i - 1].second);
    EXPECT_LT(widest, 2.7 * 1000 / count) << count;
  }
}

TEST(ChooseFrames, FewerWhereThereAreNoMore) {
  EXPECT_THAT(choose_frames({}, 5, 1), IsEmpty());
  EXPECT_THAT(choose_frames({clip("a", 3)}, 0, 1), IsEmpty());
  EXPECT_THAT(choose_frames({clip("a", 3)}, 20, 1), SizeIs(3));
  EXPECT_THAT(choose_frames({clip("a", 8, spoken({"b", "aa"}))}, 20, 1), SizeIs(2));
  EXPECT_THAT(choose_frames({clip("a", 4, spoken({"b", "aa"}))}, 20, 1), SizeIs(1)) << "the video ends before aa";
}

/// A video whose decoder complained of a frame.
class Damaged final : public VideoSource {
 public:
  Rational rate() const override { return 25; }
  std::int64_t frames() const override { return 3; }
  cv::Size size() const override { return {4, 4}; }
  std::unique_ptr<Reader> open() const override { return nullptr; }
  std::string name() const override { return "damaged"; }
  Key key() const override { return {}; }
  std::vector<std::int64_t> decoding_errors() const override { return {1}; }
};

TEST(ChooseFrames, PassesOverDamagedOnes) {
  auto frames = numbers(choose_frames({{"a", [] { return Video{std::make_shared<Damaged>(), {}}; }, {}}}, 3, 1));
  std::sort(frames.begin(), frames.end());
  EXPECT_THAT(frames, ElementsAre(std::pair(0u, 0), std::pair(0u, 2)));
}

}  // namespace
}  // namespace talkgraph::annotate
