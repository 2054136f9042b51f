#include "study/server.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <sys/resource.h>

#include <mutex>

#include "study/session.h"
#include "study/store.h"
#include "tests/study/running_server.h"
#include "tests/study/simulated.h"
#include "tests/study/small_study.h"
#include "tests/temporary_folder.h"

namespace talkgraph::study {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

struct ServerTest : testing::Test {
  const test::TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path();
  const Study study = small_study();
  std::unique_ptr<RunningServer> server;

  ServerTest() {
    write_small_study(folder);
    server = std::make_unique<RunningServer>(folder);
  }

  httplib::Client client() { return httplib::Client("127.0.0.1", (*server)->port()); }
  Reply get(const std::string& path) { return ask((*server)->port(), path); }
  Reply post(const std::string& path, const Json& body) { return ask((*server)->port(), path, body); }
  std::string start() { return RunningServer::path((*server)->start_url()); }
  std::string report() { return RunningServer::path((*server)->report_url()); }
  std::string invited() { return RunningServer::path((*server)->invite()); }
  /// A person who has given a profile.
  std::string starter() {
    const auto path = invited();
    post(path + "/consent", Json::object());
    post(path + "/profile", {{"age", 1}, {"native", 2}});
    return path;
  }
  /// Option 0 of everything, for a clip of a person's test.
  static Json answers(const Json& test, std::size_t clip = 0) {
    Json all = Json::object();
    for (const auto& question : test["questions"])
      all[question["id"].get<std::string>()] = {{"option", 0}, {"seconds", 2.5}};
    return {{"clip", test["clips"][clip]["id"]}, {"plays", 1}, {"answers", all}};
  }
  std::vector<std::string> kept() const {
    std::vector<std::string> all;
    for (const auto& a : read_answers(folder).answers)
      all.push_back(fmt::format("{} {} {}", a.clip, a.question, a.option));
    return all;
  }
};

TEST_F(ServerTest, LeadsFromConsentToTheEnd) {
  EXPECT_EQ(get(start() + "/state").json["stage"], "consent");
  const auto path = "/" + post(start() + "/consent", Json::object()).json["link"].get<std::string>();
  auto state = get(path + "/state").json;
  EXPECT_EQ(state["stage"], "profile");
  EXPECT_EQ(state["questions"][1]["options"], (Json{"yes", "no", "prefer not to say"}));
  state = post(path + "/profile", {{"age", 3}, {"native", 0}}).json;
  for (int done = 0; done < 16; ++done) {
    ASSERT_EQ(state["stage"], "test");
    EXPECT_EQ(state["done"], done);
    EXPECT_EQ(state["total"], 16);
    EXPECT_EQ(state["test"]["tests"], 3);
    state = post(path + "/answers", answers(state["test"])).json;
  }
  EXPECT_EQ(state["stage"], "done");
  EXPECT_EQ(state["paragraphs"], (Json{"Thank you: that was all."}));
  EXPECT_EQ(get(path + "/state").json, state);
  const auto all = read_answers(folder);
  EXPECT_EQ(all.answers.size(), 32u);
  EXPECT_GT(all.participants.at(0).finished, 0);
  EXPECT_EQ(get(report()).json, (Json{{"invited", 1}, {"started", 1}, {"finished", 1}, {"answers", 32}}));
}

TEST_F(ServerTest, AnInvitedPersonAgreesFirst) {
  const auto path = invited();
  EXPECT_EQ(get(path + "/state").json["stage"], "consent");
  EXPECT_EQ(post(path + "/profile", {{"age", 0}, {"native", 0}}).status, 409);
  EXPECT_EQ(post(path + "/consent", Json::object()).json["stage"], "profile");
  EXPECT_EQ(post(path + "/consent", Json::object()).json["stage"], "profile");
  EXPECT_EQ(get(report()).json["started"], 0);
}

TEST_F(ServerTest, GoesOnWhereItWasAfterARestart) {
  const auto path = starter();
  auto state = get(path + "/state").json;
  state = post(path + "/answers", answers(state["test"])).json;
  server.reset();
  server = std::make_unique<RunningServer>(folder);
  EXPECT_EQ(get(path + "/state").json, state);
}

TEST_F(ServerTest, SavesThatComeTwiceLateOrTooEarlyChangeNothing) {
  const auto path = starter();
  const auto test = get(path + "/state").json["test"];
  EXPECT_EQ(post(path + "/answers", answers(test, 1)).status, 409) << "too early";
  EXPECT_TRUE(kept().empty());
  const auto state = post(path + "/answers", answers(test)).json;
  const auto once = kept();
  auto other = answers(test);
  for (auto& answer : other["answers"]) answer["option"] = 1;
  const auto again = post(path + "/answers", other);
  EXPECT_EQ(again.status, 200);
  EXPECT_EQ(again.json, state);
  EXPECT_EQ(kept(), once);
  post(path + "/answers", answers(test, 1));
  EXPECT_EQ(post(path + "/answers", other).status, 200) << "late";
  post(path + "/profile", {{"age", 0}, {"native", 0}});
  EXPECT_EQ(kept().size(), 2 * once.size());
  EXPECT_EQ(read_answers(folder).participants.at(0).profile.at("age"), 1);
}

TEST_F(ServerTest, NothingTellsWhatAClipShows) {
  const auto path = starter();
  for (const auto& file : {path + "/state", path, start(), std::string("/study.js")}) {
    const auto text = client().Get(file)->body;
    for (const char* secret : {"secret", "correct", "synthetic\":", "eyes", "Ann", "category", "speaker"})
      EXPECT_THAT(text, Not(HasSubstr(secret))) << file;
  }
}

TEST_F(ServerTest, AClipIsItsPersonsAlone) {
  const auto path = starter();
  const auto token = path.substr(path.rfind('/') + 1);
  const auto taker = Store(folder, study).find(token).value();
  std::set<std::string> mine;
  for (const auto& shown : plan(study, taker.seed)) mine.insert(shown.clip->id);
  for (const auto& test : study.tests)
    for (const auto& clip : test.clips) {
      const auto response = client().Get(fmt::format("{}/clips/{}.mp4", path, clip.id));
      EXPECT_EQ(response->status, mine.contains(clip.id) ? 200 : 404) << clip.id;
      if (mine.contains(clip.id)) {
        EXPECT_EQ(response->body, fmt::format("bytes of {}.mp4", clip.id));
        EXPECT_EQ(response->get_header_value("Content-Type"), "video/mp4");
        EXPECT_EQ(response->get_header_value_count("Cache-Control"), 1u);
      }
      EXPECT_EQ(client().Get(fmt::format("{}/clips/{}.mp4", start(), clip.id))->status, 404);
    }
}

TEST_F(ServerTest, NoClipIsShownBeforeTheProfileIsGiven) {
  const auto path = invited();
  const auto taker = Store(folder, study).find(path.substr(path.rfind('/') + 1)).value();
  const auto clip = plan(study, taker.seed).front().clip->id;
  EXPECT_EQ(client().Get(fmt::format("{}/clips/{}.mp4", path, clip))->status, 409);
}

TEST_F(ServerTest, ClipsAreServedInRanges) {
  const auto path = starter();
  const auto id = get(path + "/state").json["test"]["clips"][0]["id"].get<std::string>();
  const auto whole = fmt::format("bytes of {}.webm", id);
  const auto ranged = [&](const std::string& range) {
    return client().Get(fmt::format("{}/clips/{}.webm", path, id), {{"Range", range}});
  };
  const auto from_start = ranged("bytes=0-4");
  EXPECT_EQ(from_start->status, 206);
  EXPECT_EQ(from_start->body, "bytes");
  EXPECT_EQ(from_start->get_header_value("Content-Range"), fmt::format("bytes 0-4/{}", whole.size()));
  EXPECT_EQ(ranged("bytes=6-")->body, whole.substr(6));
  EXPECT_EQ(ranged("bytes=-4")->body, "webm");
  EXPECT_EQ(ranged("bytes=3-999999")->body, whole.substr(3));
  EXPECT_EQ(ranged(fmt::format("bytes={}-", whole.size()))->status, 416);
  EXPECT_EQ(ranged("bytes=0-1,3-4")->body, whole) << "several are not served";
  EXPECT_EQ(client().Head(fmt::format("{}/clips/{}.webm", path, id))->body, "");
}

TEST_F(ServerTest, TheReportHasItsOwnLink) {
  const auto path = starter();
  post(path + "/answers", answers(get(path + "/state").json["test"]));
  const auto token = [](const std::string& link) { return link.substr(link.rfind('/')); };
  for (const auto& link : {path, start()})
    for (const char* what : {"", "/answers.json", "/answers.csv"})
      EXPECT_EQ(client().Get("/report" + token(link) + what)->status, 404);
  for (const char* what : {"/start", "/p"}) EXPECT_EQ(get(what + token(report()) + "/state").status, 404);
  const auto answers = get(report() + "/answers.json").json;
  EXPECT_EQ(answers["participants"][0]["profile"], (Json{{"age", 1}, {"native", 2}}));
  EXPECT_EQ(answers["answers"][0]["option"], 0);
  EXPECT_EQ(answers["answers"][0]["seconds"], 2.5);
  const auto csv = client().Get(report() + "/answers.csv")->body;
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), kept().size() + 1);
  EXPECT_THAT(csv, HasSubstr("participant,test,clip,question,option,position,plays,seconds,given\n1,"));
}

TEST_F(ServerTest, MalformedAnswersAreRefused) {
  const auto path = starter();
  const auto test = get(path + "/state").json["test"];
  const auto question = test["questions"][0]["id"].get<std::string>();
  const auto changed = [&](const auto& change) {
    Json body = answers(test);
    change(body);
    return body;
  };
  const std::vector<Json> bodies = {
      Json::array(),
      "text",
      changed([](Json& b) { b.erase("plays"); }),
      changed([](Json& b) { b.erase("answers"); }),
      changed([](Json& b) { b["plays"] = 0; }),
      changed([](Json& b) { b["plays"] = -1; }),
      changed([](Json& b) { b["plays"] = 1.5; }),
      changed([](Json& b) { b["plays"] = 1e6; }),
      changed([](Json& b) { b["plays"] = 18446744073709551615u; }),
      changed([&](Json& b) { b["answers"].erase(question); }),
      changed([&](Json& b) { b["answers"]["more"] = b["answers"][question]; }),
      changed([&](Json& b) { b["answers"][question]["option"] = 99; }),
      changed([&](Json& b) { b["answers"][question]["option"] = -1; }),
      changed([&](Json& b) { b["answers"][question]["option"] = "0"; }),
      changed([&](Json& b) { b["answers"][question]["option"] = true; }),
      changed([&](Json& b) { b["answers"][question]["seconds"] = -1; }),
      changed([&](Json& b) { b["answers"][question]["seconds"] = 1e300; }),
      changed([&](Json& b) { b["answers"][question]["seconds"] = nullptr; }),
      changed([&](Json& b) { b["answers"][question] = 0; }),
      changed([](Json& b) { b["answers"] = {0}; }),
  };
  for (const auto& body : bodies) EXPECT_EQ(post(path + "/answers", body).status, 400) << body;
  EXPECT_EQ(post(path + "/answers", changed([](Json& b) { b["clip"] = "other"; })).status, 404);
  EXPECT_EQ(post(path + "/answers", changed([](Json& b) { b["clip"] = 1; })).status, 404);
  for (const char* text : {"", "{", "\xff", "[[[[[[[[", "{\"plays\":1e999}"})
    EXPECT_EQ(client().Post(path + "/answers", text, "application/json")->status, 400) << text;
  EXPECT_EQ(client().Post(path + "/answers", answers(test).dump(), "text/plain")->status, 415);
  EXPECT_TRUE(kept().empty());
  for (const Json& profile : {Json{{"age", 9}, {"native", 0}}, Json{{"age", 0}}, Json{{"age", 0}, {"name", 0}}})
    EXPECT_EQ(post(starter() + "/profile", profile).status, 400) << profile;
}

TEST_F(ServerTest, NothingElseIsServed) {
  const auto path = starter();
  for (const auto& place :
       {std::string("/"), std::string("/answers.db"), std::string("/../answers.db"), std::string("/study.json"),
        "/p/" + std::string(32, '0') + "/state", "/p/" + std::string(31, '0') + "/state", path + "/clips/../answers.db",
        path + "/clips/..%2fanswers.db", path + "/clips/%2e%2e/study.json", path + "/clips/t0.db", path + "/clips/t0",
        path + "/clips//etc/passwd.mp4", start() + "/profile", report() + "/study.json", path + "/"})
    EXPECT_EQ(client().Get(place)->status, 404) << place;
  EXPECT_EQ(client().Delete(path)->status, 404);
  EXPECT_EQ(client().Put(path + "/answers", "{}", "application/json")->status, 404);
}

TEST_F(ServerTest, OnlyThisComputersPagesAreAnswered) {
  const auto status = [&](const httplib::Headers& headers) { return client().Get("/study.js", headers)->status; };
  EXPECT_EQ(status({{"Host", "localhost:1"}}), 200);
  EXPECT_EQ(status({{"Host", "[::1]:1"}}), 200);
  EXPECT_EQ(status({{"Host", "evil.example"}}), 403);
  EXPECT_EQ(status({{"Host", "127.0.0.2:80"}}), 200);
  EXPECT_EQ(status({{"Host", "127.evil.example"}}), 403);
  EXPECT_EQ(status({{"Host", "10.0.0.1"}}), 403);
  EXPECT_EQ(status({{"Host", "localhost"}, {"Origin", "http://localhost"}}), 200);
  EXPECT_EQ(status({{"Host", "localhost"}, {"Origin", "http://evil.example"}}), 403);
  EXPECT_EQ(status({{"Host", "localhost"}, {"Origin", "null"}}), 403);
}

TEST_F(ServerTest, BehindAProxyItsNameIsKnown) {
  server.reset();
  auto options = RunningServer::at_any_port();
  options.url = "https://study.example/faces/";
  server = std::make_unique<RunningServer>(folder, options);
  EXPECT_THAT((*server)->start_url(), testing::StartsWith("https://study.example/faces/start/"));
  const auto status = [&](const httplib::Headers& headers) { return client().Get("/study.js", headers)->status; };
  EXPECT_EQ(status({{"Host", "study.example"}, {"Origin", "https://study.example"}}), 200);
  EXPECT_EQ(status({{"Host", "127.0.0.1:80"}, {"Origin", "https://study.example"}}), 200);
  EXPECT_EQ(status({{"Host", "example"}, {"Origin", "https://study.example"}}), 403);
  EXPECT_EQ(status({{"Host", "study.example"}, {"Origin", "https://evil.example"}}), 403);
}

TEST_F(ServerTest, PagesAllowTheirOwnFilesOnly) {
  for (const auto& path : {start(), starter(), std::string("/study.css"), report()}) {
    const auto response = client().Get(path);
    EXPECT_EQ(response->status, 200);
    EXPECT_THAT(response->get_header_value("Content-Security-Policy"),
                testing::AllOf(HasSubstr("default-src 'none'"), HasSubstr("media-src 'self' blob:")));
    EXPECT_EQ(response->get_header_value("X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(response->get_header_value("Referrer-Policy"), "no-referrer");
    EXPECT_EQ(response->get_header_value("Cache-Control"), "no-store");
  }
}

TEST_F(ServerTest, WhileNothingCanBeKeptPeopleAreTold) {
  server.reset();
  auto options = RunningServer::at_any_port();
  std::mutex mutex;
  std::string told;
  options.warn = [&](const std::string& what) {
    const std::lock_guard lock(mutex);
    told = what;
  };
  server = std::make_unique<RunningServer>(folder, options);
  const auto path = starter();
  const auto body = answers(get(path + "/state").json["test"]);
  {
    Database other(folder / "answers.db", Database::Access::write);
    const Transaction busy(other);
    const auto reply = post(path + "/answers", body);
    EXPECT_EQ(reply.status, 503);
    EXPECT_EQ(reply.json, (Json{{"error", "answers cannot be kept now"}})) << "no name of a file";
    const std::lock_guard lock(mutex);
    EXPECT_THAT(told, HasSubstr("answers.db: database is locked"));
  }
  EXPECT_EQ(post(path + "/answers", body).status, 200);
  EXPECT_FALSE(kept().empty());
}

TEST_F(ServerTest, AHundredAtOnceLoseNothing) {
  constexpr int people = 100;
  std::vector<std::vector<Answer>> given(people);
  std::vector<std::thread> threads;
  for (int i = 0; i < people; ++i)
    threads.emplace_back([&, i] { given[i] = take_study((*server)->port(), start(), i); });
  for (auto& thread : threads) thread.join();
  std::multiset<std::string> sent, there;
  const auto text = [](const Answer& a) {
    return fmt::format("{} {} {} {} {} {}", a.clip, a.question, a.option, a.position, a.plays, a.seconds);
  };
  for (const auto& one : given)
    for (const auto& answer : one) sent.insert(text(answer));
  const auto all = read_answers(folder);
  for (const auto& answer : all.answers) there.insert(text(answer));
  EXPECT_EQ(all.participants.size(), std::size_t{people});
  EXPECT_EQ(sent.size(), std::size_t{people * 32});
  EXPECT_EQ(there, sent);
}

TEST_F(ServerTest, WhatIsMissingIsNamedAtTheBeginning) {
  const auto refusal = [&](const std::filesystem::path& place) -> std::string {
    try {
      Server(place, RunningServer::at_any_port());
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return {};
  };
  EXPECT_THAT(refusal(folder / "none"), HasSubstr("study.json: cannot be read"));
  std::filesystem::remove(folder / "clips/p3.mp4");
  EXPECT_THAT(refusal(folder), HasSubstr("p3.mp4: is missing"));
}

}  // namespace
}  // namespace talkgraph::study
