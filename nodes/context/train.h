#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/vlmm.h"

namespace talkgraph {

/// What a Markov model reads its streams as.
enum class SymbolKind {
  phones,
  visemes  ///< phones as visemes, Table 2.1 of the thesis
};
template <>
inline constexpr EnumNames<SymbolKind, 2> enum_names<SymbolKind>{
    {{SymbolKind::phones, "phones"}, {SymbolKind::visemes, "visemes"}}};

/// Learns a variable length Markov model from phone-per-frame streams (docs/method.md §5,
/// thesis §5.2.1, Algorithm 3).
///
/// Strings of up to order + 1 phones are counted; those in a share of at most
/// `prune` of the symbols are pruned, so that nothing leads to them. A memory
/// σw, |σw| ≤ order, is kept with all its suffixes if it predicts the next
/// phone better than w does,
///   ΔH(σw, w) = p(σw) Σ_σ' p(σ'|σw) ln(p(σ'|σw) / p(σ'|w)) ≥ keep,
/// and on a phone σ it leads to the longest kept suffix of wσ.
///
/// The defaults are chosen by perplexity on held-out recordings, GRID speaker s1 (docs/results.md): it is 4.52,
/// 3.79, 3.51 at order 1 to 3 and 3.53 from 5 on; 4.36, 3.92, 3.53, 3.49, 3.78 at keep = 1e-5, 1e-4, 4e-4, 1e-3, 3e-3;
/// pruning what was seen twice or less costs a third of it.
///
/// Pauses at the ends of a stream (phones.mark_pauses) are labels of their own,
/// no part of a memory. Each counts as one symbol of those that follow no memory,
/// which perplexity and samples leave out.
///
/// Trainable are the longest suffix with at least `min_windows` windows of each
/// label met in training; a phone with fewer is spoken for by the commonest of its viseme if that has as many. Throws
/// std::runtime_error if there is no frame, a label holds '-', or what is no phone is to be a viseme.
struct ContextTrain {
  int order = 6;          ///< N, longest memory, symbols
  double prune = 0;       ///< ε_p
  double keep = 4e-4;     ///< ε_s, nats
  int min_windows = 5;    ///< rarer labels are mapped to a suffix, rarer phones to another of their viseme
  bool repeating = true;  ///< a symbol a frame; false: a symbol a run of equal frames
  SymbolKind symbols = SymbolKind::phones;

  Vlmm operator()(const Collected<FrameLabels>& labels) const;
};
void describe(Description<ContextTrain>& d);

}  // namespace talkgraph
