#include "nodes/latent/sequences.h"

#include <gtest/gtest.h>

#include <ctime>

#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

Track track_of(Eigen::MatrixXd values, std::vector<std::int64_t> lost = {}) {
  Track track;
  track.values = std::move(values);
  track.lost = std::move(lost);
  return track;
}

TEST(MeasuredRuns, AreSequencesOfTheFramesThatAreNotLost) {
  const Eigen::MatrixXd a = gaussian(6, 2, 1), b = gaussian(3, 2, 2);
  const Sequences s = measured_runs({{"a", track_of(a, {0, 3, 4})}, {"none", {}}, {"b", track_of(b)}});
  EXPECT_EQ(s.lengths, (std::vector<std::int64_t>{2, 1, 3}));
  Eigen::MatrixXd frames(6, 2);
  frames << a.row(1), a.row(2), a.row(5), b;
  EXPECT_EQ(s.frames, frames);
  EXPECT_THROW(measured_runs({{"a", track_of(a)}, {"b", track_of(gaussian(3, 3, 1))}}), std::runtime_error);
  EXPECT_THROW(measured_runs({{"b", track_of(b, {0, 1, 2})}}), std::runtime_error);
}

TEST(MeasuredRuns, TakeTimeInProportionToTheFrames) {
  Collected<Track> tracks;
  const Track one = track_of(gaussian(25, 40, 1));
  for (int i = 0; i < 4000; ++i) tracks.add(std::to_string(i), one);
  const std::clock_t start = std::clock();
  EXPECT_EQ(measured_runs(tracks).frames.rows(), 100000);
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 3);
}

}  // namespace
}  // namespace talkgraph
