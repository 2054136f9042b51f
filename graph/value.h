#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "graph/archive.h"

namespace talkgraph {

/// Stable name and version of a type that flows between nodes. A type is made
/// a port type by specialising this beside it:
///   template <> inline constexpr PortType port_type<Audio>{"Audio", 1};
/// Raise the version when the meaning or the members change.
struct PortType {
  std::string_view name;
  int version = 1;
  bool operator==(const PortType&) const = default;
};

template <class T>
inline constexpr PortType port_type{};

/// Of an input that takes a value of whatever type, as `const Value&`.
inline constexpr PortType any_type{"any", 1};

template <class T>
concept Port = !port_type<T>.name.empty();

/// What is known of a port type at run time.
struct TypeInfo {
  PortType type;
  void (*visit)(Archive&, void*);   ///< its fields()
  std::shared_ptr<void> (*make)();  ///< a default-constructed one, to load into
};

template <Port T>
const TypeInfo& type_info() {
  static const TypeInfo info{port_type<T>, [](Archive& ar, void* p) { fields(ar, *static_cast<T*>(p)); },
                             []() -> std::shared_ptr<void> { return std::make_shared<T>(); }};
  return info;
}

/// An immutable value of any port type, cheap to copy; empty means "nothing".
class Value {
 public:
  Value() = default;
  template <Port T>
  static Value of(T value) {
    return Value(std::make_shared<const T>(std::move(value)), &type_info<T>());
  }
  Value(std::shared_ptr<const void> data, const TypeInfo* type) : data_(std::move(data)), type_(type) {}

  explicit operator bool() const { return data_ != nullptr; }
  const TypeInfo& type() const { return *type_; }
  const void* data() const { return data_.get(); }

  template <Port T>
  std::shared_ptr<const T> share() const {
    check<T>();
    return std::static_pointer_cast<const T>(data_);
  }
  template <Port T>
  const T& get() const {
    check<T>();
    return *static_cast<const T*>(data_.get());
  }

 private:
  template <Port T>
  void check() const {
    if (data_ && (type_ == &type_info<T>() || type_->type == port_type<T>)) return;
    throw std::logic_error("a value of type " + std::string(data_ ? type_->type.name : "nothing") + " is not a " +
                           std::string(port_type<T>.name));
  }

  std::shared_ptr<const void> data_;
  const TypeInfo* type_ = nullptr;
};

/// Of the value's content; the value must not be empty.
inline Key content_key(const Value& value) {
  return content_key([&](Archive& ar) { value.type().visit(ar, const_cast<void*>(value.data())); });
}

/// A value with the key of its item: an utterance id, a state label.
template <class T>
struct Item {
  std::string key;
  T value;
};

/// The whole of a stream, in the order in which its source made the keys.
template <class T>
class Collected {
 public:
  Collected() = default;
  Collected(std::initializer_list<Item<T>> items) {
    for (const auto& item : items) add(item.key, item.value);
  }
  void add(std::string key, T value) { add(std::move(key), std::make_shared<const T>(std::move(value))); }
  void add(std::string key, std::shared_ptr<const T> value) {
    keys_.push_back(std::move(key));
    values_.push_back(std::move(value));
  }

  std::size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }
  const std::string& key(std::size_t i) const { return keys_[i]; }
  const std::vector<std::string>& keys() const { return keys_; }
  const T& operator[](std::size_t i) const { return *values_[i]; }
  /// The value of a key, or nullptr.
  const T* find(std::string_view key) const {
    for (std::size_t i = 0; i < keys_.size(); ++i)
      if (keys_[i] == key) return values_[i].get();
    return nullptr;
  }

 private:
  std::vector<std::string> keys_;
  std::vector<std::shared_ptr<const T>> values_;
};

/// A keyed stream produced on demand: each call of next gives the next item
/// or nothing at the end. Keys are unique. A call after one that threw goes on
/// with the item behind the one that could not be made. `size`, where known, is for progress.
template <class T>
class Stream {
 public:
  using Next = std::function<std::optional<Item<T>>()>;
  Stream(Next next, std::optional<std::size_t> size = {}) : next_(std::move(next)), size_(size) {}
  /// All items at hand already.
  explicit Stream(std::vector<Item<T>> items)
      : next_([items = std::move(items), i = std::size_t{0}]() mutable -> std::optional<Item<T>> {
          if (i == items.size()) return {};
          return std::move(items[i++]);
        }) {}

  std::optional<Item<T>> next() { return next_(); }
  std::optional<std::size_t> size() const { return size_; }

 private:
  Next next_;
  std::optional<std::size_t> size_;
};

}  // namespace talkgraph
