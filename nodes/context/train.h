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
/// The defaults have the least perplexity on held-out recordings: GRID speaker
/// s1, forced alignment, 198 clips to train on and 30 validation clips. There
/// it falls with the order (2.23, 2.01, 1.89, 1.86 for 1 to 4) and no further
/// beyond 5; 1.86 at keep = 4e-4, 1.97 at 1e-4, 2.15 at 1e-5, 1.93 at 1e-3;
/// pruning what was seen once costs 0.14. At keep = 1e-4 segments are about
/// twice as long.
///
/// Pauses at the ends of a stream (phones.mark_pauses) are labels of their own,
/// no part of a memory.
///
/// Trainable are the longest suffix with at least `min_windows` windows of each
/// label met in training, and every phone. Throws std::runtime_error if there
/// is no frame, a label holds '-', or what is no phone is to be a viseme.
struct ContextTrain {
  int order = 6;          ///< N, longest memory, symbols
  double prune = 0;       ///< ε_p
  double keep = 4e-4;     ///< ε_s, nats
  int min_windows = 5;    ///< rarer labels are mapped to a suffix
  bool repeating = true;  ///< a symbol a frame; false: a symbol a run of equal frames
  SymbolKind symbols = SymbolKind::phones;

  Vlmm operator()(const Collected<FrameLabels>& labels) const;
};
void describe(Description<ContextTrain>& d);

}  // namespace talkgraph
