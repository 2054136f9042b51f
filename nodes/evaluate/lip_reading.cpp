#include "nodes/evaluate/lip_reading.h"

#include "nodes/evaluate/edit_path.h"
#include "nodes/evaluate/lip_reader.h"
#include "nodes/latent/hmm.h"
#include "nodes/latent/sequences.h"
#include "nodes/types/paired.h"

namespace talkgraph {
namespace {

/// One a run, pauses left out.
std::vector<std::string> spoken(const std::vector<std::string>& units) {
  std::vector<std::string> runs;
  for (std::size_t t = 0; t < units.size(); ++t)
    if (units[t] != "sil" && (t == 0 || units[t] != units[t - 1])) runs.push_back(units[t]);
  return runs;
}

}  // namespace

std::vector<std::string> read_lips(const LipReader& reader, const Track& track, double insertion) {
  require_frames_of(track, reader.network.observations.at(0).dimension(), "the lip reader");
  if (track.frames() == 0) return {};
  Eigen::MatrixXd densities = log_densities(reader.network, track.values);
  for (const Eigen::Index t : track.lost) densities.row(t).setZero();
  MarkovChain chain = chain_of(reader.network);
  const auto unit = [&](Eigen::Index state) { return reader.unit_of[static_cast<std::size_t>(state)]; };
  for (Eigen::Index i = 0; i < densities.cols(); ++i)
    for (Eigen::Index j = 0; j < densities.cols(); ++j)
      if (unit(i) != unit(j)) chain.log_transitions(i, j) += insertion;
  std::vector<std::string> units;
  for (const Eigen::Index state : viterbi(chain, densities).states)
    units.push_back(reader.units[static_cast<std::size_t>(unit(state))]);
  return units;
}

std::optional<Scores> ScoreLipReading::operator()(const LipReader& reader, const Track& track,
                                                  const FrameLabels& labels) const {
  common_frames("the sequence", track.frames(), "frames", std::ssize(labels.labels), "labels");
  std::vector<std::string> units;
  for (const auto& phone : labels.labels) units.push_back(lip_unit(phone, reader.visemes));
  const auto said = spoken(units), read = spoken(read_lips(reader, track, insertion));
  if (said.empty()) return {};
  const auto pair = [&](std::size_t i, std::size_t j) { return said[i] == read[j] ? 0 : 10; };
  double right = 0, extra = 0;
  std::size_t i = said.size(), j = read.size();
  for (const Edit step : edit_path(said.size(), read.size(), 7, pair)) {
    i -= step != Edit::extra;
    j -= step != Edit::missing;
    right += step == Edit::pair && said[i] == read[j];
    extra += step == Edit::extra;
  }
  const auto n = static_cast<double>(said.size());
  return Scores{{{name + "_correct", right / n}, {name + "_accuracy", (right - extra) / n}}};
}

void describe(Description<ScoreLipReading>& d) {
  d.type("evaluate.lip_reading").summary("what a lip reader trained on recorded faces reads off a face");
  d.source("Thesis §6.2.4; HTK Book, HResults");
  d.input("reader", "of evaluate.lip_reader, trained on recorded faces")
      .input("track", "visual features as it was trained on, recorded or synthesised")
      .input("labels", "phone of every frame, as said")
      .output("scores",
              "x_correct: units of speech that are read right off the lips, share of those said; x_accuracy: units "
              "read right less those read that were not said, share of those said; x is the name");
  d.param("name", &ScoreLipReading::name).doc("of the units, in the names of the scores");
  d.param("insertion", &ScoreLipReading::insertion)
      .within(-1000, 1000)
      .doc("added to ln p for every unit read; below 0 fewer are read");
}

}  // namespace talkgraph
