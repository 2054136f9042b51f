#include "nodes/evaluate/lip_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "nodes/latent/em.h"
#include "nodes/latent/gmm.h"
#include "nodes/latent/hmm.h"
#include "nodes/latent/sequences.h"
#include "nodes/types/median.h"
#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

constexpr double kImpossible = -std::numeric_limits<double>::infinity();
constexpr Eigen::Index kLost = -1;

/// Frames of all sequences, one after the other, and what is said in them.
struct Labelled {
  std::vector<std::string> units;
  Eigen::MatrixXd frames;            ///< N × D, 0 where lost
  std::vector<Eigen::Index> unit;    ///< N, the number of each frame's unit, or kLost
  std::vector<Eigen::Index> starts;  ///< of the sequences, and N

  std::size_t sequences() const { return starts.size() - 1; }
};

Labelled labelled(const Collected<Track>& tracks, const Collected<FrameLabels>& labels, bool visemes) {
  const Eigen::Index dimension = measured_runs(tracks).frames.cols();
  Labelled data;
  std::map<std::string, Eigen::Index> numbers;
  std::vector<std::string> said;  // of every frame, nothing where it is lost
  std::vector<Eigen::RowVectorXd> rows;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Track& track = tracks[i];
    const FrameLabels* l = labels.find(tracks.key(i));
    if (!l) continue;
    const auto [frames, longest] = std::minmax<Eigen::Index>(track.frames(), std::ssize(l->labels));
    if (longest > frames + 2)
      throw std::runtime_error(
          fmt::format("{}: {} frames, but {} labels", tracks.key(i), track.frames(), l->labels.size()));
    if (frames > 0) data.starts.push_back(std::ssize(rows));
    for (Eigen::Index t = 0; t < frames; ++t) {
      const bool lost = track.is_lost(t);
      said.push_back(lost ? "" : lip_unit(l->labels[static_cast<std::size_t>(t)], visemes));
      if (!lost) numbers.emplace(said.back(), 0);
      rows.push_back(lost ? Eigen::RowVectorXd::Zero(dimension) : Eigen::RowVectorXd(track.values.row(t)));
    }
  }
  if (numbers.empty()) throw std::runtime_error("no measured frame has a label");
  data.starts.push_back(std::ssize(rows));
  for (auto& [name, number] : numbers) {
    number = std::ssize(data.units);
    data.units.push_back(name);
  }
  data.frames.resize(std::ssize(rows), dimension);
  for (std::size_t n = 0; n < rows.size(); ++n) {
    data.unit.push_back(said[n].empty() ? kLost : numbers[said[n]]);
    data.frames.row(static_cast<Eigen::Index>(n)) = rows[n];
  }
  return data;
}

/// Neighbouring measured frames of one unit: the first of them, and how many.
struct Run {
  Eigen::Index from, frames;
};

std::vector<std::vector<Run>> runs_of_units(const Labelled& data) {
  std::vector<std::vector<Run>> runs(data.units.size());
  for (std::size_t s = 0; s < data.sequences(); ++s)
    for (Eigen::Index from = data.starts[s], to = from; from < data.starts[s + 1]; from = to) {
      const Eigen::Index unit = data.unit[static_cast<std::size_t>(from)];
      while (to < data.starts[s + 1] && data.unit[static_cast<std::size_t>(to)] == unit) ++to;
      if (unit != kLost) runs[static_cast<std::size_t>(unit)].push_back({from, to - from});
    }
  return runs;
}

Eigen::Index states_for(const std::vector<Run>& runs, int most) {
  std::vector<double> lengths;
  for (const Run& run : runs) lengths.push_back(static_cast<double>(run.frames));
  return std::min<Eigen::Index>(most, static_cast<Eigen::Index>(median(lengths)));
}

/// p(next unit | unit) by counts of neighbouring runs, each once more, but for the unit itself; in the last row p(unit)
/// where a sequence begins, U + 1 × U.
Eigen::MatrixXd grammar_of(const Labelled& data) {
  const auto units = std::ssize(data.units);
  Eigen::MatrixXd counts = Eigen::MatrixXd::Ones(units + 1, units);
  counts.topRows(units).diagonal().setZero();
  for (std::size_t s = 0; s < data.sequences(); ++s)
    for (Eigen::Index n = data.starts[s]; n < data.starts[s + 1]; ++n) {
      const bool first = n == data.starts[s];
      const Eigen::Index to = data.unit[static_cast<std::size_t>(n)],
                         from = first ? units : data.unit[static_cast<std::size_t>(n) - 1];
      if (to != kLost && from != kLost && from != to) ++counts(from, to);
    }
  return counts.rowwise().sum().cwiseMax(1).cwiseInverse().asDiagonal() * counts;
}

/// Learns the network of a reader.
class Training {
 public:
  Training(LipReader& reader, const Labelled& data, double floor)
      : reader_(reader), data_(data), floors_(variance_floors(measured(), floor)), grammar_(grammar_of(data)) {}

  /// States of runs that are cut evenly, and every way within a unit and out of it alike.
  void start(const TrainLipReader& settings, Random& random) {
    const auto runs = runs_of_units(data_);
    for (std::size_t u = 0; u < runs.size(); ++u) {
      const Eigen::Index states = states_for(runs[u], settings.states);
      std::vector<std::vector<Eigen::Index>> members(static_cast<std::size_t>(states));
      for (const Run& run : runs[u])
        for (Eigen::Index t = 0; t < run.frames; ++t)
          members[static_cast<std::size_t>(t * states / run.frames)].push_back(run.from + t);
      for (const auto& frames : members) {
        reader_.unit_of.push_back(static_cast<std::int64_t>(u));
        reader_.network.observations.push_back(start_mixture(data_.frames(frames, Eigen::all), settings.mixture,
                                                             floors_, CovarianceKind::diagonal, random));
      }
    }
    const auto states = std::ssize(reader_.unit_of);
    given_.starts.setOnes(states);
    given_.steps.setZero(states, states);
    for (Eigen::Index i = 0; i < states; ++i)
      for (Eigen::Index j = 0; j < states; ++j)
        if (!together(i, j))
          given_.steps(i, j) = 1 / static_cast<double>(states);
        else if (j >= i)
          given_.steps(i, j) = 1;
    reader_.network.transitions.setZero(states, states);
    set_ways();
  }

  double expect() {
    const MarkovChain chain = chain_of(reader_.network);
    const Eigen::MatrixXd densities = kept_to_labels();
    const auto states = densities.cols();
    given_ = {Eigen::MatrixXd(densities.rows(), states), Eigen::VectorXd::Zero(states),
              Eigen::MatrixXd::Zero(states, states)};
    double log_likelihood = 0;
    for (std::size_t s = 0; s < data_.sequences(); ++s) {
      const Eigen::Index from = data_.starts[s], frames = data_.starts[s + 1] - from;
      const ChainPosterior p = forward_backward(chain, densities.middleRows(from, frames));
      given_.states.middleRows(from, frames) = p.states;
      given_.starts += p.states.row(0).transpose();
      given_.steps += p.steps;
      log_likelihood += p.log_likelihood;
    }
    for (std::size_t n = 0; n < data_.unit.size(); ++n)
      if (data_.unit[n] == kLost) given_.states.row(static_cast<Eigen::Index>(n)).setZero();
    return log_likelihood;
  }

  void maximise() {
    talkgraph::maximise(reader_.network.observations, data_.frames, given_.states, floors_, CovarianceKind::diagonal);
    set_ways();
  }

 private:
  bool together(Eigen::Index i, Eigen::Index j) const { return unit(i) == unit(j); }
  std::int64_t unit(Eigen::Index state) const { return reader_.unit_of[static_cast<std::size_t>(state)]; }

  Eigen::MatrixXd measured() const {
    std::vector<Eigen::Index> rows;
    for (std::size_t n = 0; n < data_.unit.size(); ++n)
      if (data_.unit[n] != kLost) rows.push_back(static_cast<Eigen::Index>(n));
    return data_.frames(rows, Eigen::all);
  }

  /// ln p(frame | state), −∞ in states of other units than the label's; a lost frame says nothing.
  Eigen::MatrixXd kept_to_labels() const {
    Eigen::MatrixXd densities = log_densities(reader_.network, data_.frames);
    for (Eigen::Index n = 0; n < densities.rows(); ++n) {
      const Eigen::Index label = data_.unit[static_cast<std::size_t>(n)];
      for (Eigen::Index k = 0; k < densities.cols(); ++k)
        densities(n, k) = label == kLost ? 0 : unit(k) == label ? densities(n, k) : kImpossible;
    }
    return densities;
  }

  /// Start and transitions from the expected steps: out of a unit by how often its states are left, on to others by the
  /// grammar, and into their states by how often runs begin there.
  void set_ways() {
    const auto states = std::ssize(reader_.unit_of);
    Eigen::VectorXd entries = given_.starts, leaving = Eigen::VectorXd::Zero(states);
    for (Eigen::Index i = 0; i < states; ++i)
      for (Eigen::Index j = 0; j < states; ++j)
        if (!together(i, j)) {
          leaving(i) += given_.steps(i, j);
          entries(j) += given_.steps(i, j);
        }
    Eigen::VectorXd of_unit = Eigen::VectorXd::Zero(std::ssize(reader_.units));
    for (Eigen::Index j = 0; j < states; ++j) of_unit(unit(j)) += entries(j);
    Hmm& network = reader_.network;
    network.start.resize(states);
    for (Eigen::Index j = 0; j < states; ++j) {
      entries(j) /= of_unit(unit(j));
      network.start(j) = grammar_(grammar_.rows() - 1, unit(j)) * entries(j);
    }
    for (Eigen::Index i = 0; i < states; ++i) {
      const double total = given_.steps.row(i).sum();
      if (total <= 1e-12) continue;
      for (Eigen::Index j = 0; j < states; ++j)
        network.transitions(i, j) =
            together(i, j) ? given_.steps(i, j) / total : leaving(i) / total * grammar_(unit(i), unit(j)) * entries(j);
    }
  }

  LipReader& reader_;
  const Labelled& data_;
  const Eigen::VectorXd floors_;
  const Eigen::MatrixXd grammar_;
  HmmExpectations given_;
};

}  // namespace

std::string lip_unit(const std::string& phone, bool visemes) {
  const auto number = viseme(phone);
  if (!number)
    throw std::runtime_error(fmt::format(
        "\"{}\" is neither a CMU nor a BEEP phone (lower case, without stress), nor a pause", phone));
  if (*number == 0) return "sil";
  return visemes ? std::to_string(*number) : phone;
}

LipReader TrainLipReader::operator()(const Collected<Track>& tracks, const Collected<FrameLabels>& labels,
                                     Random& random, Context& context) const {
  LipReader reader;
  reader.visemes = units == LipUnits::visemes;
  const Labelled data = labelled(tracks, labels, reader.visemes);
  reader.units = data.units;
  Training training(reader, data, floor);
  training.start(*this, random);
  reader.network.trace = run_em({iterations, tolerance}, data.frames.rows(),
                                fmt::format("{} units, {} states", reader.units.size(), reader.unit_of.size()), context,
                                [&] { return training.expect(); }, [&] { training.maximise(); });
  return reader;
}

void describe(Description<TrainLipReader>& d) {
  d.type("evaluate.lip_reader").version(1).stored();
  d.summary("learns to read lips: hidden Markov models of phones or visemes from recorded faces");
  d.source("Thesis §6.2.4; Hilder, Harvey & Theobald 2009");
  d.input("tracks", "visual features of recorded training sequences")
      .input("labels", "phone of every frame, by the same keys")
      .output("reader", "a network of the models");
  d.param("units", &TrainLipReader::units).doc("what is read");
  d.param("states", &TrainLipReader::states).at_least(1).doc("of a unit, fewer if its runs are shorter in the median");
  d.param("mixture", &TrainLipReader::mixture).at_least(1).doc("Gaussians of each state, diagonal");
  describe_em(d, "a Gaussian");
}

}  // namespace talkgraph
