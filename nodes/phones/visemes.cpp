#include "nodes/phones/visemes.h"

#include <stdexcept>

#include "nodes/types/visemes.h"

namespace talkgraph {

PhoneTrack ToVisemes::operator()(const PhoneTrack& phones) const {
  PhoneTrack visemes = phones;
  for (auto& interval : visemes.phones) {
    const auto label = viseme_label(interval.label);
    if (!label)
      throw std::runtime_error(
          "\"" + interval.label +
          "\" is neither a CMU nor a BEEP phone (lower case, without stress), so it has no viseme");
    interval.label = *label;
  }
  return visemes;
}

void describe(Description<ToVisemes>& d) {
  d.type("phones.to_visemes").summary("phones as MPEG-4 visemes, 1 to 14").source("Thesis Table 2.1");
  d.input("phones", "with their times").output("visemes", "the same times; labels are numbers, or sil");
}

}  // namespace talkgraph
