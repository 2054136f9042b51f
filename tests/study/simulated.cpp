#include "tests/study/simulated.h"

#include <fmt/format.h>
#include <httplib.h>

#include <chrono>
#include <stdexcept>

#include "graph/random.h"

namespace talkgraph::study {
namespace {

Reply expect(int status, const Reply& reply) {
  if (reply.status != status) throw std::runtime_error(fmt::format("{}: {}", reply.status, reply.json.dump()));
  return reply;
}

Json profile_of(const Json& state, Random& random) {
  Json profile = Json::object();
  for (const auto& question : state["questions"])
    profile[question["id"].get<std::string>()] = random.below(question["options"].size());
  return profile;
}

Json answers_of(const Json& test, Random& random) {
  const Json& clip = test["clips"][0];
  Json answers = Json::object();
  for (const auto& question : test["questions"]) {
    const auto& options = question["options"].empty() ? clip["choices"] : question["options"];
    answers[question["id"].get<std::string>()] = {{"option", random.below(options.size())},
                                                  {"seconds", random.uniform(1, 20)}};
  }
  return {{"clip", clip["id"]}, {"plays", 1 + random.below(4)}, {"answers", answers}};
}

void note(const Json& sent, const Json& test, std::vector<Answer>& given) {
  for (const auto& question : test["questions"]) {
    const auto& answer = sent["answers"][question["id"].get<std::string>()];
    Answer& one = given.emplace_back();
    one.clip = sent["clip"];
    one.question = question["id"];
    one.option = answer["option"];
    one.position = test["position"];
    one.plays = sent["plays"];
    one.seconds = answer["seconds"];
  }
}

}  // namespace

Reply ask(int port, const std::string& path, const Json& body) {
  httplib::Client client("127.0.0.1", port);
  client.set_read_timeout(30);
  const auto response = body.is_null() ? client.Get(path) : client.Post(path, body.dump(), "application/json");
  if (!response) throw std::runtime_error(fmt::format("{}: {}", path, httplib::to_string(response.error())));
  return {response->status, Json::parse(response->body, nullptr, false)};
}

std::vector<Answer> take_study(int port, const std::string& start_path, std::uint64_t seed,
                               const std::function<void(double)>& saved) {
  Random random(seed);
  const auto path =
      "/" + expect(201, ask(port, start_path + "/consent", Json::object())).json["link"].get<std::string>();
  Json state = expect(200, ask(port, path + "/state")).json;
  state = expect(200, ask(port, path + "/profile", profile_of(state, random))).json;
  std::vector<Answer> given;
  while (state["stage"] == "test") {
    const Json test = state["test"];
    expect(200, ask(port, fmt::format("{}/clips/{}.webm", path, test["clips"][0]["id"].get<std::string>())));
    const Json sent = answers_of(test, random);
    note(sent, test, given);
    const auto begun = std::chrono::steady_clock::now();
    state = expect(200, ask(port, path + "/answers", sent)).json;
    saved(std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
    if (random.below(4) == 0) state = expect(200, ask(port, path + "/answers", answers_of(test, random))).json;
  }
  return given;
}

}  // namespace talkgraph::study
