#include "study/server.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "study/messages.h"
#include "study/range.h"
#include "study/store.h"
#include "web/server.h"

namespace talkgraph::study {
namespace {

using httplib::Request;
using httplib::Response;
using web::answer;
using web::Refusal;

constexpr const char* page_html =
#include "study/index.html.inc"
    ;
constexpr const char* page_style =
#include "study/study.css.inc"
    ;
constexpr const char* page_script =
#include "study/study.js.inc"
    ;

constexpr auto endings = {"webm", "mp4"};

std::filesystem::path clip_file(const std::filesystem::path& folder, const std::string& id, const std::string& ending) {
  return folder / "clips" / fmt::format("{}.{}", id, ending);
}

Study read_whole(const std::filesystem::path& folder) {
  auto study = read_study(folder);
  for (const auto& test : study.tests)
    for (const auto& clip : test.clips)
      for (const char* ending : endings)
        if (const auto file = clip_file(folder, clip.id, ending); !std::filesystem::is_regular_file(file))
          throw std::runtime_error(fmt::format("{}: is missing; `talkgraph study make` makes it", file.string()));
  return study;
}

std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in || bytes.empty()) throw Refusal(503, "the clip cannot be read now");
  return bytes;
}

bool is_loopback(const std::string& name) {
  in_addr address{};
  if (inet_pton(AF_INET, name.c_str(), &address) == 1) return ntohl(address.s_addr) >> 24 == 127;
  return name == "localhost" || name == "::1" || name == "[::1]";
}

/// Of an address, in links: that of all addresses is this computer's name.
std::string name_for_others(const std::string& address) {
  if (address == "0.0.0.0" || address == "::") {
    char name[256] = {};
    if (gethostname(name, sizeof name - 1) == 0) return name;
  }
  return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

/// "https://study.example:81" of "https://study.example:81/faces".
std::string origin_of(const std::string& url) {
  const auto name = url.find("://");
  return name == std::string::npos ? std::string() : url.substr(0, url.find('/', name + 3));
}

/// A name that leads here only by a trick (DNS rebinding), or a page of another site, is not served.
void check_source(const Request& request, bool loopback, const std::string& origin) {
  const auto host = request.get_header_value("Host");
  const bool known = !origin.empty() && origin.ends_with("//" + host);
  if (loopback && !known && !is_loopback(web::host_of(request))) throw Refusal(403, "this server has another name");
  const auto from = request.get_header_value("Origin");
  if (request.has_header("Origin") && from != "http://" + host && from != origin)
    throw Refusal(403, "a page of another origin asks");
}

Json body_of(const Request& request) {
  constexpr int deepest = 3;
  if (request.get_header_value("Content-Type") != "application/json") throw Refusal(415, "JSON is expected");
  return web::parse(request.body, deepest, "JSON is expected");
}

void send(const std::string& bytes, const char* type, const Request& request, Response& response) {
  const auto range = range_of(request.get_header_value("Range"), bytes.size());
  response.set_header("Accept-Ranges", "bytes");
  if (range && range->length == 0) {
    response.status = 416;
    response.set_header("Content-Range", fmt::format("bytes */{}", bytes.size()));
    return;
  }
  if (range) {
    response.status = 206;
    response.set_header("Content-Range",
                        fmt::format("bytes {}-{}/{}", range->first, range->first + range->length - 1, bytes.size()));
  }
  response.headers.erase("Cache-Control");
  response.set_header("Cache-Control", "private, max-age=3600");
  response.set_content(range ? bytes.substr(range->first, range->length) : bytes, type);
}

}  // namespace

struct Server::State {
  State(const std::filesystem::path& folder, ServerOptions given)
      : folder(folder), options(std::move(given)), study(read_whole(folder)), store(folder, study) {
    route();
    server.set_exception_handler([this](const Request&, Response& response, const std::exception_ptr& failure) {
      answer_failure(response, failure);
    });
    const auto got = server.bind(options.listen, options.port);
    if (!got)
      throw std::runtime_error(
          fmt::format("port {} of {} cannot be had: name another with --port, or 0 for any free one, "
                      "and an address of this computer",
                      options.port, options.listen));
    port = *got;
    if (options.url.empty()) options.url = fmt::format("http://{}:{}", name_for_others(options.listen), port);
    if (options.url.ends_with('/')) options.url.pop_back();
  }

  /// People are not told about files of this computer.
  void answer_failure(Response& response, const std::exception_ptr& failure) const {
    try {
      std::rethrow_exception(failure);
    } catch (const DatabaseError& e) {
      options.warn(e.what());
      answer(response, {{"error", "answers cannot be kept now"}}, 503);
    } catch (const Refusal& e) {
      answer(response, {{"error", e.what()}}, e.status);
    } catch (const std::exception& e) {
      options.warn(e.what());
      answer(response, {{"error", "the server failed"}}, 500);
    }
  }

  Taker taker_of(const Request& request) const {
    if (const auto taker = store.find(request.matches[1].str())) return *taker;
    throw Refusal(404, "this link is not known");
  }

  void check_token(const Request& request, const std::string& token) const {
    if (request.matches[1].str() != token) throw Refusal(404, "this link is not known");
  }

  void answer_state(const Request& request, Response& response) const {
    answer(response, state_of(study, taker_of(request)));
  }

  void begin(const Request& request, Response& response) {
    check_token(request, store.start_token());
    const auto token = store.invite(true);
    if (!token) throw Refusal(403, "no more people can take part");
    answer(response, {{"link", "p/" + *token}}, 201);
  }

  void take_consent(const Request& request, Response& response) {
    store.agree(taker_of(request));
    answer_state(request, response);
  }

  void take_profile(const Request& request, Response& response) {
    const auto taker = taker_of(request);
    const auto profile = profile_in(body_of(request), study);
    if (!taker.agreed) throw Refusal(409, "nobody has agreed yet");
    store.keep_profile(taker, profile);
    answer_state(request, response);
  }

  void take_answers(const Request& request, Response& response) {
    const auto start = std::chrono::steady_clock::now();
    const auto taker = taker_of(request);
    const auto json = body_of(request);
    const auto shown = plan(study, taker.seed);
    const auto clip = clip_in(json, shown);
    const auto answers = answers_in(json, shown[clip]);
    if (!taker.started || clip > taker.clips) throw Refusal(409, "other questions come first");
    store.keep(taker, clip, answers, clip + 1 == shown.size());
    answer_state(request, response);
    options.saved(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }

  void send_clip(const Request& request, Response& response) const {
    const auto id = request.matches[2].str(), ending = request.matches[3].str();
    const auto taker = taker_of(request);
    clip_in({{"clip", id}}, plan(study, taker.seed));
    if (!taker.started) throw Refusal(409, "other questions come first");
    send(read_file(clip_file(folder, id, ending)), ending == "mp4" ? "video/mp4" : "video/webm", request, response);
  }

  void report(const Request& request, Response& response) const {
    check_token(request, store.report_token());
    const auto counts = store.counts();
    answer(response, {{"invited", counts.invited},
                      {"started", counts.started},
                      {"finished", counts.finished},
                      {"answers", counts.answers}});
  }

  void report_answers(const Request& request, Response& response) const {
    check_token(request, store.report_token());
    const auto answers = read_answers(folder);
    if (request.matches[2].str() == "json")
      answer(response, to_json(answers));
    else
      response.set_content(to_csv(answers), "text/csv; charset=utf-8");
  }

  void route() {
    const auto file = [](const char* text, const char* type) {
      return [=](const Request&, Response& response) { response.set_content(text, type); };
    };
    server.Get("/study.css", file(page_style, "text/css; charset=utf-8"));
    server.Get("/study.js", file(page_script, "text/javascript; charset=utf-8"));
    server.Get("/(?:start|p)/[0-9a-f]{32}", file(page_html, "text/html; charset=utf-8"));
    const std::string start = "/start/([0-9a-f]{32})", person = "/p/([0-9a-f]{32})", report = "/report/([0-9a-f]{32})";
    server.Get(start + "/state", [this](const Request& in, Response& out) {
      check_token(in, store.start_token());
      answer(out, consent_of(study));
    });
    server.Post(start + "/consent", [this](const Request& in, Response& out) { begin(in, out); });
    server.Get(person + "/state", [this](const Request& in, Response& out) { answer_state(in, out); });
    server.Post(person + "/consent", [this](const Request& in, Response& out) { take_consent(in, out); });
    server.Post(person + "/profile", [this](const Request& in, Response& out) { take_profile(in, out); });
    server.Post(person + "/answers", [this](const Request& in, Response& out) { take_answers(in, out); });
    server.Get(person + "/clips/([0-9A-Za-z_-]{1,64})\\.(webm|mp4)",
               [this](const Request& in, Response& out) { send_clip(in, out); });
    server.Get(report, [this](const Request& in, Response& out) { this->report(in, out); });
    server.Get(report + "/answers\\.(json|csv)", [this](const Request& in, Response& out) { report_answers(in, out); });
  }

  const std::filesystem::path folder;
  ServerOptions options;
  const Study study;
  Store store;
  web::Server server{{.policy = "media-src 'self' blob:", .check = [this](const Request& request) {
                        check_source(request, is_loopback(options.listen), origin_of(options.url));
                      }}};
  int port = 0;
};

Server::Server(const std::filesystem::path& folder, ServerOptions options)
    : state_(std::make_unique<State>(folder, std::move(options))) {}

Server::~Server() = default;

std::string Server::start_url() const {
  return fmt::format("{}/start/{}", state_->options.url, state_->store.start_token());
}

std::string Server::report_url() const {
  return fmt::format("{}/report/{}", state_->options.url, state_->store.report_token());
}

std::string Server::invite() {
  const auto token = state_->store.invite();
  if (!token) throw std::runtime_error("there are as many participants as there may be");
  return fmt::format("{}/p/{}", state_->options.url, *token);
}

int Server::port() const { return state_->port; }

void Server::run(const std::atomic<bool>& stop) { state_->server.run(stop); }

}  // namespace talkgraph::study
