#include "nodes/types/scheme.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace talkgraph {
namespace {

using Kind = LocatedJson::Kind;

struct BuiltIn {
  const char* name;
  const char* text;
};
constexpr BuiltIn built_in[] = {
#include "nodes/types/schemes.inc"
};

class Reader {
 public:
  explicit Reader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  PointScheme read(const LocatedJson& json) {
    PointScheme scheme;
    if (!expect(json, Kind::object, "a scheme is an object with \"name\", \"groups\", \"pairs\", \"mean\""))
      return scheme;
    check_members(json, {"name", "description", "groups", "names", "pairs", "triangles", "mean"});
    if (const auto* mean = needed(json, "mean")) read_mean(*mean, scheme);
    if (const auto* name = needed(json, "name")) scheme.name = text(*name);
    if (const auto* groups = json.find("groups")) read_groups(groups->value, scheme);
    if (const auto* names = json.find("names")) read_names(names->value, scheme);
    if (const auto* pairs = json.find("pairs")) read_pairs(pairs->value, scheme);
    if (const auto* triangles = json.find("triangles")) read_triangles(triangles->value, scheme);
    return scheme;
  }

 private:
  bool expect(const LocatedJson& json, Kind kind, const std::string& what) {
    if (json.is(kind)) return true;
    diagnostics_.error(json.place, fmt::format("{}; got {}", what, json.kind_name()));
    return false;
  }

  void check_members(const LocatedJson& json, const std::vector<std::string>& known) {
    for (const auto& member : json.members)
      if (std::find(known.begin(), known.end(), member.key) == known.end())
        diagnostics_.error(member.key_place,
                           fmt::format("unknown member \"{}\"{}", member.key, did_you_mean(member.key, known)));
  }

  const LocatedJson* needed(const LocatedJson& json, const char* key) {
    if (const auto* member = json.find(key)) return &member->value;
    diagnostics_.error(json.place, fmt::format("\"{}\" is missing", key));
    return nullptr;
  }

  std::string text(const LocatedJson& json) {
    if (!expect(json, Kind::text, "a name is expected")) return {};
    auto name = json.scalar.get<std::string>();
    if (name.empty()) diagnostics_.error(json.place, "a name must not be empty");
    return name;
  }

  double coordinate(const LocatedJson& json) {
    constexpr double most = 1e6;
    if (!expect(json, Kind::number, "a number is expected")) return 0;
    const auto value = json.scalar.get<double>();
    if (!(std::abs(value) <= most))
      diagnostics_.error(json.place, fmt::format("a number from {:g} to {:g} is expected", -most, most));
    return value;
  }

  /// A list of point numbers, each once.
  std::vector<int> points(const LocatedJson& json, const PointScheme& scheme, const char* what) {
    std::vector<int> all;
    if (!expect(json, Kind::array, what)) return all;
    for (const auto& item : json.items) {
      const int point = one_point(item, scheme);
      if (std::find(all.begin(), all.end(), point) != all.end())
        diagnostics_.error(item.place, fmt::format("point {} stands here twice", point));
      all.push_back(point);
    }
    return all;
  }

  /// Counts from 0; what is no point is complained of and becomes -1 minus the number of complaints: no two are equal.
  int one_point(const LocatedJson& json, const PointScheme& scheme) {
    const bool whole = json.is(Kind::number) && json.scalar.is_number_integer();
    const auto value = whole ? json.scalar.get<std::int64_t>() : -1;
    if (whole && value >= 0 && value < scheme.points()) return static_cast<int>(value);
    diagnostics_.error(json.place, fmt::format("a point is expected, 0 to {}", scheme.points() - 1));
    return -1 - static_cast<int>(diagnostics_.messages().size());
  }

  void read_mean(const LocatedJson& json, PointScheme& scheme) {
    constexpr auto what = "\"mean\" is a list of [x, y], one a point";
    if (!expect(json, Kind::array, what)) return;
    scheme.mean = Shape::Zero(std::ssize(json.items), 2);
    for (std::size_t i = 0; i < json.items.size(); ++i) {
      const auto& item = json.items[i];
      if (!item.is(Kind::array) || item.items.size() != 2)
        diagnostics_.error(item.place, what);
      else
        scheme.mean.row(static_cast<Eigen::Index>(i)) << coordinate(item.items[0]), coordinate(item.items[1]);
    }
    if (scheme.points() < 3)
      diagnostics_.error(json.place, fmt::format("a face needs at least 3 points, got {}", scheme.points()));
    else
      check_mean(json, scheme.mean);
  }

  /// Points must lie apart from each other and not on a line, by more than rounding.
  void check_mean(const LocatedJson& json, const Shape& mean) {
    constexpr double apart = 1e-6;  // of the face's size
    const Eigen::MatrixXd centred = mean.rowwise() - mean.colwise().mean();
    const Eigen::Vector2d size = centred.jacobiSvd().singularValues();
    if (!(size(1) > apart * size(0))) return diagnostics_.error(json.place, "the points of \"mean\" lie on one line");
    for (Eigen::Index i = 1; i < mean.rows(); ++i)
      for (Eigen::Index j = 0; j < i; ++j)
        if ((mean.row(i) - mean.row(j)).norm() <= apart * size(0))
          diagnostics_.error(json.items[static_cast<std::size_t>(i)].place,
                             fmt::format("point {} lies where point {} does", i, j));
  }

  void claim(const Place& place, const std::string& name) {
    if (!taken_.insert(name).second) diagnostics_.error(place, fmt::format("the name \"{}\" is taken already", name));
  }

  void read_groups(const LocatedJson& json, PointScheme& scheme) {
    if (!expect(json, Kind::array, "\"groups\" is a list")) return;
    for (const auto& item : json.items) {
      if (!expect(item, Kind::object, "a group is an object with \"name\" and \"points\"")) continue;
      check_members(item, {"name", "points", "closed"});
      PointScheme::Group group;
      if (const auto* name = needed(item, "name")) claim(name->place, group.name = text(*name));
      if (const auto* list = needed(item, "points")) {
        group.points = points(*list, scheme, "\"points\" is a list");
        if (group.points.empty()) diagnostics_.error(list->place, "a group needs a point");
      }
      if (const auto* closed = item.find("closed");
          closed && expect(closed->value, Kind::boolean, "\"closed\" is true or false"))
        group.closed = closed->value.scalar.get<bool>();
      scheme.groups.push_back(std::move(group));
    }
  }

  void read_names(const LocatedJson& json, PointScheme& scheme) {
    if (!expect(json, Kind::object, "\"names\" is an object from names to points")) return;
    for (const auto& member : json.members) {
      if (member.key.empty()) diagnostics_.error(member.key_place, "a name must not be empty");
      claim(member.key_place, member.key);
      scheme.names[member.key] = one_point(member.value, scheme);
    }
  }

  void read_pairs(const LocatedJson& json, PointScheme& scheme) {
    if (!expect(json, Kind::array, "\"pairs\" is a list of [point, point]")) return;
    std::set<int> paired;
    for (const auto& item : json.items) {
      const auto pair = points(item, scheme, "a pair is [point, point]");
      if (pair.size() != 2) {
        diagnostics_.error(item.place, "a pair is [point, point]");
        continue;
      }
      for (const int point : pair)
        if (!paired.insert(point).second)
          diagnostics_.error(item.place, fmt::format("point {} is in another pair already", point));
      scheme.pairs.emplace_back(pair[0], pair[1]);
    }
  }

  void read_triangles(const LocatedJson& json, PointScheme& scheme) {
    if (!expect(json, Kind::array, "\"triangles\" is a list of [point, point, point]")) return;
    scheme.triangles.resize(std::ssize(json.items), 3);
    std::set<std::set<int>> drawn;
    for (std::size_t i = 0; i < json.items.size(); ++i) {
      const auto corners = points(json.items[i], scheme, "a triangle is [point, point, point]");
      if (!drawn.insert({corners.begin(), corners.end()}).second)
        diagnostics_.error(json.items[i].place, "this triangle stands here twice");
      if (corners.size() == 3)
        scheme.triangles.row(static_cast<Eigen::Index>(i)) << corners[0], corners[1], corners[2];
      else
        diagnostics_.error(json.items[i].place, "a triangle is [point, point, point]");
    }
  }

  Diagnostics& diagnostics_;
  std::set<std::string> taken_;
};

}  // namespace

std::vector<int> PointScheme::named(const std::string& part) const {
  for (const auto& group : groups)
    if (group.name == part) return group.points;
  if (const auto single = names.find(part); single != names.end()) return {single->second};
  std::vector<std::string> known;
  for (const auto& group : groups) known.push_back(group.name);
  for (const auto& [single, point] : names) known.push_back(single);
  throw std::runtime_error(
      fmt::format("the point scheme \"{}\" has no group or point \"{}\"{}", name, part, did_you_mean(part, known)));
}

int PointScheme::point(const std::string& part) const {
  const auto points = named(part);
  if (points.size() != 1)
    throw std::runtime_error(fmt::format("\"{}\" of the point scheme \"{}\" is {} points", part, name, points.size()));
  return points[0];
}

std::optional<PointScheme> parse_scheme(std::shared_ptr<const SourceText> source, Diagnostics& diagnostics) {
  const auto before = diagnostics.messages().size();
  const auto json = parse_json(std::move(source), diagnostics);
  if (!json) return {};
  auto scheme = Reader(diagnostics).read(*json);
  if (diagnostics.messages().size() > before) return {};
  return scheme;
}

std::vector<std::string> built_in_schemes() {
  std::vector<std::string> names;
  for (const auto& scheme : built_in) names.emplace_back(scheme.name);
  return names;
}

std::string unknown_scheme(const std::string& name) {
  const auto known = built_in_schemes();
  return fmt::format("there is no point scheme \"{}\"{}; built in are {}, others are named by their .json file", name,
                     did_you_mean(name, known), fmt::join(known, ", "));
}

std::optional<PointScheme> find_scheme(const std::string& scheme) {
  std::string text = scheme;
  for (const auto& known : built_in)
    if (scheme == known.name) text = known.text;
  if (!text.starts_with('{')) return {};
  Diagnostics diagnostics;
  auto parsed = parse_scheme(std::make_shared<SourceText>(SourceText{"point scheme", text}), diagnostics);
  if (!parsed) throw std::runtime_error(diagnostics.str());
  return parsed;
}

PointScheme scheme_of(const std::string& scheme, Eigen::Index points) {
  if (scheme.empty() && points != 68)
    throw std::runtime_error(
        fmt::format("nothing says which of {} landmarks is which: name their scheme ({}, or a file) in the manifest",
                    points, fmt::join(built_in_schemes(), ", ")));
  auto found = find_scheme(scheme.empty() ? "ibug68" : scheme);
  if (!found) throw std::runtime_error(unknown_scheme(scheme));
  if (found->points() != points)
    throw std::runtime_error(
        fmt::format("the point scheme \"{}\" has {} points, the landmarks {}", found->name, found->points(), points));
  return *std::move(found);
}

PointScheme scheme_of(const LandmarkTrack& landmarks) {
  if (landmarks.frames.empty()) throw std::runtime_error("there are no landmarks");
  return scheme_of(landmarks.scheme, landmarks.frames.front().rows());
}

}  // namespace talkgraph
