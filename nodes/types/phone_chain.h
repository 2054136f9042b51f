#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "graph/archive.h"

namespace talkgraph {

/// How phones follow each other, a frame a step: a Markov chain of K phones.
struct PhoneChain {
  std::vector<std::string> phones;  ///< K, sorted
  Eigen::VectorXd start;            ///< p(π_1), of recordings and after lost frames, K
  Eigen::MatrixXd transitions;      ///< p(π_t = column | π_{t−1} = row), K × K

  Eigen::Index size() const { return std::ssize(phones); }
};
void fields(Archive& ar, PhoneChain& c);

}  // namespace talkgraph
