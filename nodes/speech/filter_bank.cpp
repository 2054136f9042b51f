#include "nodes/speech/filter_bank.h"

#include <stdexcept>

namespace talkgraph {

Track log_outputs(const Spectrum& spectrum, const Eigen::MatrixXd& weights, double scale, double floor) {
  Track out;
  out.rate = spectrum.rate;
  out.start = spectrum.start;
  out.values = spectrum.values * ((spectrum.power ? scale * scale : scale) * weights);
  out.values = out.values.cwiseMax(floor).array().log();
  return out;
}

double bank_end(double low, double high, double nyquist) {
  const double end = high > 0 ? high : nyquist;
  if (low >= end || end > nyquist * (1 + 1e-9))
    throw std::invalid_argument("filters from " + std::to_string(low) + " to " + std::to_string(end) +
                                " Hz do not fit below the Nyquist frequency of " + std::to_string(nyquist) + " Hz");
  return end;
}

}  // namespace talkgraph
