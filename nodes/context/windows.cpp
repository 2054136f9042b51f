#include "nodes/context/windows.h"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>

#include "nodes/context/automaton.h"

namespace talkgraph {
namespace {

/// A stretch of one training sequence.
struct Window {
  std::size_t sequence = 0;
  Eigen::Index start = 0, length = 0;
};

struct Sequence {
  Eigen::Index frames = 0;
  std::vector<Unit> units;
  const Track* audio;
  const Track* visual;
  std::vector<std::int64_t> cuts;  ///< lost frames that no window may hold
};

struct State {
  std::string label;
  std::vector<Window> windows;
  Eigen::Index frames = 0;
};

std::vector<Sequence> pair_up(const Collected<FrameLabels>& labels, const Collected<Track>& audio,
                              const Collected<Track>& visual, bool visemes, bool runs, bool gaps) {
  std::vector<Sequence> sequences;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const Track* a = audio.find(labels.key(i));
    const Track* v = visual.find(labels.key(i));
    if (!a || !v) continue;
    const auto& phones = labels[i].labels;
    const auto n = static_cast<Eigen::Index>(phones.size());
    const auto [shortest, longest] = std::minmax({n, a->frames(), v->frames()});
    if (longest - shortest > 2)
      throw std::runtime_error(labels.key(i) + ": " + std::to_string(n) + " labels, " + std::to_string(a->frames()) +
                               " audio frames, " + std::to_string(v->frames()) +
                               " visual frames; bring all to one rate");
    sequences.push_back(
        {shortest, units(symbols({phones.begin(), phones.begin() + shortest}, visemes), runs), a, v, {}});
    if (!gaps) sequences.back().cuts = v->lost;
  }
  if (sequences.empty())
    throw std::runtime_error("no training sequence has labels, sound and face: is the selection empty?");
  return sequences;
}

/// The states of the model, without windows.
std::map<std::string, State> states_of(const Vlmm& vlmm, StateKind kind) {
  std::map<std::string, State> states;
  if (kind == StateKind::one)
    states[one_state];
  else
    for (const auto& label : state_labels(vlmm))
      if (kind == StateKind::contexts || phone_count(label) == 1) states[label];
  return states;
}

bool has_cut(const Sequence& sequence, std::int64_t from, std::int64_t to) {
  const auto first = std::lower_bound(sequence.cuts.begin(), sequence.cuts.end(), from);
  return first != sequence.cuts.end() && *first < to;
}

/// Every stretch of units that equals a label and has no cut.
void add_windows(const std::vector<Sequence>& sequences, std::map<std::string, State>& states) {
  std::size_t longest = 0;
  for (const auto& [label, state] : states) longest = std::max(longest, label_phones(label).size());
  for (std::size_t s = 0; s < sequences.size(); ++s) {
    const auto& parts = sequences[s].units;
    for (std::size_t end = 1; end <= parts.size(); ++end) {
      std::string label;
      const auto stop = parts[end - 1].start + parts[end - 1].length;
      for (std::size_t first = end; first > 0 && end - first < longest; --first) {
        const Unit& oldest = parts[first - 1];
        label = oldest.symbol + (label.empty() ? "" : "-") + label;
        if (has_cut(sequences[s], oldest.start, stop)) break;
        if (const auto it = states.find(label); it != states.end())
          it->second.windows.push_back({s, oldest.start, stop - oldest.start});
      }
    }
  }
}

/// Every utterance, in as many windows as its cuts make.
void add_utterances(const std::vector<Sequence>& sequences, State& state) {
  for (std::size_t s = 0; s < sequences.size(); ++s) {
    const Eigen::Index end = sequences[s].frames;
    Eigen::Index start = 0;
    const auto add_until = [&](Eigen::Index stop) {
      if (stop > start) state.windows.push_back({s, start, stop - start});
      start = stop + 1;
    };
    for (const auto lost : sequences[s].cuts)
      if (lost < end) add_until(lost);
    add_until(end);
  }
}

/// Keeps windows spread evenly over all so that they hold at most `most`
/// frames, and at least one window.
void thin_out(State& state, Eigen::Index most) {
  for (const auto& w : state.windows) state.frames += w.length;
  if (state.frames <= most) return;
  const auto count = static_cast<Eigen::Index>(state.windows.size());
  const auto kept = std::max<Eigen::Index>(1, count * most / state.frames);
  std::vector<Window> thinned;
  state.frames = 0;
  for (Eigen::Index i = 0; i < kept; ++i) {
    const auto& w = state.windows[static_cast<std::size_t>((2 * i + 1) * count / (2 * kept))];
    if (!thinned.empty() && state.frames + w.length > most) break;
    thinned.push_back(w);
    state.frames += w.length;
  }
  state.windows = std::move(thinned);
}

Eigen::MatrixXd with_gaps(const Track& track, const Window& w) {
  Eigen::MatrixXd values = track.values.middleRows(w.start, w.length);
  for (Eigen::Index t = 0; t < w.length; ++t)
    if (track.is_lost(w.start + t)) values.row(t).setConstant(std::numeric_limits<double>::quiet_NaN());
  return values;
}

StateData cut(const State& state, const std::vector<Sequence>& sequences) {
  StateData data;
  data.label = state.label;
  for (const auto& w : state.windows) {
    data.audio.push_back(sequences[w.sequence].audio->values.middleRows(w.start, w.length));
    data.visual.push_back(with_gaps(*sequences[w.sequence].visual, w));
  }
  return data;
}

}  // namespace

Stream<StateData> ContextWindows::operator()(const Vlmm& vlmm, const Collected<FrameLabels>& labels,
                                             const Collected<Track>& audio, const Collected<Track>& visual) const {
  const bool runs = states == StateKind::phones || !vlmm.repeating;
  auto sequences =
      std::make_shared<const std::vector<Sequence>>(pair_up(labels, audio, visual, vlmm.visemes, runs, gaps));
  auto by_label = states_of(vlmm, states);
  if (states == StateKind::one)
    add_utterances(*sequences, by_label[one_state]);
  else
    add_windows(*sequences, by_label);
  auto all = std::make_shared<std::vector<State>>();
  for (auto& [label, state] : by_label) {
    if (state.windows.empty()) continue;
    state.label = label;
    thin_out(state, max_frames);
    all->push_back(std::move(state));
  }
  std::stable_sort(all->begin(), all->end(), [](const State& a, const State& b) { return a.frames > b.frames; });
  return Stream<StateData>(
      [all, sequences, i = std::size_t{0}]() mutable -> std::optional<Item<StateData>> {
        if (i == all->size()) return {};
        const State& state = (*all)[i++];
        return Item<StateData>{state.label, cut(state, *sequences)};
      },
      all->size());
}

void describe(Description<ContextWindows>& d) {
  d.type("context.windows")
      .summary("the training windows of each state, one item a state")
      .source("Thesis §5.2.4, Algorithm 6");
  d.input("vlmm", "the contexts")
      .input("labels", "phones at the video rate")
      .input("audio", "speech features at the video rate")
      .input("visual", "visual parameters at that rate")
      .output("state", "windows of audio and visual frames, by the state's label");
  d.param("states", &ContextWindows::states).doc("what a state stands for; as in context.segment");
  d.param("max_frames", &ContextWindows::max_frames)
      .at_least(1)
      .doc("most frames of a state; its windows are thinned out evenly");
  d.param("gaps", &ContextWindows::gaps)
      .doc("windows keep lost visual frames, as missing values for latent.mrd; else they have none");
}

}  // namespace talkgraph
