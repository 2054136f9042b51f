#include "nodes/mapping/offsets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nodes/sync/shift.h"

namespace talkgraph {
namespace {

struct Corpus {
  Collected<Track> audio, visual;
  Collected<PhoneTrack> phones;
};

/// Clips in which the face does what is heard, each as much later as `late` says.
Corpus late_by(const std::vector<double>& late) {
  Corpus corpus;
  for (std::size_t clip = 0; clip < late.size(); ++clip) {
    Track audio, visual;
    audio.values.resize(60, 2);
    visual.values.resize(60, 2);
    for (int t = 0; t < 60; ++t) {
      const auto at = [&](double time) { return std::sin(0.37 * time + 2.0 * static_cast<double>(clip)); };
      const auto other = [&](double time) { return std::sin(0.23 * time + 1.3 * static_cast<double>(clip * clip)); };
      audio.values.row(t) << at(t), other(t);
      const double then = t - late[clip];
      visual.values.row(t) << at(then) + 0.3 * other(then), 5 * other(then) * at(then);
    }
    const std::string key = "clip " + std::to_string(clip);
    corpus.audio.add(key, audio);
    corpus.visual.add(key, visual);
    corpus.phones.add(key, {{{"b", 0, 2.4}}});
  }
  return corpus;
}

Table offsets_of(const Corpus& corpus, const EstimateOffsets& node = {}) {
  Context context;
  return node(corpus.audio, corpus.phones, corpus.visual, context);
}

TEST(Offsets, AreFound) {
  const std::vector<double> late = {0, 0.5, -0.75, 0, 1.25, 0, -0.25, 0};
  const auto table = offsets_of(late_by(late));
  ASSERT_EQ(table.rows.size(), late.size());
  EXPECT_EQ(table.rows[4], "clip 4");
  EXPECT_EQ(table.columns, std::vector<std::string>{"late, s"});
  for (std::size_t clip = 0; clip < late.size(); ++clip)
    EXPECT_NEAR(table.cells[clip][0] * 25, late[clip], 0.26) << clip;
}

TEST(Offsets, StayWithinTheLargest) {
  const auto table = offsets_of(late_by({0, 0, 1.5, 0}), {.largest = 0.5});
  EXPECT_NEAR(table.cells[2][0] * 25, 0.5, 1e-9);
  const auto none = offsets_of(late_by({0, 1, 0}), {.largest = 0});
  for (const auto& row : none.cells) EXPECT_EQ(row[0], 0);
}

TEST(Offsets, AreNoneWhereNothingMovesOrIsMeasured) {
  auto corpus = late_by({0, 0.5});
  Track lost = corpus.visual[0];
  for (int t = 0; t < 60; ++t) lost.lost.push_back(t);
  corpus.audio.add("lost", corpus.audio[0]);
  corpus.phones.add("lost", corpus.phones[0]);
  corpus.visual.add("lost", lost);
  EXPECT_EQ(offsets_of(corpus).cells[2][0], 0);

  Corpus still = late_by({0, 0});
  Collected<Track> stone;
  for (std::size_t i = 0; i < 2; ++i) {
    Track t = still.visual[i];
    t.values.setConstant(3);
    stone.add(still.visual.key(i), t);
  }
  still.visual = stone;
  const auto none = offsets_of(still);
  for (const auto& row : none.cells) EXPECT_EQ(row[0], 0);
}

TEST(Offsets, NeedOthersToLearnFrom) {
  EXPECT_THROW(offsets_of(late_by({0})), std::runtime_error);
  EXPECT_THROW(offsets_of({}), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
