#include "nodes/plot/contours.h"

#include <array>
#include <cmath>
#include <compare>
#include <map>

namespace talkgraph {
namespace {

struct Corner {
  Eigen::Index row, column;
  auto operator<=>(const Corner&) const = default;
};
/// From the lower to the higher of its ends, which names it in both cells that it belongs to.
using Edge = std::pair<Corner, Corner>;

class Tracer {
 public:
  Tracer(const Eigen::MatrixXd& values, double level) : values_(values), level_(level) {}

  std::vector<Ring> rings() {
    // One cell more on each side, whose outer corners are never in the area, closes all rings.
    for (Eigen::Index r = -1; r < values_.rows(); ++r)
      for (Eigen::Index c = -1; c < values_.cols(); ++c) add_cell(r, c);
    std::vector<Ring> rings;
    while (!next_.empty()) rings.push_back(trace());
    return rings;
  }

 private:
  double at(const Corner& p) const {
    const bool there = p.row >= 0 && p.row < values_.rows() && p.column >= 0 && p.column < values_.cols();
    return there ? values_(p.row, p.column) : -INFINITY;
  }

  /// The steps of rings through a cell: from where its boundary leaves the area to where it comes in again.
  void add_cell(Eigen::Index r, Eigen::Index c) {
    const std::array<Corner, 4> corners = {{{r, c}, {r, c + 1}, {r + 1, c + 1}, {r + 1, c}}};
    std::array<bool, 4> inside;
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) inside[i] = at(corners[i]) >= level_, sum += at(corners[i]);
    const bool saddle = inside[0] == inside[2] && inside[1] == inside[3] && inside[0] != inside[1];
    const bool joined = sum / 4 >= level_;
    const auto enters = [&](std::size_t i) { return !inside[i % 4] && inside[(i + 1) % 4]; };
    const auto edge = [&](std::size_t i) {
      const Corner &a = corners[i % 4], &b = corners[(i + 1) % 4];
      return a < b ? Edge{a, b} : Edge{b, a};
    };
    for (std::size_t i = 0; i < 4; ++i) {
      if (!inside[i] || inside[(i + 1) % 4]) continue;
      std::size_t to = i + 1;
      if (saddle && !joined) to = i + 3;
      while (!enters(to)) ++to;
      next_[edge(i)] = edge(to);
    }
  }

  Eigen::Vector2d crossing(const Edge& edge) const {
    const auto [a, b] = edge;
    const double va = at(a), vb = at(b);
    const double t = std::isinf(va) ? 1 : std::isinf(vb) ? 0 : (level_ - va) / (vb - va);
    return {static_cast<double>(a.column) + t * static_cast<double>(b.column - a.column),
            static_cast<double>(a.row) + t * static_cast<double>(b.row - a.row)};
  }

  Ring trace() {
    Ring ring;
    for (auto step = next_.begin(); step != next_.end(); step = next_.find(step->second)) {
      const Eigen::Vector2d p = crossing(step->first);
      if (ring.empty() || ring.back() != p) ring.push_back(p);
      done_.push_back(step->first);
      if (step->second == done_.front()) break;
    }
    for (const auto& edge : done_) next_.erase(edge);
    done_.clear();
    return ring;
  }

  const Eigen::MatrixXd& values_;
  double level_;
  std::map<Edge, Edge> next_;
  std::vector<Edge> done_;
};

}  // namespace

std::vector<Ring> rings_above(const Eigen::MatrixXd& values, double level) { return Tracer(values, level).rings(); }

}  // namespace talkgraph
