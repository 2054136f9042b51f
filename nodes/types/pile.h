#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "graph/archive.h"

namespace talkgraph {

/// Values of one type with matrices, piled member upon member: a file with thousands of them is then a few datasets,
/// which takes less room and a hundredth of the time to read. Of each member, named by its path ("audio.weights"),
/// `values` has what all values have of it, one after the other, matrices row by row; `sizes` how many entries each
/// list and how many rows and columns each matrix has; and `present` whether an optional member is there.
class Pile : public Archive {
 public:
  /// Visits values i = 0 .. `size` − 1 by visit(archive, i), to save them to or load them from member `name` of `ar`.
  template <class Visit>
  static void keep(Archive& ar, std::string_view name, std::size_t& size, Visit visit);

  bool loading() const override { return loading_; }

 protected:
  void number(std::string_view name, double& value) override;
  void integer(std::string_view name, std::int64_t& value) override;
  void text(std::string_view name, std::string& value) override;
  void texts(std::string_view name, std::vector<std::string>& value) override;
  void numbers(std::string_view name, std::vector<double>& value) override;
  void integers(std::string_view name, std::vector<std::int64_t>& value) override;
  void bytes(std::string_view name, std::vector<std::uint8_t>& value) override;
  void matrix(std::string_view name, Eigen::MatrixXd& value) override;
  void matrices(std::string_view name, std::vector<Eigen::MatrixXd>& value) override;
  bool present(std::string_view name, bool value) override;
  void enter(std::string_view name) override;
  void leave() override;

 private:
  /// What is taken from the front while loading.
  template <class T>
  struct Queue {
    std::vector<T> all;
    std::size_t taken = 0;
  };
  struct Member {
    Queue<double> numbers;
    Queue<std::int64_t> integers, sizes, present;
    Queue<std::string> texts;
  };
  struct Members {
    std::size_t size = 0;
    std::map<std::string, Member, std::less<>> by_path;
  };
  friend void fields(Archive& ar, Member& member);
  friend void fields(Archive& ar, Members& members);

  explicit Pile(bool loading) : loading_(loading) {}
  Member& member(std::string_view name);
  template <class T>
  void one(Queue<T>& queue, T& value);
  template <class T>
  void many(Queue<T>& queue, Queue<std::int64_t>& sizes, std::vector<T>& value);
  template <class T>
  static const T* take(Queue<T>& queue, std::size_t count);

  bool loading_;
  Members members_;
  std::string path_;
};

template <class Visit>
void Pile::keep(Archive& ar, std::string_view name, std::size_t& size, Visit visit) {
  Pile pile(ar.loading());
  pile.members_.size = size;
  if (ar.loading()) ar(name, pile.members_);
  size = pile.members_.size;
  for (std::size_t i = 0; i < size; ++i) visit(pile, i);
  if (!ar.loading()) ar(name, pile.members_);
}

}  // namespace talkgraph
