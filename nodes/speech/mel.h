#pragma once

#include "graph/description.h"
#include "nodes/speech/filter_bank.h"

namespace talkgraph {

enum class MelScale { htk, slaney };
template <>
inline constexpr EnumNames<MelScale, 2> enum_names<MelScale>{{{MelScale::htk, "htk"}, {MelScale::slaney, "slaney"}}};

enum class Triangles { mel, hertz, bins };
template <>
inline constexpr EnumNames<Triangles, 3> enum_names<Triangles>{
    {{Triangles::mel, "mel"}, {Triangles::hertz, "hertz"}, {Triangles::bins, "bins"}}};

/// Log mel filter bank (T × filters): edges evenly spaced in mel from `low` to `high`, a triangle from each edge over
/// the next to the one after, sums floored, natural log. A triangle that falls between two bins gives the floor.
///
/// The defaults are HTK's: mel = 1127 ln(1 + f / 700), triangles linear in mel, samples of 16 bits. Slaney's mel is f ·
/// 3 / 200 up to 1 kHz and logarithmic above, a factor of 6.4 in 27 steps. Thesis §3.2.
struct Mel {
  int filters = 30;
  double low = 0;   ///< Hz
  double high = 0;  ///< Hz; 0: Nyquist
  MelScale mel = MelScale::htk;
  Triangles triangles = Triangles::mel;  ///< what they are linear in; bins: edges rounded down to bins of the DFT
  bool unit_area = false;                ///< over Hz, instead of a peak of 1
  double scale = 32768;                  ///< full scale of the samples
  double floor = 1;                      ///< least filter output before the log

  FilterOutputs operator()(const Spectrum& spectrum) const;

  /// Weights of the filters (bins × filters).
  Eigen::MatrixXd weights(Eigen::Index bins, double bin_hz) const;
  /// Edges of the filters, Hz (filters + 2): filter m rises from edge m to m + 1 and falls to m + 2.
  Eigen::VectorXd edges(double nyquist) const;
};
void describe(Description<Mel>& d);

}  // namespace talkgraph
