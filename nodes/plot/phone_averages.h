#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "nodes/plot/svg.h"
#include "nodes/types/phones.h"

namespace talkgraph {

/// Mean trajectories of some lines through phones: each occurrence of a phone, with `margin` frames on both sides, is
/// stretched to unit length.
class PhoneAverages {
 public:
  explicit PhoneAverages(int margin) : margin_(margin) {}

  /// The phones of a sequence, pauses left out; frames that a line lacks are its last one.
  void add(const FrameLabels& labels, const std::vector<Eigen::VectorXd>& lines);

  /// The phones met most, the first by name of equals.
  std::vector<std::string> most_frequent(int count) const;

  /// Of a phone that was met or not, with how often; `names` are those of the lines, `band` is ± a standard deviation.
  Panel panel(const std::string& phone, const std::vector<std::string>& names, bool band) const;

 private:
  struct Sums {
    int count = 0;
    Eigen::ArrayXXd values, squares;  ///< points x lines
  };
  int margin_;
  std::map<std::string, Sums> phones_;
};

}  // namespace talkgraph
