#include "nodes/evaluate/lip_reader.h"

#include <fmt/format.h>

#include <algorithm>
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

/// The runs of one unit, its frames one after the other, and a left-to-right model of them.
struct Unit {
  struct Run {
    Eigen::Index frames;
    bool left;  ///< another unit follows
  };
  std::vector<Run> runs;
  std::vector<Eigen::RowVectorXd> rows;

  Eigen::MatrixXd frames;  ///< N × D
  Hmm model;               ///< of S states; transitions leave room for the way out
  Eigen::VectorXd exits;   ///< p(the unit ends | state), S

  // What an expectation step gathers.
  HmmExpectations given;
  Eigen::VectorXd leaving;  ///< expected number of ways out, S
};

struct Speech {
  std::map<std::string, Unit> units;
  std::map<std::pair<std::string, std::string>, double> steps;  ///< from unit to unit, how many
  std::map<std::string, double> starts;                         ///< first units of sequences, how many
};

/// Adds the runs of a sequence; lost frames end runs.
void add(Speech& speech, const Track& track, const std::vector<std::string>& said) {
  std::string before;  // the unit of the frame before, nothing where there is none
  for (std::size_t t = 0; t < said.size(); ++t) {
    if (track.is_lost(static_cast<Eigen::Index>(t))) {
      before.clear();
      continue;
    }
    Unit& unit = speech.units[said[t]];
    if (said[t] != before) unit.runs.push_back({0, false});
    ++unit.runs.back().frames;
    unit.rows.emplace_back(track.values.row(static_cast<Eigen::Index>(t)));
    if (t == 0) ++speech.starts[said[t]];
    if (!before.empty() && said[t] != before) {
      speech.units[before].runs.back().left = true;
      ++speech.steps[{before, said[t]}];
    }
    before = said[t];
  }
}

Speech gathered(const Collected<Track>& tracks, const Collected<FrameLabels>& labels, bool visemes) {
  measured_runs(tracks);  // refuses what cannot be learnt from
  Speech speech;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const FrameLabels* l = labels.find(tracks.key(i));
    if (!l) continue;
    const auto [frames, longest] = std::minmax<Eigen::Index>({tracks[i].frames(), std::ssize(l->labels)});
    if (longest > frames + 2)
      throw std::runtime_error(
          fmt::format("{}: {} frames, but {} labels", tracks.key(i), tracks[i].frames(), l->labels.size()));
    std::vector<std::string> said;
    for (Eigen::Index t = 0; t < frames; ++t) said.push_back(lip_unit(l->labels[static_cast<std::size_t>(t)], visemes));
    add(speech, tracks[i], said);
  }
  if (speech.units.empty()) throw std::runtime_error("no measured frame has a label");
  return speech;
}

Eigen::MatrixXd stacked(const std::vector<Eigen::RowVectorXd>& rows) {
  Eigen::MatrixXd frames(std::ssize(rows), rows.at(0).size());
  for (std::size_t n = 0; n < rows.size(); ++n) frames.row(static_cast<Eigen::Index>(n)) = rows[n];
  return frames;
}

/// As many states as runs have frames in the median.
Eigen::Index states_of(const Unit& unit, int most) {
  std::vector<double> lengths;
  for (const Unit::Run& run : unit.runs) lengths.push_back(static_cast<double>(run.frames));
  return std::min<Eigen::Index>(most, static_cast<Eigen::Index>(median(lengths)));
}

/// Start, ways and exits from what was expected.
void set_ways(Unit& unit) {
  unit.model.start = unit.given.starts / unit.given.starts.sum();
  for (Eigen::Index i = 0; i < unit.exits.size(); ++i) {
    const double total = unit.given.steps.row(i).sum() + unit.leaving(i);
    if (total <= 1e-12) continue;
    unit.model.transitions.row(i) = unit.given.steps.row(i) / total;
    unit.exits(i) = unit.leaving(i) / total;
  }
}

/// States of runs that are cut evenly; every way on, and out, alike.
void start(Unit& unit, const TrainLipReader& settings, const Eigen::VectorXd& floors, Random& random) {
  const Eigen::Index states = states_of(unit, settings.states);
  std::vector<std::vector<Eigen::Index>> members(static_cast<std::size_t>(states));
  Eigen::Index from = 0;
  for (const Unit::Run& run : unit.runs)
    for (Eigen::Index t = 0; t < run.frames; ++t)
      members[static_cast<std::size_t>(t * states / run.frames)].push_back(from++);
  for (const auto& frames : members)
    unit.model.observations.push_back(
        start_mixture(unit.frames(frames, Eigen::all), settings.mixture, floors, CovarianceKind::diagonal, random));
  unit.model.transitions.setZero(states, states);
  unit.exits.setZero(states);
  unit.given.starts.setOnes(states);
  unit.given.steps = Eigen::MatrixXd(Eigen::MatrixXd::Ones(states, states)).triangularView<Eigen::Upper>();
  unit.leaving.setOnes(states);
  set_ways(unit);
}

double expect(Unit& unit) {
  const MarkovChain chain = chain_of(unit.model);
  const Eigen::MatrixXd densities = log_densities(unit.model, unit.frames);
  const Eigen::Index states = densities.cols();
  unit.given = {Eigen::MatrixXd(densities.rows(), states), Eigen::VectorXd::Zero(states),
                Eigen::MatrixXd::Zero(states, states)};
  unit.leaving.setZero(states);
  double log_likelihood = 0;
  Eigen::Index from = 0;
  for (const Unit::Run& run : unit.runs) {
    Eigen::MatrixXd of_run = densities.middleRows(from, run.frames);
    if (run.left) of_run.bottomRows(1) += unit.exits.array().log().matrix().transpose();
    const ChainPosterior p = forward_backward(chain, of_run);
    unit.given.states.middleRows(from, run.frames) = p.states;
    unit.given.starts += p.states.row(0).transpose();
    unit.given.steps += p.steps;
    if (run.left) unit.leaving += p.states.row(run.frames - 1).transpose();
    log_likelihood += p.log_likelihood;
    from += run.frames;
  }
  return log_likelihood;
}

/// p(next unit | unit) by counts of neighbouring runs, each once more, but for the unit itself; in the last row p(unit)
/// where a sequence begins, U + 1 × U.
Eigen::MatrixXd grammar_of(const Speech& speech, const std::vector<std::string>& units) {
  const auto number = [&](const std::string& unit) {
    return std::lower_bound(units.begin(), units.end(), unit) - units.begin();
  };
  const auto size = std::ssize(units);
  Eigen::MatrixXd counts = Eigen::MatrixXd::Ones(size + 1, size);
  counts.topRows(size).diagonal().setZero();
  for (const auto& [step, count] : speech.steps) counts(number(step.first), number(step.second)) += count;
  for (const auto& [unit, count] : speech.starts) counts(size, number(unit)) += count;
  return counts.rowwise().sum().cwiseMax(1).cwiseInverse().asDiagonal() * counts;
}

/// All units side by side, ways out of each leading into every other.
LipReader joined(const Speech& speech) {
  LipReader reader;
  Hmm& network = reader.network;
  std::vector<double> entries, exits;
  for (const auto& [name, unit] : speech.units) {
    for (Eigen::Index k = 0; k < unit.exits.size(); ++k) {
      reader.unit_of.push_back(std::ssize(reader.units));
      entries.push_back(unit.model.start(k));
      exits.push_back(unit.exits(k));
    }
    network.observations.insert(network.observations.end(), unit.model.observations.begin(),
                                unit.model.observations.end());
    reader.units.push_back(name);
  }
  const Eigen::MatrixXd grammar = grammar_of(speech, reader.units);
  const auto states = entries.size();
  network.start.resize(std::ssize(entries));
  network.transitions.resize(std::ssize(entries), std::ssize(entries));
  for (std::size_t j = 0; j < states; ++j) {
    const auto to = static_cast<Eigen::Index>(j);
    network.start(to) = grammar(grammar.rows() - 1, reader.unit_of[j]) * entries[j];
    for (std::size_t i = 0; i < states; ++i)
      network.transitions(static_cast<Eigen::Index>(i), to) =
          exits[i] * grammar(reader.unit_of[i], reader.unit_of[j]) * entries[j];
  }
  Eigen::Index from = 0;
  for (const auto& [name, unit] : speech.units) {
    const Eigen::Index size = unit.exits.size();
    network.transitions.block(from, from, size, size) = unit.model.transitions;
    from += size;
  }
  return reader;
}

}  // namespace

std::string lip_unit(const std::string& phone, bool visemes) {
  const auto number = viseme(phone);
  if (!number)
    throw std::runtime_error(
        fmt::format("\"{}\" is neither a CMU nor a BEEP phone (lower case, without stress), nor a pause", phone));
  if (*number == 0) return "sil";
  return visemes ? std::to_string(*number) : phone;
}

LipReader TrainLipReader::operator()(const Collected<Track>& tracks, const Collected<FrameLabels>& labels,
                                     Random& random, Context& context) const {
  const bool visemes = units == LipUnits::visemes;
  Speech speech = gathered(tracks, labels, visemes);
  const Eigen::MatrixXd all = measured_runs(tracks).frames;
  const Eigen::VectorXd floors = variance_floors(all, floor);
  for (auto& [name, unit] : speech.units) {
    unit.frames = stacked(unit.rows);
    start(unit, *this, floors, random);
  }
  const auto trace = run_em(
      {iterations, tolerance}, all.rows(), fmt::format("models of {} units", speech.units.size()), context,
      [&] {
        double log_likelihood = 0;
        for (auto& [name, unit] : speech.units) log_likelihood += expect(unit);
        return log_likelihood;
      },
      [&] {
        for (auto& [name, unit] : speech.units) {
          set_ways(unit);
          maximise(unit.model.observations, unit.frames, unit.given.states, floors, CovarianceKind::diagonal);
        }
      });
  LipReader reader = joined(speech);
  reader.visemes = visemes;
  reader.network.trace = trace;
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
