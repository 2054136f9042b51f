#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "graph/json.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/shape.h"

namespace talkgraph {

/// What the points of a face stand for: docs/schemes.md.
struct PointScheme {
  /// A line through its points, in order; a closed one ends where it begins.
  struct Group {
    std::string name;
    std::vector<int> points;
    bool closed = false;
  };

  std::string name;
  std::vector<Group> groups;
  std::map<std::string, int> names;        ///< single points: "mouth_left"
  std::vector<std::pair<int, int>> pairs;  ///< points that mirror each other
  Triangles triangles;                     ///< no rows: Delaunay's of the mean shape
  Shape mean;                              ///< an average face, any unit

  Eigen::Index points() const { return mean.rows(); }
  /// The points of a group, or the single point of that name. Throws std::runtime_error if there is neither.
  std::vector<int> named(const std::string& part) const;
  /// A single point. Throws std::runtime_error if none has the name.
  int point(const std::string& name) const;
};

/// Reads a scheme; whatever is wrong goes to `diagnostics`, and nothing is given.
std::optional<PointScheme> parse_scheme(std::shared_ptr<const SourceText> source, Diagnostics& diagnostics);

/// Names of the schemes that are built in: the files of the folder schemes.
std::vector<std::string> built_in_schemes();

/// What to say of a name that no scheme has.
std::string unknown_scheme(const std::string& name);

/// What landmarks say of their scheme: the name of a built-in one, or the text of a scheme file.
/// Nothing is given for a name that is unknown.
std::optional<PointScheme> find_scheme(const std::string& scheme);

/// The same; 68 points that say nothing are "ibug68". Throws std::runtime_error if the scheme is unknown or of another
/// number of points.
PointScheme scheme_of(const std::string& scheme, Eigen::Index points);
/// Of the landmarks of a clip, which must have a frame.
PointScheme scheme_of(const LandmarkTrack& landmarks);

}  // namespace talkgraph
