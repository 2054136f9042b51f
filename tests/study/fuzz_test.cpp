// Hostile requests: TALKGRAPH_FUZZ=100000 test_study --gtest_filter='Fuzz*' sends as many.

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <map>
#include <mutex>
#include <thread>

#include "graph/random.h"
#include "study/session.h"
#include "study/store.h"
#include "tests/study/running_server.h"
#include "tests/study/simulated.h"
#include "tests/study/small_study.h"
#include "tests/temporary_folder.h"

namespace talkgraph::study {
namespace {

constexpr int usual = 3200, threads = 32;

int requests() {
  const char* asked = std::getenv("TALKGRAPH_FUZZ");
  return asked ? std::atoi(asked) : usual;
}

/// The status of the answer to these bytes; 0 where there is none, -1 for an answer that is no HTTP.
int talk(int port, const std::string& bytes) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0) throw std::runtime_error("the server is gone");
  for (std::size_t at = 0; at < bytes.size();) {
    const auto n = send(socket, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
    if (n <= 0) break;
    at += static_cast<std::size_t>(n);
  }
  shutdown(socket, SHUT_WR);
  std::string answer, part(1 << 14, '\0');
  for (ssize_t n; (n = recv(socket, part.data(), part.size(), 0)) > 0;)
    answer.append(part.data(), static_cast<std::size_t>(n));
  close(socket);
  if (answer.starts_with("HTTP/1.1 100")) answer.erase(0, answer.find("HTTP/1.1", 1));
  if (answer.empty()) return 0;
  return answer.starts_with("HTTP/1.1 ") ? std::atoi(answer.c_str() + 9) : -1;
}

/// Requests that begin as sound ones and are then spoilt.
class Hostile {
 public:
  Hostile(std::uint64_t seed, std::vector<std::string> paths, std::vector<std::string> bodies)
      : random_(seed), paths_(std::move(paths)), bodies_(std::move(bodies)) {}

  std::string next() {
    if (random_.below(50) == 0) return noise(random_.below(3000));
    std::string path = one_of(paths_), body = "{}", method = "POST";
    switch (random_.below(5)) {
      case 0:
        method = "GET", path += one_of(endings), body.clear();
        break;
      case 1:
        path += "/consent";
        break;
      case 2:
        path += "/profile", body = one_of(bodies_);
        break;
      case 3:
        path += "/answers", body = one_of(bodies_);
        break;
      default:
        method = one_of(methods), path += one_of(endings), body = one_of(bodies_);
    }
    if (chance(6)) spoil(path);
    if (chance(3)) spoil(body);
    std::string head = method + " " + path + (chance(12) ? one_of(versions) : " HTTP/1.1\r\n");
    if (!chance(20)) head += "Host: localhost\r\n";
    if (!chance(20)) head += "Content-Type: application/json\r\n";
    head += fmt::format("Content-Length: {}\r\n", chance(20) ? one_of(lengths) : std::to_string(body.size()));
    while (chance(7)) head += one_of(headers) + "\r\n";
    std::string all = head + "\r\n" + body;
    if (chance(8)) spoil(all);
    return all;
  }

 private:
  using Texts = std::vector<std::string>;
  inline static const Texts methods{"GET", "POST", "HEAD", "PUT", "DELETE", "OPTIONS", "PRI", "get", ""};
  inline static const Texts endings{"",
                                    "/state",
                                    "/consent",
                                    "/profile",
                                    "/answers",
                                    "/answers",
                                    "/answers",
                                    "/clips/t0.webm",
                                    "/clips/p3.mp4",
                                    "/clips/..%2f..%2fanswers.db",
                                    "/../../study.json",
                                    "/answers.json",
                                    "/answers.csv",
                                    "?a=b&c",
                                    "//",
                                    "%00",
                                    "#"};
  inline static const Texts versions{" HTTP/1.0\r\n", " HTTP/9\r\n", "\r\n", "\n", " HTTP/1.1 \r\n"};
  inline static const Texts lengths{"0", "-1", "1", "99999", "18446744073709551616", "1e3", "", "0x10", "4 4"};
  inline static const Texts headers{"Range: bytes=0-3",
                                    "Range: bytes=5-",
                                    "Range: bytes=-18446744073709551615",
                                    "Range: bytes=9999999999999999999999-",
                                    "Range: bytes=0-,1-,2-,3-",
                                    "Range: lines=1",
                                    "Transfer-Encoding: chunked",
                                    "Content-Encoding: gzip",
                                    "Expect: 100-continue",
                                    "Connection: keep-alive",
                                    "Upgrade: h2c",
                                    "Origin: http://localhost",
                                    "Origin: null",
                                    "Host: evil.example",
                                    "Content-Type: multipart/form-data; boundary=x",
                                    "Content-Type: application/x-www-form-urlencoded",
                                    "Accept-Encoding: gzip, br",
                                    "Cookie: " + std::string(9000, 'c'),
                                    "X: " + std::string(200, '\xff'),
                                    ": no name",
                                    "no colon"};
  inline static const Texts pieces{"../",
                                   "%2e%2e%2f",
                                   "'; DROP TABLE answer; --",
                                   "\" OR 1=1",
                                   "\r\n\r\n",
                                   "\r\n",
                                   "%",
                                   "%zz",
                                   "null",
                                   "true",
                                   "-1",
                                   "1e999",
                                   "99999999999999999999",
                                   "{",
                                   "}",
                                   "[[[[[[[[[",
                                   "\"",
                                   "\\u0000",
                                   "\\ud800",
                                   "\xc3\x28",
                                   "[]",
                                   ",",
                                   "<script>",
                                   "${x}",
                                   "%n%s"};

  bool chance(std::uint64_t n) { return random_.below(n) == 0; }
  const std::string& one_of(const Texts& all) { return all[random_.below(all.size())]; }
  std::string noise(std::size_t size) {
    std::string bytes(size, '\0');
    for (auto& byte : bytes) byte = static_cast<char>(random_.below(256));
    return bytes;
  }

  void spoil(std::string& text) {
    for (auto times = 1 + random_.below(3); times > 0; --times) {
      const auto at = random_.below(text.size() + 1), length = random_.below(12);
      switch (random_.below(6)) {
        case 0:
          text.insert(at, one_of(pieces));
          break;
        case 1:
          text.erase(at, length);
          break;
        case 2:
          text.insert(at, text.substr(at, length));
          break;
        case 3:
          text.resize(at);
          break;
        case 4:
          text.insert(at, noise(length));
          break;
        default:
          text.insert(at, std::string(chance(20) ? 40000 : 300, 'a'));
      }
    }
  }

  Random random_;
  Texts paths_, bodies_;
};

struct Fuzz : testing::Test {
  const test::TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path();
  const Study study = small_study();
  std::unique_ptr<RunningServer> server;
  std::vector<std::string> people;
  std::vector<std::string> bodies{"{}", R"({"age": 1, "native": 2})"};

  Fuzz() {
    write_small_study(folder);
    server = std::make_unique<RunningServer>(folder);
    for (const int clips : {-2, -1, 0, 1, 7, 15, 16}) people.push_back(person(clips));
  }

  std::string person(int clips) {
    const int port = (*server)->port();
    const auto path = RunningServer::path((*server)->invite());
    if (clips > -2) ask(port, path + "/consent", Json::object());
    if (clips > -1) ask(port, path + "/profile", {{"age", 1}, {"native", 2}});
    for (auto state = ask(port, path + "/state").json; state["stage"] == "test";
         state = ask(port, path + "/state").json) {
      bodies.push_back(first_answers(state["test"]).dump());
      if (state["done"] == clips) break;
      ask(port, path + "/answers", first_answers(state["test"]));
    }
    return path;
  }

  static Json first_answers(const Json& test) {
    Json all = Json::object();
    for (const auto& question : test["questions"])
      all[question["id"].get<std::string>()] = {{"option", 0}, {"seconds", 2.5}};
    return {{"clip", test["clips"][0]["id"]}, {"plays", 1}, {"answers", all}};
  }

  std::vector<std::string> paths() {
    auto all = people;
    all.insert(all.end(), people.begin(), people.end());
    all.push_back(RunningServer::path((*server)->start_url()));
    all.push_back(RunningServer::path((*server)->report_url()));
    all.insert(all.end(), {"/study.js", "/study.css", "/", "/p/" + std::string(32, 'f'), "/start/", "/p/x"});
    return all;
  }

  /// Whatever was sent: only whole answers to the clips of a person, in the order in which they are shown.
  void check_rows(const Answers& all) const;
};

void Fuzz::check_rows(const Answers& all) const {
  std::map<std::int64_t, std::vector<Answer>> of;
  for (const auto& answer : all.answers) of[answer.participant].push_back(answer);
  Database database(folder / "answers.db", Database::Access::read);
  for (const auto& [id, answers] : of) {
    Statement row(database, "SELECT seed FROM participant WHERE id = ? AND agreed > 0 AND started > 0", id);
    ASSERT_TRUE(row.step()) << id;
    std::size_t at = 0;
    for (const auto& shown : plan(study, static_cast<std::uint64_t>(row.integer(0)))) {
      if (at == answers.size()) break;
      for (const auto& question : shown.test->questions) {
        ASSERT_LT(at, answers.size());
        const auto& answer = answers[at++];
        ASSERT_EQ(answer.clip, shown.clip->id);
        ASSERT_EQ(answer.question, question.id);
        ASSERT_EQ(answer.test, shown.test->id);
        ASSERT_EQ(answer.position, shown.position);
        ASSERT_LT(static_cast<std::size_t>(answer.option), options(question, *shown.clip).size());
      }
    }
    ASSERT_EQ(at, answers.size()) << "nothing beyond what is shown";
  }
  for (const auto& person : all.participants) {
    ASSERT_EQ(person.profile.size(), study.profile.size());
    for (const auto& question : study.profile)
      ASSERT_LT(static_cast<std::size_t>(person.profile.at(question.id)), question.options.size());
    ASSERT_EQ(person.finished > 0, of[person.id].size() == 32);
  }
}

TEST_F(Fuzz, HostileRequestsNeitherBreakTheServerNorLeaveRows) {
  const auto before = read_answers(folder);
  const auto invited = ask((*server)->port(), RunningServer::path((*server)->report_url())).json["invited"].get<int>();
  std::mutex mutex;
  std::map<int, int> statuses;
  std::vector<std::string> failures;
  std::vector<std::thread> all;
  for (int t = 0; t < threads; ++t)
    all.emplace_back([&, t, hostile = Hostile(static_cast<std::uint64_t>(t), paths(), bodies)]() mutable {
      for (int i = 0; i < requests() / threads; ++i) {
        const auto bytes = hostile.next();
        const int status = talk((*server)->port(), bytes);
        const std::lock_guard lock(mutex);
        ++statuses[status];
        if (status < 0 || status >= 500) failures.push_back(fmt::format("{}: {:.300}", status, bytes));
      }
    });
  for (auto& thread : all) thread.join();
  for (const auto& failure : failures) ADD_FAILURE() << failure;
  std::string told;
  for (const auto& [status, count] : statuses) told += fmt::format(" {}: {}", status, count);
  std::cout << "statuses" << told << "\n";
  EXPECT_GT(statuses[200], requests() / 20) << "some get as far as to be answered";
  const auto after = read_answers(folder);
  check_rows(after);
  EXPECT_EQ(ask((*server)->port(), RunningServer::path((*server)->report_url())).json["invited"],
            invited + statuses[201])
      << "nobody is made but by the first link";
  for (const auto& answer : before.answers) {
    const auto same = [&](const Answer& a) {
      return a.participant == answer.participant && a.clip == answer.clip && a.question == answer.question &&
             a.option == answer.option && a.plays == answer.plays && a.seconds == answer.seconds;
    };
    EXPECT_EQ(std::count_if(after.answers.begin(), after.answers.end(), same), 1) << answer.clip;
  }
  EXPECT_EQ(take_study((*server)->port(), RunningServer::path((*server)->start_url()), 1).size(), 32u)
      << "and people go on";
}

}  // namespace
}  // namespace talkgraph::study
