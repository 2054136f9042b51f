#include "nodes/context/windows.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
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
  std::vector<std::string> phones;
  const Track* audio;
  const Track* visual;
};

struct State {
  std::string label;
  std::vector<Window> windows;
  Eigen::Index frames = 0;
};

std::vector<Sequence> pair_up(const Collected<FrameLabels>& labels, const Collected<Track>& audio,
                              const Collected<Track>& visual) {
  std::vector<Sequence> sequences;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const Track* a = audio.find(labels.key(i));
    const Track* v = visual.find(labels.key(i));
    if (!a || !v) continue;
    const auto n = static_cast<Eigen::Index>(labels[i].labels.size());
    const auto [shortest, longest] = std::minmax({n, a->frames(), v->frames()});
    if (longest - shortest > 2)
      throw std::runtime_error(labels.key(i) + ": " + std::to_string(n) + " labels, " + std::to_string(a->frames()) +
                               " audio frames, " + std::to_string(v->frames()) + " visual frames");
    sequences.push_back({{labels[i].labels.begin(), labels[i].labels.begin() + shortest}, a, v});
  }
  if (sequences.empty())
    throw std::runtime_error("no training sequence has labels, sound and face: is the selection empty?");
  return sequences;
}

void add_context_windows(const Vlmm& vlmm, const std::vector<Sequence>& sequences,
                         std::map<std::string, State>& states) {
  for (const auto& [label, count] : vlmm.occupancy) states[trainable_suffix(vlmm, label)];
  std::size_t longest = 1;
  for (const auto& [label, state] : states) longest = std::max(longest, label_phones(label).size());
  for (std::size_t s = 0; s < sequences.size(); ++s) {
    const auto& phones = sequences[s].phones;
    for (std::size_t end = 1; end <= phones.size(); ++end) {
      std::string label;
      for (std::size_t start = end; start > 0 && end - start < longest; --start) {
        label = phones[start - 1] + (label.empty() ? "" : "-") + label;
        if (const auto it = states.find(label); it != states.end())
          it->second.windows.push_back(
              {s, static_cast<Eigen::Index>(start - 1), static_cast<Eigen::Index>(end - start + 1)});
      }
    }
  }
}

void add_phone_runs(const std::vector<Sequence>& sequences, std::map<std::string, State>& states) {
  for (std::size_t s = 0; s < sequences.size(); ++s) {
    const auto& phones = sequences[s].phones;
    for (std::size_t start = 0, end = 0; start < phones.size(); start = end) {
      while (end < phones.size() && phones[end] == phones[start]) ++end;
      states[phones[start]].windows.push_back(
          {s, static_cast<Eigen::Index>(start), static_cast<Eigen::Index>(end - start)});
    }
  }
}

/// Keeps windows spread evenly over all until they hold no more than `most` frames.
void thin_out(State& state, Eigen::Index most) {
  for (const auto& w : state.windows) state.frames += w.length;
  if (state.frames <= most) return;
  const double kept = static_cast<double>(most) / static_cast<double>(state.frames);
  std::vector<Window> thinned;
  Eigen::Index frames = 0;
  for (std::size_t i = 0; i < state.windows.size(); ++i) {
    const auto& w = state.windows[i];
    const auto due = std::floor(static_cast<double>(i + 1) * kept) > std::floor(static_cast<double>(i) * kept);
    if ((!due || frames + w.length > most) && !thinned.empty()) continue;
    thinned.push_back(w);
    frames += w.length;
  }
  state.windows = std::move(thinned);
  state.frames = frames;
}

StateData cut(const State& state, const std::vector<Sequence>& sequences) {
  StateData data;
  data.label = state.label;
  for (const auto& w : state.windows) {
    data.audio.push_back(sequences[w.sequence].audio->values.middleRows(w.start, w.length));
    data.visual.push_back(sequences[w.sequence].visual->values.middleRows(w.start, w.length));
  }
  return data;
}

}  // namespace

Stream<StateData> ContextWindows::operator()(const Vlmm& vlmm, const Collected<FrameLabels>& labels,
                                             const Collected<Track>& audio, const Collected<Track>& visual) const {
  auto sequences = std::make_shared<const std::vector<Sequence>>(pair_up(labels, audio, visual));
  std::map<std::string, State> by_label;
  if (states == StateKind::contexts)
    add_context_windows(vlmm, *sequences, by_label);
  else
    add_phone_runs(*sequences, by_label);
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
  d.input("vlmm").input("labels", "phones at the video rate").input("audio").input("visual").output("state");
  d.param("states", &ContextWindows::states).doc("what a state stands for; as in context.segment");
  d.param("max_frames", &ContextWindows::max_frames)
      .at_least(1)
      .doc("most frames of a state; its windows are thinned out evenly");
}

}  // namespace talkgraph
