#pragma once

#include <string>
#include <vector>

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The 39 CMU phones, "sil" and "breath".
std::vector<std::string> cmu_phones();

/// Labels as indicators, one column a label of the alphabet (T × labels), to be
/// joined to speech features; `weight` in the frame's own column, else 0. Throws std::runtime_error on a label outside
/// it.
struct OneHot {
  std::vector<std::string> alphabet = cmu_phones();
  double weight = 1;

  Track operator()(const FrameLabels& labels) const;
};
void describe(Description<OneHot>& d);

}  // namespace talkgraph
