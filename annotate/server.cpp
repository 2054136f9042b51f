#include "annotate/server.h"

#include <fmt/format.h>

#include <stdexcept>

#include "nodes/codecs/codecs.h"
#include "nodes/types/codec.h"
#include "web/server.h"

namespace talkgraph::annotate {
namespace {

using httplib::Request;
using httplib::Response;
using web::answer;
using web::Refusal;

constexpr const char* page_html =
#include "annotate/index.html.inc"
    ;
constexpr const char* page_style =
#include "annotate/annotate.css.inc"
    ;
constexpr const char* page_script =
#include "annotate/annotate.js.inc"
    ;

constexpr auto address = "127.0.0.1";
constexpr std::size_t longest_body = 1 << 18;

Json to_json(const Shape& points) {
  Json all = Json::array();
  for (const auto& point : points.rowwise()) all.push_back({point.x(), point.y()});
  return all;
}

Shape points_in(const Json& json) {
  if (!json.is_array()) throw Refusal(400, "\"points\" is a list of [x, y]");
  Shape points(std::ssize(json), 2);
  for (std::size_t i = 0; i < json.size(); ++i) {
    const Json& point = json[i];
    if (!point.is_array() || point.size() != 2 || !point[0].is_number() || !point[1].is_number())
      throw Refusal(400, "\"points\" is a list of [x, y]");
    points.row(static_cast<Eigen::Index>(i)) << point[0].get<double>(), point[1].get<double>();
  }
  return points;
}

Annotation annotation_in(const std::string& body) {
  constexpr int deepest = 4;
  const auto expected = "an object with \"points\" and \"done\" is expected";
  const auto json = web::parse(body, deepest, expected);
  if (!json.is_object() || !json.contains("points") || !json.contains("done") || !json["done"].is_boolean())
    throw Refusal(400, expected);
  return {points_in(json["points"]), json["done"].get<bool>()};
}

const char* state_of(const Kept& kept) {
  if (!kept.broken.empty()) return "broken";
  return !kept.annotation ? "new" : kept.annotation->done ? "done" : "draft";
}

Json state_and_tag(const Kept& kept) {
  Json json = {{"state", state_of(kept)}, {"tag", tag_of(kept)}};
  if (!kept.broken.empty()) json["reason"] = kept.broken;
  return json;
}

Json to_json(const Kept& kept) {
  Json json = state_and_tag(kept);
  if (kept.annotation) json["points"] = to_json(kept.annotation->points);
  return json;
}

Json to_json(const Beginning& beginning) {
  constexpr const char* names[] = {"scheme", "examples", "model"};
  return {{"points", to_json(beginning.points)}, {"by", names[static_cast<int>(beginning.by)]}};
}

Json to_json(const PointScheme& scheme) {
  Json groups = Json::array();
  for (const auto& group : scheme.groups)
    groups.push_back({{"name", group.name}, {"points", group.points}, {"closed", group.closed}});
  return {{"name", scheme.name}, {"points", scheme.points()}, {"groups", groups}, {"pairs", scheme.pairs}};
}

/// A name that leads here only by a trick (DNS rebinding), or a page of another site, is not served.
void check_source(const Request& request) {
  const auto name = web::host_of(request);
  if (name != address && name != "localhost")
    throw Refusal(403, "this server is reached as 127.0.0.1 or localhost, and by no other name");
  if (request.has_header("Origin") &&
      request.get_header_value("Origin") != "http://" + request.get_header_value("Host"))
    throw Refusal(403, "a page of another origin asks");
  if (request.has_header("Range")) throw Refusal(400, "a request with Range is not served");
}

}  // namespace

struct Server::State {
  explicit State(Project& project) : project(project) {}

  std::size_t frame_of(const Request& request) const {
    if (const auto frame = project.find(request.matches[1].str())) return *frame;
    throw Refusal(404, "there is no such frame");
  }

  Json describe() const {
    Json frames = Json::array();
    for (std::size_t f = 0; f < project.frames().size(); ++f)
      frames.push_back({{"key", project.key(f)},
                        {"clip", project.clip(f)},
                        {"number", project.frames()[f].number},
                        {"phone", project.frames()[f].phone}});
    return {{"manifest", project.manifest()}, {"scheme", to_json(project.scheme())}, {"frames", frames}};
  }

  Json states() const {
    Json all = Json::array();
    for (std::size_t f = 0; f < project.frames().size(); ++f) {
      all.push_back({{"key", project.key(f)}});
      all.back().update(state_and_tag(project.kept(f)));
    }
    return all;
  }

  Json read(std::size_t frame) const {
    const auto kept = project.kept(frame);
    Json json = to_json(kept);
    if (!kept.annotation) json.update(to_json(project.begin(frame, context)));
    return json;
  }

  void write(const Request& request, Response& response) const {
    if (request.get_header_value("Content-Type") != "application/json") throw Refusal(415, "JSON is expected");
    if (!request.has_header("If-Match")) throw Refusal(428, "If-Match must say which state was changed");
    const auto written =
        project.annotate(frame_of(request), annotation_in(request.body), request.get_header_value("If-Match"));
    answer(response, to_json(written.now), written.kept ? 200 : 412);
  }

  void send_picture(std::size_t frame, Response& response) const {
    std::vector<std::uint8_t> png;
    codec<decltype(codec_encode_png)>("codec_encode_png")(project.picture(frame, context), png);
    response.set_content(reinterpret_cast<const char*>(png.data()), png.size(), "image/png");
  }

  void route() {
    const auto page = [](const char* text, const char* type) {
      return [=](const Request&, Response& response) { response.set_content(text, type); };
    };
    server.Get("/", page(page_html, "text/html; charset=utf-8"));
    server.Get("/annotate.css", page(page_style, "text/css; charset=utf-8"));
    server.Get("/annotate.js", page(page_script, "text/javascript; charset=utf-8"));
    server.Get("/api/project", [this](const Request&, Response& out) { answer(out, describe()); });
    server.Get("/api/frames", [this](const Request&, Response& out) { answer(out, states()); });
    const std::string frame = "/api/frames/([0-9a-f]{32})";
    server.Get(frame, [this](const Request& in, Response& out) { answer(out, read(frame_of(in))); });
    server.Get(frame + "/begin", [this](const Request& in, Response& out) {
      answer(out, to_json(project.begin(frame_of(in), context)));
    });
    server.Get(frame + "/picture", [this](const Request& in, Response& out) { send_picture(frame_of(in), out); });
    server.Put(frame, [this](const Request& in, Response& out) { write(in, out); });
  }

  Project& project;
  Context context;
  web::Server server{{.longest_body = longest_body, .policy = "img-src 'self'", .check = check_source}};
};

Server::Server(Project& project, int port) : state_(std::make_unique<State>(project)) {
  state_->route();
  const auto got = state_->server.bind(address, port);
  if (!got)
    throw std::runtime_error(fmt::format("port {} is taken: name another with --port, or 0 for any free one", port));
  port_ = *got;
}

Server::~Server() = default;

std::string Server::url() const { return fmt::format("http://{}:{}/", address, port_); }

void Server::run(const std::atomic<bool>& stop) {
  state_->context.cancel = &stop;
  state_->server.run(stop);
}

}  // namespace talkgraph::annotate
