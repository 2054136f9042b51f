#include "study/store.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <set>
#include <thread>

#include "study/session.h"
#include "tests/study/small_study.h"
#include "tests/temporary_folder.h"

namespace talkgraph::study {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

struct StoreTest : testing::Test {
  const test::TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path(), file = folder / "answers.db";
  Study study = small_study();
  std::string token;

  StoreTest() { write_small_study(folder); }

  static Taker found(const Store& store, const std::string& token) { return store.find(token).value(); }
  /// Somebody who has agreed and given a profile.
  Taker starter(Store& store) {
    token = store.invite().value();
    store.agree(found(store, token));
    store.keep_profile(found(store, token), {{"age", 1}, {"native", 0}});
    return found(store, token);
  }
  static Answer answer(const Showing& shown, const std::string& question, int option) {
    return {.test = shown.test->id,
            .clip = shown.clip->id,
            .question = question,
            .option = option,
            .position = shown.position,
            .plays = 2,
            .seconds = 3.5};
  }
  std::string refusal(const auto& call) const {
    try {
      call();
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return {};
  }
};

TEST_F(StoreTest, TokensAreKeptAndUnlike) {
  std::string start, report, one, other;
  {
    Store store(folder, study);
    start = store.start_token(), report = store.report_token();
    one = store.invite().value(), other = store.invite().value();
  }
  for (const auto& token : {start, report, one, other}) EXPECT_THAT(token, MatchesRegex("[0-9a-f]{32}"));
  EXPECT_EQ((std::set{start, report, one, other}).size(), 4u);
  const Store again(folder, study);
  EXPECT_EQ(again.start_token(), start);
  EXPECT_EQ(again.report_token(), report);
  EXPECT_NE(found(again, one).seed, found(again, other).seed);
  EXPECT_FALSE(again.find(start));
  EXPECT_FALSE(again.find("' OR 1 = 1 --"));
  EXPECT_EQ(std::filesystem::status(file).permissions(), std::filesystem::perms(0600));
}

TEST_F(StoreTest, WhoHasNotGivenAProfileDoesNotTakePart) {
  Store store(folder, study);
  const auto token = store.invite().value();
  store.keep_profile(found(store, token), {{"age", 0}});
  EXPECT_FALSE(found(store, token).started) << "before agreeing";
  store.agree(found(store, token));
  EXPECT_TRUE(found(store, token).agreed);
  EXPECT_TRUE(read_answers(folder).participants.empty());
  store.keep_profile(found(store, token), {{"age", 2}, {"native", 1}});
  store.keep_profile(found(store, token), {{"age", 0}, {"native", 0}});
  const auto answers = read_answers(folder);
  ASSERT_EQ(answers.participants.size(), 1u);
  EXPECT_EQ(answers.participants[0].profile, (std::map<std::string, int>{{"age", 2}, {"native", 1}})) << "the first";
  EXPECT_GT(answers.participants[0].started, 1'600'000'000);
  EXPECT_EQ(answers.participants[0].finished, 0);
  EXPECT_THAT(answers.participants[0].tests, testing::UnorderedElementsAre("turing", "perceptual", "intelligibility"));
  EXPECT_EQ(answers.participants[0].tests[0], plan(study, found(store, token).seed)[0].test->id);
}

TEST_F(StoreTest, AnswersAreKeptOnceAndInOrder) {
  Store store(folder, study);
  const auto taker = starter(store);
  const auto shown = plan(study, taker.seed);
  EXPECT_TRUE(store.keep(taker, 0, {answer(shown[0], "real", 1), answer(shown[0], "second", 0)}, false));
  EXPECT_FALSE(store.keep(taker, 0, {answer(shown[0], "real", 0)}, false)) << "again";
  EXPECT_FALSE(store.keep(taker, 2, {answer(shown[2], "real", 0)}, false)) << "one left out";
  EXPECT_TRUE(store.keep(taker, 1, {answer(shown[1], "real", 0)}, true));
  const auto answers = read_answers(folder);
  ASSERT_EQ(answers.answers.size(), 3u);
  const auto& first = answers.answers[0];
  EXPECT_EQ(first.participant, taker.id);
  EXPECT_EQ(first.test, shown[0].test->id);
  EXPECT_EQ(first.clip, shown[0].clip->id);
  EXPECT_EQ(first.question, "real");
  EXPECT_EQ(first.option, 1);
  EXPECT_EQ(first.plays, 2);
  EXPECT_EQ(first.seconds, 3.5);
  EXPECT_GT(first.given, 1'600'000'000);
  EXPECT_EQ(answers.answers[1].question, "second");
  EXPECT_EQ(answers.answers[2].position, shown[1].position);
  EXPECT_GT(answers.participants[0].finished, 0);
}

TEST_F(StoreTest, ManyAtOnceKeepEveryAnswerOnce) {
  Store store(folder, study);
  const auto taker = starter(store);
  const auto shown = plan(study, taker.seed);
  std::atomic<int> kept = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      for (std::size_t n = 0; n < shown.size(); ++n)
        while (found(store, token).clips <= n) kept += store.keep(taker, n, {answer(shown[n], "q", 0)}, false);
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(kept, static_cast<int>(shown.size()));
  EXPECT_EQ(read_answers(folder).answers.size(), shown.size());
}

TEST_F(StoreTest, AnswersOfAnotherStudyAreNotMixedWithThis) {
  { Store(folder, study); }
  study.title = "another title";
  study.tests[0].instructions = {"Look well."};
  { Store(folder, study); }
  const auto refused = [&](const Study& other) { return refusal([&] { Store(folder, other); }); };
  Study other_truth = study;
  ++other_truth.tests[0].clips[0].correct;
  EXPECT_THAT(refused(other_truth), HasSubstr("answers.db: was begun with other tests"));
  Study turned = study;
  std::swap(turned.tests[0].questions[0].options[0], turned.tests[0].questions[0].options[1]);
  EXPECT_THAT(refused(turned), HasSubstr("answers.db: was begun with other tests"));
  study.tests[0].clips.pop_back();
  EXPECT_THAT(refused(study), HasSubstr("answers.db: was begun with other tests"));
  write_study(study, folder);
  EXPECT_THAT(refusal([&] { read_answers(folder); }), HasSubstr("answers.db: was begun with other tests"));
}

TEST_F(StoreTest, WhatCannotBeReadIsNamed) {
  EXPECT_THAT(refusal([&] { read_answers(folder); }), HasSubstr("nobody has answered yet"));
  EXPECT_THAT(refusal([&] { Store(folder / "nowhere", study); }), HasSubstr("answers.db: unable to open"));
  std::ofstream(file) << "this is text, and has been so for longer than a header is";
  EXPECT_THAT(refusal([&] { Store(folder, study); }), HasSubstr("answers.db: file is not a database"));
}

TEST_F(StoreTest, ADamagedFileIsFound) {
  {
    Store store(folder, study);
    for (int i = 0; i < 200; ++i) store.invite();
  }
  {
    std::fstream out(file, std::ios::in | std::ios::out | std::ios::binary);
    out.seekp(4096 * 4);
    out << std::string(4096 * 3, 'x');
  }
  EXPECT_THAT(refusal([&] { Store(folder, study); }), HasSubstr("answers.db: "));
}

TEST_F(StoreTest, WhileAnotherWritesNothingIsKeptAndLaterAllIs) {
  Store store(folder, study);
  const auto taker = starter(store);
  const auto shown = plan(study, taker.seed);
  {
    Database other(file, Database::Access::write);
    const Transaction busy(other);
    EXPECT_THROW(store.keep(taker, 0, {answer(shown[0], "q", 0)}, false), DatabaseError);
  }
  EXPECT_TRUE(store.keep(taker, 0, {answer(shown[0], "q", 0)}, false));
}

/// While it lives, files cannot grow: as on a full disk.
class FullDisk {
 public:
  FullDisk() : before_(signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &limit_);
    const rlimit none{1, limit_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &none);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &limit_);
    signal(SIGXFSZ, before_);
  }

 private:
  rlimit limit_{};
  void (*before_)(int);
};

TEST_F(StoreTest, OnAFullDiskNothingIsKeptAndLaterAllIs) {
  Store store(folder, study);
  const auto taker = starter(store);
  const auto shown = plan(study, taker.seed);
  const std::vector answers{answer(shown[0], "q", 0), answer(shown[0], "r", 1)};
  {
    const FullDisk full;
    EXPECT_THAT(refusal([&] { store.keep(taker, 0, answers, false); }), HasSubstr("answers.db: "));
  }
  EXPECT_TRUE(read_answers(folder).answers.empty());
  EXPECT_TRUE(store.keep(taker, 0, answers, false));
  EXPECT_EQ(read_answers(folder).answers.size(), 2u);
}

}  // namespace
}  // namespace talkgraph::study
