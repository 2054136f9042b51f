#include "nodes/phones/visemes.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace talkgraph {

namespace {

bool is_pause(std::string_view label) { return label == "sil" || label == "breath"; }

}  // namespace

bool is_phone(std::string_view label) {
  return is_pause(label) || std::any_of(std::begin(kVisemes), std::end(kVisemes),
                                        [&](const PhoneViseme& entry) { return entry.phone == label; });
}

int viseme(std::string_view phone) {
  if (is_pause(phone)) return 0;
  for (const auto& entry : kVisemes)
    if (entry.phone == phone) return entry.viseme;
  throw std::runtime_error("\"" + std::string(phone) +
                           "\" is neither a CMU nor a BEEP phone (lower case, without stress), so it has no viseme");
}

PhoneTrack ToVisemes::operator()(const PhoneTrack& phones) const {
  PhoneTrack visemes = phones;
  for (auto& interval : visemes.phones) {
    const int number = viseme(interval.label);
    interval.label = number ? std::to_string(number) : "sil";
  }
  return visemes;
}

void describe(Description<ToVisemes>& d) {
  d.type("phones.to_visemes").summary("phones as MPEG-4 visemes, 1 to 14").source("Thesis Table 2.1");
  d.input("phones").output("visemes");
}

}  // namespace talkgraph
