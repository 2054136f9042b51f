#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace talkgraph {

/// A phone with its MPEG-4 viseme, 1 to 14.
struct PhoneViseme {
  std::string_view phone;
  int viseme;
};

/// Table 2.1 of the thesis, CMU and BEEP phones together: where both sets have a name, they agree on its viseme.
inline constexpr PhoneViseme kVisemes[] = {
    {"p", 1},   {"b", 1},   {"m", 1},   {"f", 2},   {"v", 2},   {"dh", 3},  {"th", 3},  {"d", 4},   {"t", 4},
    {"g", 5},   {"hh", 5},  {"k", 5},   {"w", 5},   {"ch", 6},  {"jh", 6},  {"sh", 6},  {"zh", 6},  {"s", 7},
    {"z", 7},   {"l", 8},   {"n", 8},   {"ng", 8},  {"r", 9},   {"y", 9},   {"aa", 10}, {"ae", 10}, {"ah", 10},
    {"ao", 10}, {"ay", 10}, {"ax", 11}, {"ea", 11}, {"eh", 11}, {"er", 11}, {"ey", 11}, {"ia", 12}, {"ih", 12},
    {"iy", 12}, {"oh", 13}, {"ow", 13}, {"oy", 13}, {"aw", 14}, {"ua", 14}, {"uh", 14}, {"uw", 14}};

/// Whether a phone label is a pause: "sil", "breath", "sp", nothing, or one of these marked by
/// phones.mark_pauses.
bool is_pause(std::string_view phone);

/// Whether it is a pause at an end of an utterance: "lead_sil", "trail_breath" ...
bool is_end_pause(std::string_view phone);

/// Whether a label is a CMU or BEEP phone, or a pause.
bool is_phone(std::string_view label);

/// The MPEG-4 viseme of a CMU or BEEP phone, 1 to 14, 0 of a pause,
/// nothing of what is no phone.
std::optional<int> viseme(std::string_view phone);

/// The same as a label: "1" to "14", or "sil".
std::optional<std::string> viseme_label(std::string_view phone);

}  // namespace talkgraph
