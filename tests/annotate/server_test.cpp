#include "annotate/server.h"

#include <httplib.h>

#include <thread>

#include "tests/annotate/corpus.h"

namespace talkgraph::annotate {
namespace {

using testing::HasSubstr;

class ServerTest : public CorpusTest {
 protected:
  ServerTest() {
    project_ = open({.frames = 6, .scheme = "file"});
    server_ = std::make_unique<Server>(*project_, 0);
    thread_ = std::thread([this] { server_->run(stop_); });
  }
  ~ServerTest() override {
    stop_ = true;
    thread_.join();
  }

  httplib::Client client() const { return httplib::Client("127.0.0.1", server_->port()); }
  Json get(const std::string& path, int status = 200) const {
    const auto response = client().Get(path);
    if (!response) return ADD_FAILURE() << path, Json();
    EXPECT_EQ(response->status, status) << path << ": " << response->body;
    return Json::parse(response->body);
  }
  std::string frame(std::size_t n) const { return "/api/frames/" + project_->key(n); }
  static std::string body(const Shape& points, bool done) {
    Json list = Json::array();
    for (const auto& point : points.rowwise()) list.push_back({point.x(), point.y()});
    return Json{{"points", list}, {"done", done}}.dump();
  }
  Json put(const std::string& text, const httplib::Headers& headers, int status,
           const std::string& type = "application/json", std::string path = "") const {
    if (path.empty()) path = frame(0);
    const auto response = client().Put(path, headers, text, type);
    if (!response) return ADD_FAILURE(), Json();
    EXPECT_EQ(response->status, status) << response->body;
    return Json::parse(response->body, nullptr, false);
  }

  std::unique_ptr<Project> project_;
  std::unique_ptr<Server> server_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

TEST_F(ServerTest, TellsSchemeAndFrames) {
  const auto project = get("/api/project");
  EXPECT_EQ(project["manifest"], manifest_);
  EXPECT_EQ(project["scheme"]["points"], 36);
  EXPECT_EQ(project["scheme"]["groups"][0], (Json{{"name", "all"}, {"points", {0, 1, 2}}, {"closed", true}}));
  EXPECT_EQ(project["scheme"]["pairs"], (Json{{0, 1}}));
  ASSERT_EQ(project["frames"].size(), 6u);
  EXPECT_EQ(project["frames"][2]["clip"], project_->clip(2));
  EXPECT_EQ(project["frames"][2]["number"], project_->frames()[2].number);
  const auto states = get("/api/frames");
  ASSERT_EQ(states.size(), 6u);
  EXPECT_EQ(states[0], (Json{{"key", project["frames"][0]["key"]}, {"state", "new"}, {"tag", "none"}}));
}

TEST_F(ServerTest, GivesPicturesAsTheyAre) {
  const auto response = client().Get(frame(3) + "/picture");
  ASSERT_TRUE(response);
  EXPECT_EQ(response->get_header_value("Content-Type"), "image/png");
  const std::vector<unsigned char> png(response->body.begin(), response->body.end());
  const auto shown = cv::imdecode(png, cv::IMREAD_COLOR);
  EXPECT_EQ(cv::norm(shown, test::draw(face(project_->clip(3), project_->frames()[3].number)), cv::NORM_INF), 0);
}

TEST_F(ServerTest, AFrameIsBegunChangedAndDone) {
  const auto begun = get(frame(0));
  EXPECT_EQ(begun["state"], "new");
  EXPECT_EQ(begun["by"], "scheme");
  ASSERT_EQ(begun["points"].size(), 36u);
  const Shape points = truth(*project_, 0);
  const auto draft = put(body(points, false), {{"If-Match", "none"}}, 200);
  EXPECT_EQ(draft["state"], "draft");
  const auto done = put(body(points, true), {{"If-Match", draft["tag"].get<std::string>()}}, 200);
  EXPECT_EQ(done["state"], "done");
  const auto read = get(frame(0));
  EXPECT_EQ(read["tag"], done["tag"]);
  EXPECT_NEAR(read["points"][5][1].get<double>(), points(5, 1), 1e-9);
  EXPECT_FALSE(read.contains("by"));
  EXPECT_EQ(get("/api/frames")[0]["state"], "done");
  EXPECT_EQ(get(frame(0) + "/begin")["by"], "scheme");
  EXPECT_EQ(get(frame(1))["by"], "examples");
}

TEST_F(ServerTest, OfTwoWindowsTheLaterIsToldWhatTheOtherDid) {
  const Shape first = truth(*project_, 0), second = first.array() + 1;
  put(body(first, false), {{"If-Match", "none"}}, 200);
  const auto told = put(body(second, false), {{"If-Match", "none"}}, 412);
  EXPECT_EQ(told["state"], "draft");
  EXPECT_NEAR(told["points"][0][0].get<double>(), first(0, 0), 1e-9);
  put(body(second, false), {{"If-Match", told["tag"].get<std::string>()}}, 200);
}

TEST_F(ServerTest, RefusesWhatIsNoAnnotation) {
  const httplib::Headers fresh = {{"If-Match", "none"}};
  const std::string deep = "{\"points\": " + std::string(60000, '[');
  for (const char* text : {"", "[]", "{", "{\"points\": [], \"done\": true}", "{\"points\": [[1]], \"done\": false}",
                           "{\"points\": 3, \"done\": false}", "{\"points\": [[1, \"x\"]], \"done\": false}",
                           "{\"points\": [[1, 2]]}", "\xff\xfe", deep.c_str()})
    EXPECT_TRUE(put(text, fresh, 400).contains("error")) << text;
  const auto good = body(truth(*project_, 0), false);
  put(good, {}, 428);
  put(good, fresh, 415, "text/plain");
  put(good, fresh, 404, "application/json", "/api/frames/" + std::string(32, '0'));
  Shape outside = truth(*project_, 0);
  outside(3, 0) = 250;
  EXPECT_THAT(put(body(outside, true), fresh, 400)["error"].get<std::string>(), HasSubstr("point 3 lies outside"));
  EXPECT_EQ(get("/api/frames")[0]["state"], "new");
  EXPECT_TRUE(std::filesystem::is_empty(path("annotated")));
}

TEST_F(ServerTest, RequestsAreBounded) {
  const auto response = client().Put(frame(0), {{"If-Match", "none"}}, std::string(1 << 20, ' '), "application/json");
  if (response) {
    EXPECT_EQ(response->status, 413);
  }
  EXPECT_EQ(get("/api/frames")[0]["state"], "new");
}

TEST_F(ServerTest, NothingElseIsServed) {
  for (const char* place :
       {"/../manifest.json", "/..%2fmanifest.json", "/annotated", "/api/frames/-1", "/api/frames/99",
        "/api/frames/1234567", "/api/frames/0", "/api/frames/x/../../manifest.json", "/manifest.json", "//", "/api"}) {
    const auto response = client().Get(place);
    ASSERT_TRUE(response) << place;
    EXPECT_EQ(response->status, 404) << place;
  }
  EXPECT_EQ(client().Post(frame(0), "x", "application/json")->status, 404);
}

TEST_F(ServerTest, OnlyThePageItselfIsAnswered) {
  const auto status = [&](const httplib::Headers& headers) { return client().Get("/api/project", headers)->status; };
  const auto port = std::to_string(server_->port());
  EXPECT_EQ(status({{"Host", "localhost:" + port}}), 200);
  EXPECT_EQ(status({{"Host", "127.0.0.1:9000"}}), 200) << "a forwarded port";
  EXPECT_EQ(status({{"Host", "evil.example:" + port}}), 403);
  EXPECT_EQ(status({{"Host", "localhost.evil.example"}}), 403);
  EXPECT_EQ(status({{"Host", "127.0.0.1.evil.example:80"}}), 403);
  EXPECT_EQ(status({{"Host", ""}}), 403);
  EXPECT_EQ(status({{"Host", "localhost:1"}, {"Origin", "http://localhost:1"}}), 200);
  EXPECT_EQ(status({{"Host", "localhost:1"}, {"Origin", "http://localhost:2"}}), 403);
  EXPECT_EQ(status({{"Host", "localhost:1"}, {"Origin", "null"}}), 403);
}

int connected(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(socket, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
  return socket;
}

/// What the server answers to these bytes until it closes the connection; it need not read them all.
std::string talk(int port, const std::string& bytes) {
  const int socket = connected(port);
  for (std::size_t at = 0; at < bytes.size();) {
    const auto n = send(socket, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
    if (n <= 0) break;
    at += static_cast<std::size_t>(n);
  }
  std::string answer(1 << 16, '\0'), all;
  for (ssize_t n; (n = recv(socket, answer.data(), answer.size(), 0)) > 0;)
    all.append(answer.data(), static_cast<std::size_t>(n));
  close(socket);
  return all;
}

TEST_F(ServerTest, ARequestInTheBodyOfARefusedOneIsNotTaken) {
  const auto text = body(truth(*project_, 0), true);
  const auto hidden = fmt::format(
      "PUT {} HTTP/1.1\r\nHost: localhost\r\nIf-Match: none\r\nContent-Type: application/json\r\n"
      "Content-Length: {}\r\n\r\n{}",
      frame(0), text.size(), text);
  const auto answer =
      talk(server_->port(), fmt::format("POST / HTTP/1.1\r\nHost: localhost\r\nOrigin: http://evil.example\r\n"
                                        "Content-Type: text/plain\r\nContent-Length: {}\r\n\r\n{}",
                                        hidden.size(), hidden));
  EXPECT_THAT(answer, HasSubstr("403"));
  EXPECT_EQ(answer.find("200 OK"), std::string::npos) << answer;
  EXPECT_EQ(get("/api/frames")[0]["state"], "new");
}

TEST_F(ServerTest, ThePageAllowsItsOwnFilesOnly) {
  for (const auto& [path, type, text] :
       {std::tuple("/", "text/html", "<svg id=\"picture\""), std::tuple("/annotate.css", "text/css", "#picture"),
        std::tuple("/annotate.js", "text/javascript", "\"use strict\"")}) {
    const auto response = client().Get(path);
    ASSERT_TRUE(response) << path;
    EXPECT_EQ(response->status, 200);
    EXPECT_THAT(response->get_header_value("Content-Type"), HasSubstr(type));
    EXPECT_THAT(response->body, HasSubstr(text));
    EXPECT_THAT(response->get_header_value("Content-Security-Policy"), HasSubstr("default-src 'none'"));
    EXPECT_EQ(response->get_header_value("X-Content-Type-Options"), "nosniff");
  }
}

TEST_F(ServerTest, AMalformedFileIsNamedAndBegunAnew) {
  write(fmt::format("annotated/{}/{:06}.pts", project_->clip(0), project_->frames()[0].number), "{\n1 x\n}\n");
  const auto states = get("/api/frames");
  EXPECT_EQ(states[0]["state"], "broken");
  EXPECT_THAT(states[0]["reason"].get<std::string>(), HasSubstr(".pts:2: a number is expected"));
  EXPECT_EQ(states[1]["state"], "new");
  EXPECT_EQ(get(frame(1))["by"], "scheme");
  const auto broken = get(frame(0));
  EXPECT_EQ(broken["state"], "broken");
  ASSERT_EQ(broken["points"].size(), 36u) << "to begin with";
  const auto tag = broken["tag"].get<std::string>();
  EXPECT_EQ(put(body(truth(*project_, 0), false), {{"If-Match", tag}}, 200)["state"], "draft");
}

TEST_F(ServerTest, WhatIsMeantForAnotherProjectIsNotTaken) {
  const auto text = body(truth(*project_, 0), true);
  std::string other;
  {
    write("other.json", fmt::format(R"({{"rate": 25, "clips": [{}, {}]}})", clip_json("one"), clip_json("two")));
    Diagnostics diagnostics;
    other = Project::open(path("other.json"), {.frames = 6, .scheme = path("synthetic.json")}, diagnostics)->key(0);
  }
  put(text, {{"If-Match", "none"}}, 404, "application/json", "/api/frames/" + other);
  EXPECT_EQ(get("/api/frames")[0]["state"], "new");
}

/// Sends a request a byte at a time, until the server has enough.
void trickle(int socket, const std::atomic<bool>& enough) {
  const std::string request = "PUT /api HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n\r\n";
  for (std::size_t i = 0; !enough; ++i) {
    if (send(socket, i < request.size() ? &request[i] : " ", 1, MSG_NOSIGNAL) != 1) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  close(socket);
}

TEST_F(ServerTest, SlowOnesNeitherHoldUpOthersNorTheEnd) {
  std::atomic<bool> enough = false;
  std::vector<std::thread> slow;
  for (int i = 0; i < 20; ++i) slow.emplace_back(trickle, connected(server_->port()), std::cref(enough));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto start = std::chrono::steady_clock::now();
  const auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  get("/api/project");
  EXPECT_LT(passed(), 1);
  stop_ = true;
  thread_.join();
  EXPECT_LT(passed(), 2);
  enough = true;
  for (auto& one : slow) one.join();
  thread_ = std::thread([] {});
}

TEST_F(ServerTest, ARequestEndsInTime) {
  const auto start = std::chrono::steady_clock::now();
  std::atomic<bool> enough = false;
  trickle(connected(server_->port()), enough);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(8));
}

TEST_F(ServerTest, BodiesThatGrowAreRefused) {
  const auto start = fmt::format(
      "PUT {} HTTP/1.1\r\nHost: localhost\r\nIf-Match: none\r\n"
      "Content-Type: application/json\r\n",
      frame(0));
  EXPECT_THAT(talk(server_->port(), start + "Content-Encoding: gzip\r\nContent-Length: 3\r\n\r\nabc"),
              HasSubstr("400"));
  EXPECT_THAT(talk(server_->port(), start + "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n"), HasSubstr("400"));
  const auto head = "GET / HTTP/1.1\r\nHost: localhost\r\n";
  EXPECT_THAT(talk(server_->port(), head + std::string("Range: bytes=0-,0-,0-,0-\r\n\r\n")), HasSubstr("400"));
  std::string endless = head;
  for (int i = 0; i < 100000; ++i) endless += "X: y\r\n";
  EXPECT_EQ(talk(server_->port(), endless).find("200 OK"), std::string::npos);
}

TEST_F(ServerTest, APortThatIsTakenIsToldAndFreeAgainAfterwards) {
  EXPECT_THAT(error_of([&] { Server(*project_, server_->port()); }), HasSubstr("is taken: name another with --port"));
  const int port = server_->port();
  stop_ = true;
  thread_.join();
  server_.reset();
  server_ = std::make_unique<Server>(*project_, port);
  stop_ = false;
  thread_ = std::thread([this] { server_->run(stop_); });
  get("/api/project");
}

}  // namespace
}  // namespace talkgraph::annotate
