#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace talkgraph {

/// Numbers read from a file, one row a frame.
struct NumberTable {
  std::vector<std::string> names;  ///< of the columns; empty without a header line
  Eigen::MatrixXd values;
  std::vector<int> lines;  ///< of a CSV, that each row stands in
};

/// Comma-separated numbers, "nan" among them; a first line without a number names the columns. Throws
/// std::runtime_error naming the file and the line.
NumberTable read_csv(const std::string& path);

/// NumPy .npy of float32 or float64, C order, two dimensions (one: a column).
Eigen::MatrixXd read_npy(const std::string& path);

/// A table by the ending of its name: .csv, .npy, or .h5/.hdf5, which needs the name of
/// a two-dimensional data set. Throws std::runtime_error naming the file (and the line)
/// if it is malformed, empty, or holds a number that is not finite.
NumberTable read_table(const std::string& path, const std::string& dataset);

}  // namespace talkgraph
