#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "nodes/types/shape.h"

namespace talkgraph {

/// Numbers read from a file, one row a frame.
struct NumberTable {
  std::vector<std::string> names;  ///< of the columns; empty without a header line
  Eigen::MatrixXd values;
};

/// Comma-separated numbers; a first line that is not numbers names the columns.
NumberTable read_csv(const std::string& path);

/// NumPy .npy of float32 or float64, C order, two dimensions (one: a column).
Eigen::MatrixXd read_npy(const std::string& path);

/// A table by the ending of its name: .csv, .npy, or .h5/.hdf5, which needs the name of
/// a two-dimensional data set. Throws std::runtime_error naming the file (and the line)
/// if it is malformed, empty, or holds a number that is not finite.
NumberTable read_table(const std::string& path, const std::string& dataset);

/// Landmarks: a CSV with columns x0,y0,x1,y1,... (a first column "frame" counts 0, 1,
/// ...), 0-based pixels; or a folder of .pts files, one a frame in the order of their
/// names, whose 1-based pixels become 0-based. `scheme` empty: "ibug68" for 68 points.
LandmarkTrack read_landmarks(const std::string& path, Rational rate, const std::string& scheme = "");

}  // namespace talkgraph
