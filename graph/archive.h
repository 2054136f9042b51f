#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "graph/key.h"
#include "graph/rational.h"

namespace talkgraph {

class Archive;

/// A struct that flows between nodes offers `void fields(Archive&, T&)`, found
/// by argument-dependent lookup, which names each member once. The same
/// function saves, loads and hashes.
template <class T>
concept HasFields = requires(Archive& ar, T& value) {
  fields(ar, value);
};

/// Visits the named members of a value: a writer, a reader or a hasher.
/// Errors (a missing or misshapen member, a full disk) throw std::runtime_error
/// that names the member.
class Archive {
 public:
  virtual ~Archive() = default;

  /// True if members are filled from the archive, false if they are read.
  virtual bool loading() const = 0;
  /// True if the value is only to be told from others: a lazy member gives its content key, not itself.
  virtual bool hashing() const { return false; }

  template <class T>
  void operator()(std::string_view name, T& value);

 protected:
  virtual void number(std::string_view name, double& value) = 0;
  virtual void integer(std::string_view name, std::int64_t& value) = 0;
  virtual void text(std::string_view name, std::string& value) = 0;
  virtual void texts(std::string_view name, std::vector<std::string>& value) = 0;
  virtual void numbers(std::string_view name, std::vector<double>& value) = 0;
  virtual void integers(std::string_view name, std::vector<std::int64_t>& value) = 0;
  virtual void bytes(std::string_view name, std::vector<std::uint8_t>& value) = 0;
  virtual void matrix(std::string_view name, Eigen::MatrixXd& value) = 0;
  virtual void enter(std::string_view name) = 0;
  virtual void leave() = 0;
};

/// Saves to a new HDF5 file, or to a group of it.
std::unique_ptr<Archive> hdf5_writer(const std::string& path);
std::unique_ptr<Archive> hdf5_reader(const std::string& path);

/// Of a value's content. `visit` calls fields() on the archive it is given.
Key content_key(const std::function<void(Archive&)>& visit);

inline void fields(Archive& ar, Key& key);

// ---------------------------------------------------------------------------

namespace detail {
template <class T>
struct is_vector : std::false_type {};
template <class T>
struct is_vector<std::vector<T>> : std::true_type {};
template <class T>
struct is_optional : std::false_type {};
template <class T>
struct is_optional<std::optional<T>> : std::true_type {};
template <class T>
struct is_string_map : std::false_type {};
template <class T>
struct is_string_map<std::map<std::string, T>> : std::true_type {};
template <class T>
inline constexpr bool is_eigen = std::is_base_of_v<Eigen::MatrixBase<T>, T>;
}  // namespace detail

template <class T>
void Archive::operator()(std::string_view name, T& value) {
  if constexpr (std::is_same_v<T, double>) {
    number(name, value);
  } else if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
    auto v = static_cast<std::int64_t>(value);
    integer(name, v);
    value = static_cast<T>(v);
  } else if constexpr (std::is_same_v<T, std::string>) {
    text(name, value);
  } else if constexpr (std::is_same_v<T, Rational>) {
    std::string s = value.str();
    text(name, s);
    value = Rational::parse(s);
  } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
    texts(name, value);
  } else if constexpr (std::is_same_v<T, std::vector<double>>) {
    numbers(name, value);
  } else if constexpr (std::is_same_v<T, std::vector<std::uint8_t>>) {
    bytes(name, value);
  } else if constexpr (detail::is_eigen<T>) {
    Eigen::MatrixXd m = value.template cast<double>();
    matrix(name, m);
    if (loading()) value = m.template cast<typename T::Scalar>();
  } else if constexpr (detail::is_optional<T>::value) {
    enter(name);
    bool present = value.has_value();
    (*this)("present", present);
    if (!present) value.reset();
    if (present && !value) value.emplace();
    if (present) (*this)("value", *value);
    leave();
  } else if constexpr (detail::is_vector<T>::value) {
    using Element = typename T::value_type;
    if constexpr (std::is_integral_v<Element> || std::is_enum_v<Element>) {
      std::vector<std::int64_t> v;
      for (const auto& e : value) v.push_back(static_cast<std::int64_t>(e));
      integers(name, v);
      if (loading()) {
        value.clear();
        for (const auto e : v) value.push_back(static_cast<Element>(e));
      }
    } else {
      enter(name);
      std::size_t n = value.size();
      (*this)("size", n);
      if (loading()) value.resize(n);
      for (std::size_t i = 0; i < n; ++i) (*this)(std::to_string(i), value[i]);
      leave();
    }
  } else if constexpr (detail::is_string_map<T>::value) {
    enter(name);
    std::vector<std::string> keys;
    for (const auto& [k, v] : value) keys.push_back(k);
    texts("keys", keys);
    std::size_t i = 0;
    for (const auto& k : keys) (*this)(std::to_string(i++), value[k]);
    leave();
  } else {
    static_assert(HasFields<T>, "this member needs `void fields(Archive&, T&)`");
    enter(name);
    fields(*this, value);
    leave();
  }
}

inline void fields(Archive& ar, Key& key) {
  ar("high", key.high);
  ar("low", key.low);
}

}  // namespace talkgraph
