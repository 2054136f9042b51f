#include "nodes/speech/one_hot.h"

#include <algorithm>
#include <stdexcept>

namespace talkgraph {

std::vector<std::string> cmu_phones() {
  return {"aa", "ae", "ah", "ao", "aw", "ay", "b", "ch", "d", "dh", "eh", "er",  "ey",    "f",
          "g",  "hh", "ih", "iy", "jh", "k",  "l", "m",  "n", "ng", "ow", "oy",  "p",     "r",
          "s",  "sh", "t",  "th", "uh", "uw", "v", "w",  "y", "z",  "zh", "sil", "breath"};
}

Track OneHot::operator()(const FrameLabels& labels) const {
  const auto frames = static_cast<Eigen::Index>(labels.labels.size());
  Track out;
  out.rate = labels.rate;
  out.start = 0.5 / labels.rate.value();
  out.names = alphabet;
  out.values.setZero(frames, static_cast<Eigen::Index>(alphabet.size()));
  for (Eigen::Index t = 0; t < frames; ++t) {
    const auto& label = labels.labels[static_cast<std::size_t>(t)];
    const auto found = std::find(alphabet.begin(), alphabet.end(), label);
    if (found == alphabet.end())
      throw std::runtime_error("frame " + std::to_string(t) + ": label \"" + label +
                               "\" is not in the alphabet; add it there");
    out.values(t, found - alphabet.begin()) = weight;
  }
  return out;
}

void describe(Description<OneHot>& d) {
  d.type("speech.one_hot").summary("phone labels as indicator columns");
  d.input("labels", "phone of every frame").output("track", "T x alphabet, the weight in one column, else 0");
  d.param("alphabet", &OneHot::alphabet).doc("a column each; CMU phones, sil and breath by default");
  d.param("weight", &OneHot::weight).positive().doc("of the indicators, where distances are to be measured");
}

}  // namespace talkgraph
