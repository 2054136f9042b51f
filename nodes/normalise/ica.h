#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/normalise/fast_ica.h"
#include "nodes/types/independent_components.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

template <>
inline constexpr EnumNames<Decorrelation, 2> enum_names<Decorrelation>{
    {{Decorrelation::symmetric, "symmetric"}, {Decorrelation::deflation, "deflation"}}};
template <>
inline constexpr EnumNames<Contrast, 2> enum_names<Contrast>{
    {{Contrast::logcosh, "logcosh"}, {Contrast::gauss, "gauss"}}};

/// Independent components of the rows of all tracks, lost frames left out
/// (thesis Appendix A). Rows are whitened first; directions in which they do
/// not vary, or that are beyond `components`, are left out: there the
/// components say nothing. Warns of
/// components that have not settled. Throws std::runtime_error on no tracks,
/// dimensions that differ, values that are not finite, fewer rows than
/// dimensions, and rows that do not vary.
struct LearnIca {
  Decorrelation decorrelation = Decorrelation::symmetric;
  Contrast contrast = Contrast::logcosh;
  double a1 = 1;
  int components = 0;  ///< of the largest variance kept in whitening; 0: all
  int iterations = 500;
  double tolerance = 1e-6;

  struct Out {
    IndependentComponents components;
    /// A row a component: share of the variance, excess kurtosis, iterations taken, change in the last of them.
    Table convergence;
  };
  Out operator()(const Collected<Track>& tracks, Random& random, Context& context) const;
};
void describe(Description<LearnIca>& d);

}  // namespace talkgraph
