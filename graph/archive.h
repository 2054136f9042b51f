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
#include <variant>
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

/// Whether a list of T is kept as columns, one a member; for structs of numbers and texts alone.
template <class T>
inline constexpr bool is_row = false;

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
  void operator()(std::string_view name, T& value, std::string_view unit = {});

  /// A list that need not be in memory as a whole: visit(i) visits the member std::to_string(i).
  template <class Visit>
  void list(std::string_view name, std::size_t& size, Visit visit);

  /// For who opens the file elsewhere: an attribute of a member visited before, or, without a member, of what the
  /// archive is in. It is not read back.
  virtual void note(std::string_view /*member*/, std::string_view /*what*/, std::string_view /*text*/) {}
  virtual void note(std::string_view /*member*/, std::string_view /*what*/, double /*number*/) {}

 protected:
  virtual void number(std::string_view name, double& value) = 0;
  virtual void integer(std::string_view name, std::int64_t& value) = 0;
  virtual void text(std::string_view name, std::string& value) = 0;
  virtual void texts(std::string_view name, std::vector<std::string>& value) = 0;
  virtual void numbers(std::string_view name, std::vector<double>& value) = 0;
  virtual void integers(std::string_view name, std::vector<std::int64_t>& value) = 0;
  virtual void bytes(std::string_view name, std::vector<std::uint8_t>& value) = 0;
  virtual void matrix(std::string_view name, Eigen::MatrixXd& value) = 0;
  virtual void matrices(std::string_view name, std::vector<Eigen::MatrixXd>& value) = 0;
  /// Whether an optional member is there; `value` says so unless it is loaded.
  virtual bool present(std::string_view name, bool value) = 0;
  virtual void enter(std::string_view name) = 0;
  virtual void leave() = 0;

 private:
  template <class T>
  void member(std::string_view name, T& value);
  template <class T>
  void elements(std::string_view name, std::vector<T>& value);
  template <class T>
  void rows(std::string_view name, std::vector<T>& value);
};

/// Saves what `visit` gives an archive to an HDF5 file, whole or not at all, that h5py opens: structs are groups;
/// numbers and texts, scalar datasets; lists and matrices, datasets of one and two dimensions; a list of matrices of
/// one size, a dataset of three; a list of rows (is_row), a group of columns; any other list, a group with `size` and
/// the elements "0", "1", ... Texts have fixed length and are UTF-8. An optional member that is not there is not in the
/// file. Throws std::runtime_error that names the file and the cause.
void write_hdf5(const std::string& path, const std::function<void(Archive&)>& visit);
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

[[noreturn]] void refuse_size(std::string_view name);
/// To a matrix or vector, whose size may be fixed; a row takes a column.
template <class From, class T>
void assign(std::string_view name, const From& from, T& to) {
  const auto fits = [](Eigen::Index fixed, Eigen::Index n) { return fixed == Eigen::Dynamic || fixed == n; };
  if constexpr (From::IsVectorAtCompileTime) {
    if (!fits(T::SizeAtCompileTime, from.size())) refuse_size(name);
  } else if (!fits(T::RowsAtCompileTime, from.rows()) || !fits(T::ColsAtCompileTime, from.cols())) {
    refuse_size(name);
  }
  to = from.template cast<typename T::Scalar>();
}
template <class T>
inline constexpr bool is_eigen_vector = false;
template <class T>
requires is_eigen<T>
inline constexpr bool is_eigen_vector<T> = T::IsVectorAtCompileTime;

/// Rows on their way to columns, or back.
class Columns final : public Archive {
 public:
  /// What fields() is called for: to learn the columns, to collect rows into them, to hand rows out of them.
  enum class Stage { learn, collect, hand_out };

  bool loading() const override { return stage_ == Stage::hand_out; }
  void begin(Stage stage) { stage_ = stage; }
  /// Visits the columns. Throws std::runtime_error if loaded ones differ in length.
  void visit(Archive& ar);
  std::size_t rows() const;
  void note(std::string_view member, std::string_view what, std::string_view text) override;

 protected:
  void number(std::string_view name, double& value) override { cell(name, value); }
  void integer(std::string_view name, std::int64_t& value) override { cell(name, value); }
  void text(std::string_view name, std::string& value) override { cell(name, value); }
  void texts(std::string_view, std::vector<std::string>&) override { refuse(); }
  void numbers(std::string_view, std::vector<double>&) override { refuse(); }
  void integers(std::string_view, std::vector<std::int64_t>&) override { refuse(); }
  void bytes(std::string_view, std::vector<std::uint8_t>&) override { refuse(); }
  void matrix(std::string_view, Eigen::MatrixXd&) override { refuse(); }
  void matrices(std::string_view, std::vector<Eigen::MatrixXd>&) override { refuse(); }
  bool present(std::string_view, bool) override { refuse(); }
  void enter(std::string_view) override { refuse(); }
  void leave() override { refuse(); }

 private:
  struct Column {
    std::string name, unit;
    std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::string>> cells;
    std::size_t handed_out = 0;
  };
  template <class T>
  void cell(std::string_view name, T& value);
  Column& column(std::string_view name);
  [[noreturn]] static void refuse();

  Stage stage_ = Stage::learn;
  std::vector<Column> columns_;
};
}  // namespace detail

template <class T>
void Archive::operator()(std::string_view name, T& value, std::string_view unit) {
  member(name, value);
  if (!unit.empty()) note(name, "unit", unit);
}

template <class Visit>
void Archive::list(std::string_view name, std::size_t& size, Visit visit) {
  enter(name);
  (*this)("size", size);
  for (std::size_t i = 0; i < size; ++i) visit(i);
  leave();
}

template <class T>
void Archive::rows(std::string_view name, std::vector<T>& value) {
  detail::Columns columns;
  T example{};
  fields(columns, example);
  enter(name);
  if (loading()) {
    columns.visit(*this);
    value.assign(columns.rows(), T{});
    columns.begin(detail::Columns::Stage::hand_out);
  } else {
    columns.begin(detail::Columns::Stage::collect);
  }
  for (auto& row : value) fields(columns, row);
  if (!loading()) columns.visit(*this);
  leave();
}

template <class T>
void Archive::elements(std::string_view name, std::vector<T>& value) {
  if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
    std::vector<std::int64_t> v;
    for (const auto& e : value) v.push_back(static_cast<std::int64_t>(e));
    integers(name, v);
    if (!loading()) return;
    value.clear();
    for (const auto e : v) value.push_back(static_cast<T>(e));
  } else if constexpr (detail::is_eigen<T>) {
    std::vector<Eigen::MatrixXd> v;
    for (const auto& e : value) v.push_back(e.template cast<double>());
    matrices(name, v);
    if (!loading()) return;
    value.clear();
    value.resize(v.size());
    for (std::size_t i = 0; i < v.size(); ++i) detail::assign(name, v[i], value[i]);
  } else if constexpr (is_row<T>) {
    rows(name, value);
  } else {
    std::size_t size = value.size();
    if (loading()) value.clear();
    list(name, size, [&](std::size_t i) {
      if (loading()) value.emplace_back();
      (*this)(std::to_string(i), value[i]);
    });
  }
}

template <class T>
void Archive::member(std::string_view name, T& value) {
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
    note(name, "number", value.value());
  } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
    texts(name, value);
  } else if constexpr (std::is_same_v<T, std::vector<double>>) {
    numbers(name, value);
  } else if constexpr (std::is_same_v<T, std::vector<std::uint8_t>>) {
    bytes(name, value);
  } else if constexpr (detail::is_eigen_vector<T>) {
    std::vector<double> v;
    for (const auto e : value) v.push_back(static_cast<double>(e));
    numbers(name, v);
    if (loading())
      detail::assign(name, Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size())), value);
  } else if constexpr (detail::is_eigen<T>) {
    Eigen::MatrixXd m = value.template cast<double>();
    matrix(name, m);
    if (loading()) detail::assign(name, m, value);
  } else if constexpr (detail::is_optional<T>::value) {
    const bool there = present(name, value.has_value());
    if (!there) value.reset();
    if (there && !value) value.emplace();
    if (there) (*this)(name, *value);
  } else if constexpr (detail::is_vector<T>::value) {
    elements(name, value);
  } else if constexpr (detail::is_string_map<T>::value) {
    std::vector<std::string> keys;
    for (const auto& [k, v] : value) keys.push_back(k);
    enter(name);
    texts("keys", keys);
    if (loading()) value.clear();
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
