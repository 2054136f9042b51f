#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/mapping/tied_gaussians.h"
#include "nodes/mapping/trajectory_error.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Trajectory hidden Markov model with minimum generation error (Tokuda et al. 2000; Wu and Wang 2006; Zen, Tokuda and
/// Kitamura 2007; of sound and face Wang, Qian, Scott, Chen and Soong 2010): the states of phones in context give
/// Gaussians of sound and face with their slopes and curvatures. Expectation maximisation starts from phones cut evenly
/// and knows where phones begin; where their states do, it finds. Trees of questions share Gaussians, those of the
/// sound apart from those of the face: at first about phones alone, then about their neighbours too. Then means and
/// logarithms of variances of the face take steps of scaled conjugate gradients down the mean squared error of the
/// trajectories of all training sequences, in the states that the sound makes likeliest.
///
/// Of the sources this differs in that states may be skipped, as a phone may last but a frame at video rates; in one
/// matrix of transitions for all phones; in trees about the nearest neighbours alone; and in the descent, which takes
/// all sequences at once without a learning rate.
///
/// Frames are scaled to mean 0 and deviation 1. Every run of measured frames is a sequence, with pauses around it.
/// Streams are paired by key. Throws std::runtime_error if none pair, if lengths differ by more than two frames, on
/// different dimensions, on values that are not finite, and if no visual frame is measured.
struct TrainTrajectoryHmm {
  int states = 5;
  double occupancy = 20;
  double penalty = 1;
  double floor = 1e-2;
  int iterations = 20;
  double tolerance = 1e-4;
  int descent = 60;

  TrajectoryHmm operator()(const Collected<Track>& audio, const Collected<Track>& visual,
                           const Collected<FrameLabels>& labels, Context& context) const;
};
void describe(Description<TrainTrajectoryHmm>& d);

/// The Gaussians of the face.
StateGaussians face_of(const TrajectoryHmm& model);
/// Through the states of one sequence that its scaled sound, T × D_Y, makes likeliest inside its phones.
StatePath path_of(const TrajectoryHmm& model, const Eigen::MatrixXd& audio, const std::vector<std::string>& labels);

}  // namespace talkgraph
