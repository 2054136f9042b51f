#pragma once

#include <algorithm>
#include <cmath>

#include "nodes/mapping/context_gp.h"
#include "tests/nodes/latent/gaussian.h"

namespace talkgraph::testing {

inline Track track(Eigen::MatrixXd values) {
  Track t;
  t.values = std::move(values);
  t.start = 0.02;
  return t;
}

/// Phones of so many frames each.
inline PhoneTrack said(const std::vector<std::pair<std::string, int>>& phones) {
  PhoneTrack out;
  double at = 0;
  for (const auto& [label, frames] : phones) {
    out.phones.push_back({label, at, at + frames / 25.0});
    at += frames / 25.0;
  }
  return out;
}

struct ContextCorpus {
  Collected<Track> audio, visual;
  Collected<PhoneTrack> phones;
  void add(const std::string& key, Track a, PhoneTrack p, Track v) {
    audio.add(key, std::move(a));
    phones.add(key, std::move(p));
    visual.add(key, std::move(v));
  }
  ContextGp learn(TrainContextGp node, int kernel_steps = 0) const {
    node.kernel_steps = kernel_steps;
    Context context;
    Random random(1);
    return node(audio, phones, visual, random, context);
  }
};

inline ContextCorpus random_corpus() {
  ContextCorpus corpus;
  corpus.add("a", track(gaussian(12, 3, 1)), said({{"b", 3}, {"ih", 5}, {"n", 4}}), track(gaussian(12, 2, 2)));
  corpus.add("b", track(gaussian(9, 3, 3)), said({{"n", 4}, {"b", 5}}), track(gaussian(9, 2, 4)));
  return corpus;
}

/// Every frame with all it is compared by, weighted: the textbook's way to the same kernel.
inline Eigen::MatrixXd stacked(const TrainContextGp& node, const Eigen::MatrixXd& z_scored,
                               const Eigen::MatrixXd& shares) {
  const Eigen::Index frames = z_scored.rows(), d = z_scored.cols(), p = shares.cols();
  Eigen::VectorXd w(2 * node.reach + 1);
  for (int l = -node.reach; l <= node.reach; ++l) w[l + node.reach] = std::exp(-l * l / (node.width * node.width));
  w /= w.sum();
  Eigen::MatrixXd out(frames, w.size() * (d + p));
  for (Eigen::Index t = 0; t < frames; ++t)
    for (int l = -node.reach; l <= node.reach; ++l) {
      const auto from = std::clamp<Eigen::Index>(t + l, 0, frames - 1);
      const double root = std::sqrt(w[l + node.reach]);
      out.block(t, (l + node.reach) * (d + p), 1, d) =
          root * std::sqrt(node.sound / static_cast<double>(d)) * z_scored.row(from);
      out.block(t, (l + node.reach) * (d + p) + d, 1, p) = root * std::sqrt(node.phones) * shares.row(from);
    }
  return out;
}

inline Eigen::MatrixXd rbf(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return Eigen::MatrixXd::NullaryExpr(a.rows(), b.rows(), [&](Eigen::Index i, Eigen::Index j) {
    return std::exp(-0.5 * (a.row(i) - b.row(j)).squaredNorm());
  });
}

}  // namespace talkgraph::testing
