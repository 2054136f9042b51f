#include "nodes/types/visemes.h"

namespace talkgraph {
bool is_pause(std::string_view phone) {
  return phone == "sil" || phone == "breath" || phone == "sp" || phone.empty() || is_end_pause(phone);
}

bool is_end_pause(std::string_view phone) { return phone.starts_with("lead_") || phone.starts_with("trail_"); }

bool is_phone(std::string_view label) { return viseme(label).has_value(); }

std::optional<int> viseme(std::string_view phone) {
  if (is_pause(phone)) return 0;
  for (const auto& entry : kVisemes)
    if (entry.phone == phone) return entry.viseme;
  return {};
}

std::optional<std::string> viseme_label(std::string_view phone) {
  const auto number = viseme(phone);
  if (!number) return {};
  return *number == 0 ? "sil" : std::to_string(*number);
}

}  // namespace talkgraph
