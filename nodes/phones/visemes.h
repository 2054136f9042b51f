#pragma once

#include <string_view>

#include "graph/description.h"
#include "nodes/types/phones.h"

namespace talkgraph {

/// A phone with its MPEG-4 viseme, 1 to 14.
struct PhoneViseme {
  std::string_view phone;
  int viseme;
};

/// Table 2.1 of the thesis, CMU and BEEP phones together: where both sets have
/// a name, they agree on its viseme.
inline constexpr PhoneViseme kVisemes[] = {
    {"p", 1},   {"b", 1},   {"m", 1},   {"f", 2},   {"v", 2},   {"dh", 3},  {"th", 3},  {"d", 4},   {"t", 4},
    {"g", 5},   {"hh", 5},  {"k", 5},   {"w", 5},   {"ch", 6},  {"jh", 6},  {"sh", 6},  {"zh", 6},  {"s", 7},
    {"z", 7},   {"l", 8},   {"n", 8},   {"ng", 8},  {"r", 9},   {"y", 9},   {"aa", 10}, {"ae", 10}, {"ah", 10},
    {"ao", 10}, {"ay", 10}, {"ax", 11}, {"ea", 11}, {"eh", 11}, {"er", 11}, {"ey", 11}, {"ia", 12}, {"ih", 12},
    {"iy", 12}, {"oh", 13}, {"ow", 13}, {"oy", 13}, {"aw", 14}, {"ua", 14}, {"uh", 14}, {"uw", 14}};

/// Whether a label is a CMU or BEEP phone, "sil" or "breath".
bool is_phone(std::string_view label);

/// The viseme of a phone; 0 for silence and breath. Throws std::runtime_error
/// for what is no CMU or BEEP phone.
int viseme(std::string_view phone);

/// Phones as MPEG-4 visemes: labels "1" to "14", or "sil". Adjoining stretches of one
/// viseme stay apart, as their phones are.
struct ToVisemes {
  PhoneTrack operator()(const PhoneTrack& phones) const;
};
void describe(Description<ToVisemes>& d);

}  // namespace talkgraph
