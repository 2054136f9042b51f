#pragma once

#include <cstddef>
#include <deque>
#include <iterator>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>

namespace talkgraph {

/// The keys of a domain's items in their order, each once.
class Keys {
 public:
  Keys() = default;
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;

  /// False if the key came before.
  bool add(std::string key) {
    const bool rises = list_.empty() || less(list_.back(), key);
    list_.push_back(std::move(key));
    if (rising_ && rises) return true;
    if (std::exchange(rising_, false)) seen_.insert(list_.begin(), std::prev(list_.end()));
    if (seen_.insert(list_.back()).second) return true;
    list_.pop_back();
    return false;
  }

  bool empty() const { return list_.empty(); }
  std::size_t size() const { return list_.size(); }
  /// The address stays.
  const std::string& operator[](std::size_t i) const { return list_[i]; }
  const std::string& back() const { return list_.back(); }

 private:
  /// The order of numbers and of names of one length: sorted keys, which are the most common, need no set.
  static bool less(const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  }

  std::deque<std::string> list_;
  bool rising_ = true;
  std::unordered_set<std::string_view> seen_;  // once keys do not rise
};

}  // namespace talkgraph
