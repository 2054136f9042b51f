#pragma once

#include <tsl/robin_set.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>

namespace talkgraph {

/// The keys of a domain's items in their order, each once.
class Keys {
 public:
  Keys() = default;
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;

  /// False if the key came before.
  bool add(std::string key) {
    list_.push_back(std::move(key));
    if (seen_.insert(static_cast<std::uint32_t>(list_.size() - 1)).second) return true;
    list_.pop_back();
    return false;
  }

  bool empty() const { return list_.empty(); }
  std::size_t size() const { return list_.size(); }
  /// The address stays.
  const std::string& operator[](std::size_t i) const { return list_[i]; }
  const std::string& back() const { return list_.back(); }

 private:
  // The set holds places in the list and hashes, which is less memory to go through than texts.
  struct Hash {
    const std::deque<std::string>* list;
    std::size_t operator()(std::uint32_t i) const { return std::hash<std::string>()((*list)[i]); }
  };
  struct Equal {
    const std::deque<std::string>* list;
    bool operator()(std::uint32_t a, std::uint32_t b) const { return (*list)[a] == (*list)[b]; }
  };
  static constexpr bool store_hash = true;

  std::deque<std::string> list_;
  tsl::robin_set<std::uint32_t, Hash, Equal, std::allocator<std::uint32_t>, store_hash> seen_{0, Hash{&list_},
                                                                                              Equal{&list_}};
};

}  // namespace talkgraph
