#include "nodes/latent/observed_outputs.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <stdexcept>

#include "nodes/types/centred.h"

namespace talkgraph {

namespace {

using Pattern = std::vector<bool>;

void check(const Eigen::MatrixXd& values, const std::string& stream) {
  for (Eigen::Index c = 0; c < values.cols(); ++c) {
    if (values.col(c).array().isInf().any())
      throw std::runtime_error(fmt::format("the {} stream has an infinite value in dimension {}", stream, c));
    if (values.col(c).array().isNaN().all())
      throw std::runtime_error(
          fmt::format("dimension {} of the {} stream is missing in all {} frames: leave it out, or give frames that "
                      "have it",
                      c, stream, values.rows()));
  }
}

void centre(ObservedOutputs& y, const Eigen::MatrixXd& given, OutputScaling scaling) {
  const CentredFrames frames = centred(given);
  y.mean = frames.mean;
  y.varies = frames.varies();
  y.scale = output_scale(frames.deviation, scaling);
  y.values = frames.values.array().rowwise() / y.scale.array();
}

/// Numbers of equal patterns, in the order in which they are first met.
std::vector<std::vector<Eigen::Index>> equal_patterns(const std::vector<Pattern>& patterns) {
  std::map<Pattern, std::size_t> known;
  std::vector<std::vector<Eigen::Index>> members;
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    const auto [at, fresh] = known.emplace(patterns[i], members.size());
    if (fresh) members.emplace_back();
    members[at->second].push_back(static_cast<Eigen::Index>(i));
  }
  return members;
}

void group(ObservedOutputs& y, const Eigen::MatrixXd& given) {
  std::vector<Pattern> by_output;
  for (Eigen::Index c = 0; c < given.cols(); ++c) {
    by_output.emplace_back();
    for (Eigen::Index n = 0; n < given.rows(); ++n) by_output.back().push_back(!std::isnan(given(n, c)));
  }
  y.groups = equal_patterns(by_output);
  std::vector<Pattern> by_row(static_cast<std::size_t>(given.rows()));
  for (std::size_t n = 0; n < by_row.size(); ++n)
    for (const auto& outputs : y.groups) by_row[n].push_back(by_output[static_cast<std::size_t>(outputs[0])][n]);
  for (auto& rows : equal_patterns(by_row)) {
    ObservedOutputs::Class c;
    const Pattern& has = by_row[static_cast<std::size_t>(rows[0])];
    for (std::size_t g = 0; g < has.size(); ++g)
      if (has[g]) c.groups.push_back(g);
    c.rows = std::move(rows);
    if (!c.groups.empty()) y.classes.push_back(std::move(c));
  }
}

}  // namespace

ObservedOutputs observed_outputs(const Eigen::MatrixXd& values, OutputScaling scaling, const std::string& stream) {
  check(values, stream);
  ObservedOutputs y;
  centre(y, values, scaling);
  group(y, values);
  return y;
}

}  // namespace talkgraph
