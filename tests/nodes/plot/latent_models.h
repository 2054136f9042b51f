#pragma once

#include <cmath>
#include <string>

#include "nodes/latent/sgpdm.h"
#include "nodes/types/ssgpdm.h"

namespace talkgraph::test {

/// A state of `windows` windows that bend through time, after a few iterations of training.
inline Sgpdm bent_state(const std::string& label, int windows, int length, int d = 3, int iterations = 4) {
  StateData data{label, {}, {}};
  for (int w = 0; w < windows; ++w) {
    Eigen::MatrixXd y(length, 5), z(length, 4);
    for (int t = 0; t < length; ++t) {
      for (int k = 0; k < 5; ++k) y(t, k) = std::sin(0.7 * t + k) + 0.3 * std::cos(1.1 * w * (k + 1));
      for (int k = 0; k < 4; ++k) z(t, k) = std::cos(0.5 * t * (k + 1)) + 0.2 * std::sin(2.3 * w + k);
    }
    data.audio.push_back(y);
    data.visual.push_back(z);
  }
  TrainSgpdm train;
  train.latent_dimension = d;
  train.iterations = iterations;
  Context context;
  return train(data, context);
}

inline Ssgpdm switching(const std::vector<Sgpdm>& states) {
  Ssgpdm model;
  for (const auto& s : states) model.states[s.label] = s;
  return model;
}

}  // namespace talkgraph::test
