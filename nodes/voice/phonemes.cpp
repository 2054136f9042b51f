#include <stdexcept>
#include <unordered_map>

#include "nodes/voice/voice.h"

namespace talkgraph {
namespace {

using Phones = std::vector<std::string>;

const std::unordered_map<std::string, Phones>& table() {
  static const std::unordered_map<std::string, Phones> phones{
      {"p", {"p"}},          {"b", {"b"}},          {"t", {"t"}},        {"t2", {"t"}},
      {"t#", {"t"}},         {"?", {"t"}},          {"d", {"d"}},        {"d#", {"d"}},
      {"k", {"k"}},          {"g", {"g"}},          {"tS", {"ch"}},      {"dZ", {"jh"}},
      {"f", {"f"}},          {"v", {"v"}},          {"T", {"th"}},       {"D", {"dh"}},
      {"s", {"s"}},          {"z", {"z"}},          {"z/2", {"z"}},      {"S", {"sh"}},
      {"Z", {"zh"}},         {"h", {"hh"}},         {"x", {"k"}},        {"C", {"hh"}},
      {"m", {"m"}},          {"n", {"n"}},          {"N", {"ng"}},       {"l", {"l"}},
      {"l#", {"l"}},         {"l/2", {"l"}},        {"r", {"r"}},        {"r/", {"r"}},
      {"r-", {"r"}},         {"w", {"w"}},          {"w#", {"w"}},       {"j", {"y"}},
      {"@", {"ah"}},         {"@2", {"ah"}},        {"@5", {"ah"}},      {"@-", {"ah"}},
      {"@L", {"ah", "l"}},   {"n-", {"ah", "n"}},   {"m-", {"ah", "m"}}, {"3", {"er"}},
      {"3:", {"er"}},        {"VR", {"er"}},        {"V", {"ah"}},       {"a", {"ae"}},
      {"aa", {"ae"}},        {"a#", {"ah"}},        {"A", {"aa"}},       {"A:", {"aa"}},
      {"A#", {"aa"}},        {"A@", {"aa", "r"}},   {"E", {"eh"}},       {"e", {"eh"}},
      {"E#", {"ih"}},        {"E2", {"eh"}},        {"e@", {"eh", "r"}}, {"I", {"ih"}},
      {"I2", {"ih"}},        {"I#", {"ih"}},        {"i", {"iy"}},       {"i:", {"iy"}},
      {"i@", {"iy", "ah"}},  {"i@3", {"ih", "r"}},  {"IR", {"ih", "r"}}, {"0", {"aa"}},
      {"02", {"aa"}},        {"0#", {"aa"}},        {"O", {"ao"}},       {"O:", {"ao"}},
      {"O2", {"ao"}},        {"O@", {"ao", "r"}},   {"o@", {"ao", "r"}}, {"U", {"uh"}},
      {"u", {"uw"}},         {"u:", {"uw"}},        {"U@", {"uh", "r"}}, {"aI", {"ay"}},
      {"aI@", {"ay", "ah"}}, {"aI3", {"ay", "er"}}, {"aU", {"aw"}},      {"aU@", {"aw", "er"}},
      {"eI", {"ey"}},        {"oU", {"ow"}},        {"oU#", {"ow"}},     {"OI", {"oy"}},
      {"OI@", {"oy", "ah"}}, {"A~", {"aa"}},        {"i::", {"iy"}},     {";", {}},
  };
  return phones;
}

}  // namespace

std::vector<std::string> cmu_phones(const std::string& phoneme) {
  if (phoneme.empty() || phoneme[0] == '_') return {};
  const auto found = table().find(phoneme);
  if (found == table().end())
    throw std::runtime_error("espeak-ng: phoneme \"" + phoneme +
                             "\" has no CMU phone; is the word foreign? Spell it as it is said in English");
  return found->second;
}

}  // namespace talkgraph
