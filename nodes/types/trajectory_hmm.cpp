#include "nodes/types/trajectory_hmm.h"

#include "nodes/types/stored_model.h"

namespace talkgraph {

void fields(Archive& ar, ContextNode& n) {
  ar("place", n.place);
  ar("viseme", n.viseme);
  ar("phone", n.phone);
  ar("yes", n.yes);
  ar("no", n.no);
  ar("row", n.row);
}

void fields(Archive& ar, TiedGaussians& g) {
  ar("nodes", g.nodes);
  ar("means", g.means);
  ar("variances", g.variances);
}

namespace {

void check_tied(const StoredModel& stored, const std::string& member, const TiedGaussians& g, Eigen::Index positions,
                Eigen::Index dimension) {
  const auto nodes = std::ssize(g.nodes);
  const Eigen::Index leaves = g.means.rows();
  stored.matrix(member + ".means", g.means, leaves, dimension);
  stored.variances(member + ".variances", g.variances, leaves, dimension);
  stored.require(nodes >= positions, member + ".nodes", "lack the root of a tree");
  for (std::int64_t i = 0; i < nodes; ++i) {
    const ContextNode& node = g.nodes[static_cast<std::size_t>(i)];
    // What follows a question stands behind it, so that every way ends.
    const auto follows = [&](std::int64_t next) { return next > i && next < nodes; };
    stored.require(node.yes == 0 ? node.row >= 0 && node.row < leaves : follows(node.yes) && follows(node.no),
                   member + ".nodes", "lead to no Gaussian");
  }
}

void check(const TrajectoryHmm& h) {
  const StoredModel stored("trajectory hidden Markov model");
  const Eigen::Index states = h.start.size(), heard = h.audio.mean.size(), seen = h.visual.mean.size();
  stored.scaling("audio", h.audio, heard);
  stored.scaling("visual", h.visual, seen);
  stored.matrix("start", h.start, states, 1);
  stored.weights("start", h.start);
  stored.matrix("transitions", h.transitions, states, states);
  stored.weights("transitions", h.transitions);
  check_tied(stored, "sound", h.sound, states, 3 * heard);
  check_tied(stored, "face", h.face, states, 3 * seen);
}

}  // namespace

void fields(Archive& ar, TrajectoryHmm& h) {
  ar("audio", h.audio);
  ar("visual", h.visual);
  ar("start", h.start);
  ar("transitions", h.transitions);
  ar("sound", h.sound);
  ar("face", h.face);
  ar("trace", h.trace);
  ar("errors", h.errors);
  if (ar.loading()) check(h);
}

}  // namespace talkgraph
