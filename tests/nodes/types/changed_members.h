#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <map>
#include <utility>
#include <variant>

#include "graph/archive.h"

namespace talkgraph::testing {

/// Holds a value's members in memory, where each can be changed.
class MemoryArchive final : public Archive {
 public:
  using Member = std::variant<double, std::int64_t, std::string, std::vector<std::string>, std::vector<double>,
                              std::vector<std::int64_t>, std::vector<std::uint8_t>, Eigen::MatrixXd,
                              std::vector<Eigen::MatrixXd>, bool>;
  std::map<std::string, Member> members;
  bool loads = false;

  bool loading() const override { return loads; }

 protected:
  void number(std::string_view name, double& value) override { keep(name, value); }
  void integer(std::string_view name, std::int64_t& value) override { keep(name, value); }
  void text(std::string_view name, std::string& value) override { keep(name, value); }
  void texts(std::string_view name, std::vector<std::string>& value) override { keep(name, value); }
  void numbers(std::string_view name, std::vector<double>& value) override { keep(name, value); }
  void integers(std::string_view name, std::vector<std::int64_t>& value) override { keep(name, value); }
  void bytes(std::string_view name, std::vector<std::uint8_t>& value) override { keep(name, value); }
  void matrix(std::string_view name, Eigen::MatrixXd& value) override { keep(name, value); }
  void matrices(std::string_view name, std::vector<Eigen::MatrixXd>& value) override { keep(name, value); }
  bool present(std::string_view name, bool value) override {
    keep(std::string(name) + '?', value);
    return value;
  }
  void enter(std::string_view name) override { path_ += std::string(name) + '/'; }
  void leave() override {
    path_.pop_back();
    path_.resize(path_.rfind('/') == std::string::npos ? 0 : path_.rfind('/') + 1);
  }

 private:
  template <class T>
  void keep(std::string_view name, T& value) {
    const std::string path = path_ + std::string(name);
    if (loads)
      value = std::get<T>(members.at(path));
    else
      members[path] = value;
  }
  std::string path_;
};

inline std::vector<double> changes(double) { return {std::numeric_limits<double>::quiet_NaN(), -1, 0, 7.5}; }
inline std::vector<std::int64_t> changes(std::int64_t) { return {-1, 0, 7, std::int64_t{1} << 62}; }
inline std::vector<std::string> changes(const std::string&) { return {""}; }
inline std::vector<bool> changes(bool value) { return value ? std::vector<bool>{false} : std::vector<bool>{}; }
inline std::vector<Eigen::MatrixXd> changes(const Eigen::MatrixXd& m) {
  if (m.size() == 0) return {};
  return {m.topRows(m.rows() - 1), m.leftCols(m.cols() - 1), m.transpose(), Eigen::MatrixXd(),
          std::numeric_limits<double>::quiet_NaN() * m};
}
inline std::vector<std::uint8_t> changes(std::uint8_t) { return {0}; }
template <class T>
std::vector<std::vector<T>> changes(const std::vector<T>& value) {
  if (value.empty()) return {};
  std::vector<std::vector<T>> all{{}, {value.begin(), value.end() - 1}, {value.rbegin(), value.rend()}};
  for (const T& first : changes(value[0])) {
    all.push_back(value);
    all.back()[0] = first;
  }
  return all;
}

/// Every member of `whole` changed at a time, as `changed` sees it.
inline void each_change(const MemoryArchive& whole,
                        const std::function<void(const std::string& path, MemoryArchive changed)>& changed) {
  for (const auto& [path, member] : whole.members) {
    const std::vector<MemoryArchive::Member> others = std::visit(
        [](const auto& value) {
          const auto all = changes(value);
          return std::vector<MemoryArchive::Member>(all.begin(), all.end());
        },
        member);
    for (const auto& other : others) {
      MemoryArchive damaged = whole;
      damaged.members[path] = other;
      changed(path, std::move(damaged));
    }
  }
}

/// Loads and uses a value with one member changed at a time: both may throw std::exception; what use gives must be
/// finite. Returns how many changes were refused.
inline int refusals(MemoryArchive whole, const std::function<Eigen::MatrixXd(Archive&)>& load_and_use) {
  whole.loads = true;
  int refused = 0;
  each_change(whole, [&](const std::string& path, MemoryArchive damaged) {
    try {
      EXPECT_TRUE(load_and_use(damaged).allFinite()) << path;
    } catch (const std::exception&) {
      ++refused;
    }
  });
  EXPECT_TRUE(load_and_use(whole).allFinite()) << "as it was";
  return refused;
}

template <class Model>
int refuses_or_answers(Model model, const std::function<Eigen::MatrixXd(const Model&)>& use) {
  MemoryArchive whole;
  fields(whole, model);
  return refusals(whole, [&](Archive& archive) {
    Model loaded;
    fields(archive, loaded);
    return use(loaded);
  });
}

}  // namespace talkgraph::testing
