#include "nodes/types/pile.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace talkgraph {

void fields(Archive& ar, Pile::Member& m) {
  const auto visit = [&](std::string_view name, auto& queue) {
    std::optional<std::decay_t<decltype(queue.all)>> there;
    if (!queue.all.empty()) there = std::move(queue.all);
    ar(name, there);
    if (there) queue.all = std::move(*there);
  };
  visit("values", m.numbers);
  visit("integers", m.integers);
  visit("texts", m.texts);
  visit("sizes", m.sizes);
  visit("present", m.present);
}

void fields(Archive& ar, Pile::Members& m) {
  ar("size", m.size);
  std::vector<std::string> paths;
  for (const auto& [path, member] : m.by_path) paths.push_back(path);
  ar("members", paths);
  for (const auto& path : paths) ar(path, m.by_path[path]);
}

Pile::Member& Pile::member(std::string_view name) {
  const std::size_t length = path_.size();
  path_ += name;
  const auto found = members_.by_path.find(path_);
  if (found == members_.by_path.end() && loading_)
    throw std::runtime_error("the stored values lack \"" + path_ + "\"; make them anew");
  Member& m = found == members_.by_path.end() ? members_.by_path[path_] : found->second;
  path_.resize(length);
  return m;
}

template <class T>
const T* Pile::take(Queue<T>& queue, std::size_t count) {
  if (count > queue.all.size() - queue.taken)
    throw std::runtime_error("the stored values have fewer entries than they say; make them anew");
  const T* first = queue.all.data() + queue.taken;
  queue.taken += count;
  return first;
}

template <class T>
void Pile::one(Queue<T>& queue, T& value) {
  if (loading_)
    value = *take(queue, 1);
  else
    queue.all.push_back(value);
}

template <class T>
void Pile::many(Queue<T>& queue, Queue<std::int64_t>& sizes, std::vector<T>& value) {
  auto size = static_cast<std::int64_t>(value.size());
  one(sizes, size);
  if (loading_) {
    const T* first = take(queue, static_cast<std::size_t>(size));
    value.assign(first, first + size);
  } else {
    queue.all.insert(queue.all.end(), value.begin(), value.end());
  }
}

void Pile::number(std::string_view name, double& value) { one(member(name).numbers, value); }
void Pile::integer(std::string_view name, std::int64_t& value) { one(member(name).integers, value); }
void Pile::text(std::string_view name, std::string& value) { one(member(name).texts, value); }

void Pile::texts(std::string_view name, std::vector<std::string>& value) {
  Member& m = member(name);
  many(m.texts, m.sizes, value);
}

void Pile::numbers(std::string_view name, std::vector<double>& value) {
  Member& m = member(name);
  many(m.numbers, m.sizes, value);
}

void Pile::integers(std::string_view name, std::vector<std::int64_t>& value) {
  Member& m = member(name);
  many(m.integers, m.sizes, value);
}

void Pile::bytes(std::string_view name, std::vector<std::uint8_t>&) {
  throw std::logic_error("\"" + std::string(name) + "\": a pile has no bytes");
}

void Pile::matrix(std::string_view name, Eigen::MatrixXd& value) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Member& m = member(name);
  std::int64_t rows = value.rows(), columns = value.cols();
  one(m.sizes, rows);
  one(m.sizes, columns);
  if (loading_) {
    if (rows < 0 || columns < 0 || (columns > 0 && rows > std::numeric_limits<std::int64_t>::max() / columns))
      throw std::runtime_error("a stored matrix has a size that none can have; make it anew");
    value = Eigen::Map<const RowMajor>(take(m.numbers, static_cast<std::size_t>(rows * columns)), rows, columns);
  } else {
    const RowMajor flat = value;
    m.numbers.all.insert(m.numbers.all.end(), flat.data(), flat.data() + flat.size());
  }
}

void Pile::matrices(std::string_view name, std::vector<Eigen::MatrixXd>& value) {
  auto count = static_cast<std::int64_t>(value.size());
  one(member(name).sizes, count);
  value.resize(static_cast<std::size_t>(count));
  for (auto& one_matrix : value) matrix(name, one_matrix);
}

bool Pile::present(std::string_view name, bool value) {
  std::int64_t there = value;
  one(member(name).present, there);
  return there != 0;
}

void Pile::enter(std::string_view name) {
  path_ += name;
  path_ += '.';
}

void Pile::leave() {
  path_.pop_back();
  path_.resize(path_.rfind('.') == std::string::npos ? 0 : path_.rfind('.') + 1);
}

}  // namespace talkgraph
