#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Line spectral frequencies of a track of predictors, in radians a sample, ascending in (0, π) (T × order). A(z) = 1,
/// as in silence, has k π / (order + 1).
///
/// A predictor that is not of minimum phase has no such frequencies. Its roots outside the unit circle are mirrored at
/// it, which keeps the shape of the spectrum but not its level, and the user is warned of how many frames that befell.
/// Throws std::runtime_error on values that are not finite. Thesis §3.2.
struct Lsf {
  Track operator()(const Track& lpc, Context& context) const;
};
void describe(Description<Lsf>& d);

/// The predictors of line spectral frequencies (T × order). Frequencies that were predicted may be out of order or too
/// near to each other: they are sorted and kept `spacing` rad apart. At a spacing of 0 two equal ones make a root on
/// the unit circle. Throws std::runtime_error on values that are not finite, std::invalid_argument where so many do not
/// fit.
struct FromLsf {
  double spacing = 0;

  Track operator()(const Track& lsf) const;
};
void describe(Description<FromLsf>& d);

/// Reflection coefficients k_1 ... k_p of a track of predictors, k_m = a_m of the predictor of order m (T × order). As
/// for line spectral frequencies, roots outside the unit circle are mirrored, and the user is warned.
struct Reflection {
  Track operator()(const Track& lpc, Context& context) const;
};
void describe(Description<Reflection>& d);

}  // namespace talkgraph
